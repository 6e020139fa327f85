"""What a job may do with a mesh."""

from typing import Literal, get_args

Task = Literal["fill", "restore", "denoise", "encode", "decode"]
FILL: Task = "fill"
TASKS: tuple[Task, ...] = get_args(Task)

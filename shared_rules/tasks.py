"""What a job may do with a mesh."""

from collections.abc import Mapping
from types import MappingProxyType
from typing import Literal, get_args

Task = Literal["fill", "restore", "denoise", "encode", "decode"]
FILL: Task = "fill"
TASKS: tuple[Task, ...] = get_args(Task)
# What names of results say was done.
DONE: Mapping[Task, str] = MappingProxyType(
    {"fill": "repaired", "restore": "restored", "denoise": "denoised", "encode": "encoded", "decode": "decoded"}
)

"""What a job may do with a mesh, or learn from several."""

from collections.abc import Mapping
from types import MappingProxyType
from typing import Literal, get_args

Task = Literal["fill", "restore", "denoise", "encode", "decode", "train"]
FILL: Task = "fill"
TRAIN: Task = "train"
TASKS: tuple[Task, ...] = get_args(Task)
# What names of results say was done.
DONE: Mapping[Task, str] = MappingProxyType(
    {
        "fill": "repaired",
        "restore": "restored",
        "denoise": "denoised",
        "encode": "encoded",
        "decode": "decoded",
        "train": "learned",
    }
)

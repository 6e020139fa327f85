"""Stages of a repair, in order: the names in progress, events and reports."""

from typing import Literal, get_args

Stage = Literal[
    "read",
    "holes",
    "fill",
    "smooth",
    "quadrangulate",
    "patchify",
    "learn",
    "inpaint",
    "reconstruct",
    "judge",
    "colour",
    "write",
]
STAGES: tuple[Stage, ...] = get_args(Stage)

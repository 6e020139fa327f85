"""What every task hands back once its file has been written."""

from dataclasses import dataclass
from typing import Any

from quadpatch.types import BoolArray, TriangleMesh


@dataclass(frozen=True)
class TaskResult:
    """A task whose output has been written.

    Attributes
    ----------
    report : dict
        JSON-ready. Optional steps that follow add their warnings and seconds to it.
    before, after : TriangleMesh
        What pictures are drawn from.
    changed : (n_triangles of `after`,) bool
        Triangles that the task placed anew; pictures tint them.
    """

    report: dict[str, Any]
    before: TriangleMesh
    after: TriangleMesh
    changed: BoolArray

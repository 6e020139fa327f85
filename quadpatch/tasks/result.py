"""What every task hands back once its file has been written."""

from dataclasses import dataclass
from typing import Any

from quadpatch.types import BoolArray, FloatArray, TriangleMesh


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
    shift : (n_triangles of `after`,) float64, optional
        How far each of them moved, 0..1 of what counts as far; pictures tint by it instead.
    """

    report: dict[str, Any]
    before: TriangleMesh
    after: TriangleMesh
    changed: BoolArray
    shift: FloatArray | None = None

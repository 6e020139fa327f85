"""A PLY file in memory, as its writer needs it."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from quadpatch.formats.ply.header import Header
from quadpatch.formats.ply.rows import Rows
from quadpatch.types import IntArray

INDEX_NAMES = ("vertex_indices", "vertex_index")


@dataclass(frozen=True)
class PlyFile:
    """A PLY file as it was read.

    Attributes
    ----------
    data : bytes
        The whole file.
    header : Header
    rows : tuple of Rows
        One for each element of the header.
    carrier : str
        Element that holds the triangles and takes further ones: `face` or `tristrips`, the later one in the file.
    polygon : (m,) int64 or None
        Row of `face` that each triangle was cut from, -1 for triangles of strips; None where triangle and row have one
        number, as in nearly all files.
    n_triangles : int
    """

    data: bytes
    header: Header
    rows: tuple[Rows, ...]
    carrier: str
    polygon: IntArray | None
    n_triangles: int

    @cached_property
    def triangle_row(self) -> IntArray:
        """Row of `face` of each triangle, (m,) int64, -1 for triangles of strips."""
        return np.arange(self.n_triangles) if self.polygon is None else self.polygon

    def rows_of(self, triangles: IntArray) -> IntArray:
        """Return the row of `face` of some triangles (k,)."""
        return triangles if self.polygon is None else self.polygon[triangles]

    def element(self, name: str) -> Rows | None:
        """Rows of an element, None where the file has none of that name."""
        return next((rows for rows in self.rows if rows.element.name == name), None)

"""A PLY file in memory, as its writer needs it."""

from dataclasses import dataclass

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
    triangle_row : (m,) int64
        Row of `face` that each triangle was cut from, -1 for triangles of strips.
    """

    data: bytes
    header: Header
    rows: tuple[Rows, ...]
    carrier: str
    triangle_row: IntArray

    def element(self, name: str) -> Rows | None:
        """Rows of an element, None where the file has none of that name."""
        return next((rows for rows in self.rows if rows.element.name == name), None)

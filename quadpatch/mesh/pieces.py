"""Connected pieces of a mesh."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from quadpatch.mesh.topology import components
from quadpatch.types import FloatArray, IntArray, TriangleMesh


@dataclass(frozen=True)
class Pieces:
    """Which piece each vertex and each loop belongs to.

    Attributes
    ----------
    of_vertex : (n_vertices,) int64
    of_loop : (n_loops,) int64
    diagonals : (n_pieces,) float64
        Of the bounding box of each piece, in mesh units.
    """

    of_vertex: IntArray
    of_loop: IntArray
    diagonals: FloatArray

    @cached_property
    def _by_piece(self) -> tuple[IntArray, IntArray]:
        order = np.argsort(self.of_vertex, kind="stable")
        return order, np.searchsorted(self.of_vertex[order], np.arange(len(self.diagonals) + 1))

    def vertices_of(self, piece: int) -> IntArray:
        """Return the vertices (n,) of one piece."""
        order, starts = self._by_piece
        return order[starts[piece] : starts[piece + 1]]


def find_pieces(mesh: TriangleMesh, loops: list[IntArray]) -> Pieces:
    """Find the connected pieces of a mesh, and those of some non-empty loops of vertices."""
    n, triangles = len(mesh.vertices), mesh.triangles
    piece = components(np.stack([triangles[:, :2].ravel(), triangles[:, 1:].ravel()], axis=1), n)
    count = int(piece.max(initial=-1)) + 1
    low, high = np.full((count, 3), np.inf), np.full((count, 3), -np.inf)
    np.minimum.at(low, piece, mesh.vertices)
    np.maximum.at(high, piece, mesh.vertices)
    of_loop = piece[np.array([loop[0] for loop in loops], np.int64)]
    return Pieces(piece, of_loop, np.linalg.norm(high - low, axis=1))

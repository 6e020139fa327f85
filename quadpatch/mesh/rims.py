"""The rims of boundary loops, laid end to end in flat arrays, with the faces that lie along them.

Edge i of a rim runs from its vertex i to the next one of its loop, with its face on the left.
"""

from dataclasses import dataclass

import numpy as np

from quadpatch.mesh.loops import laid_out
from quadpatch.mesh.normals import unit
from quadpatch.mesh.topology import edges_found
from quadpatch.types import FloatArray, IntArray, TriangleMesh, Triangles, Vertices


@dataclass(frozen=True)
class Rims:
    """All rims of a mesh; n edges in all.

    Attributes
    ----------
    starts : (n_loops + 1,) int64
        The edges of loop k are those from starts[k] to starts[k + 1].
    loop : (n,) int64
        Position of each edge's loop.
    points, edges : (n, 3) float64
        Where each edge starts, and the way to its end.
    lengths : (n,) float64
    inward : (n, 3) float64
        Unit vector across the edge into its face, in the plane of that face; 0 where there is no such face.
    heights : (n,) float64
        Height of the face over the edge.
    """

    starts: IntArray
    loop: IntArray
    points: Vertices
    edges: FloatArray
    lengths: FloatArray
    inward: FloatArray
    heights: FloatArray

    @property
    def n_loops(self) -> int:
        """Number of loops."""
        return len(self.starts) - 1

    def sums(self, values: FloatArray) -> FloatArray:
        """Sum values (n, ...) over the edges of each loop, (n_loops, ...)."""
        return np.asarray(np.add.reduceat(values, self.starts[:-1], axis=0))

    def slice_of(self, loop: int) -> slice:
        """Return the edges of one loop."""
        return slice(int(self.starts[loop]), int(self.starts[loop + 1]))


def rims_of(mesh: TriangleMesh, loops: list[IntArray]) -> Rims:
    """Lay out the rims of some loops.

    Parameters
    ----------
    mesh : TriangleMesh
    loops : list of (n_loop,) int64
        At least one, none of them empty, with the surface on their left.
    """
    starts, following = laid_out(loops)
    start = np.concatenate(loops)
    end = start[following]
    points = mesh.vertices[start]
    edges = mesh.vertices[end] - points
    # Not a norm of the edges: a long loop's perimeter must not depend on how it is laid out.
    lengths = np.linalg.norm(edges, axis=1)
    apex = apex_of_edges(mesh.triangles, start, end, len(mesh.vertices))
    to_apex = np.where(apex[:, None] >= 0, mesh.vertices[apex] - points, 0.0)
    along = unit(edges)
    across = to_apex - np.einsum("ij,ij->i", to_apex, along)[:, None] * along
    return Rims(
        starts,
        np.repeat(np.arange(len(loops)), np.diff(starts)),
        points,
        edges,
        lengths,
        unit(across),
        np.linalg.norm(across, axis=1),
    )


def apex_of_edges(triangles: Triangles, start: IntArray, end: IntArray, n_vertices: int) -> IntArray:
    """Third corner (n,) of a face that passes each edge from start to end of a loop, -1 where none does."""
    at = edges_found(triangles, start, end, n_vertices)
    return np.where(at >= 0, triangles[at // 3, (at % 3 + 2) % 3], -1)

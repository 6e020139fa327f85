"""Part of a mesh around some places, as a mesh of its own.

Finding it takes one pass over the vertices and one over the triangles. A grid of cubes over the mesh says what is near:
a vertex belongs to the region if its cube touches a ball around one of the places. So the region holds all that the
balls hold, and a little more.
"""

from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from quadpatch.filling.filled_mesh import FilledMesh, JoinedMesh
from quadpatch.mesh.measures import LONG_EDGE, EdgeStatistics
from quadpatch.mesh.passes import extent, parts_of
from quadpatch.mesh.topology import touching
from quadpatch.types import BoolArray, FloatArray, IntArray, TriangleMesh, Triangles, Vertices

# A region of a larger share of the triangles would save nothing: the whole mesh is taken.
MOST_OF_MESH = 0.5
# Cubes along the longest side of the mesh.
_CELLS = 256
# Vertices, and triangles, that are looked at together.
_CHUNK = 1 << 14

Number = TypeVar("Number", bound=np.generic)


@dataclass(frozen=True)
class Region:
    """Part of a mesh.

    Attributes
    ----------
    mesh : TriangleMesh
        In vertices of its own, in the order of the whole; where the region ends it has a boundary.
    whole : TriangleMesh
    vertices : (n,) int64
        Vertex of the whole that each vertex is, ascending.
    chosen : (m,) int64 or None
        Triangle of the whole that each triangle is, ascending; None where all are.
    """

    mesh: TriangleMesh
    whole: TriangleMesh
    vertices: IntArray
    chosen: IntArray | None = None

    @classmethod
    def all_of(cls, mesh: TriangleMesh) -> "Region":
        """Take a whole mesh for a region."""
        return cls(mesh, mesh, np.arange(len(mesh.vertices)))

    def of_triangles(self, values: NDArray[Number]) -> NDArray[Number]:
        """Take the rows of the region's triangles out of a table for those of the whole, which may have fewer rows.

        Triangles behind the last row, as invented ones are behind the measured ones, are left out.
        """
        return values if self.chosen is None else values[self.chosen[: np.searchsorted(self.chosen, len(values))]]

    def local(self, indices: IntArray) -> IntArray:
        """Translate vertices of the whole, all of which the region has, into its own: any shape."""
        return np.searchsorted(self.vertices, indices)

    def local_triangles(self, triangles: Triangles | None) -> Triangles | None:
        """Translate triangles (k, 3) of the whole into its own vertices; those that it does not hold are left out."""
        if triangles is None or self.mesh is self.whole:
            return triangles
        has = np.zeros(len(self.whole.vertices), bool)
        has[self.vertices] = True
        return self.local(triangles[has[triangles].all(axis=1)])

    def widened(self, filled: FilledMesh) -> FilledMesh:
        """Put what was filled in the region into the whole."""
        if self.mesh is self.whole:
            return filled
        n_new = len(filled.new_vertices)
        to_whole = np.concatenate([self.vertices, len(self.whole.vertices) + np.arange(n_new)])
        new = to_whole[filled.new_triangles]
        mesh = JoinedMesh(self.whole, filled.new_vertices, new)
        measured = len(self.whole.vertices), len(self.whole.triangles)
        return replace(filled, mesh=mesh, n_measured_vertices=measured[0], n_measured_triangles=measured[1])


def region_around(
    mesh: TriangleMesh, edges: EdgeStatistics, centres: Vertices, radii: FloatArray, obstacles: Triangles | None
) -> Region:
    """Cut out what lies around some places.

    Parameters
    ----------
    mesh : TriangleMesh
    edges : EdgeStatistics
        Of the mesh.
    centres : (k, 3) float64
    radii : (k,) float64
        In mesh units. Every triangle of the mesh that comes so near to a centre is in the region.
    obstacles : (j, 3) int64, optional
        Further triangles, whose vertices the region is to hold if they come as near, or are long.
    """
    # The corners of a triangle that touches a ball are no further from it than the longest edge.
    slack = min(edges.longest, LONG_EDGE * edges.mean)
    near = _near(mesh.vertices, centres, radii + slack)
    wanted = touching(mesh.triangles, near)
    if edges.longest > slack:
        wanted |= _long(mesh, slack)
    if wanted.sum() > MOST_OF_MESH * len(mesh.triangles):
        return Region.all_of(mesh)
    rows = np.flatnonzero(wanted)
    triangles = mesh.triangles[rows]
    is_used = near
    is_used[triangles] = True
    if obstacles is not None and len(obstacles):
        is_used[obstacles[touching(obstacles, near) | _long(TriangleMesh(mesh.vertices, obstacles), slack)]] = True
    vertices = np.flatnonzero(is_used)
    number = np.zeros(len(is_used), np.int64)
    number[vertices] = np.arange(len(vertices))
    return Region(TriangleMesh(mesh.vertices[vertices], number[triangles]), mesh, vertices, rows)


def _near(points: Vertices, centres: Vertices, radii: FloatArray) -> BoolArray:
    """Which points (n,) lie in cubes of a grid that touch some balls."""
    low, high = extent(points)
    size = high - low
    cell = max(float(size.max()) / _CELLS, float(np.finfo(np.float64).tiny))
    shape = np.floor(size / cell).astype(np.int64) + 1
    grid = np.zeros(shape, bool)
    for centre, radius in zip((centres - low) / cell, radii / cell, strict=True):
        _mark_ball(grid, centre, radius)
    found = np.zeros(len(points), bool)
    of_cube, n_y, n_z = grid.ravel(), int(shape[1]), int(shape[2])
    for part in parts_of(len(points), _CHUNK):
        x, y, z = ((points[part] - low) / cell).astype(np.int64).T
        found[part] = of_cube[(x * n_y + y) * n_z + z]
    return found


def _mark_ball(grid: BoolArray, centre: FloatArray, radius: float) -> None:
    """Mark the unit cubes of a grid that touch a ball; in cubes."""
    first = np.floor(centre - radius).astype(np.int64).clip(0)
    last = np.floor(centre + radius).astype(np.int64) + 1
    part = grid[tuple(slice(start, end) for start, end in zip(first.tolist(), last.tolist(), strict=True))]
    squared = np.zeros((1, 1, 1))
    for axis, n in enumerate(part.shape):
        start = first[axis] + np.arange(n)
        away = np.maximum(np.maximum(start - centre[axis], centre[axis] - start - 1), 0.0) ** 2
        squared = squared + np.expand_dims(away, tuple({0, 1, 2} - {axis}))
    part |= squared <= radius**2


def _long(mesh: TriangleMesh, length: float) -> BoolArray:
    """Which triangles (m,) have an edge longer than a length."""
    found = np.zeros(len(mesh.triangles), bool)
    for part in parts_of(len(mesh.triangles), _CHUNK):
        corners = mesh.vertices[mesh.triangles[part]]
        edges = corners - np.roll(corners, 1, axis=1)
        found[part] = (np.einsum("tkx,tkx->tk", edges, edges) > length**2).any(axis=1)
    return found

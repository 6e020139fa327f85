"""Thin a smooth mesh by joining the vertices of each cell of a grid, for a mesher that trips over broken input.

References
----------
J. Rossignac, P. Borrel, "Multi-resolution 3D approximations for rendering complex scenes", Modeling in Computer
Graphics, 1993.
"""

from dataclasses import dataclass

import numpy as np

from quadpatch.mesh.normals import triangle_normals
from quadpatch.mesh.topology import components
from quadpatch.types import BoolArray, FloatArray, IntArray, TriangleMesh, Triangles, Vertices

# Twice the area over the squared length of two sides: below this three corners lie on a line, in float32.
_THINNEST = 1e-5
# Vertices of one cell whose normals differ by more than 120 degrees lie on two sides of a thin wall.
_OTHER_SIDE = -0.5
# Cells of a grid for each vertex, up to which a table of them is made.
_DENSE = 8
# Cells along a side up to which one integer tells them apart: 2e6 cubed is just under 2**63.
_MOST_CELLS = 2_000_000
# Vertices, and triangles, that are looked at together.
_CHUNK = 1 << 17


@dataclass(frozen=True)
class Clusters:
    """The vertices of a mesh, joined by the cells of a grid.

    Attributes
    ----------
    label : (n,) int64
        Cluster of each vertex.
    vertices : (k, 3) float64
        Means of the clusters.
    """

    label: IntArray
    vertices: Vertices

    def spanning(self, triangles: Triangles) -> IntArray:
        """Find the triangles (l,), of some (m, 3), whose corners are in three clusters: most vanish."""
        found = [np.zeros(0, np.int64)]
        for at in range(0, len(triangles), _CHUNK):
            a, b, c = self.label[triangles[at : at + _CHUNK]].T
            found.append(at + np.flatnonzero((a != b) & (b != c) & (c != a)))
        return np.concatenate(found)

    def join(self, triangles: Triangles) -> tuple[Triangles, IntArray]:
        """Give triangles (m, 3) their clusters: what is left of them (l, 3), and which they were (l,).

        Every triangle left has an area, and no other one its corners.
        """
        kept = self.spanning(triangles)
        joined = self.label[triangles[kept]]
        sound = np.flatnonzero(_has_area(self.vertices, joined))
        sound = sound[_is_first_of_its_corners(joined[sound], len(self.vertices))]
        return joined[sound], kept[sound]


def cluster(mesh: TriangleMesh, cell: float, kind: IntArray | None = None) -> Clusters:
    """Join all vertices within one cell of a cubic grid at their mean, except across a wall thinner than a cell.

    Parameters
    ----------
    mesh : TriangleMesh
        With at least one triangle.
    cell : float
        Side of the cells, in mesh units.
    kind : (n,) int64, optional
        From 0 on: vertices of different kinds stay apart.
    """
    label = _cluster_labels(mesh, cell, kind)
    count = np.bincount(label)
    means = [np.bincount(label, weights=mesh.vertices[:, axis]) / count for axis in range(3)]
    return Clusters(label, np.stack(means, axis=1))


def cluster_vertices(mesh: TriangleMesh, cell: float) -> TriangleMesh:
    """Thin a mesh by clusters. Right for a smooth surface; details smaller than a cell vanish.

    Parameters
    ----------
    mesh : TriangleMesh
        Finite; triangles without area, in several copies or turned against each other are allowed.
    cell : float
        Side of the cells, in mesh units.

    Returns
    -------
    TriangleMesh
        Every triangle has an area and no other triangle its corners, every vertex has one fan of
        triangles that are turned alike.
    """
    if len(mesh.triangles) == 0:
        return TriangleMesh(np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int64))
    clusters = cluster(mesh, cell)
    corner_vertex, triangles = split_fans(clusters.join(mesh.triangles)[0])
    return TriangleMesh(clusters.vertices[corner_vertex], triangles)


def split_fans(triangles: Triangles) -> tuple[IntArray, Triangles]:
    """Cut the mesh where it is not a manifold: every fan of triangles around a vertex gets a vertex of its own.

    Triangles belong to the same fan if they share an edge that has exactly these two, in opposite directions.

    Parameters
    ----------
    triangles : (n_triangles, 3) int64

    Returns
    -------
    original : (n_new,) int64
        The vertex that each new vertex is a copy of.
    triangles : (n_triangles, 3) int64
        The same triangles into the new vertices.
    """
    n_corners = triangles.size
    if n_corners == 0:
        return np.zeros(0, dtype=np.int64), triangles
    # Edge k of the flat list runs from corner k to the next corner of its triangle.
    following = (np.arange(n_corners).reshape(-1, 3)[:, [1, 2, 0]]).ravel()
    start, end = triangles.ravel(), triangles.ravel()[following]
    low, high = np.minimum(start, end), np.maximum(start, end)
    order = np.argsort(low * (int(triangles.max()) + 1) + high, kind="stable")
    new_edge = np.diff(low[order], prepend=-1).astype(bool) | np.diff(high[order], prepend=-1).astype(bool)
    first = np.flatnonzero(new_edge)
    pairs = first[np.diff(first, append=n_corners) == 2]
    one, other = order[pairs], order[pairs + 1]
    is_opposite = start[one] == end[other]
    one, other = one[is_opposite], other[is_opposite]
    links = np.concatenate([one, following[one]]), np.concatenate([following[other], other])
    fan = components(np.stack(links, axis=1), n_corners)
    _, first_corner = np.unique(fan, return_index=True)
    return triangles.ravel()[first_corner], fan.reshape(-1, 3)


def _cluster_labels(mesh: TriangleMesh, cell: float, kind: IntArray | None) -> IntArray:
    first, label = _groups(_cell_keys(mesh.vertices, cell))
    triangle = _some_triangle(mesh)
    front = _normals_of(mesh, triangle[first])
    for at in range(0, len(label), _CHUNK):
        part = slice(at, at + _CHUNK)
        agreement = np.einsum("ij,ij->i", _normals_of(mesh, triangle[part]), front[label[part]])
        label[part] = 2 * label[part] + (agreement < _OTHER_SIDE)
    if kind is not None:
        label += 2 * len(first) * kind
    return _groups(label)[1]


def _cell_keys(vertices: Vertices, cell: float) -> IntArray:
    """One integer (n,) for the cell of every vertex."""
    low = vertices.min(axis=0)
    # Cells of the highest corner, by the same arithmetic as those of the vertices.
    base = int(np.floor((vertices.max(axis=0) - low) / cell).max()) + 1
    if base >= _MOST_CELLS:
        return _as_keys(np.floor((vertices - low) / cell).astype(np.int64), base)
    keys = np.empty(len(vertices), np.int64)
    for at in range(0, len(vertices), _CHUNK):
        cells = np.floor((vertices[at : at + _CHUNK] - low) / cell).astype(np.int64)
        keys[at : at + _CHUNK] = _as_keys(cells, base)
    return keys


def _groups(keys: IntArray) -> tuple[IntArray, IntArray]:
    """First member (k,) of each group of equal keys (n,), by rising key, and the group (n,) of every member."""
    size = int(keys.max()) + 1
    if size > _DENSE * len(keys):
        _, first, group = np.unique(keys, return_index=True, return_inverse=True)
        return first, np.asarray(group, np.int64)
    # A table of all keys costs less than sorting.
    table = np.full(size, -1)
    table[keys[::-1]] = np.arange(len(keys) - 1, -1, -1)
    first = table[table >= 0]
    table[table >= 0] = np.arange(len(first))
    return first, table[keys]


def _some_triangle(mesh: TriangleMesh) -> IntArray:
    """Give every vertex one of its triangles: (n,); -1 without one."""
    triangle = np.full(len(mesh.vertices), -1)
    for corner in range(3):
        triangle[mesh.triangles[:, corner]] = np.arange(len(mesh.triangles))
    return triangle


def _normals_of(mesh: TriangleMesh, triangle: IntArray) -> FloatArray:
    """Give the unit normals (k, 3) of some triangles (k,); zero for -1."""
    normals = triangle_normals(mesh.vertices, mesh.triangles[triangle])
    normals[triangle < 0] = 0.0
    return normals


def _has_area(vertices: Vertices, triangles: Triangles) -> BoolArray:
    a, b, c = (vertices[triangles[:, corner]] for corner in range(3))
    double_area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    square = np.einsum("ij,ij->i", b - a, b - a) + np.einsum("ij,ij->i", c - a, c - a)
    return np.asarray(double_area > _THINNEST * square)


def _is_first_of_its_corners(triangles: Triangles, n_vertices: int) -> BoolArray:
    """Keep one triangle for each set of corners, turned as most of them are; none where the turns cancel out."""
    # With the smallest corner in front, a triangle is turned forward if the next one is the smaller of the others.
    start = np.argmin(triangles, axis=1)
    rows = np.arange(len(triangles))
    turn = np.where(triangles[rows, (start + 1) % 3] < triangles[rows, (start + 2) % 3], 1, -1)
    _, group = np.unique(_as_keys(np.sort(triangles, axis=1), n_vertices), return_inverse=True)
    net_turn = np.sign(np.bincount(group, weights=turn))
    agreeing = np.flatnonzero(net_turn[group] == turn)
    _, first = np.unique(group[agreeing], return_index=True)
    is_kept = np.zeros(len(triangles), dtype=bool)
    is_kept[agreeing[first]] = True
    return is_kept


def _as_keys(rows: IntArray, base: int) -> IntArray:
    """One integer for each row of three, so that sorting is fast; the rank of the row where that would overflow."""
    if base >= _MOST_CELLS:
        return np.asarray(np.unique(rows, axis=0, return_inverse=True)[1], dtype=np.int64).ravel()
    return (rows[:, 0] * base + rows[:, 1]) * base + rows[:, 2]

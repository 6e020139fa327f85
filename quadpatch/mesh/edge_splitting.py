"""Splitting of long edges: a finer copy of a mesh, whose triangles each lie in one of the mesh.

Edges that are too long are halved, and halved again; the triangles at them are cut into two, three or four. Whether an
edge is split depends on its length alone, so both triangles at it agree and the copy has no gaps.
"""

from dataclasses import dataclass

import numpy as np

from quadpatch.mesh.topology import directed_edges, edge_keys
from quadpatch.types import BoolArray, FloatArray, IntArray, TriangleMesh

# Corners of the pieces of a triangle, by how many of its edges are split. Corners 0 to 2 are its own, 3 to 5 the
# middles of the edges that begin there. One split edge is edge 0, two are the edges 0 and 1.
_PIECES = {
    1: np.array([[0, 3, 2], [3, 1, 2]]),
    2: np.array([[3, 1, 4], [0, 3, 4], [0, 4, 2]]),
    3: np.array([[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]]),
}
# The same with the other diagonal of the quadrangle that two split edges leave.
_OTHER_DIAGONAL = np.array([[3, 1, 4], [0, 3, 2], [3, 4, 2]])


@dataclass(frozen=True)
class SplitMesh:
    """A finer copy of a mesh.

    Attributes
    ----------
    mesh : TriangleMesh
        The vertices of the mesh first.
    parent : (m,) int64
        Triangle of the mesh that each triangle lies in.
    corners : (m, 3, 3) float64
        Barycentric coordinates of the corners in it.
    """

    mesh: TriangleMesh
    parent: IntArray
    corners: FloatArray


def split_long_edges(mesh: TriangleMesh, longest: float | FloatArray) -> SplitMesh:
    """Halve edges until none is longer than a length, in mesh units.

    Parameters
    ----------
    mesh : TriangleMesh
    longest : float or (n_vertices,) float64
        Positive; where vertices have lengths of their own, the mean of both ends counts.
    """
    # The length of each vertex stands behind its coordinates, and is halved with them.
    vertices = np.column_stack([mesh.vertices, np.broadcast_to(longest, len(mesh.vertices))])
    triangles, parent = mesh.triangles, np.arange(len(mesh.triangles), dtype=np.int64)
    corners = np.tile(np.eye(3), (len(triangles), 1, 1))
    done: list[tuple[IntArray, IntArray, FloatArray]] = []
    # Loops over halvings.
    while True:
        is_long = _long_edges(vertices, triangles)
        whole = ~is_long.any(axis=1)
        done.append((triangles[whole], parent[whole], corners[whole]))
        if whole.all():
            break
        split = ~whole
        vertices, triangles, parent, corners = _split(
            vertices, triangles[split], parent[split], corners[split], is_long[split]
        )
    all_triangles, all_parents, all_corners = (np.concatenate(rows) for rows in zip(*done, strict=True))
    return SplitMesh(TriangleMesh(np.ascontiguousarray(vertices[:, :3]), all_triangles), all_parents, all_corners)


def _long_edges(vertices: FloatArray, triangles: IntArray) -> BoolArray:
    """Which edges (m, 3) of some triangles are too long; the same for both directions of an edge."""
    edges = np.sort(directed_edges(triangles), axis=1)
    first, second = vertices[edges[:, 0]], vertices[edges[:, 1]]
    along, longest = second[:, :3] - first[:, :3], 0.5 * (first[:, 3] + second[:, 3])
    return np.asarray(np.einsum("ij,ij->i", along, along) > longest**2).reshape(-1, 3)


def _split(
    vertices: FloatArray, triangles: IntArray, parent: IntArray, corners: FloatArray, is_long: BoolArray
) -> tuple[FloatArray, IntArray, IntArray, FloatArray]:
    """Halve the long edges of some triangles, each of which has one."""
    edges = directed_edges(triangles)[is_long.ravel()]
    _, first, number = np.unique(edge_keys(edges, len(vertices)), return_index=True, return_inverse=True)
    middles = np.full(is_long.size, -1)
    middles[is_long.ravel()] = len(vertices) + number.reshape(-1)
    vertices = np.concatenate([vertices, vertices[np.sort(edges[first], axis=1)].mean(axis=1)])
    # Turned so that what is split begins with edge 0.
    count = is_long.sum(axis=1)
    turn = np.where(count == 1, is_long.argmax(axis=1), np.where(count == 2, (~is_long).argmax(axis=1) + 1, 0)) % 3
    order = (np.arange(3) + turn[:, np.newaxis]) % 3
    triangles, middles = (np.take_along_axis(rows.reshape(-1, 3), order, axis=1) for rows in (triangles, middles))
    corners = np.take_along_axis(corners, order[:, :, np.newaxis], axis=1)
    points = np.concatenate([triangles, middles], axis=1)
    places = np.concatenate([corners, 0.5 * (corners + np.roll(corners, -1, axis=1))], axis=1)
    pieces: list[tuple[IntArray, IntArray, FloatArray]] = []
    for rows, pattern in _by_pattern(vertices, points, count):
        pieces.append(
            (
                points[rows][:, pattern].reshape(-1, 3),
                np.repeat(parent[rows], len(pattern)),
                places[rows][:, pattern].reshape(-1, 3, 3),
            )
        )
    new_triangles, new_parents, new_corners = (np.concatenate(part) for part in zip(*pieces, strict=True))
    return vertices, new_triangles, new_parents, new_corners


def _by_pattern(vertices: FloatArray, points: IntArray, count: IntArray) -> list[tuple[IntArray, IntArray]]:
    """Triangles (k,) and how they are cut; a quadrangle by its shorter diagonal."""
    one, two, three = (np.flatnonzero(count == n) for n in (1, 2, 3))
    first = _lengths(vertices, points[two, 0], points[two, 4])
    second = _lengths(vertices, points[two, 3], points[two, 2])
    return [
        (one, _PIECES[1]),
        (two[first <= second], _PIECES[2]),
        (two[first > second], _OTHER_DIAGONAL),
        (three, _PIECES[3]),
    ]


def _lengths(vertices: FloatArray, start: IntArray, end: IntArray) -> FloatArray:
    return np.asarray(np.linalg.norm(vertices[end, :3] - vertices[start, :3], axis=1))

"""Triangles that run through each other; the adapter of libigl's exact predicates (CGAL's)."""

from collections.abc import Iterator
from itertools import chain

import numpy as np
from igl.copyleft.cgal import remesh_self_intersections
from scipy.spatial import cKDTree

from quadpatch.mesh.averages import mean_of_corners
from quadpatch.mesh.normals import cross, length
from quadpatch.mesh.topology import compacted
from quadpatch.types import BoolArray, FloatArray, IntArray, TriangleMesh, Triangles, Vertices

# A triangle lower than this share of its longest edge is a line in all but name: it has no side to be crossed on.
LEAST_HEIGHT = 1e-6
# Crossings by less than this share of a triangle are rounding.
_SHRINKAGE = 1e-5
# A triangle lies on another where its centroid does, up to this share of the other's longest edge; both must be higher
# than the second share of theirs, or the edge between two neighbours would be as near.
_ON_SURFACE = 1e-6
_LEAST_HEIGHT_ON_SURFACE = 1e-3
_PAIRS_AT_A_TIME = 1_000_000
# Triangles that are looked at to estimate how many pairs there are.
_SAMPLE = 256


def crossing_pairs(mesh: TriangleMesh, n_looked_at: int | None = None) -> IntArray:
    """Find the pairs of triangles that share more than their common corners.

    Parameters
    ----------
    mesh : TriangleMesh
    n_looked_at : int, optional
        Pairs of two triangles behind so many may be left out.

    Returns
    -------
    (n_pairs, 2) int64
        Positions of triangles. Triangles without a height are in none of the pairs.
    """
    height = heights(mesh.vertices, mesh.triangles)
    solid = np.flatnonzero(height > LEAST_HEIGHT)
    if len(solid) < 2:
        return np.zeros((0, 2), np.int64)
    pairs = solid[_exact_pairs(mesh.vertices, mesh.triangles[solid])]
    clear = np.flatnonzero(height > _LEAST_HEIGHT_ON_SURFACE)
    # Sheets in one plane but for rounding do not cross.
    n_first = len(clear) if n_looked_at is None else int((clear < n_looked_at).sum())
    overlapping = clear[_overlapping_pairs(mesh.vertices[mesh.triangles[clear]], n_first)]
    corners = np.sort(mesh.triangles[overlapping], axis=-1)
    overlapping = overlapping[(corners[:, 0] != corners[:, 1]).any(axis=-1)]
    return np.concatenate([pairs[_cross_when_shrunk(mesh, pairs)], overlapping])


def _overlapping_pairs(corners: FloatArray, n_first: int) -> IntArray:
    """Pairs (n, 2) of triangles, by their corners (m, 3, 3), the centroid of the second of which lies on the first.

    One of the two is among the first so many.
    """
    centres = mean_of_corners(corners)
    radii = length(corners - centres[:, None]).max(axis=1)
    normals = cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    # Edges are up to twice as long as the radius.
    reach = 2 * (2 * _ON_SURFACE) * radii * length(normals)
    first, others = np.arange(n_first), np.arange(n_first, len(corners))
    found = [np.zeros((0, 2), np.int64)]
    for pairs in chain(
        _near_centres(centres, radii, first, len(corners)), _near_centres(centres, radii, others, n_first)
    ):
        # Most neighbours are off the plane.
        height = np.einsum("ij,ij->i", centres[pairs[:, 1]] - centres[pairs[:, 0]], normals[pairs[:, 0]])
        flat = pairs[np.abs(height) <= reach[pairs[:, 0]]]
        found.append(flat[_lies_on(centres[flat[:, 1]], corners[flat[:, 0]])])
    return np.concatenate(found)


def _near_centres(centres: Vertices, radii: FloatArray, lower: IntArray, n_upper: int) -> Iterator[IntArray]:
    """Find the centres of the first so many triangles within the radii of some (k,): pairs (n, 2), in pieces.

    Triangles up to twice as large are looked up together, in two trees: many times faster than one by one.
    """
    upper, size = cKDTree(centres[:n_upper]), np.frexp(radii[lower])[1]
    for part in (lower[size == s] for s in np.unique(size)):
        sample = part[:: len(part) // _SAMPLE + 1]
        n_near = upper.query_ball_point(centres[sample], radii[part].max(), return_length=True).mean()
        # Few triangles may hold the centres of all others: as many at a time as memory has room for.
        n_pieces = min(int(len(part) * n_near) // _PAIRS_AT_A_TIME + 1, len(part))
        for piece in (part[start::n_pieces] for start in range(n_pieces)):
            own = cKDTree(centres[piece])
            near = own.sparse_distance_matrix(upper, radii[piece].max(), output_type="ndarray")
            pairs = np.stack([piece[near["i"]], near["j"]], axis=1)
            yield pairs[(near["v"] <= radii[pairs[:, 0]]) & (pairs[:, 0] != pairs[:, 1])]


def _lies_on(points: Vertices, corners: FloatArray) -> BoolArray:
    """Whether each point (n, 3) lies on its triangle (n, 3, 3), off its border."""
    a, b, c = (corners[:, k] for k in range(3))
    normal = cross(b - a, c - a)
    double_area = length(normal)
    longest = np.max([length(b - a), length(c - b), length(a - c)], axis=0)
    lies = np.abs(np.einsum("ij,ij->i", points - a, normal)) <= _ON_SURFACE * longest * double_area
    for start, end in ((a, b), (b, c), (c, a)):
        lies &= np.einsum("ij,ij->i", cross(end - start, points - start), normal) > _SHRINKAGE * double_area**2
    return np.asarray(lies)


def _exact_pairs(vertices: Vertices, triangles: Triangles) -> IntArray:
    used, local = compacted(triangles, len(vertices))
    found = remesh_self_intersections(vertices[used], local, detect_only=True)
    return np.asarray(found[2], np.int64).reshape(-1, 2)


def _cross_when_shrunk(mesh: TriangleMesh, pairs: IntArray) -> BoolArray:
    """Tell the pairs (n,) that cross by more than rounding: they still do when every triangle is a little smaller."""
    if not len(pairs):
        return np.zeros(0, bool)
    members, local = np.unique(pairs, return_inverse=True)
    corners = mesh.vertices[mesh.triangles[members]]
    smaller = corners + _SHRINKAGE * (mean_of_corners(corners)[:, None] - corners)
    found = _exact_pairs(smaller.reshape(-1, 3), np.arange(3 * len(members)).reshape(-1, 3))
    keys, wanted = (np.sort(rows, axis=1) @ np.array([len(members), 1]) for rows in (found, local.reshape(-1, 2)))
    return np.asarray(np.isin(wanted, keys))


def heights(vertices: Vertices, triangles: Triangles) -> FloatArray:
    """Measure the height of every triangle over its longest edge, in shares of that edge: (n_triangles,)."""
    corners = vertices[triangles]
    edges = np.stack([corners[:, k] - corners[:, k - 1] for k in range(3)], axis=1)
    # Divided before they are multiplied: the squares of small edges vanish in float64.
    longest = np.abs(edges).max(axis=(1, 2), initial=0.0)
    longest[longest == 0] = 1.0
    edges = edges / longest[:, None, None]
    return np.asarray(length(cross(edges[:, 0], edges[:, 1])) / np.maximum(length(edges).max(axis=1), 1.0) ** 2)


def touching_boxes(low: FloatArray, high: FloatArray, mesh: TriangleMesh) -> BoolArray:
    """Find the triangles whose bounding box touches one of some boxes.

    Parameters
    ----------
    low, high : (n_boxes, 3) float64
        In mesh units.
    mesh : TriangleMesh

    Returns
    -------
    (n_triangles,) bool
    """
    touched = np.zeros(len(mesh.triangles), bool)
    touched[box_contacts(low, high, mesh)[:, 1]] = True
    return touched


def box_contacts(low: FloatArray, high: FloatArray, mesh: TriangleMesh) -> IntArray:
    """Find which bounding boxes of triangles touch which of some boxes.

    Parameters
    ----------
    low, high : (n_boxes, 3) float64
        In mesh units.
    mesh : TriangleMesh

    Returns
    -------
    (n_contacts, 2) int64
        Positions of boxes and of triangles, in no order.
    """
    near = _in_box(low.min(axis=0, initial=np.inf), high.max(axis=0, initial=-np.inf), mesh)
    corners = mesh.vertices[mesh.triangles[near]]
    centres = mean_of_corners(corners)
    radii = length(corners - centres[:, None]).max(axis=1)
    a, b, c = (corners[:, k] for k in range(3))
    lowest, highest = np.minimum(np.minimum(a, b), c), np.maximum(np.maximum(a, b), c)
    middles, size = (low + high) / 2, np.frexp(radii)[1]
    found = [np.zeros((0, 2), np.int64)]
    # Triangles up to twice as large share a tree: a few large ones do not widen the search among all others.
    for alike in (np.flatnonzero(size == s) for s in np.unique(size)):
        # Boxes are few: a tree that is built quickly is worth more than one that answers quickly.
        tree = cKDTree(centres[alike], balanced_tree=False, compact_nodes=False)
        reaches = length(high - low) / 2 + radii[alike].max()
        n_near = np.cumsum(tree.query_ball_point(middles, reaches, return_length=True))
        for boxes in np.split(np.arange(len(low)), np.flatnonzero(np.diff(n_near // _PAIRS_AT_A_TIME)) + 1):
            rows = tree.query_ball_point(middles[boxes], reaches[boxes], return_sorted=False)
            box = np.repeat(boxes, [len(row) for row in rows])
            triangle = alike[np.concatenate(rows).astype(np.int64)]
            is_disjoint = (lowest[triangle] > high[box]) | (highest[triangle] < low[box])
            touching = ~is_disjoint.any(axis=1)
            found.append(np.stack([box[touching], near[triangle[touching]]], axis=1))
    return np.concatenate(found)


def _in_box(low: FloatArray, high: FloatArray, mesh: TriangleMesh) -> IntArray:
    """Find the triangles (k,) whose bounding box touches one box, by its corners (3,)."""
    inside = np.ones(len(mesh.triangles), bool)
    for axis in range(3):
        column = mesh.vertices[:, axis]
        below, above = column < low[axis], column > high[axis]
        for is_beyond in (below, above):
            if is_beyond.any():
                a, b, c = (is_beyond[mesh.triangles[:, corner]] for corner in range(3))
                inside &= ~(a & b & c)
    return np.flatnonzero(inside)

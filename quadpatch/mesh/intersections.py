"""Triangles that run through each other; the adapter of libigl's exact predicates (CGAL's)."""

import numpy as np
from igl.copyleft.cgal import remesh_self_intersections
from scipy.spatial import cKDTree

from quadpatch.mesh.normals import cross, length
from quadpatch.types import BoolArray, FloatArray, IntArray, TriangleMesh, Triangles, Vertices

# A triangle lower than this share of its longest edge is a line in all but name: it has no side to be crossed on.
LEAST_HEIGHT = 1e-6
# Crossings by less than this share of a triangle are rounding.
_SHRINKAGE = 1e-3
# Triangles larger than so many mean radii count as large.
_LARGE = 4.0


def crossing_pairs(mesh: TriangleMesh) -> IntArray:
    """Find the pairs of triangles that share more than their common corners.

    Parameters
    ----------
    mesh : TriangleMesh

    Returns
    -------
    (n_pairs, 2) int64
        Positions of triangles. Triangles without a height are in none of the pairs.
    """
    solid = np.flatnonzero(heights(mesh.vertices, mesh.triangles) > LEAST_HEIGHT)
    if len(solid) < 2:
        return np.zeros((0, 2), np.int64)
    pairs = solid[_exact_pairs(mesh.vertices, mesh.triangles[solid])]
    return pairs[_cross_when_shrunk(mesh, pairs)]


def _exact_pairs(vertices: Vertices, triangles: Triangles) -> IntArray:
    used, local = np.unique(triangles, return_inverse=True)
    found = remesh_self_intersections(vertices[used], local.reshape(-1, 3), detect_only=True)
    return np.asarray(found[2], np.int64).reshape(-1, 2)


def _cross_when_shrunk(mesh: TriangleMesh, pairs: IntArray) -> BoolArray:
    """Tell the pairs (n,) that cross by more than rounding: they still do when every triangle is a little smaller."""
    if not len(pairs):
        return np.zeros(0, bool)
    members, local = np.unique(pairs, return_inverse=True)
    corners = mesh.vertices[mesh.triangles[members]]
    smaller = corners + _SHRINKAGE * (corners.mean(axis=1, keepdims=True) - corners)
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
    corners = mesh.vertices[mesh.triangles]
    centres = corners.mean(axis=1)
    radii = length(corners - centres[:, None]).max(axis=1)
    # Few triangles are far larger than the others; those are taken unseen, or every query would have to reach as far.
    reach = _LARGE * float(radii.mean()) if len(radii) else 0.0
    touched: BoolArray = radii > reach
    ordinary = np.flatnonzero(~touched)
    if not len(ordinary):
        return touched
    spheres = cKDTree(centres[ordinary]).query_ball_point((low + high) / 2, length(high - low) / 2 + reach)
    for box_low, box_high, found in zip(low, high, spheres, strict=True):
        near = ordinary[found]
        apart = (corners[near].min(axis=1) > box_high) | (corners[near].max(axis=1) < box_low)
        touched[near[~apart.any(axis=1)]] = True
    return touched

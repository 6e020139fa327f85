"""Normals that a file stores, computed anew where its vertices moved.

A stored normal describes the surface as it was. At a vertex that moved it is replaced by the mean of the normals of
the triangles around, weighted by area. Corners at one position whose normals were equal stay alike, so a seam of the
texture does not show, and corners with different normals stay a crease.

Tested in `tests/quadpatch/formats/test_moving.py`.
"""

import numpy as np

from quadpatch.formats.scan import Moved, Scan
from quadpatch.mesh.normals import area_vectors, unit
from quadpatch.mesh.weld import first_of_equal
from quadpatch.types import FloatArray, IntArray

# Beyond the point: more than float32 holds, and no more than a text needs.
NORMAL_DIGITS = 9


def moved_vertex_normals(scan: Scan, stored: FloatArray, moved: Moved) -> FloatArray:
    """Compute the normals of the vertices that moved.

    Parameters
    ----------
    scan : Scan
    stored : (n, 3) float64
        Normal of each vertex.
    moved : Moved

    Returns
    -------
    (n, 3) float64
        Unit normals for the vertices that moved, `stored` for all others and for those without any area around.
    """
    rows = moved.is_moved(scan)
    group = _alike(scan.vertices, stored)
    normals = normals_of_groups(scan, group[scan.triangles], stored, moved)
    fresh = normals[group]
    return np.where((rows & fresh.any(axis=1))[:, np.newaxis], fresh, stored)


def _alike(vertices: FloatArray, normals: FloatArray) -> IntArray:
    """Give vertices that are equal in position and normal the number of the first of them, (n,) int64."""
    n = len(vertices)
    key = first_of_equal(vertices) * n + first_of_equal(normals)
    _, first, inverse = np.unique(key, return_index=True, return_inverse=True)
    return np.asarray(first[inverse.reshape(-1)], dtype=np.int64)


def normals_of_groups(scan: Scan, corner_group: IntArray, stored: FloatArray, moved: Moved) -> FloatArray:
    """Compute the mean normal of each group of corners, at the new positions.

    Parameters
    ----------
    scan : Scan
    corner_group : (m, 3) int64
        Group of each corner of the scan's triangles, -1 for none.
    stored : (n_groups, 3) float64
        Normals that the file has; where most of them face against their triangles, so do the new ones.
    moved : Moved

    Returns
    -------
    (n_groups, 3) float64
        Unit length to nine digits, zero for groups without area.
    """
    after = _sums(moved.vertices, scan, corner_group, len(stored))
    before = _sums(scan.vertices, scan, corner_group, len(stored))
    agreement = np.einsum("ij,ij->i", np.nan_to_num(before), np.nan_to_num(stored))
    sign = -1.0 if np.sign(agreement).sum() < 0 else 1.0
    return np.round(sign * unit(np.nan_to_num(after)), NORMAL_DIGITS) + 0.0


def _sums(vertices: FloatArray, scan: Scan, corner_group: IntArray, n_groups: int) -> FloatArray:
    """Add up the area vectors around each group; triangles with a missing corner count for nothing."""
    vectors = np.repeat(np.nan_to_num(area_vectors(vertices, scan.triangles)), 3, axis=0)
    group = corner_group.ravel()
    has = group >= 0
    return np.stack([np.bincount(group[has], vectors[has, axis], minlength=n_groups) for axis in range(3)], axis=1)

"""Faces that repeat another face: the same three places, in either direction.

A repeated face gives its edges a third face, or closes a surface that is open, so the hole at whose rim it lies is no
hole any more. What a repeated face says of the surface, the first of its kind says as well.

Two solids that touch have coincident faces too: the wall between them. It is no repetition, since each of the solids
would be open without its own. So a connected group of repeated faces is left out only where the surface is manifold
without it along most of the group's outline.
"""

import numpy as np
from numpy.typing import NDArray

from quadpatch.mesh.edge_groups import EdgeGroups, group_edges
from quadpatch.mesh.hashes import shared_hashes, short_numbers
from quadpatch.mesh.passes import is_identity, parts_of
from quadpatch.mesh.topology import components, touching
from quadpatch.types import BoolArray, IntArray, Triangles

# Triangles that are looked at together.
_CHUNK = 1 << 15


def repeated_triangles(triangles: Triangles, place: IntArray) -> BoolArray:
    """Find the triangles that repeat an earlier one and can be left out.

    Parameters
    ----------
    triangles : (m, 3) int64
    place : (n,) int64
        A number of each vertex's position; vertices at one position have the same.

    Returns
    -------
    (m,) bool
        The first triangle of a kind is not among them.
    """
    corners = triangles if is_identity(place) else place[triangles]
    again, first = with_same_corners(corners)
    repeated = np.zeros(len(triangles), dtype=bool)
    if not len(again):
        return repeated
    repeated[again] = True
    near = np.zeros(len(place), dtype=bool)
    near[corners[repeated]] = True
    # Only what touches a repeated face is looked at.
    rows = np.flatnonzero(touching(corners, near))
    is_doubled = np.zeros(len(triangles), dtype=bool)
    is_doubled[first] = True
    wanted = _without_walls(group_edges(corners[rows], len(place)), repeated[rows], is_doubled[rows])
    result = np.zeros(len(triangles), dtype=bool)
    result[rows] = wanted
    return result


def with_same_corners(corners: Triangles) -> tuple[IntArray, IntArray]:
    """Find the triangles that have the same three corners as an earlier one, in any order.

    Parameters
    ----------
    corners : (m, 3) int64

    Returns
    -------
    again, first : (k,) int64
        Positions in `corners`, ascending, and those of the first triangle with these corners. A triangle with equal
        corners is like no other.
    """
    rows = shared_hashes(_corner_hashes(corners))
    a, b, c = corners[rows].T
    rows = rows[(a != b) & (b != c) & (c != a)]
    _, begins, kind = np.unique(np.sort(corners[rows], axis=1), axis=0, return_index=True, return_inverse=True)
    first = rows[begins][kind.reshape(-1)]
    return rows[first != rows], first[first != rows]


def _corner_hashes(corners: Triangles) -> NDArray[np.uint32]:
    """Hash the corners of triangles (m, 3), in any order."""
    number = short_numbers(int(corners.max(initial=-1)) + 1)
    hashes = np.zeros(len(corners), np.uint32)
    for part in parts_of(len(corners), _CHUNK):
        a, b, c = corners[part].T
        hashes[part] = number[a] + number[b] + number[c]
    return hashes


def _without_walls(groups: EdgeGroups, repeated: BoolArray, is_doubled: BoolArray) -> BoolArray:
    """Drop the groups of repeated faces whose absence would leave three faces on most of their outline."""
    triangle = groups.order // 3
    n_kept = np.add.reduceat((~repeated)[triangle].astype(np.int64), groups.starts)
    n_single = np.add.reduceat((~repeated & ~is_doubled)[triangle].astype(np.int64), groups.starts)
    # An edge is on the outline of a doubled region where that ends, or meets what is not doubled.
    is_outline, is_crowded = (n_single > 0) | (n_kept == 1), (n_single > 0) & (n_kept > 2)
    group = _connected(groups, repeated)
    rows = np.flatnonzero(repeated)
    edges = groups.edge.reshape(-1, 3)[rows]
    n_groups = int(group.max()) + 1
    outline, crowded = (
        np.bincount(group[rows], marked[edges].sum(axis=1), minlength=n_groups) for marked in (is_outline, is_crowded)
    )
    return repeated & (2 * crowded <= outline)[group]


def _connected(groups: EdgeGroups, chosen: BoolArray) -> IntArray:
    """Find the group of chosen triangles, joined by edges, of each triangle, (m,) int64; others are their own."""
    triangle = groups.order // 3
    inside = np.flatnonzero(chosen[triangle])
    same = groups.edge[groups.order[inside[1:]]] == groups.edge[groups.order[inside[:-1]]]
    links = np.stack([triangle[inside[:-1]][same], triangle[inside[1:]][same]], axis=1)
    return components(links, len(chosen))

"""Faces flipped against their neighbours.

Boundary edges keep the direction of their face, so one face in the wrong direction breaks the rim that it lies at.
"""

import numpy as np

from quadpatch.mesh.edge_groups import group_edges
from quadpatch.mesh.topology import components, directed_edges, edge_keys
from quadpatch.types import BoolArray, IntArray, Triangles


def flipped_triangles(triangles: Triangles, n_vertices: int) -> BoolArray:
    """Find the triangles that are flipped against most of their piece.

    Two faces agree where they pass their common edge in opposite directions; edges with more than two faces say
    nothing. Pieces that have no consistent direction, such as a Moebius strip, are left as they are.

    Parameters
    ----------
    triangles : (m, 3) int64
    n_vertices : int

    Returns
    -------
    (m,) bool
        In a piece that is divided in two halves, the half of the first triangle is right.
    """
    n = len(triangles)
    nothing = np.zeros(n, dtype=bool)
    groups = group_edges(triangles, n_vertices)
    one, other = groups.pairs.T
    disagrees = groups.edges[one, 0] == groups.edges[other, 0]
    if not disagrees.any():
        return nothing
    one, other = one // 3, other // 3
    # Every triangle twice: t as it is, t + n flipped. A consistent piece falls into two mirrored components.
    crossed = np.where(disagrees, n, 0)
    links = np.stack([np.append(one, one + n), np.append(other + crossed, other + n - crossed)], axis=1)
    component = components(links, 2 * n)
    as_is, flipped = component[:n], component[n:]
    faces = np.bincount(as_is, minlength=int(component.max()) + 1)
    is_minority = (faces[as_is] < faces[flipped]) | ((faces[as_is] == faces[flipped]) & (as_is > flipped))
    return np.asarray((as_is != flipped) & is_minority)


def triangles_facing_flipped(new: Triangles, hole: IntArray, flipped: Triangles) -> BoolArray:
    """Find the new triangles of the holes whose rims lie for the most part at flipped triangles.

    Parameters
    ----------
    new : (l, 3) int64
    hole : (l,) int64
        Hole of each new triangle, counted from 0.
    flipped : (k, 3) int64

    Returns
    -------
    (l,) bool
    """
    if not len(new) or not len(flipped):
        return np.zeros(len(new), dtype=bool)
    n_vertices = int(max(new.max(), flipped.max())) + 1
    groups = group_edges(new, n_vertices)
    on_rim = (groups.count == 1)[groups.edge]
    at_flipped = on_rim & np.isin(edge_keys(groups.edges, n_vertices), edge_keys(directed_edges(flipped), n_vertices))
    n_holes = int(hole.max()) + 1
    rim, facing = (np.bincount(np.repeat(hole, 3), marked, minlength=n_holes) for marked in (on_rim, at_flipped))
    return np.asarray((2 * facing > rim)[hole])

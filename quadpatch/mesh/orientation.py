"""Faces turned over against their neighbours.

Boundary edges keep the direction of their face, so one face in the wrong direction breaks the rim that it lies at.
"""

import numpy as np

from quadpatch.mesh.edge_groups import components, group_edges
from quadpatch.types import BoolArray, Triangles


def turned_triangles(triangles: Triangles, n_vertices: int) -> BoolArray:
    """Find the triangles that are turned over against most of their piece.

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
    # Every triangle twice: t as it is, t + n turned over. A consistent piece falls into two mirrored components.
    crossed = np.where(disagrees, n, 0)
    links = np.stack([np.append(one, one + n), np.append(other + crossed, other + n - crossed)], axis=1)
    component = components(links, 2 * n)
    as_is, turned = component[:n], component[n:]
    faces = np.bincount(as_is, minlength=int(component.max()) + 1)
    is_minority = (faces[as_is] < faces[turned]) | ((faces[as_is] == faces[turned]) & (as_is > turned))
    return np.asarray((as_is != turned) & is_minority)

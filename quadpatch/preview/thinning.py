"""Large scans with fewer triangles: a picture has fewer pixels than they have vertices.

Vertices in one cell of a grid become one (J. Rossignac, P. Borrel, "Multi-resolution 3D approximations for rendering
complex scenes", 1993). The surroundings of holes that are drawn in close-up stay as they are.
"""

from collections.abc import Sequence

import numpy as np

from quadpatch.mesh.measures import bounding_box, diagonal
from quadpatch.types import BoolArray, IntArray, TriangleMesh, Vertices

# Meshes of more triangles are to be thinned.
MOST_TRIANGLES = 1_000_000
# Cells along the diagonal of the bounding box: about as many as an overview has pixels.
_CELLS = 750
# What a close-up shows of the surface around a hole, in diameters of the hole.
_AROUND = 1.5


def thinned(mesh: TriangleMesh, spared: Sequence[Vertices]) -> tuple[TriangleMesh, IntArray]:
    """Join vertices of a large mesh where a picture does not show the difference.

    Parameters
    ----------
    mesh : TriangleMesh
    spared : sequence of (n, 3) float64
        Points, such as those of the fill of each hole: every vertex around such a group stays as it is.

    Returns
    -------
    mesh : TriangleMesh
    kept : (k,) int64
        Which triangle of the mesh each one was.
    """
    # Vertices that no triangle uses may lie anywhere.
    low, high = bounding_box(mesh)
    cells = ((np.clip(mesh.vertices, low, high) - low) * (_CELLS / diagonal(mesh))).astype(np.int64)
    counts = cells.max(axis=0) + 1
    # Cells of the grid are numbered from 0, spared vertices below it.
    cell = (cells[:, 0] * counts[1] + cells[:, 1]) * counts[2] + cells[:, 2]
    stays = np.flatnonzero(_around(mesh, spared))
    cell[stays] = -1 - stays
    _, first, number = np.unique(cell, return_index=True, return_inverse=True)
    a, b, c = number.reshape(-1)[mesh.triangles].T
    kept = np.flatnonzero((a != b) & (b != c) & (c != a))
    return TriangleMesh(mesh.vertices[first], np.stack([a[kept], b[kept], c[kept]], axis=1)), kept


def _around(mesh: TriangleMesh, spared: Sequence[Vertices]) -> BoolArray:
    near = np.zeros(len(mesh.vertices), bool)
    for points in spared:
        low, high = points.min(axis=0), points.max(axis=0)
        reach = _AROUND * float(np.linalg.norm(high - low))
        near |= ((mesh.vertices > low - reach) & (mesh.vertices < high + reach)).all(axis=1)
    return near

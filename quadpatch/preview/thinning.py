"""Large scans with fewer triangles: a picture has fewer pixels than they have vertices.

Vertices in one cell of a grid become one (J. Rossignac, P. Borrel, "Multi-resolution 3D approximations for rendering
complex scenes", 1993). The surroundings of holes that are drawn in close-up stay as they are.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from quadpatch.mesh.measures import bounding_box, diagonal
from quadpatch.types import BoolArray, IntArray, TriangleMesh, Vertices

# Meshes of more triangles are to be thinned.
MOST_TRIANGLES = 1_000_000
# Cells along the diagonal of the bounding box: about as many as an overview has pixels.
_CELLS = 750
# Cells along the side of a block; what is spared is whole blocks, so that it takes no pass over the mesh for each hole.
_BLOCK = 8
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
    scale = _CELLS / diagonal(mesh)
    cells = ((np.clip(mesh.vertices, low, high) - low) * scale).astype(np.int32)
    counts = cells.max(axis=0) + 1
    # Cells of the grid are numbered from 0, spared vertices below it.
    cell = (cells[:, 0] * counts[1] + cells[:, 1]) * counts[2] + cells[:, 2]
    in_blocks = [(points - low) * (scale / _BLOCK) for points in spared]
    stays = np.flatnonzero(_around(cells // _BLOCK, in_blocks))
    cell[stays] = -1 - stays
    _, first, number = np.unique(cell, return_index=True, return_inverse=True)
    a, b, c = number.reshape(-1)[mesh.triangles].T
    kept = np.flatnonzero((a != b) & (b != c) & (c != a))
    return TriangleMesh(mesh.vertices[first], np.stack([a[kept], b[kept], c[kept]], axis=1)), kept


def _around(blocks: NDArray[np.int32], spared: Sequence[Vertices]) -> BoolArray:
    """Tell which vertices (n,), by their blocks (n, 3), lie around some points (k, 3), which are in blocks as well."""
    counts = blocks.max(axis=0) + 1
    is_spared = np.zeros(counts, dtype=bool)
    for points in spared:
        low, high = points.min(axis=0), points.max(axis=0)
        reach = _AROUND * np.linalg.norm(high - low)
        first, last = (np.floor(np.clip(corner, 0, counts)).astype(int) for corner in (low - reach, high + reach))
        is_spared[tuple(slice(i, j + 1) for i, j in zip(first, last, strict=True))] = True
    return np.asarray(is_spared[tuple(blocks.T)])

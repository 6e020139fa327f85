"""A plate that carries open tubes."""

import numpy as np

from quadpatch.types import TriangleMesh
from tests.quadpatch.shapes import open_grid


def plate_with_chimneys(n_rows: int, n_columns: int) -> TriangleMesh:
    """Cut square windows into a plate and raise their rims, three rings high."""
    n = 5 * max(n_rows, n_columns) + 1
    plate = open_grid(n)
    vertices, triangles = [plate.vertices], plate.triangles
    cell = np.arange((n - 1) ** 2)
    row, column = np.divmod(cell, n - 1)
    inside = (row % 5 == 2) & (column % 5 == 2) & (row // 5 < n_rows) & (column // 5 < n_columns)
    walls, count = [], n * n
    for k in cell[inside].tolist():
        i = k // (n - 1) * n + k % (n - 1)
        rim = np.array([i, i + 1, i + n + 1, i + n])
        for height in (1.0, 2.0, 3.0):
            ring = count + np.arange(4)
            vertices.append(plate.vertices[[i, i + 1, i + n + 1, i + n]] + np.array([0, 0, height]))
            after, ring_after = np.roll(rim, -1), np.roll(ring, -1)
            walls += [np.stack([rim, after, ring], 1), np.stack([after, ring_after, ring], 1)]
            rim, count = ring, count + 4
    kept = triangles[~np.tile(inside, 2)]
    return TriangleMesh(np.concatenate(vertices), np.concatenate([kept, *walls]))

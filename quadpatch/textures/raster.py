"""Rasterisation: which texels triangles of a page cover, and where in the triangles they lie.

Texel (row, column) of a page has its centre at (column + 0.5, row + 0.5).
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from quadpatch.types import FloatArray, IntArray

# Texels of bounding boxes that are looked at together.
_CHUNK = 1 << 21
# How far outside a triangle a centre counts as on its edge, in barycentric coordinates.
_EDGE = 1e-9


@dataclass(frozen=True)
class Coverage:
    """Texels that triangles cover; one on a common edge is covered by both triangles.

    Attributes
    ----------
    triangle : (k,) int64
        Ascending.
    row, column : (k,) int64
    weights : (k, 3) float64
        Barycentric coordinates of the texel's centre.
    """

    triangle: IntArray
    row: IntArray
    column: IntArray
    weights: FloatArray


def rasterise(corners: FloatArray) -> Iterator[Coverage]:
    """Find the texels whose centres lie in triangles with corners (m, 3, 2): column and row, in texels."""
    low = np.ceil(corners.min(axis=1) - 0.5 - _EDGE).astype(np.int64)
    size = (np.floor(corners.max(axis=1) - 0.5 + _EDGE).astype(np.int64) - low + 1).clip(0)
    counts = size.prod(axis=1)
    ends = np.cumsum(counts)
    start = 0
    # Loops over chunks of triangles.
    while start < len(corners):
        done = int(ends[start - 1]) if start else 0
        stop = max(int(np.searchsorted(ends, done + _CHUNK, side="right")), start + 1)
        yield _covered(corners, low, size, np.arange(start, stop))
        start = stop


def _covered(corners: FloatArray, low: IntArray, size: IntArray, rows: IntArray) -> Coverage:
    counts = size[rows].prod(axis=1)
    triangle = np.repeat(rows, counts)
    place = np.arange(len(triangle)) - np.repeat(np.cumsum(counts) - counts, counts)
    width = size[triangle, 0]
    column, row = low[triangle, 0] + place % width, low[triangle, 1] + place // width
    a, b, c = (corners[triangle, corner] for corner in range(3))
    centre = np.stack([column + 0.5, row + 0.5], axis=1)
    doubled = _cross(b - a, c - a)
    proper = doubled != 0
    scale = np.divide(1.0, doubled, out=np.zeros_like(doubled), where=proper)
    second, third = _cross(centre - a, c - a) * scale, _cross(b - a, centre - a) * scale
    weights = np.stack([1.0 - second - third, second, third], axis=1)
    inside = proper & (weights >= -_EDGE).all(axis=1)
    return Coverage(triangle[inside], row[inside], column[inside], weights[inside])


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    return np.asarray(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])

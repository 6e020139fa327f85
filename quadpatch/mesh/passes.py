"""Passes over large arrays of points, in parts that fit into the processor's cache."""

from collections.abc import Iterator

import numpy as np

from quadpatch.types import FloatArray, IntArray, Vertices

# Points that become one row of a table.
_POINTS_PER_ROW = 64
# Numbers that are compared together.
_NUMBERS = 1 << 16


def parts_of(n: int, size: int) -> Iterator[slice]:
    """Cut n rows into parts of a size; the last one may be smaller."""
    for at in range(0, n, size):
        yield slice(at, min(at + size, n))


def extent(points: Vertices) -> tuple[FloatArray, FloatArray]:
    """Lowest and highest coordinates (3,) of points (n, 3), of which there is at least one."""
    return _reduced(np.minimum, points), _reduced(np.maximum, points)


def _reduced(bound: np.ufunc, points: Vertices) -> FloatArray:
    # Rows of three are compared one by one, long rows many numbers at a time.
    n_rows = len(points) // _POINTS_PER_ROW
    if n_rows > 1:
        head, rest = np.split(points, [n_rows * _POINTS_PER_ROW])
        points = np.concatenate([bound.reduce(head.reshape(n_rows, -1), axis=0).reshape(-1, 3), rest])
    return np.asarray(bound.reduce(points, axis=0))


def is_identity(numbers: IntArray) -> bool:
    """Tell whether every position (n,) has its own number: without an array of them to compare with."""
    parts = parts_of(len(numbers), _NUMBERS)
    return all((numbers[part] == np.arange(part.start, part.stop)).all() for part in parts)


class Rows:
    """Rows of a table (n, k), picked as one item each: that takes half as long as picking k numbers."""

    def __init__(self, table: FloatArray) -> None:
        self._items = np.ascontiguousarray(table).view(np.dtype((np.void, table.shape[1] * table.itemsize)))[:, 0]
        self._dtype, self._width = table.dtype, table.shape[1]

    def at(self, rows: IntArray) -> FloatArray:
        """Return some rows (j, k)."""
        return self._items[rows].view(self._dtype).reshape(len(rows), self._width)

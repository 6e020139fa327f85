"""The table of the minimum-weight triangulation, for many loops of one length at once.

A stretch of a loop, from one vertex to another, is closed by a triangle on the chord between its ends and the two
stretches on either side of the triangle's apex. From short stretches to long ones, the table notes which apex is best.
"""

from collections.abc import Callable

import numpy as np

from quadpatch.types import BoolArray, FloatArray, IntArray

# Dihedral angles closer than this (as 1 - cos) count as equal; area decides then.
_ANGLE_STEP = 1e-3

# Whether triangles are forbidden, by the positions of their corners on a loop (broadcast against each other): (b, ...).
IsForbidden = Callable[[IntArray, IntArray, IntArray], BoolArray]


def best_triangulations(
    points: FloatArray, rim_normals: FloatArray, forbidden_chords: BoolArray, is_forbidden: IsForbidden | None
) -> tuple[IntArray, BoolArray]:
    """Triangulate b loops of n vertices.

    Parameters
    ----------
    points : (b, n, 3) float64
    rim_normals : (b, n, 3) float64
        Unit normal of the face at each rim edge, from vertex i to i + 1.
    forbidden_chords : (b, n, n) bool
    is_forbidden : callable or None
        None where no triangle is.

    Returns
    -------
    corners : (b, n - 2, 3) int64
        Positions on the loop.
    exists : (b,) bool
        False where every triangulation would contain what is forbidden.
    """
    b, n, _ = points.shape
    place, rim = (np.ascontiguousarray(np.moveaxis(vectors, 2, 0)) for vectors in (points, rim_normals))
    # Of each stretch the angle, the area and the normal at its chord, by start and length, and by end and length: so
    # the two stretches beside an apex, for all apexes of a stretch, are slices.
    from_start, from_end = np.zeros((5, b, n, n)), np.zeros((5, b, n, n))
    from_start[2:, :, :-1, 1] = from_end[2:, :, 1:, 1] = rim[:, :, :-1]
    apex = np.full((b, n, n), -1)
    size = np.linalg.norm(np.ptp(points, axis=1), axis=1)[:, None, None] ** 2 + 1e-300
    has_forbidden = bool(forbidden_chords.any())
    for gap in range(2, n):
        start = np.arange(n - gap)
        left = from_start[:, :, : n - gap, 1:gap]
        right = from_end[:, :, gap:, gap - 1 : 0 : -1]
        values = np.zeros((5, b, n - gap, gap - 1))
        bend, area, normal = values[0], values[1], values[2:]
        np.divide(_faces(place, gap, normal), 2, out=area)
        turn = np.minimum(_dot(normal, left[2:]), _dot(normal, right[2:]))
        if gap == n - 1:
            turn = np.minimum(turn, _dot(normal, rim[:, :, -1:, None]))
        np.subtract(1.0, turn, out=bend)
        np.maximum(bend, np.maximum(left[0], right[0]), out=bend)
        area += left[1]
        area += right[1]
        if has_forbidden:
            bend[forbidden_chords.diagonal(gap, axis1=1, axis2=2)] = np.inf
        if is_forbidden is not None:
            bend[is_forbidden(start[:, None], start[:, None] + np.arange(1, gap), start[:, None] + gap)] = np.inf
        best = (np.rint(bend / _ANGLE_STEP) + 1e-3 * area / size).argmin(axis=-1)
        apex[:, : n - gap, gap] = start + 1 + best
        at = np.arange(best.size).reshape(best.shape) * (gap - 1) + best
        chosen = values.reshape(5, -1)[:, at]
        from_start[:, :, : n - gap, gap] = from_end[:, :, gap:, gap] = chosen
    return _read_off(apex), np.isfinite(from_start[0, :, 0, n - 1])


def _faces(place: FloatArray, gap: int, normal: FloatArray) -> FloatArray:
    """Give double areas (b, n - gap, gap - 1) of the triangles on all stretches of a length, by start and apex.

    Their unit normals are written to `normal` (3, b, n - gap, gap - 1).
    """
    n, (by_axis, by_loop, by_vertex) = place.shape[2], place.strides
    first, last = place[:, :, : n - gap, None], place[:, :, gap:, None]
    # Apexes as `sliding_window_view` has them, which takes longer to say so than to compute with them.
    strides = (by_axis, by_loop, by_vertex, by_vertex)
    apex: FloatArray = np.ndarray(normal.shape, place.dtype, place.data, by_vertex, strides)
    u, v = apex - last, first - last
    for axis in range(3):
        one, other = (axis + 1) % 3, (axis + 2) % 3
        np.multiply(u[one], v[other], out=normal[axis])
        normal[axis] -= u[other] * v[one]
    double_area = np.sqrt(_dot(normal, normal))
    normal /= np.maximum(double_area, 1e-300)
    return double_area


def _dot(one: FloatArray, other: FloatArray) -> FloatArray:
    """Multiply vectors (3, ...); summed in the order of `numpy.einsum`."""
    products = one * other
    products[0] += products[2]
    products[0] += products[1]
    return np.asarray(products[0])


def _read_off(apex: IntArray) -> IntArray:
    """Triangles (b, n - 2, 3) out of the table of apexes, by start and length of a stretch."""
    b, n, _ = apex.shape
    corners = np.zeros((b, n - 2, 3), np.int64)
    for row in range(b):
        table, spans, count = apex[row], [(0, n - 1)], 0
        while spans:
            i, j = spans.pop()
            if j - i < 2:
                continue
            k = int(table[i, j - i])
            corners[row, count] = j, k, i
            count += 1
            spans += [(i, k), (k, j)]
    return corners

"""Polygons and strips cut into triangles.

Convex polygons become fans around their first corner, concave quads fans around their reflex corner, other concave
polygons are cut by ear clipping (Meisters, "Polygons have ears", 1975). Corners keep their order, so orientation
survives. Polygons of fewer than three corners have no area and give no triangle.
"""

import numpy as np

from quadpatch.types import BoolArray, FloatArray, IntArray, Triangles, Vertices

# Ear clipping costs the square of the corner count; larger concave polygons become fans.
_MOST_CLIPPED_CORNERS = 500
# Polygons looked at together: few enough to stay in the processor's cache.
_AT_ONCE = 8192
# Share of the polygon's area by which a corner may point inwards and still count as straight.
_STRAIGHT = 1e-9


def triangulate_polygons(vertices: Vertices, counts: IntArray, corners: IntArray) -> tuple[Triangles, IntArray]:
    """Cut polygons into triangles.

    Parameters
    ----------
    vertices : (n, 3) float64
    counts : (n_polygons,) int64
        Corners of each polygon.
    corners : (sum of counts,) int64
        Vertex indices, polygon by polygon; must be in range.

    Returns
    -------
    triangles : (m, 3) int64
        In the order of the polygons.
    polygon : (m,) int64
        The polygon of each triangle.
    """
    if (counts == 3).all():
        return corners.reshape(-1, 3), np.arange(len(counts), dtype=np.int64)
    starts = np.cumsum(counts) - counts
    pieces: list[Triangles] = [np.zeros((0, 3), dtype=np.int64)]
    owners: list[IntArray] = [np.zeros(0, dtype=np.int64)]
    for size in np.unique(counts[counts >= 3]):
        which = np.flatnonzero(counts == size)
        owners.append(np.repeat(which, size - 2))
        for first in range(0, len(which), _AT_ONCE):
            loops = corners[starts[which[first : first + _AT_ONCE]][:, np.newaxis] + np.arange(size)]
            pieces.append(_cut(vertices, loops).reshape(-1, 3))
    owner = np.concatenate(owners)
    triangles = np.concatenate(pieces)
    if (owner[1:] >= owner[:-1]).all():
        return triangles, owner
    order = np.argsort(owner, kind="stable")
    return triangles[order], owner[order]


def _cut(vertices: Vertices, loops: IntArray) -> IntArray:
    """Cut polygons of one size: (p, k) corners to (p, k - 2, 3) triangles."""
    size = loops.shape[1]
    if size == 3:
        return loops[:, np.newaxis, :]
    points = vertices[loops]
    normals = _newell_normals(points)
    reflex = _reflex_corners(points, normals)
    if size == 4:
        # A fan around the reflex corner stays inside; argmax of no reflex corner at all is 0.
        turn = (np.argmax(reflex, axis=1)[:, np.newaxis] + np.arange(4)) % 4
        return _fans(np.take_along_axis(loops, turn, axis=1))
    triangles = _fans(loops)
    if size <= _MOST_CLIPPED_CORNERS:
        for row in np.flatnonzero(reflex.any(axis=1)):
            triangles[row] = loops[row][_clip_ears(_flatten(points[row], normals[row]))]
    return triangles


def _fans(loops: IntArray) -> IntArray:
    first = np.repeat(loops[:, :1], loops.shape[1] - 2, axis=1)
    return np.stack([first, loops[:, 1:-1], loops[:, 2:]], axis=2)


def _newell_normals(points: FloatArray) -> FloatArray:
    """Twice the area vector of each polygon, (p, 3)."""
    centred = points - points.mean(axis=1, keepdims=True)
    return np.asarray(_cross(centred, np.roll(centred, -1, axis=1)).sum(axis=1))


def _reflex_corners(points: FloatArray, normals: FloatArray) -> BoolArray:
    """Corners at which the polygon turns the wrong way, (p, k)."""
    after = np.roll(points, -1, axis=1) - points
    turn = np.einsum("pki,pi->pk", _cross(np.roll(after, 1, axis=1), after), normals)
    return np.asarray(turn < -_STRAIGHT * np.einsum("pi,pi->p", normals, normals)[:, np.newaxis])


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    """Cross products, (..., 3); numpy's own takes twice as long."""
    ax, ay, az = np.moveaxis(a, -1, 0)
    bx, by, bz = np.moveaxis(b, -1, 0)
    return np.stack([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx], axis=-1)


def _flatten(points: FloatArray, normal: FloatArray) -> FloatArray:
    """Project a polygon along the largest axis of its normal, counter-clockwise, (k, 2)."""
    axis = int(np.argmax(np.abs(normal)))
    flat = points[:, [(axis + 1) % 3, (axis + 2) % 3]]
    return flat if normal[axis] > 0 else flat * np.array([1.0, -1.0])


def _clip_ears(flat: FloatArray) -> IntArray:
    """Triangles of a simple counter-clockwise polygon, (k - 2, 3) positions in it."""
    remaining = list(range(len(flat)))
    triangles: list[tuple[int, int, int]] = []
    while len(remaining) > 3:
        corners = [(remaining[i - 1], remaining[i], remaining[(i + 1) % len(remaining)]) for i in range(len(remaining))]
        # A polygon that crosses itself may have no ear: any corner then keeps the work finite.
        at = next((i for i, corner in enumerate(corners) if _is_ear(flat, corner, remaining)), 0)
        triangles.append(corners[at])
        del remaining[at]
    triangles.append((remaining[0], remaining[1], remaining[2]))
    return np.array(triangles, dtype=np.int64)


def _is_ear(flat: FloatArray, corner: tuple[int, int, int], remaining: list[int]) -> bool:
    a, b, c = (flat[i] for i in corner)
    if _area(a, b, c) <= 0:
        return False
    others = flat[[i for i in remaining if i not in corner]]
    inside = (_area(a, b, others) >= 0) & (_area(b, c, others) >= 0) & (_area(c, a, others) >= 0)
    return not bool(np.any(inside))


def _area(a: FloatArray, b: FloatArray, points: FloatArray) -> FloatArray:
    """Twice the signed area of the triangles a, b, point."""
    ab, ap = b - a, points - a
    return np.asarray(ab[0] * ap[..., 1] - ab[1] * ap[..., 0])


def triangulate_strips(counts: IntArray, corners: IntArray) -> Triangles:
    """Cut triangle strips into triangles.

    Parameters
    ----------
    counts : (n_lists,) int64
        Length of each list.
    corners : (sum of counts,) int64
        Vertex indices list by list; a negative one starts a new strip.

    Returns
    -------
    (m, 3) int64
        Every second triangle of a strip turned round; triangles with a repeated corner, which only lead a strip on,
        are left out.
    """
    # A separator between the lists makes all of them one sequence.
    sequence = np.insert(np.maximum(corners, -1), np.cumsum(counts), -1)
    places = np.arange(len(sequence), dtype=np.int64)
    last_break = np.maximum.accumulate(np.where(sequence < 0, places, -1))
    triangles = np.stack([sequence[:-2], sequence[1:-1], sequence[2:]], axis=1)
    is_odd = (places[:-2] - last_break[:-2] - 1) % 2 == 1
    triangles[is_odd] = triangles[is_odd][:, [1, 0, 2]]
    a, b, c = triangles.T
    keep = (triangles >= 0).all(axis=1) & (a != b) & (b != c) & (c != a)
    return np.asarray(triangles[keep], dtype=np.int64)


def list_range(starts: IntArray, counts: IntArray) -> IntArray:
    """Return the place of every item of lists that begin at `starts` and hold `counts` items, list by list."""
    first_of_each = np.repeat(starts - (np.cumsum(counts) - counts), counts)
    return first_of_each + np.arange(len(first_of_each), dtype=np.int64)

"""Flips of edges until a triangulation is locally Delaunay.

Each pass flips edges no two of which share a triangle. Which half-edges lie on one edge is kept from pass to pass, so
that a pass looks only at edges beside the flips of the pass before it, and at those that could not be flipped then.
Half-edge ``3 t + k`` runs from corner k of triangle t to the next one.

Tested in `tests/quadpatch/filling/test_refinement.py`.
"""

import numpy as np

from quadpatch.filling.triangulation import EdgeSet
from quadpatch.mesh.edge_groups import group_edges
from quadpatch.mesh.normals import cross, triangle_normals, unit
from quadpatch.mesh.topology import directed_edges, edge_keys, order_of
from quadpatch.types import BoolArray, FloatArray, IntArray, Triangles, Vertices

_MAX_PASSES = 40
# An edge counts as Delaunay while cot(alpha) + cot(beta) is above minus this.
_SLACK = 1e-9
# Flips that are asked to keep the surface from folding over leave a margin to `faults.FOLD_ANGLE_DEG`.
MOST_TURN_DEG = 135.0


def delaunay(
    triangles: Triangles, vertices: Vertices, shared: BoolArray, existing_edges: EdgeSet, rim: Triangles | None = None
) -> Triangles:
    """Flip interior edges until all are locally Delaunay.

    Parameters
    ----------
    triangles : (m, 3) int64
        An oriented manifold.
    vertices : (n, 3) float64
    shared : (n,) bool
        No flip makes an edge between two of these.
    existing_edges : EdgeSet
        Edges that exist already.
    rim : (k, 3) int64, optional
        Triangles around. With them, no flip makes a turn beyond `MOST_TURN_DEG` or makes one sharper.

    Returns
    -------
    (m, 3) int64
        A copy; triangles beside flipped edges are others.
    """
    triangles, twin = triangles.copy(), _twins(triangles, len(vertices))
    places = np.ascontiguousarray(vertices.T)
    wanted = np.flatnonzero(twin > np.arange(len(twin)))
    for _ in range(_MAX_PASSES):
        excess = _excess(triangles, places, wanted, twin[wanted])
        is_bad = excess < -_SLACK
        if not is_bad.any():
            break
        bad = _by_urgency(triangles, wanted[is_bad], excess[is_bad], len(vertices))
        allowed = _is_allowed(triangles, vertices, bad, twin[bad], shared, existing_edges)
        if rim is not None:
            allowed &= _turns_little(np.concatenate([triangles, rim]), vertices, bad, twin[bad])
        flipped = _apart(triangles, bad[allowed], twin[bad[allowed]], len(vertices))
        if not len(flipped):
            break
        changed = np.concatenate([flipped, twin[flipped]]) // 3
        left_over = _flip(triangles, twin, flipped, np.setdiff1d(bad, flipped))
        beside = np.concatenate([left_over, (3 * changed[:, None] + np.arange(3)).ravel()])
        wanted = np.unique(np.minimum(beside, twin[beside]))
        wanted = wanted[wanted >= 0]
    return triangles


def _twins(triangles: Triangles, n_vertices: int) -> IntArray:
    """Find the other half-edge (3 m,) on the edge of each; -1 on a border, and where an edge has three."""
    keys = edge_keys(directed_edges(triangles), n_vertices)
    order = order_of(keys, n_vertices**2)
    ranked = keys[order]
    same = np.zeros(len(keys) + 1, bool)
    np.equal(ranked[1:], ranked[:-1], out=same[1:-1])
    first = np.flatnonzero(same[1:-1] & ~same[:-2] & ~same[2:])
    one, other = order[first], order[first + 1]
    twin = np.full(len(keys), -1)
    twin[one], twin[other] = other, one
    return twin


def _corners(triangles: Triangles, left: IntArray, right: IntArray) -> tuple[IntArray, IntArray, IntArray, IntArray]:
    """Give ends a and b of edges by their half-edges (k,), a to b in a triangle (a, b, c), and back in (b, a, d)."""
    flat, after_left = triangles.ravel(), _next(left)
    return flat[left], flat[after_left], flat[_next(after_left)], flat[_next(_next(right))]


def _next(half_edges: IntArray) -> IntArray:
    return half_edges + np.where(half_edges % 3 == 2, -2, 1)


def _excess(triangles: Triangles, places: FloatArray, left: IntArray, right: IntArray) -> FloatArray:
    """Add the cotangents (k,) opposite some edges, by vertices (3, n); below zero where an edge is not Delaunay."""
    a, b, c, d = (places[:, corner] for corner in _corners(triangles, left, right))
    return _cotangent(a - c, b - c) + _cotangent(a - d, b - d)


def _cotangent(u: FloatArray, v: FloatArray) -> FloatArray:
    """Cotangents (k,) of the angles between vectors (3, k)."""
    x, y, z = u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]
    length = np.sqrt(x * x + y * y + z * z)
    return np.asarray((u[0] * v[0] + u[1] * v[1] + u[2] * v[2]) / np.maximum(length, 1e-300))


def _by_urgency(triangles: Triangles, half_edges: IntArray, excess: FloatArray, n_vertices: int) -> IntArray:
    """Sort half-edges (k,) by the least excess (k,); equal ones by their ends."""
    flat = triangles.ravel()
    ends = np.stack([flat[half_edges], flat[_next(half_edges)]], axis=1)
    return half_edges[np.lexsort((edge_keys(ends, n_vertices), excess))]


def _is_allowed(
    triangles: Triangles,
    vertices: Vertices,
    left: IntArray,
    right: IntArray,
    shared: BoolArray,
    existing_edges: EdgeSet,
) -> BoolArray:
    """Which edges (k,) may be flipped: neither folds the surface nor makes an edge that is there already."""
    a, b, c, d = _corners(triangles, left, right)
    allowed = _is_unfolded(*(vertices[row] for row in (a, b, c, d))) & (c != d)
    crossing = np.stack([c, d], axis=1)
    allowed &= ~existing_edges.contains(crossing) & ~(shared[c] & shared[d])
    # Only edges between ends of these can be among them.
    is_end = np.zeros(len(vertices), bool)
    is_end[crossing] = True
    flat = triangles.ravel()
    near = np.flatnonzero(is_end[flat])
    starts, ends = flat[near], flat[_next(near)]
    near = is_end[ends]
    found = np.sort(edge_keys(np.stack([starts[near], ends[near]], axis=1), len(vertices)))
    keys = edge_keys(crossing, len(vertices))
    if len(found):
        allowed &= found[np.searchsorted(found, keys).clip(max=len(found) - 1)] != keys
    return np.asarray(allowed)


def _apart(triangles: Triangles, left: IntArray, right: IntArray, n_vertices: int) -> IntArray:
    """Choose edges (k,), the most urgent first, no two of which have a triangle in common or become one edge."""
    is_first = _is_first_everywhere(left // 3, right // 3, len(triangles))
    left, right = left[is_first], right[is_first]
    _, _, c, d = _corners(triangles, left, right)
    return left[np.unique(edge_keys(np.stack([c, d], axis=1), n_vertices), return_index=True)[1]]


def _flip(triangles: Triangles, twin: IntArray, left: IntArray, followed: IntArray) -> IntArray:
    """Flip edges by one of their half-edges (k,), in place; say where some others (j,) are then.

    Triangles (a, b, c) and (b, a, d) become (a, d, c) and (d, b, c).
    """
    right = twin[left]
    a, b, c, d = _corners(triangles, left, right)
    bc, ad = _next(left), _next(right)
    outer = np.concatenate([ad, _next(bc), _next(ad), bc])
    t, u = 3 * (left // 3), 3 * (right // 3)
    place = np.concatenate([t, t + 2, u, u + 1])
    triangles[left // 3] = np.stack([a, d, c], axis=1)
    triangles[right // 3] = np.stack([d, b, c], axis=1)
    number = np.arange(len(twin))
    number[outer] = place
    beyond = twin[outer]
    beyond = np.where(beyond >= 0, number[beyond], -1)
    twin[place] = beyond
    twin[beyond[beyond >= 0]] = place[beyond >= 0]
    twin[t + 1], twin[u + 2] = u + 2, t + 1
    return number[followed]


def _is_unfolded(a: Vertices, b: Vertices, c: Vertices, d: Vertices) -> BoolArray:
    """Whether the triangles (a, d, c) and (d, b, c), which the flip makes, look the same way."""
    unfolded: BoolArray = np.einsum("ij,ij->i", cross(d - a, c - a), cross(b - d, c - d)) > 0
    return unfolded


def _turns_little(triangles: Triangles, vertices: Vertices, left: IntArray, right: IntArray) -> BoolArray:
    """Whether flips (n,) keep the turns at their five edges within `MOST_TURN_DEG`, or below the sharpest before.

    Flips are given by the two directions of their edges, a to b in a triangle (a, b, c) and back in (b, a, d); edge
    ``3 t + k`` runs from corner k of triangle t.
    """
    groups = group_edges(triangles, len(vertices))
    normals = triangle_normals(vertices, triangles)

    def across(edges: IntArray, step: int) -> FloatArray:
        """Look up the normals beyond the edge that follows each edge in its triangle after so many steps."""
        edges = edges // 3 * 3 + (edges + step) % 3
        start = groups.starts[groups.edge[edges]]
        one, other = groups.order[start], groups.order[start + groups.count[groups.edge[edges]] - 1]
        return np.asarray(normals[np.where(one == edges, other, one) // 3])

    of_cb, of_ac, of_da, of_bd = across(left, 1), across(left, 2), across(right, 1), across(right, 2)
    a, b, c, d = _corners(triangles, left, right)
    abc, bad = normals[left // 3], normals[right // 3]
    adc, dbc = (unit(cross(vertices[p] - vertices[d], vertices[q] - vertices[d])) for p, q in ((c, a), (b, c)))
    before = _least_cosine([(abc, bad), (abc, of_ac), (abc, of_cb), (bad, of_bd), (bad, of_da)])
    after = _least_cosine([(adc, dbc), (adc, of_ac), (adc, of_da), (dbc, of_cb), (dbc, of_bd)])
    return np.asarray(after >= np.minimum(before, np.cos(np.radians(MOST_TURN_DEG))))


def _least_cosine(pairs: list[tuple[FloatArray, FloatArray]]) -> FloatArray:
    return np.asarray(np.min([np.einsum("ij,ij->i", one, other) for one, other in pairs], axis=0))


def _is_first_everywhere(left: IntArray, right: IntArray, n_triangles: int) -> BoolArray:
    """Which of some edges, the most urgent first, come first in both of their triangles."""
    position = np.arange(len(left))
    rank = np.full(n_triangles, len(left))
    # Later writes win: in reverse order the most urgent edge of a triangle stays.
    rank[right[::-1]] = position[::-1]
    rank_left = np.full(n_triangles, len(left))
    rank_left[left[::-1]] = position[::-1]
    rank = np.minimum(rank, rank_left)
    first: BoolArray = (rank[left] == position) & (rank[right] == position)
    return first

"""Joining boundary vertices that lie closer together than the numbers of their file can tell.

Programs that compute the corners of every facet anew leave noise in the last bits, so that equal corners are equal no
more. Such corners are joined where that collapses no triangle. A cluster is never wider than the tolerance: a row of
vertices, each near the next one, is not drawn together.
"""

from typing import Literal

import numpy as np
from scipy.spatial import cKDTree

from quadpatch.errors import OptionError
from quadpatch.mesh.measures import mean_edge_length
from quadpatch.mesh.topology import components, directed_edges, touching
from quadpatch.types import BoolArray, FloatArray, IntArray, TriangleMesh, Triangles, Vertices

# In mesh units, or what the numbers of the file allow.
Tolerance = float | Literal["auto"]

# Two corners that are each two units off in the last place of every coordinate lie up to seven units apart.
ULPS = 8

# An automatic tolerance is at most this share of every edge at the vertices that it joins.
EDGE_SHARE = 0.01

# More pairs than this take gigabytes, and of those that are looked at one by one, minutes.
MAX_PAIRS, MAX_SINGLE_PAIRS = 5_000_000, 100_000

# Clusters that are not plain stop growing here.
_MAX_MEMBERS = 64

# Decimal digits that a number of single precision is never wrong in, and that always suffice to write it.
_SAFE_DIGITS, _WRITTEN_DIGITS = 7, (8, 9)


def join_near(mesh: TriangleMesh, on_boundary: BoolArray, tolerance: Tolerance) -> tuple[IntArray | None, float]:
    """Find boundary vertices to be joined.

    Parameters
    ----------
    mesh : TriangleMesh
        Equal positions on its boundary are joined already.
    on_boundary : (n,) bool
        Its boundary vertices.
    tolerance : float or "auto"
        Largest distance, in mesh units. `auto` is `ULPS` units in the last place of the largest coordinate on the
        boundary, in the precision that the file has kept, but at most `EDGE_SHARE` of the shortest edge at either
        vertex, edges shorter than those units aside.

    Returns
    -------
    first : (n,) int64 or None
        The lowest vertex of each vertex's cluster; None where there is nothing to join.
    tolerance : float
        In mesh units.

    Raises
    ------
    OptionError
        If the tolerance is longer than the mean edge, or too many vertices are in reach of each other. An automatic one
        joins none of these.
    """
    vertices = mesh.vertices
    if tolerance != "auto" and not tolerance:
        return None, 0.0
    candidates = np.flatnonzero(on_boundary)
    points = vertices[candidates]
    limit = stored_precision(points) if tolerance == "auto" else tolerance
    if tolerance != "auto" and limit > mean_edge_length(mesh):
        raise OptionError(
            f"weld_tolerance must be at most the mean edge length, {mean_edge_length(mesh):.6g}; it is {limit:.6g}"
        )
    # Most vertices have no other one in reach; the nearest one tells.
    candidates = candidates[_nearest_distance(points, limit) <= limit]
    if not len(candidates):
        return None, limit
    first = np.arange(len(vertices), dtype=np.int64)
    reach = np.full(len(candidates), limit)
    if tolerance == "auto":
        reach = np.minimum(reach, EDGE_SHARE * _shortest_edges(mesh, candidates, limit))
    pairs = _near_pairs(vertices[candidates], reach)
    if pairs is not None and len(pairs):
        reach_of = np.zeros(len(vertices))
        reach_of[candidates] = reach
        rest = _join_plain(first, mesh, candidates[pairs], reach_of)
        if len(rest) <= MAX_SINGLE_PAIRS:
            _join_one_by_one(first, mesh, rest, reach_of)
        else:
            pairs = None
    if pairs is None and tolerance != "auto":
        raise OptionError(f"weld_tolerance {limit:.6g} joins too much: too many vertices are in reach of each other")
    return first, limit


def stored_precision(points: Vertices) -> float:
    """Say how far equal points of a file may lie apart by rounding, in mesh units.

    Parameters
    ----------
    points : (n, 3) float64

    Returns
    -------
    float
        `ULPS` units in the last place of the largest coordinate: of single precision where every number is one, or is
        written with as few digits, else of double precision.
    """
    largest = float(np.abs(points).max(initial=0.0))
    if _is_single(points[:1000]) and _is_single(points):
        with np.errstate(over="ignore"):
            return ULPS * float(np.spacing(np.float32(largest)).astype(np.float64))
    return ULPS * float(np.spacing(largest))


def _is_single(points: Vertices) -> bool:
    """Whether all numbers have single precision, as bits or as what is left of them in a text file."""
    with np.errstate(over="ignore", under="ignore"):
        single = points.astype(np.float32).astype(np.float64)
    known = single == points
    if known.all():
        return True
    numbers, single = points[~known], single[~known]
    written = _equals(numbers, _rounded(numbers, _SAFE_DIGITS))
    for digits in _WRITTEN_DIGITS:
        written |= _equals(numbers, _rounded(single, digits))
    return bool(np.isfinite(single).all() and written.all())


def _rounded(numbers: FloatArray, digits: int) -> FloatArray:
    """Round numbers (n,) to so many significant decimal digits, to float64's accuracy."""
    # Numbers too small for single precision round to 0 there; so do they here.
    exponent = np.floor(np.log10(np.maximum(np.abs(numbers), 1e-300)))
    scale = 10.0 ** np.clip(digits - 1 - exponent, -300, 300)
    return np.asarray(np.rint(numbers * scale) / scale)


def _equals(numbers: FloatArray, others: FloatArray) -> BoolArray:
    return np.asarray(np.abs(numbers - others) <= 4 * np.spacing(np.abs(numbers)))


def _nearest_distance(points: Vertices, limit: float) -> FloatArray:
    """Distance (n,) of each point to the nearest other one, infinite beyond the limit."""
    if len(points) < 2:
        return np.full(len(points), np.inf)
    distance, _ = cKDTree(points).query(points, k=[2], distance_upper_bound=np.nextafter(limit, np.inf))
    return np.asarray(distance)[:, 0]


def _shortest_edges(mesh: TriangleMesh, wanted: IntArray, noise: float) -> FloatArray:
    """Shortest edge at each wanted vertex that is longer than the noise, (k,) float64; 0 where there is none."""
    shortest = np.full(len(mesh.vertices), np.inf)
    is_wanted = np.zeros(len(mesh.vertices), dtype=bool)
    is_wanted[wanted] = True
    triangles = mesh.triangles[touching(mesh.triangles, is_wanted)]
    for k in range(3):
        start, end = triangles[:, k], triangles[:, k - 2]
        length = np.linalg.norm(mesh.vertices[start] - mesh.vertices[end], axis=1)
        length[length <= noise] = np.inf
        np.minimum.at(shortest, start, length)
        np.minimum.at(shortest, end, length)
    # Where no edge is longer than the noise, noise and surface can't be told apart.
    return np.where(np.isfinite(shortest), shortest, 0.0)[wanted]


def _near_pairs(points: Vertices, reach: FloatArray) -> IntArray | None:
    """Find the pairs of points (k, 2) that lie in reach of each other; None where they are too many."""
    nothing = np.zeros((0, 2), np.int64)
    if len(points) < 2:
        return nothing
    rows = np.flatnonzero(_nearest_distance(points, float(reach.max())) <= reach)
    if not len(rows):
        return nothing
    tree = cKDTree(points[rows])
    counts = tree.query_ball_point(points[rows], reach[rows], return_length=True)
    if counts.sum() - len(rows) > 2 * MAX_PAIRS:
        return None
    found = tree.query_ball_point(points[rows], reach[rows])
    one = np.repeat(rows, counts)
    other = rows[np.concatenate(found).astype(np.int64)]
    # Both ends must reach the other one; each pair is found from both.
    both = (one < other) & (np.linalg.norm(points[one] - points[other], axis=1) <= reach[other])
    return np.stack([one[both], other[both]], axis=1)


def _join_plain(first: IntArray, mesh: TriangleMesh, pairs: IntArray, reach: FloatArray) -> IntArray:
    """Join the clusters that are narrow and hold no two corners of a triangle; return the pairs (k, 2) of the others.

    Changes `first`.
    """
    used, local = np.unique(pairs, return_inverse=True)
    cluster = components(local.reshape(-1, 2), len(used))
    is_plain = _narrow(mesh.vertices[used], reach[used], cluster)
    label = np.full(len(first), -1)
    label[used] = cluster
    corners = label[mesh.triangles]
    for k in range(3):
        is_plain[corners[(corners[:, k] >= 0) & (corners[:, k] == corners[:, k - 1]), k]] = False
    lowest = np.full(len(is_plain), len(first))
    np.minimum.at(lowest, cluster, used)
    plain = is_plain[cluster]
    first[used[plain]] = lowest[cluster[plain]]
    return np.asarray(pairs[~is_plain[label[pairs[:, 0]]]])


def _narrow(points: Vertices, reach: FloatArray, cluster: IntArray) -> BoolArray:
    """Whether the bounding box of each cluster is narrower than all its points reach, (n_clusters,) bool."""
    n = int(cluster.max()) + 1
    low, high, least = np.full((n, 3), np.inf), np.full((n, 3), -np.inf), np.full(n, np.inf)
    np.minimum.at(low, cluster, points)
    np.maximum.at(high, cluster, points)
    np.minimum.at(least, cluster, reach)
    return np.asarray(np.linalg.norm(high - low, axis=1) <= least)


def _join_one_by_one(first: IntArray, mesh: TriangleMesh, pairs: IntArray, reach: FloatArray) -> None:
    """Join the nearest pairs first, as long as no cluster gets wider than its points reach or holds an edge.

    Loops over the pairs of clusters that are not plain. Their order is that of distance and position, so the clusters
    are the same whatever the file's order. Changes `first`.
    """
    vertices = mesh.vertices
    distance = np.linalg.norm(vertices[pairs[:, 0]] - vertices[pairs[:, 1]], axis=1)
    middle = vertices[pairs[:, 0]] + vertices[pairs[:, 1]]
    edges = _edges_among(mesh.triangles, pairs, len(vertices))
    members = {v: [v] for v in np.unique(pairs).tolist()}
    for one, other in pairs[np.lexsort((*middle.T, distance))].tolist():
        mine, theirs = members[one], members[other]
        if mine is theirs or len(mine) + len(theirs) > _MAX_MEMBERS:
            continue
        if any((a, b) in edges for a in mine for b in theirs):
            continue
        both = sorted(mine + theirs)
        distances = np.linalg.norm(vertices[mine][:, np.newaxis] - vertices[theirs], axis=2)
        if distances.max() <= reach[both].min():
            members |= dict.fromkeys(both, both)
    for vertex, both in members.items():
        first[vertex] = both[0]


def _edges_among(triangles: Triangles, vertices: IntArray, n_vertices: int) -> set[tuple[int, int]]:
    """Edges between some vertices, in both directions."""
    is_wanted = np.zeros(n_vertices, dtype=bool)
    is_wanted[vertices] = True
    edges = directed_edges(triangles)
    found = edges[is_wanted[edges].all(axis=1)].tolist()
    return {(a, b) for a, b in found} | {(b, a) for a, b in found}

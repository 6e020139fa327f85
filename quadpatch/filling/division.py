"""Division of long boundary loops by chords.

The table of the minimum-weight triangulation costs O(n^3), so a long loop is divided first, into loops short enough
for it. The best chord is short for the stretch of rim that it cuts off: in a crack it leads from one side to the other,
in a disk it is a diameter. It must start and end inside the hole, which lies on the right of its loop, and may not run
through another stretch of the rim: around an island, or a finger of surface, that would be the shortest way.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from quadpatch.mesh.normals import cross, unit
from quadpatch.types import BoolArray, FloatArray, IntArray, Vertices

# Which pairs (k, 2) of loop vertices are joined by an edge already: (k,).
IsEdge = Callable[[IntArray], BoolArray]

# End points that are compared, at most; the rest of a longer loop is left out, evenly.
_MAX_ENDS = 512
# Smallest angle between a chord and the rim at its ends, in radians; a second try goes without.
_LEAST_ANGLE = 0.05
# Smallest share of a loop's edges that a chord cuts off.
_LEAST_SHARE = 1 / 8
# A rim edge is in the way of a chord if it passes it within this share of its length, along the normal.
_REACH = 0.5
# The best chords are compared with the rim so many at a time, and so many in all.
_BATCH = 32
_MOST_COMPARED = 4096


@dataclass(frozen=True)
class RimLoop:
    """A loop to be triangulated.

    Attributes
    ----------
    vertices : (n,) int64
        With the surface on the left of the loop.
    normals : (n, 3) float64
        Unit normal of the surface at every edge, from vertex i to i + 1.
    """

    vertices: IntArray
    normals: FloatArray


def divide(loop: RimLoop, points: Vertices, max_size: int, is_edge: IsEdge) -> list[RimLoop]:
    """Divide a loop until none of the parts has more than `max_size` vertices.

    Parameters
    ----------
    loop : RimLoop
    points : (n_vertices, 3) float64
    max_size : int
    is_edge : callable
        Which pairs (k, 2) int64 of loop vertices an edge joins already: (k,) bool.

    Returns
    -------
    list of RimLoop
        Empty where no chord is free.
    """
    parts, waiting = [], [loop]
    while waiting:
        part = waiting.pop()
        if len(part.vertices) <= max_size:
            parts.append(part)
            continue
        chord = _best_chord(part, points, is_edge)
        if chord is None:
            return []
        waiting += _cut(part, *chord)
    return parts


def _cut(loop: RimLoop, i: int, j: int) -> list[RimLoop]:
    """Cut a loop by the chord between its positions i < j; the chord lies between the normals at its ends."""
    n = len(loop.vertices)
    normal = unit(_at_vertices(loop.normals)[[i, j]].sum(axis=0, keepdims=True))
    positions = np.arange(i, j + 1), np.append(np.arange(j, n), np.arange(i + 1))
    return [RimLoop(loop.vertices[at], np.concatenate([loop.normals[at[:-1]], normal])) for at in positions]


def _best_chord(loop: RimLoop, points: Vertices, is_edge: IsEdge) -> tuple[int, int] | None:
    n = len(loop.vertices)
    ends = np.unique(np.linspace(0, n, min(n, _MAX_ENDS), endpoint=False).astype(np.int64))
    rim = points[loop.vertices]
    pairs = np.stack(np.triu_indices(len(ends), 1), axis=1)
    steps = ends[pairs[:, 1]] - ends[pairs[:, 0]]
    pairs = pairs[np.minimum(steps, n - steps) >= max(2, int(_LEAST_SHARE * n))]
    some = pairs[_start_inside(loop, rim, ends, pairs)]
    some = some[_start_inside(loop, rim, ends, some[:, ::-1])]
    some = some[~is_edge(loop.vertices[ends[some]])]
    if not len(some):
        some = pairs[~is_edge(loop.vertices[ends[pairs]])]
    chords = rim[ends[some[:, 1]]] - rim[ends[some[:, 0]]]
    ratio = np.linalg.norm(chords, axis=-1) / np.maximum(_rim_between(rim, ends[some]), 1e-300)
    found = ends[some[np.argsort(ratio, kind="stable")[:_MOST_COMPARED]]]
    if not len(found):
        return None
    for start in range(0, len(found), _BATCH):
        some = found[start : start + _BATCH]
        clear = np.flatnonzero(~_runs_through_rim(loop, rim, some))
        if len(clear):
            return int(some[clear[0], 0]), int(some[clear[0], 1])
    return int(found[0, 0]), int(found[0, 1])


def _runs_through_rim(loop: RimLoop, rim: Vertices, chords: IntArray) -> BoolArray:
    """Whether each chord (k, 2), by positions, meets a rim edge, seen along the normals at its ends: (k,)."""
    start = rim[chords[:, 0]]
    chord = rim[chords[:, 1]] - start
    up = unit(_at_vertices(loop.normals)[chords].sum(axis=1))
    size = np.linalg.norm(chord, axis=1, keepdims=True)
    ahead = chord / np.maximum(size, np.finfo(np.float64).tiny)
    offset = rim[None] - start[:, None]
    # Where the rim lies (k, n): to the side of a chord, along it, above it.
    side, along, above = (np.einsum("knj,kj->kn", offset, axis) for axis in (cross(ahead, up), ahead, up))
    other_side = np.roll(side, -1, axis=1)
    passes = (side > 0) != (other_side > 0)
    share = np.where(passes, side / np.where(passes, side - other_side, 1.0), 0.0)
    along, above = (at + share * (np.roll(at, -1, axis=1) - at) for at in (along, above))
    passes &= (along > 0) & (along < size) & (np.abs(above) < _REACH * size)
    # The edges at its ends touch a chord; those of their twins do as well, where an edge is walked twice.
    ends = loop.vertices[chords]
    is_end = (loop.vertices[None] == ends[:, :1]) | (loop.vertices[None] == ends[:, 1:])
    return np.asarray((passes & ~is_end & ~np.roll(is_end, -1, axis=1)).any(axis=1))


def _rim_between(rim: Vertices, pairs: IntArray) -> FloatArray:
    """Length (k,) of the shorter stretch of rim between two positions (k, 2), in mesh units."""
    edges = np.linalg.norm(np.roll(rim, -1, axis=0) - rim, axis=1)
    along = np.concatenate([[0.0], np.cumsum(edges)])
    way = np.abs(along[pairs[:, 0]] - along[pairs[:, 1]])
    return np.asarray(np.minimum(way, along[-1] - way))


def _start_inside(loop: RimLoop, rim: Vertices, ends: IntArray, pairs: IntArray) -> BoolArray:
    """Whether the chord between two of some end points (k,), by pairs (p, 2), starts on the side of the hole: (p,)."""
    normals = _at_vertices(loop.normals)[ends]
    forward = np.roll(rim, -1, axis=0)[ends] - rim[ends]
    x = unit(forward - np.einsum("ij,ij->i", forward, normals)[:, None] * normals)
    # The hole lies on the right: angles count clockwise from the edge that leaves to the edge that arrives.
    y = -cross(normals, x)

    def angle(vectors: FloatArray, at: IntArray) -> FloatArray:
        across, ahead = (np.einsum("ij,ij->i", vectors, axis[at]) for axis in (y, x))
        return np.asarray(np.arctan2(across, ahead) % (2 * np.pi))

    back = angle(np.roll(rim, 1, axis=0)[ends] - rim[ends], np.arange(len(ends)))
    start, end = pairs.T
    turned = angle(rim[ends[end]] - rim[ends[start]], start)
    inside: BoolArray = (turned > _LEAST_ANGLE) & (turned < back[start] - _LEAST_ANGLE)
    return inside


def _at_vertices(edge_normals: FloatArray) -> FloatArray:
    """Average the unit normals of the edges of a loop into those of its vertices (n, 3)."""
    return unit(edge_normals + np.roll(edge_normals, 1, axis=0))

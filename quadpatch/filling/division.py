"""Division of long boundary loops by chords.

The table of the minimum-weight triangulation costs O(n^3), so a long loop is divided first, into loops short enough
for it. The best chord is short for the stretch of rim that it cuts off: in a crack it leads from one side to the other,
in a disk it is a diameter. It must start and end inside the hole, which lies on the right of its loop.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from quadpatch.mesh.normals import cross, unit
from quadpatch.types import BoolArray, FloatArray, IntArray, Vertices

# Which pairs (k, k) of the loop vertices (k,) are joined by an edge already.
Taken = Callable[[IntArray], BoolArray]

# End points that are compared, at most; the rest of a longer loop is left out, evenly.
_MAX_ENDS = 512
# Smallest angle between a chord and the rim at its ends, in radians; a second try goes without.
_LEAST_ANGLE = 0.05
# Smallest share of a loop's edges that a chord cuts off.
_LEAST_SHARE = 1 / 8


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


def divide(loop: RimLoop, points: Vertices, max_size: int, taken: Taken) -> list[RimLoop]:
    """Divide a loop until none of the parts has more than `max_size` vertices.

    Parameters
    ----------
    loop : RimLoop
    points : (n_vertices, 3) float64
    max_size : int
    taken : callable
        Which pairs (k, k) bool of loop vertices (k,) int64 an edge joins already.

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
        chord = _best_chord(part, points, taken)
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


def _best_chord(loop: RimLoop, points: Vertices, taken: Taken) -> tuple[int, int] | None:
    n = len(loop.vertices)
    ends = np.unique(np.linspace(0, n, min(n, _MAX_ENDS), endpoint=False).astype(np.int64))
    rim = points[loop.vertices]
    chords = rim[ends][None] - rim[ends][:, None]
    steps = np.abs(ends[:, None] - ends[None])
    allowed = np.minimum(steps, n - steps) >= max(2, int(_LEAST_SHARE * n))
    allowed &= ~taken(loop.vertices[ends])
    starts_inside = _points_inside(loop, rim, ends, chords)
    inside = starts_inside & starts_inside.T & allowed
    ratio = np.linalg.norm(chords, axis=-1) / np.maximum(_rim_between(rim, ends), 1e-300)
    ratio = np.where(inside if inside.any() else allowed, ratio, np.inf)
    best = int(ratio.argmin())
    i, j = sorted((int(ends[best // len(ends)]), int(ends[best % len(ends)])))
    return (i, j) if np.isfinite(ratio.flat[best]) else None


def _rim_between(rim: Vertices, ends: IntArray) -> FloatArray:
    """Length (k, k) of the shorter stretch of rim between two positions, in mesh units."""
    edges = np.linalg.norm(np.roll(rim, -1, axis=0) - rim, axis=1)
    along = np.concatenate([[0.0], np.cumsum(edges)])
    way = np.abs(along[ends][:, None] - along[ends][None])
    return np.asarray(np.minimum(way, along[-1] - way))


def _points_inside(loop: RimLoop, rim: Vertices, ends: IntArray, chords: FloatArray) -> BoolArray:
    """Whether the chord (k, k, 3) from each position to each other one starts on the side of the hole: (k, k)."""
    normals = _at_vertices(loop.normals)[ends]
    forward = np.roll(rim, -1, axis=0)[ends] - rim[ends]
    x = unit(forward - np.einsum("ij,ij->i", forward, normals)[:, None] * normals)
    # The hole lies on the right: angles count clockwise from the edge that leaves to the edge that arrives.
    y = -cross(normals, x)

    def angle(vectors: FloatArray) -> FloatArray:
        across, ahead = (np.einsum("ijk,ik->ij", vectors, axis) for axis in (y, x))
        return np.asarray(np.arctan2(across, ahead) % (2 * np.pi))

    back = angle((np.roll(rim, 1, axis=0)[ends] - rim[ends])[:, None])
    turned = angle(chords)
    inside: BoolArray = (turned > _LEAST_ANGLE) & (turned < back - _LEAST_ANGLE)
    return inside


def _at_vertices(edge_normals: FloatArray) -> FloatArray:
    """Average the unit normals of the edges of a loop into those of its vertices (n, 3)."""
    return unit(edge_normals + np.roll(edge_normals, 1, axis=0))

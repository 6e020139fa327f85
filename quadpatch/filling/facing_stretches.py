"""The stretches along which two rims face each other, where they do so along a part of them only."""

import numpy as np

from quadpatch.filling.facing import Facing, Rim
from quadpatch.types import BoolArray, IntArray

# Stretches of a rim that are apart by less than so many gaps are one.
_MOST_PAUSE = 2.0
# An edge at the end of a strip is at most so many times as long as the gap or an edge of the rim, and no rim edge that
# a strip is extended by points across the gap more than this (cosine).
_LONGEST_END = 1.5
_MOST_ACROSS = 0.8
# A strip is at most so many gaps longer at each end than what faces the other rim for sure.
_MOST_EXTENSION = 2.0
# A rib takes one edge at either end of a stretch of so many vertices, and a hole is left between the ribs.
_LEAST_STRETCH = 4


def facing_stretches(facing: Facing) -> tuple[IntArray, IntArray] | None:
    """Find the longest stretches of two loops that face each other.

    Returns
    -------
    pair of (n,) int64, or None
        Positions in each loop, in its own order, so that the first of one is across from the last of the other. None
        where the stretches are shorter than three edges, or than the gap is wide.
    """
    (one, other), (sight, back) = facing.rims, facing.sights
    pause = _MOST_PAUSE * facing.gap
    here = _longest_stretch(sight.faces, one, pause)
    n_one, n_other = len(one.points), len(other.points)
    is_here = np.isin(np.arange(n_one), here)
    there = _longest_stretch(back.faces & is_here[back.nearest], other, pause)
    is_there = np.isin(np.arange(n_other), there)
    here = _longest_stretch(is_here & sight.faces & is_there[sight.nearest], one, pause)
    if not len(here) or not len(there):
        return None
    end, start = _extended(facing, int(here[-1]), int(there[0]), 1)
    begin, stop = _extended(facing, int(here[0]), int(there[-1]), -1)
    n_here, n_there = (end - begin) % n_one + 1, (stop - start) % n_other + 1
    here, there = (begin + np.arange(n_here)) % n_one, (start + np.arange(n_there)) % n_other
    shorter = min(one.lengths[here].sum(), other.lengths[there].sum())
    if min(n_here, n_there) < _LEAST_STRETCH or shorter < facing.gap:
        return None
    return here, there


def _longest_stretch(wanted: BoolArray, rim: Rim, pause: float) -> IntArray:
    """Find the longest stretch of a loop whose vertices are wanted, pauses of a length aside: positions in order."""
    n = len(wanted)
    places = np.flatnonzero(wanted)
    if not len(places):
        return places
    along = np.concatenate([[0.0], np.cumsum(rim.lengths)])
    following = np.append(places[1:], places[0] + n)
    ways = along[following % n] + along[-1] * (following // n) - along[places]
    # A rim edge is no pause, however small the gap is.
    breaks = np.flatnonzero((ways > pause) & (following - places > 1))
    if not len(breaks):
        return np.arange(places[0], places[0] + n) % n
    starts, ends = following[breaks], np.append(places[breaks[1:]], places[breaks[0]] + n)
    starts = np.where(starts >= n, starts - n, starts)
    ends = starts + (ends - starts) % n
    longest = int((along[ends % n] + along[-1] * (ends // n) - along[starts]).argmax())
    return np.arange(starts[longest], ends[longest] + 1) % n


def _extended(facing: Facing, i: int, j: int, step: int) -> tuple[int, int]:
    """Move the end of a strip outwards, from positions i and j of both loops, as long as its end edge stays short.

    The first loop is walked by steps of 1 or -1, the second one, which runs the other way, against them.
    """
    one, other = facing.rims
    longest = _LONGEST_END * max(facing.gap, one.edge, other.edge)
    room = _MOST_EXTENSION * max(facing.gap, one.edge, other.edge)
    for _ in range(len(one.points) + len(other.points)):
        steps = ((one, other, i, j, step), (other, one, j, i, -step))
        ends = [_end_after(*each, longest) for each in steps]
        best = int(np.argmin(ends))
        way = steps[best][0].lengths[steps[best][2]]
        if not np.isfinite(ends[best]) or way > room:
            break
        room -= way / 2
        i, j = ((i + step) % len(one.points), j) if best == 0 else (i, (j - step) % len(other.points))
    return i, j


def _end_after(rim: Rim, other: Rim, at: int, across: int, step: int, longest: float) -> float:
    """Length of the end edge once a strip goes one rim edge further; infinite where that would be no good end."""
    following = rim.points[(at + step) % len(rim.points)]
    edge, end = following - rim.points[at], other.points[across] - rim.points[at]
    before, new = float(np.linalg.norm(end)), float(np.linalg.norm(other.points[across] - following))
    # The side that lags behind makes up for it, whatever the direction.
    runs_along = abs(float(edge @ end)) <= _MOST_ACROSS * float(np.linalg.norm(edge)) * before or new < before
    return new if runs_along and new <= longest else np.inf

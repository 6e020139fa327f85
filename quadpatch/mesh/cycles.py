"""Cycles of directed edges, all of them at once."""

from dataclasses import dataclass

import numpy as np

from quadpatch.mesh.loops import cut_at
from quadpatch.mesh.topology import components
from quadpatch.types import BoolArray, IntArray


@dataclass(frozen=True)
class PlainCycles:
    """Cycles without a choice of way: one edge arrives at each of their vertices, and one leaves.

    Attributes
    ----------
    cycles : list of (n_cycle,) int64
        Vertices of each, from its lowest one on; in the order of those.
    is_plain : (n_edges,) bool
        Edges that belong to one of them.
    """

    cycles: list[IntArray]
    is_plain: BoolArray


def plain_cycles(edges: IntArray) -> PlainCycles:
    """Find the plain cycles among directed edges (n_edges, 2)."""
    n_vertices = int(edges.max(initial=-1)) + 1
    leaving, arriving = (np.bincount(edges[:, k], minlength=n_vertices) for k in range(2))
    used = np.flatnonzero(leaving + arriving)
    number = np.zeros(n_vertices, np.int64)
    number[used] = np.arange(len(used))
    chain = components(number[edges], len(used))
    in_plain = np.ones(len(used), bool)
    in_plain[chain[(leaving[used] != 1) | (arriving[used] != 1)]] = False
    is_plain = in_plain[chain[number[edges[:, 0]]]]
    following = np.arange(len(used))
    following[number[edges[is_plain, 0]]] = number[edges[is_plain, 1]]
    places = np.flatnonzero(in_plain[chain])
    lowest = np.arange(len(used))
    # Of several values for one index the last one stays.
    lowest[chain[places[::-1]]] = places[::-1]
    first = lowest[chain[places]]
    lengths = np.bincount(first, minlength=len(used))
    starts = np.cumsum(lengths) - lengths
    at = starts[first] + (lengths[first] - _steps_to_lowest(following, lowest[chain])[places]) % lengths[first]
    laid = np.zeros(len(places), np.int64)
    laid[at] = used[places]
    return PlainCycles(cut_at(laid, np.append(starts[lengths > 0], len(places))), is_plain)


def _steps_to_lowest(following: IntArray, lowest: IntArray) -> IntArray:
    """Count the steps (n,) from each place to the lowest one of its cycle; a place that follows itself is one.

    Every round doubles the steps that are taken at once.
    """
    here = np.arange(len(following))
    ahead = np.where(here == lowest, here, following)
    steps = (ahead != here).astype(np.int64)
    while (further := steps[ahead]).any():
        steps += further
        ahead = ahead[ahead]
    return np.asarray(steps)

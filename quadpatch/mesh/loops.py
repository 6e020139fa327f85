"""Loops of vertices, end to end in one array: a scan may have a million of them, too many to handle one by one."""

from collections.abc import Iterator
from itertools import pairwise
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from quadpatch.types import IntArray

Value = TypeVar("Value", bound=np.generic)


def laid_out(loops: list[IntArray]) -> tuple[IntArray, IntArray]:
    """Lay loops end to end: where each starts (n_loops + 1,), and which place follows each on its loop (n,)."""
    starts = np.zeros(len(loops) + 1, np.int64)
    np.cumsum([len(loop) for loop in loops], out=starts[1:])
    following = np.arange(starts[-1]) + 1
    following[starts[1:] - 1] = starts[:-1]
    return starts, following


def cut_at(values: NDArray[Value], starts: IntArray) -> list[NDArray[Value]]:
    """Cut what is laid end to end (n, ...) where each loop starts (n_loops + 1,); nothing is copied."""
    return [values[start:end] for start, end in pairwise(starts.tolist())]


def by_length(starts: IntArray) -> Iterator[tuple[IntArray, IntArray]]:
    """Yield loops that are equally long together, by where each starts (n_loops + 1,) when laid end to end.

    Which they are (k,), ascending, and their places (k, n).
    """
    counts = np.diff(starts)
    order = np.argsort(counts, kind="stable")
    for members in np.split(order, np.flatnonzero(np.diff(counts[order])) + 1):
        if len(members):
            yield members, starts[members][:, np.newaxis] + np.arange(counts[members[0]])

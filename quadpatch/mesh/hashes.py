"""Whole numbers scattered over 64 bits, so that sums of some of them are as good as never equal by chance.

Tested in `tests/quadpatch/mesh/test_edge_survey.py`.
"""

import numpy as np
from numpy.typing import NDArray

from quadpatch.types import IntArray

# Of a hash: as many bits as a table has that stays in the processor's cache.
_TABLE_BITS = 20


def scattered_numbers(n: int) -> NDArray[np.uint64]:
    """Scatter the numbers below n, (n,) uint64: no two of them to the same value.

    Multiplications by odd numbers and shifts, as in SplitMix64 (G. Steele et al., "Fast Splittable Pseudorandom Number
    Generators", 2014), can be undone.
    """
    mixed = np.arange(1, n + 1, dtype=np.uint64)
    mixed *= np.uint64(0x9E3779B97F4A7C15)
    mixed ^= mixed >> np.uint64(32)
    mixed *= np.uint64(0xD6E8FEB86659FD93)
    mixed ^= mixed >> np.uint64(32)
    return mixed


def short_numbers(n: int) -> NDArray[np.uint32]:
    """Scatter the numbers below n, (n,) uint32, likewise."""
    mixed = np.arange(1, n + 1, dtype=np.uint32)
    mixed *= np.uint32(0x9E3779B9)
    mixed ^= mixed >> np.uint32(16)
    mixed *= np.uint32(0x85EBCA6B)
    mixed ^= mixed >> np.uint32(13)
    return mixed


def shared_hashes(hashes: NDArray[np.uint32]) -> IntArray:
    """Find the hashes (n,) that are there more than once: positions (k,), ascending.

    What they stand for has to be compared: some of millions agree by chance. Sorting 64 bits takes twice as long.
    """
    ranked = np.sort(hashes)
    shared = ranked[1:][ranked[1:] == ranked[:-1]]
    if not len(shared):
        return np.zeros(0, np.int64)
    shift = np.uint32(32 - _TABLE_BITS)
    is_likely = np.zeros(1 << _TABLE_BITS, bool)
    is_likely[shared >> shift] = True
    likely = np.flatnonzero(is_likely[hashes >> shift])
    return np.asarray(likely[np.isin(hashes[likely], shared)])

"""Averages over parts of a mesh."""

import numpy as np

from quadpatch.types import FloatArray, IntArray


def mean_by(group: IntArray, values: FloatArray, n_groups: int) -> FloatArray:
    """Average values over groups, such as those of all new vertices over their holes.

    Parameters
    ----------
    group : (n,) int64
        Group of every value, from 0 to ``n_groups - 1``.
    values : (n,) float64
        In any unit.
    n_groups : int

    Returns
    -------
    (n_groups,) float64
        In the unit of the values; 0 for a group without any.
    """
    total = np.bincount(group, values, minlength=n_groups)
    mean: FloatArray = total / np.maximum(np.bincount(group, minlength=n_groups), 1)
    return mean

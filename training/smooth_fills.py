"""Smooth fills of a hole in a patch: what a patch looks like to someone who has learned nothing."""

import numpy as np

from quadpatch.types import BoolArray, FloatArray


def smooth_fill(values: FloatArray, known: BoolArray, order: int) -> FloatArray:
    """Fill the unknown bins of all patches with the smoothest continuation of the known ones.

    Minimises the sum of squared differences of the given order over the whole patch while the known bins stay as
    they are: a linear system in the unknown bins, the same for every patch.

    Parameters
    ----------
    values : (n_patches, N, N) float64
        Unknown bins are never read.
    known : (N, N) bool
        One mask for all patches; at least three bins that are not in a line are known.
    order : int
        1: membrane (discrete Laplace equation); 2: thin plate (discrete biharmonic equation).

    Returns
    -------
    (n_patches, N, N) float64
    """
    resolution = len(known)
    energy = _energy(resolution, order)
    inside, outside = np.flatnonzero(~known.ravel()), np.flatnonzero(known.ravel())
    filled = values.reshape(len(values), -1).copy()
    pull = filled[:, outside] @ energy[np.ix_(outside, inside)]
    filled[:, inside] = -np.linalg.solve(energy[np.ix_(inside, inside)], pull.T).T
    return filled.reshape(values.shape)


def disk(resolution: int, diameter_share: float) -> BoolArray:
    """Mask (N, N) of a patch whose middle is unknown: a disk as wide as that share of the patch's side."""
    ticks = np.arange(resolution) - 0.5 * (resolution - 1)
    return np.asarray(np.hypot(ticks[:, None], ticks[None, :]) > 0.5 * diameter_share * resolution)


def _energy(resolution: int, order: int) -> FloatArray:
    """Quadratic form (n_bins, n_bins) of the squared differences."""
    one = np.eye(resolution)
    first = np.diff(one, axis=0)
    if order == 1:
        rows = [np.kron(one, first), np.kron(first, one)]
    else:
        second = np.diff(one, n=2, axis=0)
        rows = [np.kron(one, second), np.kron(second, one), np.sqrt(2.0) * np.kron(first, first)]
    return np.asarray(sum(r.T @ r for r in rows))

r"""Gaussian codes: every atom takes part, as far as the known bins ask for it.

Signals are taken as :math:`y = D\,\mathrm{diag}(s)\,z + \sigma\epsilon` with :math:`z` and :math:`\epsilon` standard
normal: atom k is used with standard deviation :math:`s_k`. Seen through the mask :math:`M` of its known bins, the most
likely code of a signal solves

.. math:: (S D^T M D S + \sigma^2 I)\, z = S D^T M y.

That is ridge regression on the known bins, each atom as free as it is common. Textures are rarely sparse in atoms that
were learned in seconds, and a sparse code puts all its weight on the atoms that fit the rim best; this one hedges. The
atoms are the principal directions of the signals.

References
----------
M. Tipping, C. Bishop, "Probabilistic principal component analysis", Journal of the Royal Statistical Society B 61,
1999.
"""

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from quadpatch.sparse.parallel import map_batches, single_threaded_blas
from quadpatch.types import BoolArray, FloatArray, IntArray

# Variance of what the atoms don't explain, in signals of variance 1. Found on reliefs; between 0.01 and 0.05 it hardly
# matters.
NOISE = 0.03
# Principal directions with less variance than this part of the largest are rounding.
_LEAST_VARIANCE = 1e-6
_BATCH = 64


def gaussian_codes(signals: FloatArray, known: BoolArray, scaled_atoms: FloatArray) -> FloatArray:
    """Code signals of which only some bins are known.

    Parameters
    ----------
    signals : (n, n_bins) float64
        Values in unknown bins are never read.
    known : (n, n_bins) bool
        True = measured bin.
    scaled_atoms : (n_bins, n_atoms) float64
        Atoms times their standard deviations, ``atoms * deviations``.

    Returns
    -------
    (n, n_atoms) float64
        ``codes @ scaled_atoms.T`` is the completed signal; zero for a signal without known bins.
    """
    with single_threaded_blas():
        whole = scaled_atoms.T @ scaled_atoms
    whole[np.diag_indices_from(whole)] += NOISE
    visible = np.where(known, signals, 0.0)
    codes = np.zeros((len(signals), scaled_atoms.shape[1]))

    def code_batch(members: IntArray) -> None:
        for i in members.tolist():
            # Holes are smaller than patches: take the unknown bins off the whole rather than add up the known ones.
            hidden = scaled_atoms[~known[i]]
            factor = cho_factor(whole - hidden.T @ hidden, lower=True, overwrite_a=True, check_finite=False)
            codes[i] = cho_solve(factor, visible[i] @ scaled_atoms, check_finite=False)

    everyone = np.arange(len(signals))
    map_batches(code_batch, [everyone[start : start + _BATCH] for start in range(0, len(everyone), _BATCH)])
    return codes


def known_covariance(signals: FloatArray, known: BoolArray) -> FloatArray:
    """Take the covariance (N * N, N * N) of signals with missing bins.

    That of two bins is taken over the signals which know both. All is averaged over the eight turns and mirror images
    of a patch, since the frame of a patch may point along any side of its quad: eight times as many signals.

    Parameters
    ----------
    signals : (n, N * N) float64
        0 in unknown bins.
    known : (n, N * N) bool
    """
    counted = known.astype(np.float64)
    with single_threaded_blas():
        return _turned(signals.T @ signals / np.maximum(counted.T @ counted, 1.0))


def principal_atoms(covariance: FloatArray, n_atoms: int) -> tuple[FloatArray, FloatArray]:
    """Find the principal directions of signals by their covariance (n_bins, n_bins).

    Returns
    -------
    atoms : (n_bins, at most n_atoms) float64
        Unit-norm columns, most common first.
    deviations : (n_atoms,) float64
        How much each is used, as a standard deviation over the signals.
    """
    with single_threaded_blas():
        variances, directions = np.linalg.eigh(covariance)
    variances, directions = variances[::-1][:n_atoms], directions[:, ::-1][:, :n_atoms]
    kept = variances > _LEAST_VARIANCE * variances[0]
    return np.ascontiguousarray(directions[:, kept]), np.sqrt(variances[kept])


def _turned(covariance: FloatArray) -> FloatArray:
    """Average a covariance (N * N, N * N) over the eight turns and mirror images of the patch."""
    n = round(np.sqrt(len(covariance)))
    bins = np.arange(n * n).reshape(n, n)
    turns = [np.rot90(image, k).ravel() for image in (bins, bins.T) for k in range(4)]
    mean: FloatArray = sum((covariance[np.ix_(turn, turn)] for turn in turns), np.zeros_like(covariance)) / len(turns)
    return mean

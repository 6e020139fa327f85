"""Sparse, quantised codes of patches that share grid vertices.

The height of a grid vertex is the mean over the patches that it belongs to, as the paper puts a surface together from
overlapping patches; neighbouring patches share the vertices along their edge, so the surface has no cracks. Codes c
minimise the squared error of these means over the grid vertices with a known height, with as few non-zeros as a
quantisation step leaves: iterative hard thresholding, whose threshold and rounding are those of the file, so that what
one round could not say goes into the next. With an overcomplete dictionary it starts from orthogonal matching pursuit.

References
----------
T. Blumensath, M. E. Davies, "Iterative hard thresholding for compressed sensing", Applied and Computational Harmonic
Analysis 27, 2009. K. Sarkar, K. Varanasi, D. Stricker, "Learning Quadrangulated Patches For 3D Shape Processing", 2019.
"""

import numpy as np

from quadpatch.compression.heights import Grid
from quadpatch.sparse.omp import masked_omp
from quadpatch.types import BoolArray, FloatArray, IntArray

_ROUNDS = 4
# A coefficient is rounded up from this part of a step on; below one half, since a zero takes the fewest bits.
_ROUND_UP = 0.40
# Where the products of different atoms are smaller than this the dictionary counts as orthonormal.
_ORTHONORMAL = 0.35
# Atoms that one patch may use when the codes start from matching pursuit.
_MOST_NONZERO = 32
# It ends at this residual (root mean square), in quantisation steps, and leaves out patches that know less than this.
_PURSUED_TO = 0.1
_LEAST_KNOWN = 0.8


def sparse_codes(grid: Grid, heights: FloatArray, known: BoolArray, atoms: FloatArray, step: float) -> IntArray:
    """Code the heights of a grid.

    Parameters
    ----------
    grid : Grid
    heights : (n,) float64
        Of every grid vertex; read where `known`.
    known : (n,) bool
    atoms : (n_bins, n_atoms) float64
        Over the (m + 1)**2 grid vertices of a patch.
    step : float
        Quantisation step of the coefficients, in mesh units.

    Returns
    -------
    (n_patches, n_atoms) int64
        Coefficients in steps.
    """
    spectral = float(np.linalg.norm(atoms, 2)) ** 2
    gain = 1.0 / max(spectral, 1.0)
    quantised = np.zeros((len(grid.patches), atoms.shape[1]), np.int64)
    if _is_overcomplete(atoms):
        quantised = _pursued(grid, heights, known, atoms, step)
    for _ in range(_ROUNDS):
        missing = np.where(known, heights - decoded_heights(grid, quantised, atoms, step), 0.0)
        wanted = quantised + gain * (missing[grid.patches].reshape(len(quantised), -1) @ atoms) / step
        quantised = _rounded(wanted)
    return quantised


def decoded_heights(grid: Grid, codes: IntArray, atoms: FloatArray, step: float) -> FloatArray:
    """Mean height (n,) of every grid vertex over the patches that it belongs to, in mesh units."""
    patches = (codes * step) @ atoms.T
    total = np.bincount(grid.patches.ravel(), patches.ravel(), len(grid.points))
    return np.asarray(total / np.maximum(grid.n_shared, 1.0))


def _rounded(wanted: FloatArray) -> IntArray:
    return (np.sign(wanted) * np.floor(np.abs(wanted) + _ROUND_UP)).astype(np.int64)


def _is_overcomplete(atoms: FloatArray) -> bool:
    gram = atoms.T @ atoms
    return atoms.shape[1] > atoms.shape[0] or float(np.abs(gram - np.diag(np.diag(gram))).max()) > _ORTHONORMAL


def _pursued(grid: Grid, heights: FloatArray, known: BoolArray, atoms: FloatArray, step: float) -> IntArray:
    """Codes by orthogonal matching pursuit to half a step, each patch for itself."""
    n_patches = len(grid.patches)
    norms = np.maximum(np.linalg.norm(atoms, axis=0), 1e-12)
    signals = heights[grid.patches].reshape(n_patches, -1)
    seen = known[grid.patches].reshape(n_patches, -1)
    codes = masked_omp(signals, seen, atoms / norms, min(_MOST_NONZERO, *atoms.shape), _PURSUED_TO * step)
    codes[seen.mean(axis=1) < _LEAST_KNOWN] = 0.0
    return _rounded(codes / norms / step)

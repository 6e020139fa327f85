"""Dictionaries over the grid vertices of a patch: learned from the mesh itself, or taken from a model.

The first atom is always the constant height. A dictionary of the mesh's own are the principal directions of its
patches, most important first, as many as the quantisation step asks for. It stands in the file, each atom by its cosine
transform, quantised as coarsely as its importance allows: codes are made with the atoms as they are read back.

A model's atoms are over bins of its own resolution. They are read at the grid vertices bilinearly and brought to unit
norm.

References
----------
I. T. Jolliffe, "Principal Component Analysis", 2002; N. Ahmed, T. Natarajan, K. R. Rao, "Discrete cosine transform",
IEEE Transactions on Computers C-23, 1974.
"""

from dataclasses import dataclass

import numpy as np

from quadpatch.sparse.dictionary import Dictionary
from quadpatch.types import FloatArray, IntArray

MAX_ATOMS = 256
# A principal direction is kept whose standard deviation is at least this part of the quantisation step.
_LEAST_DEVIATION = 0.25
# Error of an atom, times what it is used for, in quantisation steps.
_ATOM_STEP = 0.7
# An atom of which less than this part is its own counts as dependent.
_DEPENDENT = 1e-6
# Steps of atoms are 2**-2 to 2**-10.
_EXPONENTS = (2, 10)


@dataclass(frozen=True)
class EmbeddedAtoms:
    """A dictionary as it stands in a file.

    Attributes
    ----------
    exponents : (n_atoms,) int64
        Atom k is quantised in steps of 2**-exponent.
    coefficients : (n_bins, n_atoms) int64
        Cosine coefficients in these steps, from low to high frequencies.
    """

    exponents: IntArray
    coefficients: IntArray

    def atoms(self) -> FloatArray:
        """Return the atoms (n_bins, n_atoms): orthonormal, the constant one in front.

        Rounding leaves them oblique, so each is freed of those before it; what nothing is left of becomes 0.
        """
        values = self.coefficients * 0.5**self.exponents
        return _orthonormal(with_constant(cosine_atoms(resolution_of(len(values))) @ values))


def _orthonormal(columns: FloatArray) -> FloatArray:
    """Gram-Schmidt, each column twice: unlike a library's factorisation it has one result on every machine."""
    result = np.zeros_like(columns)
    # One turn for each atom, of which there are at most 257.
    for k in range(columns.shape[1]):
        rest = columns[:, k]
        for _ in range(2):
            rest = rest - result[:, :k] @ (result[:, :k].T @ rest)
        norm = float(np.linalg.norm(rest))
        result[:, k] = rest / norm if norm > _DEPENDENT * float(np.linalg.norm(columns[:, k])) else 0.0
    return result


def learned_atoms(signals: FloatArray, step: float) -> EmbeddedAtoms:
    """Learn the principal directions of patches.

    Parameters
    ----------
    signals : (n_patches, n_bins) float64
        Heights, 0 where unknown.
    step : float
        Quantisation step of the codes, in the unit of the heights.
    """
    detail = signals - signals.mean(axis=1, keepdims=True)
    values, directions = np.linalg.eigh(detail.T @ detail / max(len(detail), 1))
    deviations = np.sqrt(np.maximum(values[::-1], 0.0))
    count = min(int((deviations > _LEAST_DEVIATION * step).sum()), MAX_ATOMS, len(signals), signals.shape[1] - 1)
    directions, deviations = directions[:, ::-1][:, :count], deviations[:count]
    wanted = np.ceil(np.log2(np.maximum(deviations / (_ATOM_STEP * step), 1.0)))
    exponents = np.clip(wanted, *_EXPONENTS).astype(np.int64)
    spectrum = cosine_atoms(resolution_of(signals.shape[1])).T @ directions
    # The sign of a direction is arbitrary; fixed, it is the same on every machine.
    largest = spectrum[np.abs(spectrum).argmax(axis=0), np.arange(count)] if count else np.zeros(0)
    rounded = np.rint(spectrum * np.where(largest < 0, -1.0, 1.0) * 2.0**exponents).astype(np.int64)
    return EmbeddedAtoms(exponents, rounded)


def model_atoms(dictionary: Dictionary, resolution: int) -> FloatArray:
    """Read a model's atoms at (resolution)**2 grid vertices that span a patch, behind the constant one."""
    n = dictionary.resolution
    if n == resolution:
        sampled = dictionary.atoms
    else:
        # Bin j is centred at (j + 0.5) / n of the side; grid vertices reach from 0 to 1.
        place = np.clip(np.arange(resolution) / (resolution - 1) * n - 0.5, 0.0, n - 1.0)
        low = np.minimum(place.astype(np.int64), max(n - 2, 0))
        weights = np.zeros((resolution, n))
        rows = np.arange(resolution)
        weights[rows, low] = 1.0 - (place - low)
        weights[rows, np.minimum(low + 1, n - 1)] += place - low
        sampled = np.kron(weights, weights) @ dictionary.atoms
    sampled = sampled - sampled.mean(axis=0)
    norms = np.linalg.norm(sampled, axis=0)
    return with_constant(sampled[:, norms > 1e-9] / norms[norms > 1e-9])


def with_constant(atoms: FloatArray) -> FloatArray:
    """Put the constant atom in front."""
    n_bins = len(atoms)
    return np.concatenate([np.full((n_bins, 1), 1.0 / np.sqrt(n_bins)), atoms], axis=1)


def cosine_atoms(resolution: int) -> FloatArray:
    """Products of cosines (n_bins, n_bins) of unit norm, from low to high frequencies."""
    place = np.arange(resolution)
    table = np.cos(np.pi * (place[:, np.newaxis] + 0.5) * place / resolution)
    table /= np.linalg.norm(table, axis=0)
    order = np.argsort(np.add.outer(place, place).ravel(), kind="stable")
    return np.asarray(np.kron(table, table)[:, order])


def resolution_of(n_bins: int) -> int:
    """Bins along one side."""
    return round(float(np.sqrt(n_bins)))

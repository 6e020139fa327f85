"""K-SVD: learn a dictionary from patches, all of whose bins need not be known.

Two steps take turns: code every signal with the atoms as they are, then improve the atoms one by one, each together
with its coefficients, against what the other atoms leave over. The rank-one fit of the second step is one round of
alternating least squares instead of a singular value decomposition ("approximate K-SVD"); with masks it is the
weighted fit with weights 0 and 1. Neither step can raise the error: where the pursuit, which is greedy, finds a worse
code than the signal had, the old one stays.

References
----------
M. Aharon, M. Elad, A. Bruckstein, "K-SVD: an algorithm for designing overcomplete dictionaries for sparse
representation", IEEE Transactions on Signal Processing 54, 2006.
R. Rubinstein, M. Zibulevsky, M. Elad, "Efficient implementation of the K-SVD algorithm using batch orthogonal matching
pursuit", Technion, 2008.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from quadpatch.errors import StageError
from quadpatch.sparse.omp import masked_omp
from quadpatch.sparse.parallel import single_threaded_blas
from quadpatch.types import BoolArray, FloatArray, IntArray

# Atoms whose inner product comes this close to 1 say the same thing twice.
DUPLICATE = 0.995

# Called as on_iteration(iteration from 0, root mean square error over all known bins).
OnIteration = Callable[[int, float], None]


@dataclass(frozen=True)
class KsvdOptions:
    """Size of the dictionary, atoms that a signal may use, and rounds of learning."""

    n_atoms: int = 256
    n_nonzero: int = 10
    n_iterations: int = 15


def masked_ksvd(
    signals: FloatArray,
    known: BoolArray,
    options: KsvdOptions,
    rng: np.random.Generator,
    on_iteration: OnIteration | None = None,
) -> tuple[FloatArray, FloatArray]:
    """Learn a dictionary.

    Parameters
    ----------
    signals : (n, n_bins) float64
        Values in unknown bins are never read.
    known : (n, n_bins) bool
        True = measured bin.
    options : KsvdOptions
    rng : numpy.random.Generator
        Draws the signals that the atoms start from.
    on_iteration : callable, optional
        Told the error after every iteration.

    Returns
    -------
    atoms : (n_bins, n_atoms) float64
        Unit-norm columns.
    errors : (n_iterations,) float64
        Root mean square error over all known bins after each iteration. It never rises, except by what merging two
        atoms that say the same costs.

    Raises
    ------
    StageError
        If fewer signals than atoms hold anything.
    """
    values = np.where(known, signals, 0.0)
    weights = None if known.all() else known.astype(np.float64)
    errors = np.zeros(options.n_iterations)
    with single_threaded_blas():
        atoms = _first_atoms(values, options.n_atoms, rng)
        codes = np.zeros((len(values), options.n_atoms))
        for i in range(options.n_iterations):
            codes = _better_codes(values, known, atoms, codes, options.n_nonzero)
            residual = _residual(values, known, atoms, codes)
            for atom in range(options.n_atoms):
                _improve_atom(atom, atoms, codes, residual, weights)
            errors[i] = np.sqrt((residual**2).sum() / max(known.sum(), 1))
            if on_iteration is not None:
                on_iteration(i, float(errors[i]))
            if i + 1 < options.n_iterations:
                _replace_useless(atoms, codes, values, residual)
    return atoms, errors


def _first_atoms(values: FloatArray, n_atoms: int, rng: np.random.Generator) -> FloatArray:
    """Draw different signals and bring them to unit norm."""
    norms = np.linalg.norm(values, axis=1)
    usable = np.flatnonzero(norms > 0.0)
    if len(usable) < n_atoms:
        raise StageError(f"{len(usable)} patches hold any detail; learning {n_atoms} atoms needs at least as many")
    chosen = np.sort(rng.choice(usable, n_atoms, replace=False))
    return np.ascontiguousarray((values[chosen] / norms[chosen, None]).T)


def _better_codes(
    values: FloatArray, known: BoolArray, atoms: FloatArray, codes: FloatArray, n_nonzero: int
) -> FloatArray:
    """Code every signal anew and keep the new code unless the old one fits better."""
    new = masked_omp(values, known, atoms, n_nonzero)
    old_error = (_residual(values, known, atoms, codes) ** 2).sum(axis=1)
    new_error = (_residual(values, known, atoms, new) ** 2).sum(axis=1)
    return np.where((new_error <= old_error)[:, None], new, codes)


def _residual(values: FloatArray, known: BoolArray, atoms: FloatArray, codes: FloatArray) -> FloatArray:
    return np.where(known, values - codes @ atoms.T, 0.0)


def _improve_atom(
    atom: int, atoms: FloatArray, codes: FloatArray, residual: FloatArray, weights: FloatArray | None
) -> None:
    """Fit one atom, then its coefficients, to what the others leave over; changes its arguments."""
    users = np.flatnonzero(codes[:, atom])
    if len(users) == 0:
        return
    shape, values = atoms[:, atom].copy(), codes[users, atom]
    if weights is None:
        residual_without = residual[users] + np.outer(values, shape)
        shape = _unit(values @ residual_without, shape)
        values = residual_without @ shape
        residual[users] = residual_without - np.outer(values, shape)
    else:
        mask = weights[users]
        residual_without = residual[users] + mask * np.outer(values, shape)
        seen = values**2 @ mask
        # A bin that no user of the atom knows keeps what it had.
        shape = _unit(np.divide(values @ residual_without, seen, out=shape.copy(), where=seen > 0.0), shape)
        in_sight = mask @ shape**2
        values = np.divide(residual_without @ shape, in_sight, out=np.zeros_like(values), where=in_sight > 0.0)
        residual[users] = residual_without - mask * np.outer(values, shape)
    atoms[:, atom] = shape
    codes[users, atom] = values


def _unit(vector: FloatArray, fallback: FloatArray) -> FloatArray:
    norm = float(np.linalg.norm(vector))
    return vector / norm if norm > 0.0 else fallback


def _replace_useless(atoms: FloatArray, codes: FloatArray, values: FloatArray, residual: FloatArray) -> None:
    """Put the worst represented signals in place of atoms that no signal uses or that repeat another; in place."""
    useless = np.union1d(_merge_duplicates(atoms, codes), np.flatnonzero(~codes.any(axis=0)))
    error = (residual**2).sum(axis=1)
    worst = np.argsort(-error, kind="stable")[: len(useless)]
    worst = worst[error[worst] > 0.0]
    useless = useless[: len(worst)]
    atoms[:, useless] = (values[worst] / np.linalg.norm(values[worst], axis=1)[:, None]).T


def _merge_duplicates(atoms: FloatArray, codes: FloatArray) -> IntArray:
    """Move the coefficients of atoms that repeat an earlier one over to it; tells which are free now."""
    gram = atoms.T @ atoms
    first, second = np.nonzero(np.triu(np.abs(gram) > DUPLICATE, k=1))
    free: list[int] = []
    for i, j in zip(first.tolist(), second.tolist(), strict=True):
        if i in free or j in free:
            continue
        codes[:, i] += gram[i, j] * codes[:, j]
        codes[:, j] = 0.0
        free.append(j)
    return np.array(free, dtype=np.int64)

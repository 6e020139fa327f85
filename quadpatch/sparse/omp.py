r"""Masked orthogonal matching pursuit over many signals at once.

Each signal :math:`y` is seen through its own mask :math:`M` (its known bins). The pursuit adds, step by step, the
atom whose visible part, brought to unit length, agrees best with the residual, and refits all chosen atoms by least
squares over the known bins. That is matching pursuit on the matrix :math:`M D`, orthogonalised by a QR factorisation
that grows by one column a step.

With :math:`q_1 \dots q_j` the orthonormal columns so far, only their products with all atoms, :math:`P = Q^T M D`,
are kept. They hold everything that a step needs: the projections of a new atom on the earlier ones are a column of
:math:`P`, and the correlations of all atoms with the residual drop by a multiple of its newest row. What is left to
compute is :math:`D^T M d_{new}`: one matrix product over the whole batch, or a look-up in the Gram matrix where many
signals share a mask. No residual is ever formed.

References
----------
Y. Pati, R. Rezaiifar, P. Krishnaprasad, "Orthogonal matching pursuit: recursive function approximation with
applications to wavelet decomposition", Asilomar Conference on Signals, Systems and Computers, 1993.
R. Rubinstein, M. Zibulevsky, M. Elad, "Efficient implementation of the K-SVD algorithm using batch orthogonal matching
pursuit", Technion, 2008.
"""

from collections.abc import Callable, Iterator

import numpy as np

from quadpatch.sparse.parallel import map_batches
from quadpatch.types import BoolArray, FloatArray, IntArray

# An atom counts as dependent on the chosen ones when less than this part of its visible length points elsewhere.
# Squared it is 1e-8, which leaves the normal equations half the digits of float64.
DEPENDENT = 1e-4
# An atom of which a signal sees less than this (of its unit length) is out of its sight: its coefficient would be
# free to blow up in the unknown bins.
OUT_OF_SIGHT = 1e-2
# Scores closer than this (relative) are a tie, and the lowest atom wins: matrix products round the same sum
# differently from column to column.
TIE = 1e-10
# A best score this small against its signal is rounding.
ROUNDING = 1e-13
# Signals per batch, so that P stays in the processor's cache.
BATCH = 128

# Called with signals of the batch and one atom for each: products of the atom's visible part with all atoms.
GramRows = Callable[[IntArray, IntArray], FloatArray]


def masked_omp(
    signals: FloatArray, known: BoolArray, atoms: FloatArray, n_nonzero: int, tolerance: float = 0.0
) -> FloatArray:
    """Code signals of which only some bins are known.

    Parameters
    ----------
    signals : (n, n_bins) float64
        Values in unknown bins are never read.
    known : (n, n_bins) bool
        True = measured bin.
    atoms : (n_bins, n_atoms) float64
        Unit-norm columns.
    n_nonzero : int
        At most so many atoms a signal; fewer where it has fewer known bins.
    tolerance : float
        A signal is done when the root mean square of its residual over its known bins is at most this; in the unit
        of the signals.

    Returns
    -------
    (n, n_atoms) float64
        Codes; ``codes @ atoms.T`` is the completed signal. All zero for a signal without known bins.
    """
    codes = np.zeros((len(signals), atoms.shape[1]))
    squares = atoms**2

    def code_batch(batch: tuple[IntArray, FloatArray | None]) -> None:
        members, gram = batch
        mask = known[members]
        visible = np.where(mask, signals[members], 0.0)
        norms = np.sqrt(mask.astype(np.float64) @ squares)
        n_known = mask.sum(axis=1)
        pursuit = _Pursuit(visible, norms, visible @ atoms, min(n_nonzero, atoms.shape[1]))
        rows = _masked_rows(mask, atoms) if gram is None else _shared_rows(gram)
        codes[members] = pursuit.run(rows, n_known, tolerance**2 * n_known)

    map_batches(code_batch, _batches(known, atoms, n_nonzero))
    return codes


def _batches(known: BoolArray, atoms: FloatArray, n_nonzero: int) -> Iterator[tuple[IntArray, FloatArray | None]]:
    """Cut the signals into batches; with the Gram matrix of the visible atoms where sharing one mask pays for it."""
    if known.size == 0:
        return
    packed = np.ascontiguousarray(np.packbits(known, axis=1))
    _, first, group, counts = np.unique(
        packed.view(f"V{packed.shape[1]}").ravel(), return_index=True, return_inverse=True, return_counts=True
    )
    shares = counts * n_nonzero > atoms.shape[1]
    for g in np.flatnonzero(shares):
        visible_atoms = atoms[known[first[g]]]
        gram = visible_atoms.T @ visible_atoms
        for members in _chunks(np.flatnonzero(group == g)):
            yield members, gram
    for members in _chunks(np.flatnonzero(~shares[group])):
        yield members, None


def _chunks(indices: IntArray) -> Iterator[IntArray]:
    for start in range(0, len(indices), BATCH):
        yield indices[start : start + BATCH]


def _masked_rows(mask: BoolArray, atoms: FloatArray) -> GramRows:
    by_atom = np.ascontiguousarray(atoms.T)
    weights = mask.astype(np.float64)
    return lambda members, chosen: (weights[members] * by_atom[chosen]) @ atoms


def _shared_rows(gram: FloatArray) -> GramRows:
    return lambda members, chosen: gram[chosen]


class _Pursuit:
    """One batch of signals on its way. A signal that is done takes part with zeros.

    Attributes
    ----------
    correlations : (n, n_atoms) float64
        Products of all atoms with the residuals.
    energy : (n,) float64
        Squared norm of the residuals.
    weights : (n, n_atoms) float64
        One over the visible norm of every atom; 0 where it is out of sight or already chosen.
    products : (n, n_steps, n_atoms) float64
        P: products of all atoms with the orthonormal columns so far.
    factor, loads : (n, n_steps, n_steps), (n, n_steps) float64
        R of the QR factorisation of the chosen visible atoms, and the signals' products with Q.
    support, used : (n, n_steps) int64, bool
        Atom of every step, and whether the signal took it.
    """

    def __init__(self, visible: FloatArray, norms: FloatArray, correlations: FloatArray, n_steps: int) -> None:
        n, n_atoms = correlations.shape
        self.norms = norms
        self.correlations = correlations
        self.energy = np.einsum("ij,ij->i", visible, visible)
        self.least_score = ROUNDING * np.sqrt(self.energy)
        self.weights = np.divide(1.0, norms, out=np.zeros_like(norms), where=norms > OUT_OF_SIGHT)
        self.products = np.zeros((n, n_steps, n_atoms))
        self.factor = np.zeros((n, n_steps, n_steps))
        self.loads = np.zeros((n, n_steps))
        self.support = np.zeros((n, n_steps), dtype=np.int64)
        self.used = np.zeros((n, n_steps), dtype=np.bool_)

    def run(self, rows: GramRows, n_known: IntArray, energy_limits: FloatArray) -> FloatArray:
        """Choose atoms until every signal is done, and solve for the codes (n, n_atoms)."""
        active = self.energy > energy_limits
        for step in range(self.loads.shape[1]):
            chosen, is_clear = self._best_atoms()
            active = self._take(step, chosen, active & is_clear & (step < n_known))
            if not active.any():
                break
            self._advance(step, rows, active)
            active = active & (self.energy > energy_limits)
        return self._codes()

    def _best_atoms(self) -> tuple[IntArray, BoolArray]:
        """Atom that agrees best with each residual, and whether it does so beyond rounding."""
        scores = np.abs(self.correlations)
        scores *= self.weights
        best = scores.max(axis=1)
        chosen = (scores >= (best * (1.0 - TIE))[:, None]).argmax(axis=1)
        return chosen, best > self.least_score

    def _take(self, step: int, chosen: IntArray, active: BoolArray) -> BoolArray:
        """Add a column to Q and R; tells which signals could (their atom was independent of the earlier ones)."""
        each = np.arange(len(chosen))
        earlier = self.products[each, :step, chosen]
        squared_norm = self.norms[each, chosen] ** 2
        rest = squared_norm - np.einsum("ij,ij->i", earlier, earlier)
        active = active & (rest > DEPENDENT**2 * squared_norm)
        length = np.sqrt(np.where(active, rest, 1.0))
        self.support[:, step] = chosen
        self.used[:, step] = active
        self.factor[:, :step, step] = earlier
        self.factor[:, step, step] = length
        self.loads[:, step] = np.where(active, self.correlations[each, chosen] / length, 0.0)
        self.weights[each, chosen] = 0.0
        self.energy -= self.loads[:, step] ** 2
        return active

    def _advance(self, step: int, rows: GramRows, active: BoolArray) -> None:
        """Products of all atoms with the new column of Q, and with the residual after it."""
        if step + 1 == self.loads.shape[1]:
            return
        members = np.flatnonzero(active)
        new = np.zeros_like(self.correlations)
        new[members] = rows(members, self.support[members, step])
        new -= np.matmul(self.factor[:, None, :step, step], self.products[:, :step])[:, 0]
        new *= (active / self.factor[:, step, step])[:, None]
        self.products[:, step] = new
        self.correlations -= self.loads[:, step, None] * new

    def _codes(self) -> FloatArray:
        """Solve R x = loads backwards for all signals and put x on the chosen atoms."""
        values = np.where(self.used, self.loads, 0.0)
        for step in range(values.shape[1] - 1, -1, -1):
            diagonal = np.where(self.used[:, step], self.factor[:, step, step], 1.0)
            values[:, step] /= diagonal
            values[:, :step] -= self.factor[:, :step, step] * values[:, step, None]
        codes = np.zeros_like(self.correlations)
        each, steps = np.nonzero(self.used)
        codes[each, self.support[each, steps]] = values[each, steps]
        return codes

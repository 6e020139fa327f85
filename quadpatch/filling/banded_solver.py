"""Many small symmetric systems at once: those of all holes of a scan.

No unknown of one hole depends on those of another. Numbered by reverse Cuthill-McKee, the equations of each hole are a
narrow band, whose Cholesky factors LAPACK computes several times faster than a general sparse solver does. The
numbering depends on the triangles alone, so all energies and shapes of the same triangles share it.

References
----------
E. Cuthill, J. McKee, "Reducing the bandwidth of sparse symmetric matrices", ACM National Conference, 1969.
A. George, J. Liu, "Computer Solution of Large Sparse Positive Definite Systems", 1981.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from scipy import sparse
from scipy.linalg import LinAlgError, solveh_banded
from scipy.sparse.csgraph import connected_components, reverse_cuthill_mckee
from scipy.sparse.linalg import splu
from threadpoolctl import ThreadpoolController

from quadpatch.types import FloatArray, IntArray

# A band with more numbers than this, 240 MB, takes longer than a general solver that keeps to the non-zeros.
_LARGEST_BAND = 30_000_000
# Blocks share a band of up to so many numbers, 2 MB: small ones are solved together, and no band leaves the cache.
_GROUP = 250_000


@dataclass(frozen=True)
class EliminationOrder:
    """The order in which unknowns are eliminated.

    Attributes
    ----------
    position : (n,) int64
        Of each unknown; the unknowns of a block follow each other.
    starts : (n_groups + 1,) int64
        Where the groups of blocks that are solved together begin.
    """

    position: IntArray
    starts: IntArray

    @classmethod
    def of(cls, pattern: "sparse.csr_array[Any]") -> "EliminationOrder":
        """Choose the order for symmetric matrices (n, n) with no other entries than this one."""
        n = pattern.shape[0]
        if not n:
            return cls(np.zeros(0, np.int64), np.zeros(1, np.int64))
        order = np.asarray(reverse_cuthill_mckee(sparse.csr_array(pattern), symmetric_mode=True), np.int64)
        position = np.empty(n, np.int64)
        position[order] = np.arange(n)
        n_blocks, block = connected_components(pattern, directed=False)
        entries = pattern.tocoo()
        width = np.zeros(n_blocks, np.int64)
        np.maximum.at(width, block[entries.row], np.abs(position[entries.row] - position[entries.col]))
        # Blocks up to twice as wide share a band.
        kind = np.ceil(np.log2(width + 1)).astype(np.int64)
        order = order[np.lexsort((block[order], kind[block[order]]))]
        position[order] = np.arange(n)
        return cls(position, _groups(kind, np.bincount(block, minlength=n_blocks)))

    def upper_part(self, matrix: "sparse.csr_array[np.float64]") -> "UpperPart":
        """Take the upper half of a symmetric matrix (n, n) whose unknowns are in this order."""
        # A row of it is a column as well.
        column = np.repeat(np.arange(matrix.shape[0]), np.diff(matrix.indptr))
        offset = column - matrix.indices
        is_upper = offset >= 0
        column, offset = column[is_upper], offset[is_upper]
        return UpperPart(matrix, column, offset, matrix.data[is_upper], np.searchsorted(column, self.starts))

    def solve(self, terms: "Sequence[tuple[float, UpperPart]]", right: FloatArray) -> FloatArray:
        """Solve the positive definite system of a weighted sum of matrices for right sides (n, k), in this order.

        Raises
        ------
        RuntimeError
            If the matrix is singular.
        """
        solution = np.full(right.shape, np.nan)
        # Threads of the BLAS wait for each other at every block of a narrow band: five times slower on a busy machine.
        with _blas().limit(limits=1, user_api="blas"):
            for i, (start, end) in enumerate(zip(self.starts[:-1].tolist(), self.starts[1:].tolist(), strict=True)):
                band = _band(terms, i, start, end)
                if band is None:
                    break
                try:
                    solution[start:end] = solveh_banded(band, right[start:end], overwrite_ab=True, check_finite=False)
                except LinAlgError:
                    break
        if np.isfinite(solution).all():
            return solution
        # Rounding may leave a matrix that is not definite, and a band may be too wide.
        whole = sparse.csr_array((len(right), len(right)))
        for weight, term in terms:
            whole = whole + weight * term.matrix
        factors = splu(
            sparse.csc_array(whole),
            permc_spec="MMD_AT_PLUS_A",
            options={"SymmetricMode": True},
            diag_pivot_thresh=0.0,
        )
        return np.asarray(factors.solve(right))


@dataclass(frozen=True)
class UpperPart:
    """The entries of a symmetric matrix on its diagonal and above, by columns.

    Attributes
    ----------
    matrix : (n, n) sparse array
        With all entries.
    column, offset : (n_entries,) int64
        Column, and how far above the diagonal.
    values : (n_entries,) float64
    starts : (n_groups + 1,) int64
        Where the entries of the groups begin.
    """

    matrix: "sparse.csr_array[np.float64]"
    column: IntArray
    offset: IntArray
    values: FloatArray
    starts: IntArray


def _groups(kind: IntArray, size: IntArray) -> IntArray:
    """Choose where groups begin (n_groups + 1,), for blocks of some kinds (k,) and sizes (k,), by kind and number."""
    by_kind = np.lexsort((np.arange(len(kind)), kind))
    starts, in_group, last = [0], 0, -1
    at = 0
    for block_kind, block_size in zip(kind[by_kind].tolist(), size[by_kind].tolist(), strict=True):
        numbers = block_size << block_kind
        if last >= 0 and (block_kind != last or in_group + numbers > _GROUP):
            starts.append(at)
            in_group = 0
        at, in_group, last = at + block_size, in_group + numbers, block_kind
    return np.array([*starts, at], np.int64)


def _band(terms: "Sequence[tuple[float, UpperPart]]", group: int, start: int, end: int) -> FloatArray | None:
    """Add up the upper bands (width + 1, end - start) of one group, as LAPACK wants them; None if that is too large."""
    rows = [slice(term.starts[group], term.starts[group + 1]) for _, term in terms]
    width = max(int(term.offset[of_group].max(initial=0)) for (_, term), of_group in zip(terms, rows, strict=True))
    if (width + 1) * (end - start) > _LARGEST_BAND:
        return None
    band = np.zeros((end - start) * (width + 1))
    for (weight, term), of_group in zip(terms, rows, strict=True):
        # By columns, the diagonal last.
        at = (term.column[of_group] - start + 1) * (width + 1) - 1 - term.offset[of_group]
        band[at] += weight * term.values[of_group]
    return band.reshape(end - start, width + 1).T


@cache
def _blas() -> ThreadpoolController:
    return ThreadpoolController()

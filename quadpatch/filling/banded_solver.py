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

import numpy as np
from scipy import sparse
from scipy.linalg import LinAlgError, solveh_banded
from scipy.sparse.csgraph import connected_components, reverse_cuthill_mckee
from scipy.sparse.linalg import splu
from threadpoolctl import ThreadpoolController

from quadpatch.types import FloatArray, IntArray

# A band with more numbers than this, 240 MB, takes longer than a general solver that keeps to the non-zeros.
_LARGEST_BAND = 30_000_000


@dataclass(frozen=True)
class EliminationOrder:
    """The order in which unknowns are eliminated.

    Attributes
    ----------
    position : (n,) int64
        Of each unknown; the unknowns of a block follow each other, and blocks of like bandwidth.
    starts : (n_groups + 1,) int64
        Where the groups of blocks that are solved together begin.
    """

    position: IntArray
    starts: IntArray

    @classmethod
    def of(cls, pattern: "sparse.csr_array[np.float64]") -> "EliminationOrder":
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
        group = np.ceil(np.log2(width + 1)).astype(np.int64)[block]
        order = order[np.argsort(group[order], kind="stable")]
        position[order] = np.arange(n)
        starts = np.flatnonzero(np.diff(group[order], prepend=-1))
        return cls(position, np.append(starts, n))

    def banded(self, matrix: "sparse.csr_array[np.float64] | sparse.csc_array[np.float64]") -> "BandedMatrix":
        """Bring a symmetric matrix (n, n) into this order."""
        entries = matrix.tocoo()
        row, column = self.position[entries.row], self.position[entries.col]
        is_upper = column >= row
        row, column, values = row[is_upper], column[is_upper], entries.data[is_upper]
        group = np.searchsorted(self.starts, row, side="right") - 1
        bands: list[FloatArray | None] = []
        for i, (start, end) in enumerate(zip(self.starts[:-1].tolist(), self.starts[1:].tolist(), strict=True)):
            mine = group == i
            offset = column[mine] - row[mine]
            width = int(offset.max(initial=0))
            if (width + 1) * (end - start) > _LARGEST_BAND:
                bands.append(None)
                continue
            # As LAPACK wants it: by columns, the diagonal last.
            band = np.zeros((end - start, width + 1))
            band[column[mine] - start, width - offset] = values[mine]
            bands.append(band)
        return BandedMatrix(matrix, bands)

    def solve(self, terms: "Sequence[tuple[float, BandedMatrix]]", right: FloatArray) -> FloatArray:
        """Solve the positive definite system of a weighted sum of matrices for right sides (n, k).

        Raises
        ------
        RuntimeError
            If the matrix is singular.
        """
        solution = np.full(right.shape, np.nan)
        unknown = np.empty(len(self.position), np.int64)
        unknown[self.position] = np.arange(len(unknown))
        for i, (start, end) in enumerate(zip(self.starts[:-1].tolist(), self.starts[1:].tolist(), strict=True)):
            band, rows = _sum([(weight, term.bands[i]) for weight, term in terms]), unknown[start:end]
            if band is None:
                break
            solution[rows] = _solved(band.T, right[rows])
        if np.isfinite(solution).all():
            return solution
        # Rounding may leave a matrix that is not definite, and a band may be too wide.
        whole = sparse.csc_array((len(right), len(right)))
        for weight, term in terms:
            whole = whole + weight * sparse.csc_array(term.matrix)
        factors = splu(
            whole,
            permc_spec="MMD_AT_PLUS_A",
            options={"SymmetricMode": True},
            diag_pivot_thresh=0.0,
        )
        return np.asarray(factors.solve(right))


@dataclass(frozen=True)
class BandedMatrix:
    """A symmetric matrix in an order of elimination.

    Attributes
    ----------
    matrix : (n, n) sparse array
        As it was.
    bands : list of (n_group, width + 1) float64 or None
        Upper band of each group of blocks, by columns, the diagonal last; None where it would be too large.
    """

    matrix: "sparse.csr_array[np.float64] | sparse.csc_array[np.float64]"
    bands: list[FloatArray | None]


@cache
def _blas() -> ThreadpoolController:
    return ThreadpoolController()


def _sum(terms: list[tuple[float, FloatArray | None]]) -> FloatArray | None:
    """Add bands of several widths; None if one of them is missing."""
    bands = [(weight, band) for weight, band in terms if band is not None]
    if len(bands) < len(terms):
        return None
    n = len(bands[0][1])
    width = max(band.shape[1] for _, band in bands)
    total = np.zeros((n, width))
    for weight, band in bands:
        total[:, width - band.shape[1] :] += weight * band
    return total


def _solved(band: FloatArray, right: FloatArray) -> FloatArray:
    try:
        # Threads of the BLAS wait for each other at every block of a narrow band: five times slower on a busy machine.
        with _blas().limit(limits=1, user_api="blas"):
            solution = solveh_banded(band, right, overwrite_ab=True, check_finite=False)
    except LinAlgError:
        return np.full(right.shape, np.nan)
    return np.asarray(solution)

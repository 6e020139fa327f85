import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import sparse
from scipy.linalg import solveh_banded
from threadpoolctl import threadpool_info, threadpool_limits

from quadpatch.filling import banded_solver
from quadpatch.filling.banded_solver import EliminationOrder
from quadpatch.types import FloatArray


def blocks(sizes: list[int], seed: int) -> "sparse.csr_array[np.float64]":
    """Symmetric positive definite blocks, their unknowns shuffled."""
    rng = np.random.default_rng(seed)
    parts = []
    for size in sizes:
        factor = sparse.random_array((size, size), density=min(1.0, 4 / size), rng=rng)
        parts.append(factor @ factor.T + sparse.eye_array(size))
    names = rng.permutation(sum(sizes))
    return sparse.csr_array(sparse.csr_array(sparse.block_diag(parts))[names][:, names])


def solved(
    matrix: "sparse.csr_array[np.float64]", right: FloatArray, order: EliminationOrder | None = None
) -> FloatArray:
    order = order or EliminationOrder.of(matrix)
    solution = order.solve([(1.0, order.upper_part(numbered(matrix, order)))], right[np.argsort(order.position)])
    return np.asarray(solution[order.position])


def numbered(matrix: "sparse.csr_array[np.float64]", order: EliminationOrder) -> "sparse.csr_array[np.float64]":
    """The matrix with its unknowns in some order."""
    by_position = np.argsort(order.position)
    return sparse.csr_array(matrix[by_position][:, by_position])


def right_sides(n: int) -> FloatArray:
    return np.random.default_rng(1).normal(size=(n, 3))


@given(sizes=st.lists(st.integers(1, 40), min_size=1, max_size=8), seed=st.integers(0, 2**32 - 1))
def test_blocks_of_any_sizes_are_solved(sizes: list[int], seed: int) -> None:
    matrix = blocks(sizes, seed)
    right = right_sides(sum(sizes))
    assert matrix @ solved(matrix, right) == pytest.approx(right, abs=1e-8)


def test_one_order_serves_other_matrices_of_the_same_pattern() -> None:
    matrix = blocks([30, 8, 21], 5)
    other = sparse.csr_array(matrix + 3 * sparse.eye_array(59))
    right = right_sides(59)
    assert other @ solved(other, right, EliminationOrder.of(matrix)) == pytest.approx(right, abs=1e-8)


def test_a_sum_of_matrices_of_several_widths_is_solved() -> None:
    wide = blocks([30, 8, 21], 5)
    narrow = sparse.csr_array(sparse.diags_array(np.arange(1.0, 60.0)))
    order, right = EliminationOrder.of(wide), right_sides(59)
    terms = [(weight, order.upper_part(numbered(matrix, order))) for weight, matrix in ((0.3, narrow), (2.0, wide))]
    found = order.solve(terms, right[np.argsort(order.position)])[order.position]
    assert (0.3 * narrow + 2.0 * wide) @ found == pytest.approx(right, abs=1e-8)


def test_a_band_that_is_too_large_is_left_to_a_general_solver(monkeypatch: pytest.MonkeyPatch) -> None:
    matrix, right = blocks([30, 8], 2), right_sides(38)
    expected = solved(matrix, right)
    monkeypatch.setattr(banded_solver, "_LARGEST_BAND", 50)
    assert solved(matrix, right) == pytest.approx(expected, abs=1e-10)


def test_a_matrix_that_is_not_definite_is_solved_all_the_same() -> None:
    matrix = sparse.csr_array(np.array([[0.0, 2.0], [2.0, 0.0]]))
    assert solved(matrix, np.array([[2.0], [4.0]])) == pytest.approx(np.array([[2.0], [1.0]]))


def test_bands_are_factored_on_one_thread(monkeypatch: pytest.MonkeyPatch) -> None:
    threads: list[int] = []

    def watched(band: FloatArray, right: FloatArray, **options: bool) -> FloatArray:
        threads.extend(pool["num_threads"] for pool in threadpool_info() if pool["user_api"] == "blas")
        return np.asarray(solveh_banded(band, right, **options))

    monkeypatch.setattr("quadpatch.filling.banded_solver.solveh_banded", watched)
    matrix = blocks([30, 8], 2)
    with threadpool_limits(2, user_api="blas"):
        solved(matrix, right_sides(38))
    assert set(threads) == {1}


def test_a_singular_matrix_is_an_error() -> None:
    matrix = sparse.csr_array(np.ones((2, 2)))
    with pytest.raises(RuntimeError):
        solved(matrix, np.ones((2, 1)))


def test_nothing_has_no_unknowns() -> None:
    empty = sparse.csr_array((0, 0))
    assert solved(empty, np.zeros((0, 3))).shape == (0, 3)

"""Known values spread over a graph."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from quadpatch.mesh.harmonic import extend_harmonically
from quadpatch.types import IntArray


def path_edges(n: int) -> IntArray:
    return np.stack([np.arange(n - 1), np.arange(1, n)], axis=1)


@given(n=st.integers(3, 40), low=st.floats(-100, 100), high=st.floats(-100, 100))
def test_along_a_path_values_run_straight_from_end_to_end(n: int, low: float, high: float) -> None:
    known = np.zeros(n, bool)
    known[[0, -1]] = True
    values = np.zeros((n, 1))
    values[0], values[-1] = low, high
    extended = extend_harmonically(path_edges(n), known, values)[:, 0]
    assert np.allclose(extended, np.linspace(low, high, n), atol=1e-9)


@given(seed=st.integers(0, 10_000), n=st.integers(2, 30))
def test_every_unknown_node_is_the_mean_of_its_neighbours_and_within_the_known_range(seed: int, n: int) -> None:
    rng = np.random.default_rng(seed)
    edges = rng.integers(0, n, (3 * n, 2))
    known = rng.random(n) < 0.3
    values = rng.normal(size=(n, 2))
    extended = extend_harmonically(edges, known, values)
    assert extended[known].tobytes() == values[known].tobytes()
    both = np.unique(np.concatenate([edges, edges[:, ::-1]]), axis=0)
    both = both[both[:, 0] != both[:, 1]]
    for node in np.flatnonzero(~known & np.isfinite(extended[:, 0])):
        neighbours = both[both[:, 0] == node, 1]
        assert np.allclose(extended[node], extended[neighbours].mean(axis=0), atol=1e-9)
    if known.any():
        assert np.nanmin(extended) >= values[known].min()
        assert np.nanmax(extended) <= values[known].max()


def test_components_without_a_known_node_stay_unknown() -> None:
    edges = np.array([[0, 1], [2, 3]])
    extended = extend_harmonically(edges, np.array([True, False, False, False]), np.full((4, 1), 7.0))
    assert extended[:2, 0].tolist() == [7, 7]
    assert np.isnan(extended[2:]).all()


def test_numbers_at_the_end_of_the_range_stay_within_that_of_their_rim() -> None:
    largest = np.finfo(np.float64).max
    known = np.array([True, False, False, True])
    values = np.array([[largest], [0.0], [0.0], [0.9 * largest]])
    extended = extend_harmonically(path_edges(4), known, values)[:, 0]
    assert np.isfinite(extended).all()
    assert (extended >= 0.9 * largest).all()

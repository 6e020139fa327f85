import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from quadpatch.mesh.passes import Rows, extent, is_identity, parts_of


@given(n=st.integers(0, 30), size=st.integers(1, 12))
def test_parts_hold_every_row_once(n: int, size: int) -> None:
    parts = [range(n)[part] for part in parts_of(n, size)]
    assert [row for part in parts for row in part] == list(range(n))
    assert all(len(part) <= size for part in parts)


@given(n=st.integers(1, 400))
def test_the_extent_is_that_of_every_column(n: int) -> None:
    points = np.random.default_rng(n).normal(size=(n, 3))
    low, high = extent(points)
    assert low.tolist() == points.min(axis=0).tolist()
    assert high.tolist() == points.max(axis=0).tolist()


def test_rows_are_picked_as_numpy_picks_them() -> None:
    rng = np.random.default_rng(0)
    table, rows = rng.normal(size=(50, 3)), rng.integers(50, size=80)
    assert (Rows(table).at(rows) == table[rows]).all()
    assert Rows(table).at(rows[:0]).shape == (0, 3)
    assert (Rows(table[:, ::-1]).at(rows) == table[rows, ::-1]).all()


def test_numbers_that_are_their_own_positions_are_an_identity() -> None:
    numbers = np.arange(100_000)
    assert is_identity(numbers)
    assert is_identity(numbers[:0])
    numbers[-1] = 0
    assert not is_identity(numbers)

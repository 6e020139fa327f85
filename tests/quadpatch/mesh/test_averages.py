import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from quadpatch.mesh.averages import mean_by, mean_of_corners


def test_each_group_has_the_mean_of_its_own_values_and_an_empty_one_has_zero() -> None:
    assert mean_by(np.array([2, 0, 2, 2]), np.array([1.0, 5.0, 2.0, 6.0]), 4).tolist() == [5.0, 0.0, 3.0, 0.0]


def test_values_weigh_as_much_as_they_are_told_to() -> None:
    group, values, weights = np.array([0, 0, 1, 2]), np.array([1.0, 4.0, 5.0, 7.0]), np.array([2.0, 1.0, 3.0, 0.0])
    assert mean_by(group, values, 3, weights).tolist() == [2.0, 5.0, 0.0]


def test_no_values_give_zero_for_every_group() -> None:
    assert mean_by(np.zeros(0, np.int64), np.zeros(0), 3).tolist() == [0.0, 0.0, 0.0]
    assert mean_by(np.zeros(0, np.int64), np.zeros(0), 0).shape == (0,)


@given(seed=st.integers(0, 2**32 - 1), n=st.integers(1, 40), n_groups=st.integers(1, 6))
def test_every_value_weighs_the_same_in_whatever_order_the_groups_are_named(seed: int, n: int, n_groups: int) -> None:
    rng = np.random.default_rng(seed)
    group, values, name = rng.integers(0, n_groups, n), rng.normal(size=n), rng.permutation(n_groups)
    mean = mean_by(group, values, n_groups)
    np.testing.assert_allclose((mean * np.bincount(group, minlength=n_groups)).sum(), values.sum(), atol=1e-12)
    np.testing.assert_array_equal(mean_by(name[group], values, n_groups)[name], mean)


@given(seed=st.integers(0, 1000), width=st.sampled_from([(), (3,)]))
def test_the_mean_of_three_corners_is_numpys_to_the_last_bit(seed: int, width: tuple[int, ...]) -> None:
    corners = np.random.default_rng(seed).normal(size=(50, 3, *width))
    assert (mean_of_corners(corners) == corners.mean(axis=1)).all()

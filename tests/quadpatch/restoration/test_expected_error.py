import numpy as np
import pytest

from quadpatch.restoration.expected_error import learn_error_curve
from quadpatch.types import FloatArray


def drawn(n: int = 600) -> tuple[FloatArray, FloatArray, FloatArray]:
    rng = np.random.default_rng(0)
    sign = rng.uniform(0, 2, n)
    return sign, 0.5 * sign * np.abs(rng.normal(size=n)), np.full(n, 1 / n)


def test_the_curve_states_the_error_of_the_hidden_vertices() -> None:
    sign, error, weight = drawn()
    expected = learn_error_curve(sign, error, weight).expected(sign)
    assert np.sqrt((expected**2).mean()) == pytest.approx(np.sqrt((error**2).mean()))


def test_a_larger_sign_never_means_a_smaller_error() -> None:
    expected = learn_error_curve(*drawn()).expected(np.linspace(0, 10, 200))
    assert (np.diff(expected) >= 0).all()


def test_errors_that_follow_the_sign_are_told_apart() -> None:
    curve = learn_error_curve(*drawn())
    low, high = curve.expected(np.array([0.2, 1.8])).tolist()
    assert high > 5 * low


def test_beyond_the_hidden_vertices_the_error_grows_in_proportion() -> None:
    curve = learn_error_curve(*drawn())
    at_end, beyond = curve.expected(np.array([curve.sign[-1], 3 * curve.sign[-1]])).tolist()
    assert beyond == pytest.approx(3 * at_end)


def test_a_few_vertices_without_any_error_expect_none() -> None:
    curve = learn_error_curve(np.zeros(5), np.zeros(5), np.full(5, 0.2))
    assert curve.expected(np.zeros(3)).tolist() == [0, 0, 0]

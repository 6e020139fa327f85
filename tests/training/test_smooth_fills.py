import numpy as np
import pytest

from quadpatch.types import FloatArray
from training.smooth_fills import disk, smooth_fill


def polynomial(degree: int, seed: int, n: int = 12) -> FloatArray:
    rng = np.random.default_rng(seed)
    x, y = np.meshgrid(np.linspace(-1, 1, n), np.linspace(-1, 1, n))
    terms = [x**i * y**j for i in range(degree + 1) for j in range(degree + 1 - i)]
    return np.asarray(sum(rng.normal() * term for term in terms))


@pytest.mark.parametrize(("order", "degree"), [(1, 0), (2, 1)])
def test_what_has_no_energy_is_continued_exactly(order: int, degree: int) -> None:
    truth = np.stack([polynomial(degree, seed) for seed in range(3)])
    known = disk(12, 0.6)
    filled = smooth_fill(np.where(known, truth, np.nan), known, order)
    np.testing.assert_allclose(filled, truth, atol=1e-10)


def test_a_membrane_solves_the_discrete_laplace_equation() -> None:
    known = disk(12, 0.5)
    filled = smooth_fill(np.random.default_rng(0).normal(size=(2, 12, 12)), known, 1)
    around = np.roll(filled, 1, 1) + np.roll(filled, -1, 1) + np.roll(filled, 1, 2) + np.roll(filled, -1, 2)
    np.testing.assert_allclose((around - 4.0 * filled)[:, ~known], 0.0, atol=1e-10)


def test_a_plate_continues_a_bowl_better_than_a_membrane_does() -> None:
    truth = polynomial(2, 1)[None]
    known = disk(12, 0.6)
    errors = [np.abs(smooth_fill(truth, known, order) - truth).max() for order in (1, 2)]
    assert errors[1] < 0.1 * errors[0]


def test_known_bins_keep_their_bits() -> None:
    values = np.random.default_rng(2).normal(size=(4, 10, 10))
    known = disk(10, 0.4)
    np.testing.assert_array_equal(smooth_fill(values, known, 2)[:, known], values[:, known])


def test_a_disk_is_centred_and_as_wide_as_asked() -> None:
    known = disk(24, 0.25)
    np.testing.assert_array_equal(known, known[::-1])
    np.testing.assert_array_equal(known, known.T)
    assert (~known).any(axis=0).sum() == 6
    assert disk(24, 0.0).all()

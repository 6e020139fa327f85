import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from quadpatch.patches.normalise import normalisation


@given(seed=st.integers(0, 2**32 - 1), scale=st.sampled_from([1e-6, 1.0, 1e6]))
def test_undo_returns_the_heights(seed: int, scale: float) -> None:
    rng = np.random.default_rng(seed)
    heights = scale * rng.normal(size=(6, 5, 5))
    there = normalisation(heights, rng.random((6, 5, 5)) < 0.5)
    np.testing.assert_allclose(there.undo(there.apply(heights)), heights, rtol=1e-12, atol=1e-12 * scale)
    assert (there.scale > 0).all()


def test_normal_noise_gets_mean_zero_and_spread_one() -> None:
    rng = np.random.default_rng(0)
    heights = rng.normal(7, 3, (1, 200, 200))
    known = rng.random(heights.shape) < 0.7
    values = normalisation(heights, known).apply(heights)[known]
    assert values.mean() == pytest.approx(0, abs=1e-12)
    assert values.std() == pytest.approx(1, rel=0.02)


def test_unknown_bins_have_no_say() -> None:
    rng = np.random.default_rng(1)
    heights = rng.normal(size=(3, 6, 6))
    known = rng.random(heights.shape) < 0.6
    one = normalisation(heights, known)
    other = normalisation(np.where(known, heights, 1e6), known)
    np.testing.assert_array_equal(one.shift, other.shift)
    np.testing.assert_array_equal(one.scale, other.scale)


def test_a_constant_patch_has_scale_one_whatever_its_height() -> None:
    heights = np.stack([np.full((4, 4), 0.1), np.full((4, 4), 0.0), np.full((4, 4), 1e6 / 3)])
    there = normalisation(heights, np.ones(heights.shape, dtype=bool))
    np.testing.assert_array_equal(there.scale, 1)
    np.testing.assert_allclose(there.apply(heights), 0, atol=1e-9)


def test_patches_with_too_few_known_bins_take_the_usual_scale() -> None:
    rng = np.random.default_rng(2)
    heights = rng.normal(5, 2, size=(5, 8, 8))
    known = np.ones(heights.shape, dtype=bool)
    known[3], known[4] = False, False
    known[3, 0, :2] = True
    there = normalisation(heights, known)
    np.testing.assert_allclose(there.scale[3:], np.median(there.scale[:3]))
    assert there.shift[3] == pytest.approx(heights[3, 0, :2].mean())
    assert there.shift[4] == 0


def test_nothing_known_anywhere_and_no_patches_are_fine() -> None:
    there = normalisation(np.ones((2, 3, 3)), np.zeros((2, 3, 3), dtype=bool))
    np.testing.assert_array_equal(there.scale, 1)
    assert normalisation(np.zeros((0, 3, 3)), np.zeros((0, 3, 3), dtype=bool)).shift.shape == (0,)

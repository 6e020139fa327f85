import numpy as np
import pytest

from quadpatch.types import FloatArray
from training.patterns import PATTERNS


def some_points(n_side: int = 60, extent: float = 8.0) -> FloatArray:
    ticks = np.linspace(3.0, 3.0 + extent, n_side)
    return np.stack(np.meshgrid(ticks, ticks), axis=-1).reshape(-1, 2)


@pytest.mark.parametrize("name", sorted(PATTERNS))
def test_a_pattern_is_a_bounded_relief_that_follows_from_its_generator(name: str) -> None:
    points = some_points()
    for seed in range(20):
        heights = PATTERNS[name](points, np.random.default_rng(seed))
        assert heights.shape == (len(points),)
        assert np.abs(heights).max() < 3.0
        assert heights.std() > 0.05
        np.testing.assert_array_equal(heights, PATTERNS[name](points, np.random.default_rng(seed)))


@pytest.mark.parametrize("name", sorted(PATTERNS))
def test_a_pattern_has_its_features_within_a_few_periods(name: str) -> None:
    """Half of a window of two periods must vary as the whole does: nothing longer than the period dominates."""
    rng = np.random.default_rng(3)
    heights = PATTERNS[name](some_points(120, 12.0), rng).reshape(120, 120)
    windows = [heights[i : i + 30, j : j + 30].std() for i in range(0, 120, 30) for j in range(0, 120, 30)]
    assert np.median(windows) > 0.3 * heights.std()


@pytest.mark.parametrize("name", sorted(PATTERNS))
def test_two_generators_give_two_reliefs(name: str) -> None:
    points = some_points()
    one, two = (PATTERNS[name](points, np.random.default_rng(seed)) for seed in (1, 2))
    assert np.abs(one - two).mean() > 0.01

import numpy as np
import pytest

from quadpatch.patches.folding import is_unfolded
from quadpatch.types import FloatArray, Patches


def patches(heights: FloatArray) -> Patches:
    """Patches of length 1 with these heights; NaN marks bins that see nothing."""
    n = len(heights)
    seen = np.isfinite(heights)
    triangle = np.where(seen, 0, -1)
    return Patches(
        np.zeros((n, 3)), np.tile(np.eye(3), (n, 1, 1)), 1.0, np.where(seen, heights, 0), seen, seen, triangle
    )


def test_a_plane_and_a_steep_slope_do_not_fold() -> None:
    slope = np.tile(np.arange(10) * 0.29, (10, 1))
    assert is_unfolded(patches(np.stack([np.zeros((10, 10)), slope]))).all()


@pytest.mark.parametrize("axis", [1, 2])
def test_both_sides_of_a_step_count(axis: int) -> None:
    one, two = np.zeros((2, 10, 10))
    one[5:] = 0.31
    two[3:6] = 0.31
    np.testing.assert_array_equal(is_unfolded(patches(np.stack([one, two]).swapaxes(1, axis))), [True, False])


def test_a_patch_over_the_border_of_a_scan_is_not_folded() -> None:
    heights = np.zeros((3, 10, 10))
    heights[0, :5] = np.nan
    heights[1, :7] = np.nan
    heights[2] = np.indices((10, 10)).sum(axis=0) % 2
    np.testing.assert_array_equal(is_unfolded(patches(heights)), [True, False, False])


def test_folding_does_not_depend_on_the_unit_of_length() -> None:
    rng = np.random.default_rng(0)
    one = patches(rng.normal(0, 0.12, (40, 10, 10)))
    scaled = Patches(one.origins, one.frames, 1e3, 1e3 * one.heights, one.known, one.seen, one.triangle)
    assert 0 < is_unfolded(one).sum() < 40
    np.testing.assert_array_equal(is_unfolded(one), is_unfolded(scaled))

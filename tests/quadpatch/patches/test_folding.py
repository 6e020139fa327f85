import numpy as np
import pytest

from quadpatch.patches.folding import fold_fraction, is_height_map, is_unfolded
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
    both = patches(np.stack([np.zeros((10, 10)), slope]))
    np.testing.assert_array_equal(fold_fraction(both), 0)
    assert is_height_map(both).all()


@pytest.mark.parametrize("axis", [0, 1])
def test_both_sides_of_a_step_count(axis: int) -> None:
    step = np.zeros((10, 10))
    step[5:] = 0.31
    assert fold_fraction(patches(np.moveaxis(step, 0, axis)[None]))[0] == pytest.approx(0.2)


def test_bins_that_see_nothing_count_and_are_no_step() -> None:
    heights = np.full((1, 10, 10), 5.0)
    heights[0, :3] = np.nan
    assert fold_fraction(patches(heights))[0] == pytest.approx(0.3)
    assert not is_height_map(patches(heights))[0]


def test_a_patch_over_the_border_of_a_scan_is_not_folded() -> None:
    heights = np.zeros((3, 10, 10))
    heights[0, :5] = np.nan
    heights[1, :7] = np.nan
    heights[2] = np.indices((10, 10)).sum(axis=0) % 2
    np.testing.assert_array_equal(is_unfolded(patches(heights)), [True, False, False])


def test_a_checkerboard_of_two_layers_is_no_height_map() -> None:
    board = np.indices((10, 10)).sum(axis=0) % 2 * 1.0
    assert fold_fraction(patches(board[None]))[0] == 1


def test_folding_does_not_depend_on_the_unit_of_length() -> None:
    rng = np.random.default_rng(0)
    one = patches(rng.normal(0, 0.3, (20, 10, 10)))
    scaled = Patches(one.origins, one.frames, 1e3, 1e3 * one.heights, one.known, one.seen, one.triangle)
    np.testing.assert_array_equal(fold_fraction(one), fold_fraction(scaled))

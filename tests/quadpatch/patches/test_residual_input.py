from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from quadpatch.patches.residual_input import CHANNELS, LARGEST, corrected, network_input, standardise
from quadpatch.types import FloatArray, Patches

N = 12


def patches_and_base_heights(seed: int, n_patches: int = 4) -> tuple[Patches, FloatArray]:
    """Waves over a tilted base surface, with bins that are invented and bins that nothing is seen in."""
    rng = np.random.default_rng(seed)
    base_heights = np.asarray(np.cumsum(rng.normal(size=(n_patches, N, N)), axis=2))
    seen = rng.random((n_patches, N, N)) > 0.1
    known = seen & (rng.random((n_patches, N, N)) > 0.3)
    heights = np.where(seen, base_heights + rng.normal(size=base_heights.shape), 0.0)
    frames = np.tile(np.eye(3), (n_patches, 1, 1))
    triangle = np.where(seen, 0, -1)
    return Patches(np.zeros((n_patches, 3)), frames, 1.0, heights, known, seen, triangle), base_heights


def with_heights(patches: Patches, heights: FloatArray, length: float = 1.0) -> Patches:
    return replace(patches, heights=heights, length=length)


def test_a_network_sees_the_detail_in_spreads_and_which_bins_are_known() -> None:
    patches, base_heights = patches_and_base_heights(0)
    seen = network_input(patches, base_heights)
    assert seen.channels.shape == (4, CHANNELS, N, N)
    assert seen.channels.dtype == np.float32
    np.testing.assert_array_equal(seen.channels[:, 1] == 1.0, patches.known)
    np.testing.assert_array_equal(seen.channels[:, 1] == 0.0, ~patches.known)
    for detail, signal, known in zip(
        patches.heights - base_heights, seen.channels[:, 0].astype(np.float64), patches.known, strict=True
    ):
        assert signal[known].mean() == pytest.approx(0, abs=1e-6)
        assert signal[known].std() == pytest.approx(1, abs=1e-6)
        # The fill is shown in the same measure as what was measured.
        shown = known | (signal != 0)
        wanted = (detail - detail[known].mean()) / detail[known].std()
        np.testing.assert_allclose(signal[shown], np.clip(wanted, -LARGEST, LARGEST)[shown], atol=1e-5)


@given(seed=st.integers(0, 1000), scale=st.sampled_from([2.0**-20, 0.5, 4.0, 2.0**30]))
def test_the_unit_of_length_changes_the_spread_and_nothing_else(seed: int, scale: float) -> None:
    patches, base_heights = patches_and_base_heights(seed)
    one = network_input(patches, base_heights)
    other = network_input(with_heights(patches, scale * patches.heights, scale), scale * base_heights)
    np.testing.assert_array_equal(one.channels, other.channels)
    np.testing.assert_array_equal(other.deviation, scale * one.deviation)


@given(seed=st.integers(0, 1000), shift=st.floats(-100, 100))
def test_how_far_the_detail_lies_off_the_base_surface_does_not_matter(seed: int, shift: float) -> None:
    patches, base_heights = patches_and_base_heights(seed)
    one, other = network_input(patches, base_heights), network_input(patches, base_heights - shift)
    np.testing.assert_allclose(one.channels, other.channels, atol=1e-5)
    np.testing.assert_allclose(one.deviation, other.deviation, rtol=1e-6)


def test_bins_that_nothing_is_seen_in_are_zero_whatever_stands_there() -> None:
    patches, base_heights = patches_and_base_heights(1)
    wild = with_heights(patches, np.where(patches.seen, patches.heights, 1e6))
    channels = network_input(wild, base_heights).channels
    assert (channels.transpose(0, 2, 3, 1)[~patches.seen] == 0).all()
    np.testing.assert_array_equal(channels, network_input(patches, base_heights).channels)


def test_flat_patches_and_unknown_ones_say_nothing_and_are_never_corrected() -> None:
    patches, base_heights = patches_and_base_heights(2, 2)
    known = patches.known & np.array([True, False])[:, None, None]
    still = with_heights(replace(patches, known=known), np.where(known, base_heights + 0.25, patches.heights))
    seen = network_input(still, base_heights)
    np.testing.assert_array_equal(seen.deviation, 0.0)
    assert (seen.channels[:, 0] == 0).all()
    corrections = np.ones_like(still.heights)
    np.testing.assert_array_equal(corrected(still, seen.deviation, corrections), still.heights)


def test_what_rounding_leaves_of_a_flat_patch_is_no_detail() -> None:
    patches, base_heights = patches_and_base_heights(4)
    noise = 1e-15 * np.random.default_rng(4).normal(size=base_heights.shape)
    seen = network_input(with_heights(patches, np.where(patches.seen, noise, 0.0)), np.zeros_like(base_heights))
    np.testing.assert_array_equal(seen.deviation, 0.0)
    assert (seen.channels[:, 0] == 0).all()


def test_a_spike_is_cut_off() -> None:
    patches, base_heights = patches_and_base_heights(3)
    spiked = patches.heights.copy()
    invented = np.argwhere(patches.seen & ~patches.known)[0]
    spiked[tuple(invented)] += 1e6
    channels = network_input(with_heights(patches, spiked), base_heights).channels
    assert channels[invented[0], 0, invented[1], invented[2]] == LARGEST
    assert np.abs(channels).max() == LARGEST


@given(seed=st.integers(0, 1000))
def test_no_correction_is_the_fill_as_it_was(seed: int) -> None:
    patches, base_heights = patches_and_base_heights(seed)
    deviation = network_input(patches, base_heights).deviation
    np.testing.assert_array_equal(corrected(patches, deviation, np.zeros_like(base_heights)), patches.heights)


@settings(max_examples=25)
@given(seed=st.integers(0, 1000))
def test_known_bins_are_never_changed_and_others_move_by_the_correction_in_spreads(seed: int) -> None:
    patches, base_heights = patches_and_base_heights(seed)
    deviation = network_input(patches, base_heights).deviation
    corrections = np.random.default_rng(seed).normal(size=base_heights.shape)
    heights = corrected(patches, deviation, corrections)
    assert heights[patches.known].tobytes() == patches.heights[patches.known].tobytes()
    moved = (heights - patches.heights)[~patches.known]
    np.testing.assert_allclose(moved, (deviation[:, None, None] * corrections)[~patches.known], atol=1e-12)


@given(seed=st.integers(0, 1000))
def test_what_is_measured_in_spreads_is_put_back_by_the_correction(seed: int) -> None:
    """A truth that a training pair asks for is exactly what a right answer leads to."""
    patches, base_heights = patches_and_base_heights(seed)
    deviation = network_input(patches, base_heights).deviation
    missing = np.clip(np.random.default_rng(seed).normal(size=base_heights.shape), -3, 3) * ~patches.known
    answer = standardise(missing, deviation)
    np.testing.assert_allclose(corrected(patches, deviation, answer), patches.heights + missing, atol=1e-12)

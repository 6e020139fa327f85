import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from quadpatch.patches.normalisation import from_signals, raw_heights, to_signals
from quadpatch.types import BoolArray, FloatArray


def some_patches(seed: int) -> tuple[FloatArray, BoolArray]:
    rng = np.random.default_rng(seed)
    known = rng.random((7, 6, 6)) < 0.7
    return rng.normal(3.0, 0.01, (7, 6, 6)), known


def test_known_bins_have_mean_zero_and_spread_one() -> None:
    detail, known = some_patches(0)
    signals, _ = to_signals(detail, known)
    for signal, mask in zip(signals, known.reshape(7, -1), strict=True):
        assert abs(signal[mask].mean()) < 1e-12
        assert abs(signal[mask].std() - 1.0) < 1e-12
        assert (signal[~mask] == 0.0).all()


@given(seed=st.integers(0, 1000), scale=st.floats(1e-6, 1e6), shift=st.floats(-10, 10))
def test_depth_and_offset_of_a_relief_do_not_change_its_signal(seed: int, scale: float, shift: float) -> None:
    detail, known = some_patches(seed)
    signals, scaling = to_signals(detail, known)
    others, other_scaling = to_signals((detail + shift) * scale, known)
    np.testing.assert_allclose(others, signals, atol=1e-7)
    np.testing.assert_allclose(other_scaling.deviation, scaling.deviation * scale, rtol=1e-7)


def test_known_bins_come_back_from_their_signals() -> None:
    detail, known = some_patches(2)
    back = from_signals(*to_signals(detail, known))
    np.testing.assert_allclose(back[known], detail[known], rtol=1e-12)


def test_unknown_bins_are_not_read() -> None:
    detail, known = some_patches(3)
    signals, _ = to_signals(np.where(known, detail, np.nan), known)
    np.testing.assert_array_equal(signals, to_signals(detail, known)[0])


def test_flat_and_empty_patches_give_zeros_and_come_back_flat() -> None:
    detail = np.full((3, 4, 4), 0.1)
    detail[1, 0, 0] += 1e-14
    known = np.ones((3, 4, 4), dtype=np.bool_)
    known[2] = False
    signals, scaling = to_signals(detail, known)
    assert (signals == 0.0).all()
    np.testing.assert_allclose(from_signals(signals, scaling)[:2], 0.1, rtol=1e-12)
    assert (from_signals(signals, scaling)[2] == 0.0).all()


def test_patches_flatter_than_the_least_spread_stay_small() -> None:
    detail, known = some_patches(4)
    signals, scaling = to_signals(detail, known, least_deviation=1.0)
    assert (scaling.deviation == 1.0).all()
    assert np.abs(signals).max() < 0.1


@given(seed=st.integers(0, 1000))
def test_raw_heights_are_the_signals_and_unknown_bins_are_never_read(seed: int) -> None:
    heights, known = some_patches(seed)
    signals, scaling = raw_heights(np.where(known, heights, np.nan), known)
    flat_known = known.reshape(7, -1)
    assert (signals[flat_known] == heights[known]).all()
    assert (signals[~flat_known] == 0.0).all()
    assert (from_signals(signals, scaling)[known] == heights[known]).all()


def test_no_patches_are_no_signals() -> None:
    assert raw_heights(np.zeros((0, 3, 3)), np.zeros((0, 3, 3), bool))[0].shape == (0, 9)

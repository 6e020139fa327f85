import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from quadpatch.sparse.gaussian import NOISE, gaussian_codes, known_covariance, principal_atoms
from quadpatch.types import BoolArray, FloatArray

SEEDS = st.integers(0, 2**32 - 1)


def random_problem(
    seed: int, n: int = 7, n_bins: int = 36, n_atoms: int = 10
) -> tuple[FloatArray, BoolArray, FloatArray]:
    rng = np.random.default_rng(seed)
    scaled = rng.normal(size=(n_bins, n_atoms)) * rng.uniform(0.1, 2, n_atoms)
    return rng.normal(size=(n, n_bins)), rng.random((n, n_bins)) < rng.uniform(0.1, 1.0, (n, 1)), scaled


@given(seed=SEEDS)
@settings(max_examples=30)
def test_codes_are_the_conditional_mean_of_the_gaussian(seed: int) -> None:
    signals, known, scaled = random_problem(seed)
    codes = gaussian_codes(signals, known, scaled)
    for signal, mask, code in zip(signals, known, codes, strict=True):
        seen = scaled[mask]
        covariance = seen @ seen.T + NOISE * np.eye(len(seen))
        expected = seen.T @ np.linalg.solve(covariance, signal[mask])
        np.testing.assert_allclose(code, expected, rtol=1e-6, atol=1e-8)


@given(seed=SEEDS)
@settings(max_examples=20)
def test_what_stands_in_unknown_bins_is_never_read(seed: int) -> None:
    signals, known, scaled = random_problem(seed)
    junk = np.where(known, signals, np.nan)
    assert (gaussian_codes(junk, known, scaled) == gaussian_codes(signals, known, scaled)).all()


def test_a_signal_alone_gets_the_same_bits_as_among_many() -> None:
    signals, known, scaled = random_problem(3, n=200)
    together = gaussian_codes(signals, known, scaled)
    assert (gaussian_codes(signals[150:151], known[150:151], scaled) == together[150]).all()


def test_nothing_known_is_coded_by_nothing() -> None:
    signals, known, scaled = random_problem(0)
    assert (gaussian_codes(signals, np.zeros_like(known), scaled) == 0).all()
    assert gaussian_codes(signals[:0], known[:0], scaled).shape == (0, 10)


def turned(image: FloatArray) -> list[FloatArray]:
    return [np.rot90(side, k) for side in (image, image.T) for k in range(4)]


def spanned(rng: np.random.Generator, n: int, side: int = 8) -> FloatArray:
    """Signals that three patterns and their turns span, the first much more common than the last."""
    images = np.concatenate([turned(rng.normal(size=(side, side)))[:1] for _ in range(3)])
    patterns = np.stack([turn.ravel() / np.linalg.norm(turn) for image in images for turn in turned(image)])
    weights = rng.normal(size=(n, len(patterns))) * np.repeat([3.0, 1.0, 0.3], 8)
    return np.asarray(weights @ patterns)


def test_atoms_span_the_signals_also_where_bins_are_missing() -> None:
    rng = np.random.default_rng(0)
    signals = spanned(rng, 4000)
    known = rng.random(signals.shape) < 0.8
    atoms, deviations = principal_atoms(known_covariance(np.where(known, signals, 0.0), known), 24)
    left = signals - (signals @ atoms) @ atoms.T
    assert (left**2).sum() < 0.03 * (signals**2).sum()
    assert (np.diff(deviations) <= 0).all()


def test_deviations_are_those_of_the_signals_along_the_atoms() -> None:
    signals = np.concatenate(
        [turn.ravel()[None] for image in spanned(np.random.default_rng(1), 300) for turn in turned(image.reshape(8, 8))]
    )
    atoms, deviations = principal_atoms(known_covariance(signals, np.ones(signals.shape, bool)), 24)
    np.testing.assert_allclose(np.sqrt(((signals @ atoms) ** 2).mean(axis=0)), deviations, rtol=1e-9)
    np.testing.assert_allclose(atoms.T @ atoms, np.eye(atoms.shape[1]), atol=1e-12)


@pytest.mark.parametrize("k", range(4))
def test_turned_signals_give_the_same_deviations(k: int) -> None:
    signals = spanned(np.random.default_rng(2), 200)
    rotated = np.rot90(signals.reshape(-1, 8, 8), k, axes=(1, 2)).reshape(signals.shape)
    everything = np.ones(signals.shape, bool)
    one, other = (principal_atoms(known_covariance(part, everything), 20)[1] for part in (signals, rotated))
    np.testing.assert_allclose(one, other, rtol=1e-9)

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from quadpatch.errors import StageError
from quadpatch.sparse.ksvd import KsvdOptions, masked_ksvd
from quadpatch.sparse.omp import masked_omp
from quadpatch.types import FloatArray


def planted(rng: np.random.Generator, n: int, n_bins: int, n_atoms: int, n_nonzero: int) -> tuple[FloatArray, ...]:
    """Build signals that are sparse in a random dictionary."""
    atoms = rng.normal(size=(n_bins, n_atoms))
    atoms /= np.linalg.norm(atoms, axis=0)
    codes = np.zeros((n, n_atoms))
    for row in codes:
        row[rng.choice(n_atoms, n_nonzero, replace=False)] = rng.normal(size=n_nonzero)
    return codes @ atoms.T, atoms


def ksvd(signals: FloatArray, options: KsvdOptions, rng: np.random.Generator) -> tuple[FloatArray, FloatArray]:
    """Learn from signals that are known in every bin."""
    return masked_ksvd(signals, np.ones(signals.shape, dtype=np.bool_), options, rng)


def share_found(learned: FloatArray, truth: FloatArray) -> float:
    """Tell which part of the true atoms was learned, up to sign."""
    return float((np.abs(learned.T @ truth).max(axis=0) > 0.99).mean())


def test_a_planted_dictionary_is_found_again() -> None:
    rng = np.random.default_rng(0)
    signals, truth = planted(rng, 1500, 30, 40, 3)
    atoms, errors = ksvd(signals, KsvdOptions(40, 3, 40), rng)
    assert share_found(atoms, truth) > 0.9
    assert errors[-1] < 0.25 * errors[0]


def test_a_planted_dictionary_is_found_through_masks() -> None:
    rng = np.random.default_rng(1)
    signals, truth = planted(rng, 2000, 24, 30, 2)
    known = rng.random(signals.shape) < 0.8
    hidden = np.where(known, signals, np.nan)
    atoms, _ = masked_ksvd(hidden, known, KsvdOptions(30, 2, 40), rng)
    assert share_found(atoms, truth) > 0.9


@given(seed=st.integers(0, 2**32 - 1), masked=st.booleans())
@settings(max_examples=15)
def test_the_error_never_rises_and_atoms_have_unit_norm(seed: int, masked: bool) -> None:
    rng = np.random.default_rng(seed)
    signals = rng.normal(size=(120, 16)) @ rng.normal(size=(16, 16))
    known = rng.random(signals.shape) < (0.7 if masked else 1.1)
    heard: list[tuple[int, float]] = []
    atoms, errors = masked_ksvd(signals, known, KsvdOptions(20, 4, 8), rng, lambda i, e: heard.append((i, e)))
    assert heard == list(enumerate(errors.tolist()))
    assert (np.diff(errors) <= 1e-9 * errors[0]).all()
    np.testing.assert_allclose(np.linalg.norm(atoms, axis=0), 1.0, rtol=1e-12)


def test_the_reported_error_is_at_least_that_of_coding_with_the_result() -> None:
    rng = np.random.default_rng(2)
    signals, _ = planted(rng, 400, 25, 30, 3)
    known = rng.random(signals.shape) < 0.9
    atoms, errors = masked_ksvd(signals, known, KsvdOptions(30, 3, 6), rng)
    codes = masked_omp(signals, known, atoms, 3)
    residual = np.where(known, signals - codes @ atoms.T, 0.0)
    assert np.sqrt((residual**2).sum() / known.sum()) == pytest.approx(errors[-1], rel=0.1)


def test_same_generator_same_bits() -> None:
    signals, _ = planted(np.random.default_rng(3), 300, 16, 20, 3)
    one, errors = ksvd(signals, KsvdOptions(20, 3, 5), np.random.default_rng(7))
    two, same_errors = ksvd(signals, KsvdOptions(20, 3, 5), np.random.default_rng(7))
    np.testing.assert_array_equal(one, two)
    np.testing.assert_array_equal(errors, same_errors)


def test_repeated_signals_do_not_become_repeated_atoms() -> None:
    rng = np.random.default_rng(4)
    few = rng.normal(size=(5, 16))
    signals = np.concatenate([np.repeat(few, 40, axis=0), rng.normal(size=(60, 16))])
    atoms, _ = ksvd(signals, KsvdOptions(12, 2, 20), rng)
    gram = np.abs(atoms.T @ atoms) - np.eye(12)
    assert gram.max() < 0.995


def test_a_bin_that_is_never_known_does_not_spoil_the_atoms() -> None:
    rng = np.random.default_rng(5)
    signals, _ = planted(rng, 200, 16, 20, 2)
    known = np.ones(signals.shape, dtype=np.bool_)
    known[:, 3] = False
    signals[:, 3] = np.nan
    atoms, errors = masked_ksvd(signals, known, KsvdOptions(20, 2, 5), rng)
    assert np.isfinite(atoms).all()
    assert np.isfinite(errors).all()


def test_fewer_signals_than_atoms_are_refused() -> None:
    signals = np.zeros((30, 9))
    signals[:7] = np.random.default_rng(6).normal(size=(7, 9))
    with pytest.raises(StageError, match="7 patches"):
        ksvd(signals, KsvdOptions(8, 2, 3), np.random.default_rng(0))
    atoms, _ = ksvd(signals, KsvdOptions(7, 2, 3), np.random.default_rng(0))
    assert atoms.shape == (9, 7)

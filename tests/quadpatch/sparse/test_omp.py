import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from quadpatch.sparse import omp
from quadpatch.sparse.omp import masked_omp
from quadpatch.types import BoolArray, FloatArray


def random_atoms(rng: np.random.Generator, n_bins: int, n_atoms: int) -> FloatArray:
    atoms = rng.normal(size=(n_bins, n_atoms))
    return np.asarray(atoms / np.linalg.norm(atoms, axis=0))


def random_mask(rng: np.random.Generator, n: int, n_bins: int, least: int) -> BoolArray:
    known = rng.random((n, n_bins)) < rng.uniform(0.3, 1.0, (n, 1))
    known[:, :least] = True
    return known


def plain_omp(signal: FloatArray, known: BoolArray, atoms: FloatArray, n_nonzero: int) -> FloatArray:
    """One signal, least squares from scratch at every step."""
    visible = atoms[known]
    norms = np.linalg.norm(visible, axis=0)
    support: list[int] = []
    residual = signal[known]
    values: FloatArray = np.zeros(0)
    for _ in range(n_nonzero):
        scores = np.abs(residual @ visible) / norms
        scores[support] = 0.0
        support.append(int(scores.argmax()))
        values = np.asarray(np.linalg.lstsq(visible[:, support], signal[known], rcond=None)[0], dtype=np.float64)
        residual = signal[known] - visible[:, support] @ values
    code = np.zeros(atoms.shape[1])
    code[support] = values
    return code


def residual_norms(signals: FloatArray, known: BoolArray, atoms: FloatArray, codes: FloatArray) -> FloatArray:
    return np.asarray(np.linalg.norm(np.where(known, signals - codes @ atoms.T, 0.0), axis=1))


@given(seed=st.integers(0, 2**32 - 1), n_nonzero=st.integers(1, 8), same_mask=st.booleans())
@settings(max_examples=25)
def test_codes_equal_those_of_a_plain_pursuit_signal_by_signal(seed: int, n_nonzero: int, same_mask: bool) -> None:
    rng = np.random.default_rng(seed)
    atoms = random_atoms(rng, 40, 60)
    signals = rng.normal(size=(30, 40))
    known = random_mask(rng, 30, 40, least=20)
    if same_mask:
        known[:] = known[0]
    codes = masked_omp(signals, known, atoms, n_nonzero)
    expected = np.stack([plain_omp(y, m, atoms, n_nonzero) for y, m in zip(signals, known, strict=True)])
    np.testing.assert_allclose(codes, expected, rtol=0, atol=1e-10)


def test_signals_of_one_mask_and_of_many_are_coded_alike_side_by_side(monkeypatch: pytest.MonkeyPatch) -> None:
    rng = np.random.default_rng(5)
    monkeypatch.setattr(omp, "BATCH", 16)
    atoms = random_atoms(rng, 36, 50)
    signals = rng.normal(size=(100, 36))
    known = random_mask(rng, 100, 36, least=12)
    known[20:70] = True
    together = masked_omp(signals, known, atoms, 6)
    alone = np.concatenate([masked_omp(signals[[i]], known[[i]], atoms, 6) for i in range(100)])
    np.testing.assert_allclose(together, alone, rtol=0, atol=1e-10)


@given(seed=st.integers(0, 2**32 - 1))
@settings(max_examples=20)
def test_support_is_bounded_and_the_residual_never_grows_with_it(seed: int) -> None:
    rng = np.random.default_rng(seed)
    atoms = random_atoms(rng, 25, 40)
    signals = rng.normal(size=(20, 25))
    known = random_mask(rng, 20, 25, least=0)
    before = np.linalg.norm(np.where(known, signals, 0.0), axis=1)
    for n_nonzero in (*range(1, 10), 20, 30):
        codes = masked_omp(signals, known, atoms, n_nonzero)
        assert np.isfinite(codes).all()
        assert ((codes != 0.0).sum(axis=1) <= np.minimum(n_nonzero, known.sum(axis=1))).all()
        now = residual_norms(signals, known, atoms, codes)
        assert (now <= before + 1e-9).all()
        before = now


def test_an_orthonormal_dictionary_gives_the_best_of_all_supports() -> None:
    rng = np.random.default_rng(1)
    atoms = np.linalg.qr(rng.normal(size=(8, 8)))[0]
    signals = rng.normal(size=(10, 8))
    known = np.ones_like(signals, dtype=np.bool_)
    errors = residual_norms(signals, known, atoms, masked_omp(signals, known, atoms, 3))
    for signal, error in zip(signals, errors, strict=True):
        others = (
            np.linalg.norm(signal - atoms[:, s] @ (atoms[:, s].T @ signal))
            for s in map(list, itertools.combinations(range(8), 3))
        )
        assert error == pytest.approx(min(others), abs=1e-12)


def test_a_sparse_signal_is_completed_exactly_from_half_its_bins() -> None:
    rng = np.random.default_rng(2)
    atoms = random_atoms(rng, 144, 200)
    truth = np.zeros((50, 200))
    for row in truth:
        row[rng.choice(200, 4, replace=False)] = rng.choice([-1.0, 1.0], 4) * rng.uniform(1.0, 2.0, 4)
    signals = truth @ atoms.T
    known = rng.random(signals.shape) < 0.5
    hidden = np.where(known, signals, np.nan)
    codes = masked_omp(hidden, known, atoms, 12, tolerance=1e-6)
    exact = np.abs(codes @ atoms.T - signals).max(axis=1) < 1e-9
    assert exact.mean() > 0.9


@given(seed=st.integers(0, 2**32 - 1), power=st.integers(-12, 12))
@settings(max_examples=20)
def test_codes_scale_with_their_signal(seed: int, power: int) -> None:
    rng = np.random.default_rng(seed)
    atoms = random_atoms(rng, 20, 30)
    signals = rng.normal(size=(5, 20))
    known = random_mask(rng, 5, 20, least=5)
    codes = masked_omp(signals, known, atoms, 4)
    scale = 10.0**power
    np.testing.assert_allclose(masked_omp(signals * scale, known, atoms, 4) / scale, codes, rtol=0, atol=1e-9)


def test_a_signal_stops_at_the_first_residual_within_tolerance() -> None:
    rng = np.random.default_rng(3)
    atoms = random_atoms(rng, 64, 100)
    signals = rng.normal(size=(40, 64))
    known = random_mask(rng, 40, 64, least=30)
    tolerance = 0.4
    codes = masked_omp(signals, known, atoms, 30, tolerance)
    n_used = (codes != 0.0).sum(axis=1)
    rms = residual_norms(signals, known, atoms, codes) / np.sqrt(known.sum(axis=1))
    assert (rms <= tolerance).all()
    for i in np.flatnonzero(n_used > 1):
        shorter = masked_omp(signals[[i]], known[[i]], atoms, int(n_used[i]) - 1)
        (error,) = residual_norms(signals[[i]], known[[i]], atoms, shorter)
        assert error / np.sqrt(known[i].sum()) > tolerance


def test_the_lowest_of_equal_atoms_is_taken_and_its_twins_are_not() -> None:
    rng = np.random.default_rng(4)
    one = random_atoms(rng, 30, 1)
    atoms = np.concatenate([np.eye(30)[:, :2], one, one, -one, one], axis=1)
    code = masked_omp(3.0 * one.T, np.ones((1, 30), dtype=np.bool_), atoms, 5)
    np.testing.assert_allclose(code, [[0, 0, 3, 0, 0, 0]], atol=1e-12)


def test_nothing_known_or_nothing_there_gives_a_code_of_zeros() -> None:
    atoms = random_atoms(np.random.default_rng(6), 16, 20)
    signals = np.full((3, 16), np.nan)
    known = np.zeros((3, 16), dtype=np.bool_)
    signals[1], known[1] = 0.0, True
    signals[2, 3], known[2, 3] = 1.0, True
    codes = masked_omp(signals, known, atoms, 5)
    assert (codes[:2] == 0.0).all()
    assert np.count_nonzero(codes[2]) == 1
    assert codes[2] @ atoms[3] == pytest.approx(1.0)
    assert masked_omp(signals[:0], known[:0], atoms, 5).shape == (0, 20)


def test_an_atom_that_lives_in_the_unknown_bins_is_never_taken() -> None:
    atoms = np.eye(4)[:, :2].copy()
    atoms[:, 0] = [1e-3, 0.0, 0.0, np.sqrt(1.0 - 1e-6)]
    known = np.array([[True, True, True, False]])
    codes = masked_omp(np.array([[5.0, 1.0, 0.0, 0.0]]), known, atoms, 2)
    np.testing.assert_allclose(codes, [[0.0, 1.0]], atol=1e-12)


def test_inputs_are_left_as_they_were() -> None:
    rng = np.random.default_rng(7)
    atoms, signals = random_atoms(rng, 16, 20), rng.normal(size=(4, 16))
    known = random_mask(rng, 4, 16, least=4)
    expected = masked_omp(signals.copy(), known.copy(), atoms.copy(), 3)
    for array in (atoms, signals, known):
        array.setflags(write=False)
    np.testing.assert_array_equal(masked_omp(signals, known, atoms, 3), expected)

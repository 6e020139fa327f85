import numpy as np
import pytest

from quadpatch.patches.normalisation import HEIGHTS
from quadpatch.sparse.dictionary import Dictionary
from quadpatch.types import FloatArray
from training.evaluation import complete, evaluate, join
from training.smooth_fills import disk

N = 12


def wave_atoms() -> FloatArray:
    """Build plane waves of a few frequencies and phases: a dictionary that knows waves and nothing else."""
    x, y = np.meshgrid(np.arange(N), np.arange(N))
    atoms = [
        np.cos(2 * np.pi * (u * x + v * y) / N + phase).ravel()
        for u, v in [(2, 0), (0, 2), (2, 1), (1, 2), (3, 0), (0, 3), (2, 2), (3, 1)]
        for phase in (0.0, np.pi / 2)
    ]
    stacked = np.stack(atoms, axis=1)
    return np.asarray(stacked / np.linalg.norm(stacked, axis=0))


def wave_patches(n: int = 20) -> FloatArray:
    rng = np.random.default_rng(0)
    codes = np.zeros((n, 16))
    for code in codes:
        first = 2 * rng.integers(8)
        code[first : first + 2] = rng.normal(size=2)
    return (codes @ wave_atoms().T).reshape(n, N, N)


def test_a_dictionary_that_knows_the_pattern_beats_the_thin_plate_tenfold() -> None:
    measures = evaluate(Dictionary(wave_atoms(), N, 4), wave_patches())
    assert measures["n_patches"] == 20
    for hole in ("hole_25", "hole_50"):
        assert measures[f"{hole}_to_plate"] < 0.1
        assert measures[f"{hole}_to_membrane"] < 0.1


def test_a_dictionary_of_spikes_knows_nothing_about_a_hole() -> None:
    """Spikes code known bins one by one, so the hole gets the membrane and the mean: no gain over a membrane."""
    measures = evaluate(Dictionary(np.eye(N * N), N, 10), wave_patches())
    assert measures["hole_50_to_membrane"] == pytest.approx(1.0, abs=0.05)


def test_joined_patches_meet_the_known_bins_exactly() -> None:
    known = disk(N, 0.5)
    patches = np.random.default_rng(1).normal(size=(5, N, N))
    joined = join(complete(Dictionary(wave_atoms(), N, 3), patches, known), patches, known)
    np.testing.assert_allclose(joined[:, known], patches[:, known], atol=1e-12)


def test_flat_patches_are_left_out_of_the_measures() -> None:
    patches = np.concatenate([wave_patches(), np.zeros((3, N, N))])
    dictionary = Dictionary(wave_atoms(), N, 4)
    with_flat, without = evaluate(dictionary, patches), evaluate(dictionary, patches[:20])
    assert with_flat == {**without, "n_patches": 23.0}


def test_heights_are_completed_as_they_are() -> None:
    """Depth is not taken out, and a pattern that is known is completed all the same."""
    patches = 1e-3 * wave_patches()
    measures = evaluate(Dictionary(wave_atoms(), N, 4), patches, HEIGHTS)
    assert measures["hole_50_to_plate"] < 0.1
    known = disk(N, 0.25)
    completed = complete(Dictionary(wave_atoms(), N, 4), patches, known, HEIGHTS)
    np.testing.assert_allclose(completed[:, ~known], patches[:, ~known], atol=2e-4)

import numpy as np
import pytest

from quadpatch.inpainters.paper_dictionary import (
    MIN_TRAINING_PATCHES,
    NONZERO,
    HeightsInpainter,
    learn_heights,
)
from quadpatch.options import DictionaryOptions
from quadpatch.patches.paper_layout import LEAST_KNOWN
from quadpatch.sparse.dictionary import Dictionary
from quadpatch.types import BoolArray, FloatArray, Patches

N = 12


def as_patches(heights: FloatArray, known: BoolArray) -> Patches:
    count = len(heights)
    frames, everywhere = np.tile(np.eye(3), (count, 1, 1)), np.ones(heights.shape, bool)
    return Patches(np.zeros((count, 3)), frames, 1.0, heights, known, everywhere, everywhere.astype(np.int64))


def waves(count: int, seed: int = 0) -> FloatArray:
    """Reliefs of one wavelength in any phase: four functions span them all."""
    rng = np.random.default_rng(seed)
    row, column = np.mgrid[:N, :N] * (2 * np.pi * 1.5 / N)
    phase = rng.uniform(0, 2 * np.pi, (2, count, 1, 1))
    return np.asarray(rng.uniform(0.5, 2, (count, 1, 1)) * np.sin(row + phase[0]) * np.sin(column + phase[1]))


def with_hole(count: int, seed: int = 1) -> BoolArray:
    known = np.ones((count, N, N), bool)
    for i, (row, column) in enumerate(np.random.default_rng(seed).integers(2, 6, (count, 2))):
        known[i, row : row + 4, column : column + 4] = False
    return known


def learn(heights: FloatArray, known: BoolArray, atoms: int = 60, nonzero: int = 6) -> HeightsInpainter | None:
    return learn_heights(heights, known, DictionaryOptions(atoms, nonzero), np.random.default_rng(0))


@pytest.fixture(scope="module")
def learned() -> HeightsInpainter:
    found = learn(waves(400), np.ones((400, N, N), bool))
    assert found is not None
    return found


def test_a_relief_that_was_learned_is_continued_into_the_unknown(learned: HeightsInpainter) -> None:
    truth, known = waves(50, seed=9), with_hole(50)
    flat = np.where(known, truth, 0.0)
    predicted = learned.predict(as_patches(flat, known))
    error, floor = (np.abs(guess - truth)[~known].mean() for guess in (predicted, flat))
    assert error < 0.1 * floor


def test_neither_unknown_bins_nor_the_base_heights_are_looked_at(learned: HeightsInpainter) -> None:
    truth, known = waves(20, seed=5), with_hole(20)
    noise = np.random.default_rng(0).normal(size=truth.shape)
    one, other = (
        learned.predict(as_patches(np.where(known, truth, junk), known), base_heights)
        for junk, base_heights in ((0.0, None), (100 * noise, noise))
    )
    assert (one == other).all()


def test_a_level_is_learned_and_completed_like_any_other_shape() -> None:
    """Heights are coded as they are, so that the level inside a hole is a matter of atoms."""
    levels = np.random.default_rng(0).uniform(-2, 2, (60, 1, 1)) * np.ones((60, N, N))
    found = learn(levels, np.ones(levels.shape, bool), atoms=2, nonzero=1)
    assert found is not None
    known = with_hole(60)
    np.testing.assert_allclose(found.predict(as_patches(np.where(known, levels, 0.0), known)), levels, atol=1e-12)


def test_the_completed_patch_is_few_atoms() -> None:
    """With all atoms to choose from but one to use, the answer is a projection that one can write down."""
    atoms = np.eye(N * N)
    heights, known = np.zeros((1, N, N)), np.ones((1, N, N), bool)
    heights[0, 3, 4], heights[0, 0, 0], known[0, 0, 0] = 10.0, 99.0, False
    expected = np.zeros((1, N, N))
    expected[0, 3, 4] = 10.0
    predicted = HeightsInpainter(Dictionary(atoms, N, 1)).predict(as_patches(heights, known))
    np.testing.assert_allclose(predicted, expected, atol=1e-12)


def test_deep_patches_weigh_more_than_shallow_ones() -> None:
    """Heights are not divided by their standard deviation: what is deep decides what is learned."""
    row, column = np.mgrid[:N, :N] / N
    rng = np.random.default_rng(3)
    deep = rng.normal(1, 0.2, (60, 1, 1)) * np.sin(9 * row)
    shallow = 1e-3 * rng.normal(1, 0.2, (60, 1, 1)) * np.sin(9 * column)
    mixed = np.concatenate([deep, shallow])
    found = learn(mixed, np.ones(mixed.shape, bool), atoms=2, nonzero=1)
    assert found is not None
    wave = np.sin(9 * row).ravel()
    assert np.abs(wave @ found.dictionary.atoms).max() == pytest.approx(np.linalg.norm(wave), rel=1e-6)


def test_the_dictionary_has_the_size_asked_for_but_no_more_atoms_than_patches() -> None:
    few = waves(MIN_TRAINING_PATCHES)
    found = learn(few, np.ones(few.shape, bool), atoms=500, nonzero=3)
    assert found is not None
    assert (found.dictionary.n_atoms, found.dictionary.n_nonzero, found.resolution) == (len(few), 3, N)
    usual = learn_heights(few, np.ones(few.shape, bool), DictionaryOptions(), np.random.default_rng(0))
    assert usual is not None
    assert usual.dictionary.n_nonzero == NONZERO


def test_too_few_patches_give_nothing_to_learn() -> None:
    one_less = waves(MIN_TRAINING_PATCHES - 1)
    assert learn(one_less, np.ones(one_less.shape, bool)) is None
    many, known = waves(100), np.ones((100, N, N), bool)
    assert learn(0 * many, known) is None
    known[:, : int(N * (1 - LEAST_KNOWN)) + 1] = False
    assert learn(many, known) is None


def test_the_same_patches_and_generator_give_the_same_bytes(learned: HeightsInpainter) -> None:
    again = learn(waves(400), np.ones((400, N, N), bool))
    assert again is not None
    assert again.dictionary.atoms.tobytes() == learned.dictionary.atoms.tobytes()


def test_no_patch_is_no_fault(learned: HeightsInpainter) -> None:
    none = np.zeros((0, N, N))
    assert learned.predict(as_patches(none, none > 0)).shape == (0, N, N)
    assert learn(none, none > 0) is None

import numpy as np
import pytest

from quadpatch.calibration.energy_selection import EnergyBlend
from quadpatch.calibration.training_pairs import TrainingSurface
from quadpatch.filling.fairing import THIN_PLATE
from quadpatch.inpainters.dictionary import (
    LEAST_KNOWN,
    MIN_TRAINING_PATCHES,
    PRINCIPAL_ATOMS,
    DictionaryInpainter,
    SelfDictionary,
)
from quadpatch.inpainters.inpainter import UndamagedSurface
from quadpatch.patches.scale import PatchScale
from quadpatch.patches.seeds import Seeds
from quadpatch.sparse.dictionary import Dictionary
from quadpatch.types import BoolArray, FloatArray, Patches, TriangleMesh

N = 12


def as_patches(heights: FloatArray, known: BoolArray | None = None) -> Patches:
    count = len(heights)
    known = np.ones(heights.shape, bool) if known is None else known
    frames = np.tile(np.eye(3), (count, 1, 1))
    return Patches(
        np.zeros((count, 3)), frames, 1.0, heights, known, np.ones(heights.shape, bool), np.zeros(heights.shape, int)
    )


def undamaged(patches: Patches) -> UndamagedSurface:
    """Surface over a flat base surface; dictionaries don't look at the ground."""
    flat = TriangleMesh(np.zeros((0, 3)), np.zeros((0, 3), np.int64))
    nowhere = Seeds(np.zeros((0, 3)), np.zeros((0, 3, 3)), np.zeros(0, np.int64))
    training_surface = TrainingSurface(
        flat, nowhere, PatchScale(1.0, N, 1), EnergyBlend.of_one(THIN_PLATE), np.ones(1), 0.1
    )
    return UndamagedSurface(patches, 0 * patches.heights, lambda: training_surface)


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


@pytest.fixture(scope="module")
def learned() -> DictionaryInpainter:
    heights = waves(400)
    found = SelfDictionary().fitted_to(undamaged(as_patches(heights)))
    assert found is not None
    return found


def test_a_texture_that_was_learned_is_continued_into_the_unknown(learned: DictionaryInpainter) -> None:
    truth, known = waves(50, seed=9), with_hole(50)
    flat = np.where(known, truth, 0.0)
    predicted = learned.predict(as_patches(flat, known), 0 * flat)
    error, floor = (np.abs(guess - truth)[~known].mean() for guess in (predicted, flat))
    assert error < 0.1 * floor


def test_what_stands_in_unknown_bins_is_not_looked_at(learned: DictionaryInpainter) -> None:
    truth, known = waves(20, seed=5), with_hole(20)
    noise = np.random.default_rng(0).normal(size=truth.shape)
    one, other = (
        learned.predict(as_patches(np.where(known, truth, junk), known), 0 * truth) for junk in (0.0, 100 * noise)
    )
    assert (one == other).all()


def test_the_base_heights_are_carried_and_only_the_detail_is_coded(learned: DictionaryInpainter) -> None:
    truth, known = waves(20, seed=5), with_hole(20)
    base_heights = np.random.default_rng(2).normal(0, 5, truth.shape)
    plain = learned.predict(as_patches(truth, known), 0 * truth)
    carried = learned.predict(as_patches(truth + base_heights, known), base_heights)
    np.testing.assert_allclose(carried, plain + base_heights, atol=1e-9)


def test_predictions_grow_and_shift_with_the_heights(learned: DictionaryInpainter) -> None:
    truth, known = waves(20, seed=5), with_hole(20)
    plain = learned.predict(as_patches(truth, known), 0 * truth)
    changed = learned.predict(as_patches(1000 * truth + 7, known), 0 * truth)
    np.testing.assert_allclose(changed, 1000 * plain + 7, rtol=1e-9, atol=1e-6)


def test_a_patch_without_any_known_bin_gets_its_base_heights(learned: DictionaryInpainter) -> None:
    truth = waves(2)
    known = np.zeros(truth.shape, bool)
    base_heights = np.full(truth.shape, 3.0)
    assert (learned.predict(as_patches(truth, known), base_heights) == base_heights).all()


def test_a_flat_patch_stays_flat(learned: DictionaryInpainter) -> None:
    base_heights = waves(3)
    predicted = learned.predict(as_patches(base_heights + 0.25, with_hole(3)), base_heights)
    np.testing.assert_allclose(predicted, base_heights + 0.25, atol=1e-12)


def test_the_same_patches_give_the_same_dictionary() -> None:
    heights = waves(100)
    one, same = (SelfDictionary().fitted_to(undamaged(as_patches(heights))) for _ in range(2))
    assert one is not None
    assert same is not None
    assert one.dictionary.atoms.tobytes() == same.dictionary.atoms.tobytes()


def test_a_dictionary_from_elsewhere_learns_how_much_this_mesh_uses_each_atom(learned: DictionaryInpainter) -> None:
    heights = waves(200, seed=3)
    atoms = learned.dictionary.atoms
    strangers = np.linalg.qr(np.random.default_rng(0).normal(size=(N * N, N * N - atoms.shape[1])))[0]
    mixed = Dictionary(np.concatenate([atoms, strangers], axis=1), N, 4)
    fitted = DictionaryInpainter(mixed).fitted_to(undamaged(as_patches(heights)))
    # What this mesh uses comes first: the waves, not the strangers.
    common = fitted.dictionary.atoms[:, :4]
    assert np.linalg.norm(atoms.T @ common, axis=0).min() > 0.95
    truth, known = waves(50, seed=9), with_hole(50)
    flat = np.where(known, truth, 0.0)
    predicted = fitted.predict(as_patches(flat, known), 0 * flat)
    assert np.abs(predicted - truth)[~known].mean() < 0.2 * np.abs(truth)[~known].mean()


def test_without_surface_to_fit_to_a_dictionary_stays_as_it_is(learned: DictionaryInpainter) -> None:
    plain = DictionaryInpainter(learned.dictionary)
    few = waves(MIN_TRAINING_PATCHES - 1)
    assert plain.fitted_to(undamaged(as_patches(few))) is plain


def test_unknown_bins_are_not_learned_from() -> None:
    heights, known = waves(200), with_hole(200)
    junk = np.where(known, heights, 1e6)
    clean, dirty = (SelfDictionary().fitted_to(undamaged(as_patches(part, known))) for part in (heights, junk))
    assert clean is not None
    assert dirty is not None
    assert clean.dictionary.atoms.tobytes() == dirty.dictionary.atoms.tobytes()


def test_atoms_are_of_unit_length_and_no_more_than_the_texture_needs() -> None:
    for count in (MIN_TRAINING_PATCHES, 400):
        heights = waves(count)
        found = SelfDictionary().fitted_to(undamaged(as_patches(heights)))
        assert found is not None
        assert found.resolution == N
        # Four functions span these waves, less the mean of each patch, in any of the eight turns.
        assert 4 <= found.dictionary.n_atoms <= min(PRINCIPAL_ATOMS, 12)
        np.testing.assert_allclose(np.linalg.norm(found.dictionary.atoms, axis=0), 1, rtol=1e-12)


@pytest.mark.parametrize("why", ["too few", "flat", "too little known"])
def test_nothing_to_learn_from_is_no_dictionary(why: str) -> None:
    heights = waves(MIN_TRAINING_PATCHES - 1 if why == "too few" else 100)
    known = np.ones(heights.shape, bool)
    if why == "flat":
        heights[:] = 3.0
    if why == "too little known":
        known[:, : int(N * (1 - LEAST_KNOWN)) + 1] = False
    patches = as_patches(heights, known)
    assert SelfDictionary().fitted_to(undamaged(patches)) is None


def test_no_patch_at_all_needs_no_prediction(learned: DictionaryInpainter) -> None:
    nothing = np.zeros((0, N, N))
    assert learned.predict(as_patches(nothing), nothing).shape == (0, N, N)
    assert SelfDictionary().fitted_to(undamaged(as_patches(nothing))) is None


def test_the_resolution_is_that_of_the_dictionary() -> None:
    atoms = np.eye(64)[:, :5]
    assert DictionaryInpainter(Dictionary(atoms, 8, 2)).resolution == 8

import numpy as np
import pytest

from quadpatch.compression.patch_dictionary import cosine_atoms, learned_atoms, model_atoms
from quadpatch.sparse.dictionary import Dictionary


def signals(seed: int = 0) -> np.ndarray:
    """Patches of 9 x 9 that are mixtures of three shapes and a little noise."""
    rng = np.random.default_rng(seed)
    shapes = cosine_atoms(9)[:, [1, 4, 7]]
    return np.asarray(rng.normal(size=(300, 3)) * [3.0, 2.0, 1.0] @ shapes.T + rng.normal(0, 0.01, (300, 81)))


def test_cosines_are_orthonormal_and_start_with_the_constant() -> None:
    atoms = cosine_atoms(9)
    assert np.allclose(atoms.T @ atoms, np.eye(81))
    assert np.allclose(atoms[:, 0], 1 / 9)


def test_learned_atoms_are_orthonormal_however_coarsely_they_are_written() -> None:
    atoms = learned_atoms(signals(), 0.5).atoms()
    gram = atoms.T @ atoms
    is_used = np.diag(gram) > 0.5
    assert np.allclose(gram[np.ix_(is_used, is_used)], np.eye(is_used.sum()))


def test_the_three_shapes_are_found() -> None:
    atoms = learned_atoms(signals(), 0.2).atoms()
    assert atoms.shape[1] == 4
    left = signals() - signals() @ atoms @ atoms.T
    assert np.linalg.norm(left) < 0.05 * np.linalg.norm(signals())


def test_a_finer_step_keeps_more_atoms() -> None:
    assert len(learned_atoms(signals(), 0.01).exponents) > len(learned_atoms(signals(), 1.0).exponents)


@pytest.mark.parametrize("resolution", [5, 8, 17])
def test_atoms_of_a_model_are_read_at_the_grid_and_have_unit_norm(resolution: int) -> None:
    rng = np.random.default_rng(3)
    atoms = rng.normal(size=(64, 10))
    dictionary = Dictionary(np.asarray(atoms / np.linalg.norm(atoms, axis=0)), 8, 3)
    found = model_atoms(dictionary, resolution)
    assert found.shape == (resolution**2, 11)
    assert np.allclose(np.linalg.norm(found, axis=0), 1.0)


def test_a_slope_stays_a_slope_at_another_resolution() -> None:
    column = np.repeat(np.arange(16.0)[np.newaxis] - 7.5, 16, axis=0).reshape(-1, 1)
    dictionary = Dictionary(np.asarray(column / np.linalg.norm(column)), 16, 1)
    found = model_atoms(dictionary, 5)[:, 1].reshape(5, 5)
    assert (np.diff(found, axis=1) > 0).all()
    assert np.allclose(found, found[:1])

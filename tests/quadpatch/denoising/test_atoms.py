import numpy as np
import pytest

from quadpatch.denoising.atoms import N_NEAREST, DictionaryAtoms, Exemplars, lay_patches, smooth_heights
from quadpatch.errors import NoQuadsError
from quadpatch.inpainters.model_file import load_model, shipped_model
from quadpatch.mesh.measures import mean_edge_length
from quadpatch.patches.scale import PatchScale
from quadpatch.types import FloatArray, TriangleMesh
from tests.quadpatch.shapes import relief


def test_a_patch_is_no_example_for_itself() -> None:
    mesh = relief(50)
    patches = lay_patches(mesh, PatchScale(7 * mean_edge_length(mesh), 11, 1))
    own = Exemplars.of(patches, patches, True, np.random.default_rng(0))
    others = Exemplars.of(patches, patches, False, np.random.default_rng(0))
    level_free = patches.heights[0].ravel() - own.levels[0]
    (_, rows), (_, with_itself) = next(own.of_patches(np.array([0]))), next(others.of_patches(np.array([0])))
    assert rows.shape == (N_NEAREST, 121)
    assert _distance_to(level_free, own, rows) > 1e-9
    assert _distance_to(level_free, others, with_itself) < 1e-9


def _distance_to(signal: FloatArray, exemplars: Exemplars, rows: FloatArray) -> float:
    mean = next(exemplars.of_patches(np.array([0])))[0] - exemplars.levels[0]
    found = mean + rows * np.sqrt(N_NEAREST - 1)
    return float(np.abs(found - signal).max(axis=1).min())


def test_a_dictionary_gives_all_patches_the_same_atoms_in_their_own_size() -> None:
    mesh = relief(60)
    dictionary = load_model(shipped_model("general-dictionary")).dictionary
    assert dictionary is not None
    scale = PatchScale(0.65 * dictionary.resolution * mean_edge_length(mesh), dictionary.resolution, 0)
    patches = lay_patches(mesh, scale)
    atoms = DictionaryAtoms.of(patches, smooth_heights(mesh, patches, scale, False), dictionary)
    (_, first), (_, second) = atoms.of_patches(np.array([0, 1]))
    assert np.allclose(first * atoms.deviations[1], second * atoms.deviations[0])


def test_triangles_of_too_different_size_are_refused_before_they_fill_the_memory() -> None:
    mesh = relief(50)
    giant = np.array([[0.0, 0, 0], [1e6, 0, 0], [0, 1e6, 0]])
    both = TriangleMesh(
        np.concatenate([mesh.vertices, giant]),
        np.concatenate([mesh.triangles, len(mesh.vertices) + np.arange(3)[None]]),
    )
    with pytest.raises(NoQuadsError, match="too much in size"):
        lay_patches(both, PatchScale(7 * mean_edge_length(mesh), 11, 1))

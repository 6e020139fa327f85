"""Also tests `quadpatch.reconstruction.surface_layout` (quadpatch/reconstruction/surface_layout.py)."""

import math

import numpy as np
import pytest

from quadpatch.errors import NoQuadsError, OptionError, StageError
from quadpatch.mesh.measures import diagonal
from quadpatch.options import DictionaryOptions, PatchOptions
from quadpatch.patches.normalisation import NORMALISATION
from quadpatch.reconstruction.coding import PatchDictionary
from quadpatch.reconstruction.whole_surface import (
    Reconstruction,
    ReconstructOptions,
    peak_signal_to_noise,
    reconstruct,
)
from quadpatch.sparse.dictionary import Dictionary
from quadpatch.types import TriangleMesh
from tests.quadpatch.shapes import joined, moved, open_grid, relief, sphere

# One atom for every bin: any height map can be coded without an error.
COMPLETE = PatchDictionary(Dictionary(np.eye(64), 8, 64))
SMALL = ReconstructOptions(PatchOptions(resolution=8), DictionaryOptions(atoms=24, nonzero=6))


@pytest.fixture(scope="module")
def rough() -> TriangleMesh:
    return relief(40)


@pytest.fixture(scope="module")
def rebuilt(rough: TriangleMesh) -> Reconstruction:
    return reconstruct(rough, None, SMALL)


def test_a_complete_dictionary_gives_a_plane_back_exactly() -> None:
    plane = open_grid(30)
    result = reconstruct(plane, COMPLETE)
    assert result.seen.mean() > 0.9
    np.testing.assert_allclose(result.vertices, plane.vertices, atol=1e-5)


def test_codes_give_a_relief_back_within_a_fraction_of_its_depth(rebuilt: Reconstruction, rough: TriangleMesh) -> None:
    assert rebuilt.rms < 0.1 * np.ptp(rough.vertices[:, 2])
    assert rebuilt.psnr == 20 * math.log10(diagonal(rough) / rebuilt.rms)
    assert rebuilt.psnr > 45


def test_the_error_is_how_far_each_vertex_moved(rebuilt: Reconstruction, rough: TriangleMesh) -> None:
    np.testing.assert_array_equal(rebuilt.error, np.linalg.norm(rebuilt.vertices - rough.vertices, axis=1))
    assert rebuilt.rms == np.sqrt((rebuilt.error[rebuilt.seen] ** 2).mean())


def test_a_code_uses_no_more_atoms_than_it_may(rebuilt: Reconstruction) -> None:
    codes = rebuilt.coded.codes.codes
    assert codes.shape == (len(rebuilt.coded.sampled.patches), 24)
    assert (codes != 0).sum(axis=1).max() <= 6


def test_more_atoms_in_a_code_leave_less_error(rebuilt: Reconstruction, rough: TriangleMesh) -> None:
    fewer = ReconstructOptions(SMALL.patches, DictionaryOptions(atoms=24, nonzero=2))
    assert rebuilt.rms < reconstruct(rough, None, fewer).rms


def test_the_same_mesh_and_seed_give_the_same_bits(rebuilt: Reconstruction, rough: TriangleMesh) -> None:
    again = reconstruct(rough, None, SMALL)
    assert again.vertices.tobytes() == rebuilt.vertices.tobytes()


def test_vertices_that_no_patch_sees_keep_their_place() -> None:
    mesh = joined(open_grid(30), TriangleMesh(np.array([[100.0, 0, 0]]), np.zeros((0, 3), np.int64)))
    result = reconstruct(mesh, COMPLETE)
    assert not result.seen[-1]
    assert result.error[-1] == 0
    assert result.vertices[-1].tolist() == [100.0, 0, 0]


def test_a_rod_that_is_too_thin_for_the_quads_is_seen_all_the_same() -> None:
    rod = TriangleMesh(sphere(3).vertices * [0.6, 0.6, 3.0], sphere(3).triangles)
    result = reconstruct(joined(sphere(4, radius=5.0), moved(rod, (20.0, 0.0, 0.0))), COMPLETE)
    assert not (result.coded.layout.seeds.origins[:, 0] > 10).any()
    assert result.seen[-len(rod.vertices) :].mean() > 0.95


def test_a_dictionary_of_detail_rebuilds_over_the_smoothed_surface(rough: TriangleMesh) -> None:
    detail = PatchDictionary(Dictionary(np.eye(64), 8, 64), NORMALISATION)
    result = reconstruct(rough, detail)
    assert result.rms < 0.1 * np.ptp(rough.vertices[:, 2])
    assert result.coded.sampled.base_heights.any()


def test_no_patch_is_learned_from_a_mesh_of_a_few_of_them() -> None:
    with pytest.raises(StageError, match="too few"):
        reconstruct(open_grid(30), None, ReconstructOptions(PatchOptions(length=14.0, overlap=0)))


def test_a_mesh_that_carries_no_quad_is_refused() -> None:
    with pytest.raises(NoQuadsError):
        reconstruct(sphere(1), COMPLETE, ReconstructOptions(PatchOptions(length=50.0)))


def test_another_resolution_than_that_of_the_model_is_refused(rough: TriangleMesh) -> None:
    with pytest.raises(OptionError, match="16"):
        reconstruct(rough, COMPLETE, ReconstructOptions(PatchOptions(resolution=16)))


def test_options_come_from_plain_values() -> None:
    options = ReconstructOptions.from_dict({"patches": {"length": 2.0}, "dictionary": {"atoms": 50}, "seed": 3})
    assert options == ReconstructOptions(PatchOptions(length=2.0), DictionaryOptions(atoms=50), 3)


@pytest.mark.parametrize("values", [{"colour": 1}, {"patches": {"size": 1}}, {"seed": -1}, {"seed": True}])
def test_unknown_names_and_bad_seeds_are_refused(values: dict[str, object]) -> None:
    with pytest.raises(OptionError):
        ReconstructOptions.from_dict(values)


def test_psnr_of_no_error_is_infinite() -> None:
    assert peak_signal_to_noise(0.0, 1.0) == math.inf
    assert peak_signal_to_noise(0.001, 1.0) == pytest.approx(60)

import numpy as np
import pytest

from quadpatch.errors import OptionError, StageError
from quadpatch.inpainters.dictionary import SelfDictionary
from quadpatch.mesh.distance import distance_to_mesh
from quadpatch.options import PatchOptions
from quadpatch.restoration.placements import BASE_SURFACE, EDGE_NORMALS, LEAST_SQUARES
from quadpatch.restoration.restore import Restoration, RestoreOptions, restore
from quadpatch.types import BoolArray, TriangleMesh
from tests.quadpatch.restoration.boxes import scattered, step
from tests.quadpatch.shapes import joined, moved, relief, sphere


def without(mesh: TriangleMesh, missing: BoolArray) -> TriangleMesh:
    return TriangleMesh(np.where(missing[:, None], np.nan, mesh.vertices), mesh.triangles)


@pytest.fixture(scope="module")
def part() -> TriangleMesh:
    return step(41)


@pytest.fixture(scope="module")
def missing(part: TriangleMesh) -> BoolArray:
    return scattered(part, 0.3)


@pytest.fixture(scope="module")
def restored(part: TriangleMesh, missing: BoolArray) -> Restoration:
    return restore(without(part, missing), missing)


def test_measured_vertices_keep_their_bits(restored: Restoration, part: TriangleMesh, missing: BoolArray) -> None:
    assert restored.vertices[~missing].tobytes() == part.vertices[~missing].tobytes()
    assert np.isfinite(restored.vertices).all()
    np.testing.assert_array_equal(restored.restored, missing)


def test_a_part_with_edges_is_restored_by_its_normals(
    restored: Restoration, part: TriangleMesh, missing: BoolArray
) -> None:
    assert restored.placement == EDGE_NORMALS
    rms = float(np.sqrt((distance_to_mesh(restored.vertices[missing], part) ** 2).mean()))
    smooth = restored.trials[LEAST_SQUARES]
    assert rms < 0.2 * smooth


def test_the_same_mesh_and_seed_give_the_same_bits(
    restored: Restoration, part: TriangleMesh, missing: BoolArray
) -> None:
    garbage = TriangleMesh(np.where(missing[:, None], 1e300, part.vertices), part.triangles)
    assert restore(garbage, missing).vertices.tobytes() == restored.vertices.tobytes()


def test_patches_are_believed_where_they_bring_hidden_vertices_closer() -> None:
    rough = relief(80, depth=0.08, waves=8)
    missing = scattered(rough, 0.7)
    options = RestoreOptions(PatchOptions(resolution=16))
    result = restore(without(rough, missing), missing, SelfDictionary(), options)
    plain = restore(without(rough, missing), missing, None, options)
    by_patches, by_geometry = (root_mean_square(r, rough) for r in (result, plain))
    assert result.blend_factor == 1
    assert result.trials["patches"] < 0.8 * result.trials[result.placement]
    assert by_patches < 0.8 * by_geometry
    expected = float(np.sqrt((result.expected_error[missing] ** 2).mean()))
    assert 0.7 < expected / by_patches < 1.4
    assert not result.expected_error[~missing].any()


def root_mean_square(result: Restoration, truth: TriangleMesh) -> float:
    return float(np.sqrt((distance_to_mesh(result.vertices[result.restored], truth) ** 2).mean()))


def test_a_coarse_mesh_is_a_way_of_its_own() -> None:
    ball = sphere(5)
    missing = (ball.vertices[:, 2] > 0.8) | scattered(ball, 0.1)
    result = restore(without(ball, missing), missing, coarse=sphere(4, radius=0.98))
    assert BASE_SURFACE in result.trials
    error = np.abs(np.linalg.norm(result.vertices[missing], axis=1) - 1)
    assert error.mean() < 0.01


def test_pieces_without_a_measured_vertex_stay_as_they_came() -> None:
    mesh = joined(sphere(3), moved(sphere(1), (5.0, 0, 0)))
    missing = mesh.vertices[:, 0] > 2
    missing[:50] = True
    result = restore(without(mesh, missing), missing)
    assert result.out_of_reach.sum() == len(sphere(1).vertices)
    assert np.isnan(result.vertices[result.out_of_reach]).all()
    assert np.isfinite(result.vertices[~result.out_of_reach]).all()


def test_a_mesh_that_is_missing_whole_is_refused() -> None:
    ball = sphere(2)
    with pytest.raises(StageError, match="no missing vertex"):
        restore(ball, np.ones(len(ball.vertices), bool))


def test_a_small_mesh_has_no_expected_error() -> None:
    ball = sphere(2)
    missing = scattered(ball, 0.2)
    result = restore(without(ball, missing), missing)
    assert np.isnan(result.expected_error[missing]).all()
    assert result.warnings


def test_the_poisson_surface_is_tried_where_it_is_asked_for() -> None:
    ball = sphere(4)
    missing = scattered(ball, 0.5)
    result = restore(without(ball, missing), missing, options=RestoreOptions(base="poisson"))
    assert BASE_SURFACE in result.trials


@pytest.mark.parametrize("values", [{"colour": 1}, {"patches": {"size": 1}}, {"seed": -1}, {"base": "sphere"}])
def test_unknown_names_and_bad_values_are_refused(values: dict[str, object]) -> None:
    with pytest.raises(OptionError):
        RestoreOptions.from_dict(values)


def test_options_come_from_plain_values() -> None:
    assert RestoreOptions.from_dict({"patches": {"length": 2.0}, "seed": 3}) == RestoreOptions(
        PatchOptions(length=2.0), 3
    )

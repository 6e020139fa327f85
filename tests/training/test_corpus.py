from dataclasses import replace

import numpy as np
import pytest

from quadpatch.mesh.measures import mean_edge_length
from quadpatch.patches.normalisation import HEIGHTS
from quadpatch.types import TriangleMesh
from training.corpus import LEAST_KNOWN, PatchRecipe, TrainingPatches, cut_patches, turn_at_random
from training.procedural import relief_mesh

RECIPE = PatchRecipe(resolution=12, scales=(1.0, 1.5), max_seeds=60)


@pytest.fixture(scope="module")
def relief() -> TriangleMesh:
    return relief_mesh("waves", np.random.default_rng(0), 50)


def test_patches_show_the_relief_and_are_known_almost_everywhere(relief: TriangleMesh) -> None:
    patches = cut_patches(relief, RECIPE, np.random.default_rng(1))
    assert 30 < len(patches) <= 120
    assert patches.detail.shape[1:] == (12, 12)
    assert (patches.known.mean(axis=(1, 2)) >= LEAST_KNOWN).all()
    assert (patches.detail[~patches.known] == 0.0).all()
    assert np.isfinite(patches.detail).all()
    assert patches.is_clean.any()


def test_detail_is_measured_from_the_base_surface_and_not_from_the_plane_of_the_patch(relief: TriangleMesh) -> None:
    """Bending a sheet with the same relief leaves its detail nearly alone: the base surface bends with it."""
    x, y, z = relief.vertices.T
    bent = TriangleMesh(np.stack([x, y, z + 0.01 * x**2], axis=1), relief.triangles)
    plain, lifted = (cut_patches(mesh, RECIPE, np.random.default_rng(1)) for mesh in (relief, bent))
    assert lifted.detail.std() < 1.5 * plain.detail.std()


def test_heights_are_measured_from_the_plane_of_the_patch_where_they_are_asked_for(relief: TriangleMesh) -> None:
    """A smooth trough c x^2 has no detail, but its heights spread by c L^2 / (6 sqrt 5), askew by 1.32 times that."""
    x, y, _ = relief.vertices.T
    trough = TriangleMesh(np.stack([x, y, 0.005 * x**2], axis=1), relief.triangles)
    recipe = PatchRecipe(resolution=24, length=10.0, scales=(1.0,), max_seeds=60, normalisation=HEIGHTS)
    patches = cut_patches(trough, recipe, np.random.default_rng(1))
    assert len(patches) > 10
    deviation = 10.0 * patches.detail[patches.is_clean].std(axis=(1, 2))
    along = 0.005 * 10**2 / (6 * np.sqrt(5))
    # Smoothing bends the border of an open sheet, and tilts the quads that lie there.
    assert 0.9 * along < np.median(deviation) < 2.5 * along


def test_a_smooth_sheet_has_nothing_to_learn(relief: TriangleMesh) -> None:
    flat = TriangleMesh(relief.vertices * (1.0, 1.0, 0.0), relief.triangles)
    assert len(cut_patches(flat, RECIPE, np.random.default_rng(1))) == 0


def test_a_mesh_too_small_for_a_patch_gives_none(relief: TriangleMesh) -> None:
    recipe = PatchRecipe(resolution=12, length=1000.0 * mean_edge_length(relief))
    assert len(cut_patches(relief, recipe, np.random.default_rng(1))) == 0


def test_same_generator_same_patches(relief: TriangleMesh) -> None:
    one, two = (cut_patches(relief, RECIPE, np.random.default_rng(3)) for _ in range(2))
    np.testing.assert_array_equal(one.detail, two.detail)
    np.testing.assert_array_equal(one.known, two.known)


def test_turning_moves_known_bins_with_their_detail_and_reaches_all_eight_turns() -> None:
    grid = np.arange(9.0).reshape(3, 3)
    patches = TrainingPatches(np.repeat(grid[None], 200, axis=0), np.repeat(grid[None] > 2.0, 200, axis=0))
    rotated = turn_at_random(patches, np.random.default_rng(0))
    assert len(np.unique(rotated.detail.reshape(200, 9), axis=0)) == 8
    np.testing.assert_array_equal(rotated.known, rotated.detail > 2.0)
    np.testing.assert_array_equal(np.sort(rotated.detail.reshape(200, 9)), np.tile(np.arange(9.0), (200, 1)))


def test_patches_of_a_size_are_the_same_whichever_other_sizes_are_cut_with_them(relief: TriangleMesh) -> None:
    narrow, wide, both = (
        cut_patches(relief, replace(RECIPE, scales=scales), np.random.default_rng(1))
        for scales in ((1.0,), (1.5,), (1.0, 1.5))
    )
    assert len(narrow) > 0
    assert len(wide) > 0
    np.testing.assert_array_equal(both.detail, np.concatenate([narrow.detail, wide.detail]))

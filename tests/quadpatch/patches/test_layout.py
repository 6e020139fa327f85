import numpy as np
import pytest

from quadpatch.errors import NoQuadsError
from quadpatch.filling.fairing import THIN_PLATE
from quadpatch.filling.fill import close_holes, fair_holes
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.mesh.boundary import boundary_loops
from quadpatch.mesh.smoothing import laplacian_smooth
from quadpatch.patches.layout import lay_out, patchify, pick, pick_patches, seeds_near, take
from quadpatch.patches.scale import PatchScale
from quadpatch.patches.seeds import Seeds
from quadpatch.types import TriangleMesh
from tests.quadpatch.shapes import bumpy_plate, open_grid, punched, sphere

SCALE = PatchScale(0.4, 16, 1)


@pytest.fixture(scope="module")
def filled() -> FilledMesh:
    mesh = punched(bumpy_plate(60, 2.0), (0.2, 0.1, 0), radius=0.2)
    loop = min(boundary_loops(mesh.triangles).loops, key=len)
    return fair_holes(close_holes(mesh, [loop]), THIN_PLATE)


@pytest.fixture(scope="module")
def base_surface(filled: FilledMesh) -> TriangleMesh:
    return laplacian_smooth(filled.mesh, 10)


def test_every_quad_of_the_patch_length_carries_its_seeds(base_surface: TriangleMesh) -> None:
    seeds = lay_out(base_surface, SCALE)
    n_quads = len(np.unique(seeds.quad))
    assert len(seeds) == 5 * n_quads
    assert 0.6 * 4 / 0.4**2 < n_quads < 1.5 * 4 / 0.4**2
    assert (seeds.frames[:, 2, 2] > 0.8).all()


def test_a_surface_smaller_than_a_quad_has_no_layout() -> None:
    with pytest.raises(NoQuadsError):
        lay_out(open_grid(4, 0.1), PatchScale(1.0, 16, 1))


def test_patches_hold_the_surface_and_its_base_surface_and_know_what_was_measured(
    filled: FilledMesh, base_surface: TriangleMesh
) -> None:
    places = np.array([[0.2, 0.1, 0.0], [-0.5, -0.5, 0.0]])
    sampled = patchify(filled, base_surface, Seeds(places, np.tile(np.eye(3), (2, 1, 1)), np.arange(2)), SCALE)
    over_hole, elsewhere = sampled.patches.known
    assert elsewhere.all()
    assert not over_hole[6:10, 6:10].any()
    assert over_hole[[0, 0, -1, -1], [0, -1, 0, -1]].all()
    # The detail over the base surface is small, and is there.
    detail = np.abs(sampled.patches.heights - sampled.base_heights)
    assert 0 < detail.mean() < 0.1 * np.ptp(sampled.patches.heights)


def test_bins_outside_of_the_scan_are_unknown(filled: FilledMesh, base_surface: TriangleMesh) -> None:
    corner = Seeds(np.array([[1.0, 0.0, 0.0]]), np.eye(3)[None], np.zeros(1, np.int64))
    (known,) = patchify(filled, base_surface, corner, SCALE).patches.known
    assert known[:, :7].all()
    assert not known[:, 9:].any()


def test_seeds_are_near_if_a_point_lies_within_the_circle_around_their_patch() -> None:
    places = np.array([[0.0, 0, 0], [0.7, 0, 0], [0.71, 0, 0], [5, 5, 5]])
    seeds = Seeds(places, np.tile(np.eye(3), (4, 1, 1)), np.arange(4))
    assert seeds_near(seeds, np.zeros((1, 3)), 1.0).tolist() == [True, True, False, False]
    assert not seeds_near(seeds, np.zeros((0, 3)), 1.0).any()
    some = take(seeds, np.array([3, 1]))
    assert some.quad.tolist() == [3, 1]
    assert (some.origins == places[[3, 1]]).all()


def test_picked_patches_keep_what_belongs_to_them(filled: FilledMesh, base_surface: TriangleMesh) -> None:
    sampled = patchify(filled, base_surface, lay_out(base_surface, SCALE), SCALE)
    which = np.arange(len(sampled.patches)) % 3 == 1
    some = pick(sampled, which)
    assert len(some.patches) == which.sum()
    assert (some.base_heights == sampled.base_heights[which]).all()
    for picked in (some.patches, pick_patches(sampled.patches, which)):
        for name in ("origins", "frames", "heights", "known", "seen", "triangle"):
            np.testing.assert_array_equal(getattr(picked, name), getattr(sampled.patches, name)[which])
        assert picked.length == SCALE.length


def test_a_closed_surface_is_covered_all_over() -> None:
    ball = sphere(4)
    nothing = fair_holes(close_holes(ball, []), THIN_PLATE)
    sampled = patchify(nothing, ball, lay_out(ball, SCALE), SCALE)
    assert sampled.patches.known.mean() > 0.95
    assert np.linalg.norm(sampled.patches.origins, axis=1).min() > 0.9

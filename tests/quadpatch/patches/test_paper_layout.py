import numpy as np
import pytest

from quadpatch.errors import NoQuadsError
from quadpatch.mesh.distance import distance_to_mesh
from quadpatch.patches.paper_layout import (
    LEAST_KNOWN,
    cut_patches,
    is_learnable,
    learnable,
    seeds_on_surface,
    smooth_for_quads,
)
from quadpatch.patches.scale import PatchScale
from quadpatch.types import Patches
from tests.quadpatch.shapes import open_grid, punched, sphere

SCALE = PatchScale(0.4, 8, 1)


def test_seed_points_lie_on_the_smoothed_surface() -> None:
    ball = sphere(3)
    for overlap in (0, 1, 7):
        seeds = seeds_on_surface(ball, PatchScale(0.4, 8, overlap))
        assert len(seeds) % (4 * overlap + 1) == 0
        assert distance_to_mesh(seeds.origins, ball).max() < 1e-6


def test_what_is_cut_is_known_well_enough_and_drawn_the_same_every_time() -> None:
    mesh = punched(sphere(4), (0, 0, 1), radius=0.5)
    smoothed = smooth_for_quads(mesh)
    one, two = (learnable(cut_patches(mesh, smoothed, SCALE, np.random.default_rng(0))) for _ in range(2))
    assert one.heights.tobytes() == two.heights.tobytes()
    assert len(one) > 20
    assert (one.known.mean(axis=(1, 2)) >= LEAST_KNOWN).all()


def test_a_limit_picks_some_of_the_places() -> None:
    mesh = sphere(3)
    some = cut_patches(mesh, mesh, SCALE, np.random.default_rng(0), 20)
    assert len(some) == 20


def test_patches_that_are_no_height_map_or_hardly_known_teach_nothing() -> None:
    heights = np.zeros((3, 8, 8))
    heights[1, :, ::2] = 1.0  # to and fro over ten bins
    known = np.ones((3, 8, 8), bool)
    known[2, :3] = False
    patches = Patches(
        np.zeros((3, 3)), np.tile(np.eye(3), (3, 1, 1)), 0.8, heights, known, known, np.full(known.shape, -1)
    )
    assert is_learnable(patches).tolist() == [True, False, False]


def test_a_mesh_too_small_for_a_quad_is_an_error() -> None:
    mesh = open_grid(3)
    with pytest.raises(NoQuadsError):
        cut_patches(mesh, mesh, PatchScale(1e6, 8, 1), np.random.default_rng(0))

import numpy as np

from quadpatch.patches.gaps import SPACING, gap_seeds
from quadpatch.patches.seeds import Seeds
from tests.quadpatch.shapes import open_grid, sphere


def of_one_quad() -> Seeds:
    return Seeds(np.zeros((1, 3)), np.eye(3)[None], np.array([7], np.int64))


def test_surface_without_a_gap_gets_no_patch() -> None:
    grid = open_grid(9)
    assert len(gap_seeds(grid, np.zeros(81, bool), of_one_quad(), 2.0)) == 0


def test_every_unseen_vertex_has_a_patch_within_a_cell() -> None:
    ball = sphere(3)
    unseen = ball.vertices[:, 2] > 0
    seeds = gap_seeds(ball, unseen, of_one_quad(), 0.6)
    distance = np.linalg.norm(ball.vertices[unseen][:, None] - seeds.origins[None], axis=2).min(axis=1)
    assert distance.max() <= np.sqrt(3) * SPACING * 0.6
    assert len(seeds) < unseen.sum()
    assert (seeds.quad == 7).all()


def test_frames_are_right_handed_and_look_outwards() -> None:
    ball = sphere(3)
    seeds = gap_seeds(ball, np.ones(len(ball.vertices), bool), of_one_quad(), 0.6)
    turned = seeds.frames @ np.transpose(seeds.frames, (0, 2, 1))
    np.testing.assert_allclose(turned, np.tile(np.eye(3), (len(seeds), 1, 1)), atol=1e-12)
    np.testing.assert_allclose(np.linalg.det(seeds.frames), 1.0)
    assert (np.einsum("ij,ij->i", seeds.frames[:, 2], seeds.origins) > 0.99).all()


def test_a_patch_is_turned_like_the_nearest_quad() -> None:
    grid = open_grid(9)
    angle = 0.3
    x, y = np.array([np.cos(angle), np.sin(angle), 0]), np.array([-np.sin(angle), np.cos(angle), 0])
    quad = Seeds(np.zeros((1, 3)), np.stack([x, y, [0, 0, 1.0]])[None], np.zeros(1, np.int64))
    seeds = gap_seeds(grid, np.ones(81, bool), quad, 3.0)
    np.testing.assert_allclose(seeds.frames, np.tile(quad.frames, (len(seeds), 1, 1)), atol=1e-12)

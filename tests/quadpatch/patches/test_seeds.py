import numpy as np
import pytest

from quadpatch.mesh.raycast import RayScene
from quadpatch.patches.seeds import project_seeds, seed_points
from quadpatch.quads.frames import quad_frames
from quadpatch.types import QuadMesh, TriangleMesh


def two_quads() -> QuadMesh:
    vertices = np.array([[0, 0, 0], [2, 0, 0], [4, 0, 0], [0, 2, 0], [2, 2, 0], [4, 2, 0]], dtype=float)
    return QuadMesh(vertices, np.array([[0, 1, 4, 3], [1, 2, 5, 4]]))


def bump(n: int = 80) -> TriangleMesh:
    """Paraboloid z = 0.1 (x² + y²) over a square around the origin."""
    x, y = np.meshgrid(np.linspace(-5, 5, n), np.linspace(-5, 5, n))
    index = np.arange(n * n).reshape(n, n)
    a, b, c, d = (part.ravel() for part in (index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]))
    triangles = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    return TriangleMesh(np.stack([x.ravel(), y.ravel(), 0.1 * (x**2 + y**2).ravel()], axis=1), triangles)


def test_without_offsets_there_is_one_seed_at_each_centre() -> None:
    quads = two_quads()
    seeds = seed_points(quads, quad_frames(quads), 0)
    np.testing.assert_array_equal(seeds.origins, [[1, 1, 0], [3, 1, 0]])
    np.testing.assert_array_equal(seeds.quad, [0, 1])


def test_one_offset_lies_half_way_to_each_corner() -> None:
    quads = two_quads()
    seeds = seed_points(quads, quad_frames(quads), 1)
    expected = np.array([[1, 1, 0], [0.5, 0.5, 0], [1.5, 0.5, 0], [1.5, 1.5, 0], [0.5, 1.5, 0]])
    np.testing.assert_allclose(seeds.origins[:5], expected)


@pytest.mark.parametrize("n_offsets", [0, 1, 2, 5])
def test_every_quad_has_a_centre_and_four_k_different_offsets_with_its_frame(n_offsets: int) -> None:
    quads = two_quads()
    frames = quad_frames(quads)
    seeds = seed_points(quads, frames, n_offsets)
    assert len(seeds) == 2 * (4 * n_offsets + 1)
    assert len(np.unique(np.round(seeds.origins, 12), axis=0)) == len(seeds)
    np.testing.assert_array_equal(seeds.frames, frames[seeds.quad])


def test_projected_seeds_lie_on_the_surface() -> None:
    quads = two_quads()
    surface = bump()
    seeds = seed_points(quads, quad_frames(quads), 2)
    moved = project_seeds(RayScene(surface), surface, seeds, reach=5.0)
    np.testing.assert_array_equal(moved.origins[:, :2], seeds.origins[:, :2])
    np.testing.assert_allclose(moved.origins[:, 2], 0.1 * (seeds.origins[:, :2] ** 2).sum(axis=1), atol=2e-3)


def test_seeds_that_see_no_surface_within_reach_stay() -> None:
    quads = two_quads()
    surface = bump()
    seeds = seed_points(quads, quad_frames(quads), 1)
    away = TriangleMesh(surface.vertices + np.array([0.0, 0, 3]), surface.triangles)
    np.testing.assert_array_equal(project_seeds(RayScene(away), away, seeds, reach=2.0).origins, seeds.origins)

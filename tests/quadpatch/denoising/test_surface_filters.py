import numpy as np
import pytest

from quadpatch.denoising.surface_filters import FILTER_NAMES, SurfaceFilters
from quadpatch.types import TriangleMesh
from tests.quadpatch.denoising.noisy_shapes import SHAPES, normal_error, roof, with_noise
from tests.quadpatch.shapes import open_grid, sphere


def test_a_plane_stays_a_plane() -> None:
    mesh = open_grid(12)
    filtered = SurfaceFilters(mesh).apply(mesh.vertices)
    assert len(filtered) == len(FILTER_NAMES)
    assert all(np.abs(vertices[:, 2]).max() < 1e-12 for vertices in filtered)


def test_a_rim_keeps_its_corners() -> None:
    mesh = open_grid(12)
    rim = np.flatnonzero((np.abs(mesh.vertices[:, :2] - mesh.vertices[:, :2].min(axis=0)) < 1e-12).any(axis=1))
    assert all(np.allclose(v[rim], mesh.vertices[rim]) for v in SurfaceFilters(mesh).diffused(mesh.vertices))


@pytest.mark.parametrize("shape", SHAPES)
def test_every_filter_takes_noise_off(shape: str) -> None:
    clean = SHAPES[shape]()
    noisy, _ = with_noise(clean, 0.1)
    errors = [normal_error(clean, vertices) for vertices in SurfaceFilters(noisy).apply(noisy.vertices)]
    assert min(errors) < 0.5 * normal_error(clean, noisy.vertices)


def test_filtered_normals_keep_a_crease_that_diffusion_rounds() -> None:
    clean = roof(40)
    noisy, _ = with_noise(clean, 0.2)
    *diffused, _, creased = (normal_error(clean, v) for v in SurfaceFilters(noisy).apply(noisy.vertices))
    assert creased < 0.8 * min(diffused)


def test_a_vertex_of_thousands_of_triangles_takes_no_more_memory_than_they_do() -> None:
    n = 20_000
    angle = 2 * np.pi * np.arange(n) / n
    ring = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    spokes = np.stack([np.full(n, n), np.arange(n), np.roll(np.arange(n), -1)], axis=1)
    fan = TriangleMesh(np.concatenate([ring, np.zeros((1, 3))]), spokes)
    filters = SurfaceFilters(fan)
    assert filters.n_pairs == 3 * n
    assert np.isfinite(filters.apply(fan.vertices)[-1]).all()


def test_degenerate_triangles_and_edges_of_three_triangles_give_finite_vertices() -> None:
    ball = sphere(1)
    broken = np.concatenate([ball.triangles, ball.triangles[:3], [[0, 1, 0], [0, 1, 5]]])
    filtered = SurfaceFilters(TriangleMesh(ball.vertices, broken)).apply(ball.vertices)
    assert all(np.isfinite(vertices).all() for vertices in filtered)

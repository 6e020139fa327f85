import numpy as np
import pytest

from quadpatch.denoising.noise import estimate_noise
from quadpatch.types import TriangleMesh
from tests.quadpatch.denoising.noisy_shapes import SHAPES, with_noise
from tests.quadpatch.shapes import joined, open_grid, sphere


@pytest.mark.parametrize("noise", [0.05, 0.1, 0.2, 0.3])
@pytest.mark.parametrize("shape", SHAPES)
def test_noise_is_estimated_within_fifteen_percent(shape: str, noise: float) -> None:
    noisy, size = with_noise(SHAPES[shape](), noise)
    assert estimate_noise(noisy) == pytest.approx(size, rel=0.15)


def test_a_plane_has_no_noise() -> None:
    assert estimate_noise(open_grid(20)) == 0.0


def test_noise_scales_with_the_mesh() -> None:
    noisy, _ = with_noise(sphere(3), 0.1)
    larger = TriangleMesh(noisy.vertices * 1e6, noisy.triangles)
    assert estimate_noise(larger) == pytest.approx(1e6 * estimate_noise(noisy), rel=1e-6)


def test_vertices_without_triangles_do_not_count() -> None:
    noisy, _ = with_noise(sphere(3), 0.1)
    cloud = TriangleMesh(np.random.default_rng(0).normal(size=(500, 3)), np.zeros((0, 3), np.int64))
    assert estimate_noise(joined(noisy, cloud)) == pytest.approx(estimate_noise(noisy), rel=0.05)
    assert estimate_noise(cloud) == 0.0

import numpy as np
import pytest

from quadpatch.compression.proof import deviation, psnr, sample
from quadpatch.mesh.distance import distance_to_mesh
from quadpatch.types import TriangleMesh
from tests.quadpatch.shapes import open_grid, sphere


@pytest.mark.parametrize("spacing", [1.0, 0.2, 0.05])
def test_no_place_is_farther_from_a_sample_than_said(spacing: float) -> None:
    mesh = open_grid(4, width=1.0)
    samples = sample(mesh, spacing)
    rng = np.random.default_rng(0)
    weights = rng.dirichlet(np.ones(3), (50, len(mesh.triangles)))
    places = np.einsum("stk,tkj->stj", weights, mesh.vertices[mesh.triangles]).reshape(-1, 3)
    gaps = np.linalg.norm(places[:, np.newaxis] - samples.points, axis=2).min(axis=1)
    assert gaps.max() <= samples.spacing


def test_every_sample_lies_on_its_triangle() -> None:
    mesh = sphere(2)
    samples = sample(mesh, 0.1)
    for k in range(0, len(samples.points), 97):
        alone = TriangleMesh(mesh.vertices, mesh.triangles[samples.triangle[[k]]])
        assert distance_to_mesh(samples.points[[k]], alone)[0] < 1e-9


def test_a_lifted_plate_is_its_height_away() -> None:
    mesh = open_grid(5, width=1.0)
    lifted = TriangleMesh(mesh.vertices + np.array([0.0, 0.0, 0.01]), mesh.triangles)
    found = deviation(sample(mesh, 0.1), lifted)
    assert found.largest == pytest.approx(0.01)
    assert found.rms == pytest.approx(0.01)


def test_nothing_is_infinitely_far_away() -> None:
    nothing = TriangleMesh(np.zeros((0, 3)), np.zeros((0, 3), np.int64))
    assert deviation(sample(sphere(1), 1.0), nothing).largest == np.inf


def test_a_thousandth_of_the_diagonal_is_60_decibels() -> None:
    assert psnr(1.0, 0.001) == pytest.approx(60.0)
    assert psnr(1.0, 0.0) == np.inf

import numpy as np

from quadpatch.mesh.sampling import sample_surface
from quadpatch.types import TriangleMesh
from tests.quadpatch.shapes import open_grid, sphere


def test_points_lie_on_the_triangles_that_they_are_said_to_lie_on() -> None:
    mesh = sphere(2)
    points, triangle = sample_surface(mesh, 500, np.random.default_rng(0))
    a, b, c = (mesh.vertices[mesh.triangles[triangle, k]] for k in range(3))
    normal = np.cross(b - a, c - a)
    assert np.abs(np.einsum("ij,ij->i", points - a, normal)).max() < 1e-12


def test_points_are_spread_by_area() -> None:
    points, _ = sample_surface(open_grid(5, 1.0), 20_000, np.random.default_rng(0))
    counts, _, _ = np.histogram2d(points[:, 0], points[:, 1], bins=4)
    assert np.abs(counts / 20_000 * 16 - 1).max() < 0.15


def test_the_same_generator_draws_the_same_points() -> None:
    draws = [sample_surface(sphere(1), 50, np.random.default_rng(3))[0] for _ in range(2)]
    assert (draws[0] == draws[1]).all()


def test_a_surface_without_area_has_no_points() -> None:
    flat = TriangleMesh(np.zeros((3, 3)), np.array([[0, 1, 2]]))
    for mesh in (flat, TriangleMesh(np.zeros((0, 3)), np.zeros((0, 3), np.int64))):
        points, triangle = sample_surface(mesh, 10, np.random.default_rng(0))
        assert len(points) == len(triangle) == 0

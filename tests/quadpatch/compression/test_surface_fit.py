import numpy as np

from quadpatch.compression.control_mesh import collapse_to_quads
from quadpatch.compression.heights import make_grid
from quadpatch.compression.surface_fit import barycentric, fit_quads
from quadpatch.mesh.distance import distance_to_mesh
from tests.quadpatch.shapes import sphere


def test_a_fitted_subdivision_surface_lies_ten_times_closer() -> None:
    ball = sphere(4)
    rough = collapse_to_quads(ball, 60)
    before, after = (
        distance_to_mesh(make_grid(quads, 2).points, ball).mean() for quads in (rough, fit_quads(rough, ball))
    )
    assert 10 * after < before


def test_weights_of_a_point_in_its_triangle_give_the_point_back() -> None:
    rng = np.random.default_rng(0)
    corners = rng.normal(size=(50, 3, 3))
    weights = rng.dirichlet(np.ones(3), 50)
    points = np.einsum("ij,ijk->ik", weights, corners)
    assert np.allclose(barycentric(points, corners), weights)


def test_a_triangle_without_area_weighs_its_corners_alike() -> None:
    assert np.allclose(barycentric(np.zeros((1, 3)), np.zeros((1, 3, 3))), 1 / 3)

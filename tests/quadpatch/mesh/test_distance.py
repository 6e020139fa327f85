import numpy as np
import pytest

from quadpatch.mesh.distance import DistanceTree, distance_to_mesh, nearest_points, nearest_triangles, project
from quadpatch.types import TriangleMesh, Vertices
from tests.quadpatch.shapes import open_grid, sphere

FLOOR = open_grid(5, 2.0)
NOTHING = TriangleMesh(np.zeros((0, 3)), np.zeros((0, 3), np.int64))


def around_the_origin(n: int = 200) -> Vertices:
    return np.random.default_rng(0).normal(size=(n, 3))


def test_the_distance_to_a_plane_is_the_height_over_it() -> None:
    points = np.column_stack([np.random.default_rng(0).uniform(-0.9, 0.9, (50, 2)), np.linspace(-2.0, 2.0, 50)])
    height = np.abs(points[:, 2] - FLOOR.vertices[0, 2])
    np.testing.assert_allclose(distance_to_mesh(points, FLOOR), height, atol=1e-12)
    below = points * [1.0, 1.0, 0.0] + [0.0, 0.0, FLOOR.vertices[0, 2]]
    np.testing.assert_allclose(nearest_points(points, FLOOR), below, atol=1e-12)


def test_a_tree_that_is_asked_again_says_what_a_fresh_one_says() -> None:
    ball = sphere(3)
    tree = DistanceTree(TriangleMesh(np.concatenate([[[9.0, 9.0, 9.0]], ball.vertices]), ball.triangles + 1))
    for points in (around_the_origin(), 3.0 * around_the_origin(7)):
        np.testing.assert_allclose(tree.distance(points), distance_to_mesh(points, ball), atol=1e-12)


def test_distance_triangle_and_place_belong_together() -> None:
    ball, points = sphere(2), around_the_origin()
    distance, triangle, place = project(points, ball)
    np.testing.assert_allclose(np.linalg.norm(points - place, axis=1), distance, atol=1e-12)
    assert triangle.tolist() == nearest_triangles(points, ball)[1].tolist()
    lying_in = [
        float(distance_to_mesh(p[np.newaxis], TriangleMesh(ball.vertices, ball.triangles[[t]]))[0])
        for p, t in zip(place, triangle, strict=True)
    ]
    assert max(lying_in) < 1e-12


@pytest.mark.parametrize("mesh", [NOTHING, TriangleMesh(FLOOR.vertices, NOTHING.triangles)])
def test_without_a_triangle_everything_is_infinitely_far(mesh: TriangleMesh) -> None:
    points = around_the_origin(3)
    assert np.isinf(distance_to_mesh(points, mesh)).all()
    assert np.isinf(DistanceTree(mesh).distance(points)).all()
    assert nearest_triangles(points, mesh)[1].tolist() == [-1, -1, -1]


def test_no_point_has_no_distance() -> None:
    assert (
        distance_to_mesh(np.zeros((0, 3)), FLOOR).shape == DistanceTree(FLOOR).distance(np.zeros((0, 3))).shape == (0,)
    )

import numpy as np
import pytest

from quadpatch.errors import StageError
from quadpatch.mesh.boundary import boundary_loops
from quadpatch.mesh.meshlab import close_holes, collapse_edges, poisson_surface, split_edges, two_step_smooth
from quadpatch.mesh.normals import vertex_normals
from quadpatch.types import TriangleMesh
from tests.quadpatch.shapes import cylinder, moved, open_grid, punched, sphere


def test_two_step_smoothing_takes_bumps_off_a_sphere_and_keeps_the_triangles() -> None:
    ball = sphere(3)
    bumps = 1.0 + 0.02 * np.random.default_rng(0).standard_normal((len(ball.vertices), 1))
    mesh = TriangleMesh(ball.vertices * bumps, ball.triangles)
    smooth = two_step_smooth(mesh, 3)
    assert smooth.triangles is mesh.triangles
    assert np.linalg.norm(smooth.vertices, axis=1).std() < 0.8 * bumps.std()


def test_two_step_smoothing_leaves_the_input_and_its_place_alone() -> None:
    mesh = moved(sphere(3), (1000.0, 0.0, 0.0))
    before = mesh.vertices.copy()
    assert np.abs(two_step_smooth(mesh, 3).vertices - before).max() < 0.1
    assert (mesh.vertices == before).all()


def test_smoothing_takes_what_scans_hold() -> None:
    ball = sphere(2)
    vertices = np.concatenate([ball.vertices, [[5.0, 5.0, 5.0], [0.0, 0.0, 2.0]]])
    n = len(ball.vertices)
    extra = [ball.triangles[0], ball.triangles[0][::-1], [0, 0, 1], [*ball.triangles[0][:2], n + 1]]
    mesh = TriangleMesh(vertices, np.concatenate([ball.triangles, np.array(extra)]))
    smooth = two_step_smooth(mesh, 3)
    assert np.isfinite(smooth.vertices).all()
    assert (smooth.vertices[n] == 5.0).all()


def test_smoothing_nothing_gives_nothing() -> None:
    empty = TriangleMesh(np.zeros((0, 3)), np.zeros((0, 3), np.int64))
    assert two_step_smooth(empty, 3) is empty


def test_closing_keeps_the_input_as_a_prefix_and_leaves_no_loop() -> None:
    holed = punched(sphere(3), (0.0, 0.0, 1.0), (1.0, 0.0, 0.0), radius=0.4)
    used, triangles = np.unique(holed.triangles, return_inverse=True)
    mesh = TriangleMesh(holed.vertices[used], triangles.reshape(-1, 3))
    closed = close_holes(mesh, 1000, 0.1)
    assert (closed.vertices[: len(mesh.vertices)] == mesh.vertices).all()
    assert (closed.triangles[: len(mesh.triangles)] == mesh.triangles).all()
    assert boundary_loops(closed.triangles).loops == []
    assert len(closed.vertices) > len(mesh.vertices)


def test_longer_loops_stay_open() -> None:
    mesh = cylinder(20, 5)
    assert len(boundary_loops(close_holes(mesh, 19, 0.3).triangles).loops) == 2
    assert boundary_loops(close_holes(mesh, 20, 0.3).triangles).loops == []


def test_a_poisson_surface_lies_close_to_its_points_the_same_every_time() -> None:
    points = sphere(3)
    normals = vertex_normals(points.vertices, points.triangles)
    surface = poisson_surface(points.vertices, normals, depth=5)
    assert np.abs(np.linalg.norm(surface.vertices, axis=1) - 1.0).max() < 0.05
    again = poisson_surface(points.vertices, normals, depth=5)
    assert (again.vertices == surface.vertices).all()


def test_collapsing_edges_keeps_a_sphere_a_sphere() -> None:
    coarse = collapse_edges(sphere(4), 300)
    assert abs(len(coarse.triangles) - 300) <= 2
    assert np.abs(np.linalg.norm(coarse.vertices, axis=1) - 1.0).max() < 0.05


def test_splitting_leaves_no_edge_longer_than_the_limit() -> None:
    mesh = open_grid(4, 4.0)
    fine = split_edges(mesh, 0.4)
    corners = fine.vertices[fine.triangles]
    assert np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max() <= 0.4
    assert split_edges(fine, 0.4) is fine


def test_what_meshlab_refuses_is_an_error_of_the_stage() -> None:
    with pytest.raises(StageError, match="MeshLab's generate_surface_reconstruction_screened_poisson"):
        poisson_surface(np.zeros((0, 3)), np.zeros((0, 3)))

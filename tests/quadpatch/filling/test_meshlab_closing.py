import numpy as np

from quadpatch.filling.meshlab_closing import close_by_meshlab
from quadpatch.mesh.boundary import boundary_loops
from quadpatch.mesh.measures import mean_edge_length
from quadpatch.types import TriangleMesh
from tests.quadpatch.shapes import is_oriented_manifold, open_grid, punched, sphere


def test_every_hole_is_closed_behind_the_bits_that_came() -> None:
    mesh = punched(sphere(3), (0, 0, 1), (1, 0, 0), (0, -1, 0), radius=0.35)
    filled = close_by_meshlab(mesh, boundary_loops(mesh.triangles).loops)
    assert filled.unfilled == []
    assert filled.mesh.vertices[: len(mesh.vertices)].tobytes() == mesh.vertices.tobytes()
    assert filled.mesh.triangles[: len(mesh.triangles)].tobytes() == mesh.triangles.tobytes()
    assert boundary_loops(filled.mesh.triangles).loops == []
    assert is_oriented_manifold(filled.mesh.triangles)


def test_each_new_vertex_and_triangle_knows_its_hole() -> None:
    mesh = punched(sphere(3), (0, 0, 1), (1, 0, 0), radius=0.35)
    loops = boundary_loops(mesh.triangles).loops
    filled = close_by_meshlab(mesh, loops)
    new = filled.mesh.vertices[filled.n_measured_vertices :]
    for i, loop in enumerate(loops):
        centre = mesh.vertices[loop].mean(axis=0)
        assert np.linalg.norm(new[filled.vertex_hole == i] - centre, axis=1).max() < 0.4
        corners = np.unique(filled.mesh.triangles[filled.n_measured_triangles :][filled.triangle_hole == i])
        assert np.isin(loop, corners).all()


def test_the_fill_is_about_as_dense_as_the_surface_around_it() -> None:
    mesh = punched(sphere(4), (0, 0, 1), radius=0.4)
    filled = close_by_meshlab(mesh, boundary_loops(mesh.triangles).loops)
    new = TriangleMesh(filled.mesh.vertices, filled.mesh.triangles[filled.n_measured_triangles :])
    assert 0.5 < mean_edge_length(new) / mean_edge_length(mesh) < 1.5


def test_loops_that_are_not_named_stay_open() -> None:
    mesh = punched(sphere(3), (0, 0, 1), (1, 0, 0), radius=0.35)
    loops = boundary_loops(mesh.triangles).loops
    filled = close_by_meshlab(mesh, loops[:1])
    assert len(boundary_loops(filled.mesh.triangles).loops) == 1


def test_what_meshlab_leaves_open_is_closed_all_the_same() -> None:
    grid = open_grid(9, 2.0)
    mesh = TriangleMesh(grid.vertices, np.delete(grid.triangles, 60, axis=0))
    loop = next(loop for loop in boundary_loops(mesh.triangles).loops if len(loop) == 3)
    filled = close_by_meshlab(mesh, [loop])
    assert filled.unfilled == []
    assert len(filled.triangle_hole) == 1

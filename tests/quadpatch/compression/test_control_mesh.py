import numpy as np
import pytest

from quadpatch.compression.control_mesh import collapse, collapse_to_quads
from quadpatch.compression.subdivision import quad_edges
from quadpatch.mesh.distance import distance_to_mesh
from quadpatch.types import TriangleMesh
from tests.quadpatch.shapes import cylinder, joined, moved, open_grid, sphere


@pytest.mark.parametrize("mesh", [sphere(3), joined(sphere(2), moved(sphere(2), (5.0, 0.0, 0.0)))])
def test_quads_of_a_closed_surface_leave_no_gap(mesh: TriangleMesh) -> None:
    quads = collapse_to_quads(mesh, 60)
    assert (quad_edges(quads.quads, len(quads.vertices))[2] == 2).all()


def test_about_as_many_quads_come_as_are_asked_for() -> None:
    assert 90 <= len(collapse_to_quads(sphere(4), 100).quads) <= 110


def test_quads_face_as_the_triangles_do() -> None:
    quads = collapse_to_quads(sphere(3), 100)
    corners = quads.vertices[quads.quads]
    normals = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    assert (np.einsum("ij,ij->i", normals, corners.mean(axis=1)) > 0).all()


@pytest.mark.parametrize("mesh", [open_grid(12, width=1.0), cylinder(24, 12)])
def test_borders_stay_near_where_they_were(mesh: TriangleMesh) -> None:
    quads = collapse_to_quads(mesh, 80)
    edges, _, count = quad_edges(quads.quads, len(quads.vertices))
    border = quads.vertices[np.unique(edges[count == 1])]
    assert len(border) >= 4
    assert distance_to_mesh(border, mesh).max() < 0.1


def test_a_mesh_with_fewer_triangles_stays_as_it_is() -> None:
    mesh = sphere(1)
    assert len(collapse(mesh, 1000).triangles) == len(mesh.triangles)


def test_a_single_triangle_becomes_three_quads() -> None:
    mesh = TriangleMesh(np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2]]))
    assert len(collapse_to_quads(mesh, 6).quads) == 3

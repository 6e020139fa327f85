import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from quadpatch.mesh.edge_splitting import split_long_edges
from quadpatch.mesh.measures import edge_statistics, surface_area
from quadpatch.mesh.topology import directed_edges, edge_keys
from quadpatch.types import TriangleMesh
from tests.quadpatch.shapes import bumpy_plate, sphere


@pytest.mark.parametrize("longest", [0.5, 0.2, 0.07])
def test_no_edge_is_longer_than_the_length(longest: float) -> None:
    split = split_long_edges(sphere(1), longest)
    assert edge_statistics(split.mesh).longest <= longest


@pytest.mark.parametrize("longest", [0.5, 0.11])
def test_a_closed_surface_stays_closed(longest: float) -> None:
    split = split_long_edges(sphere(1), longest)
    keys = edge_keys(directed_edges(split.mesh.triangles), len(split.mesh.vertices))
    assert (np.unique(keys, return_counts=True)[1] == 2).all()


def test_area_and_direction_stay_as_they_are() -> None:
    ball = sphere(1)
    split = split_long_edges(ball, 0.1)
    assert surface_area(split.mesh) == pytest.approx(surface_area(ball))
    corners = split.mesh.vertices[split.mesh.triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert (np.einsum("ij,ij->i", normals, corners.mean(axis=1)) > 0).all()


@given(st.floats(0.03, 0.5))
def test_corners_lie_where_their_barycentric_coordinates_say(longest: float) -> None:
    plate = bumpy_plate(6, 1.0)
    split = split_long_edges(plate, longest)
    there = np.einsum("mkc,mcx->mkx", split.corners, plate.vertices[plate.triangles[split.parent]])
    assert np.abs(there - split.mesh.vertices[split.mesh.triangles]).max() < 1e-12
    assert (split.mesh.vertices[: len(plate.vertices)] == plate.vertices).all()


def test_a_mesh_that_is_fine_enough_comes_back() -> None:
    ball = sphere(2)
    split = split_long_edges(ball, 10.0)
    assert (split.mesh.triangles == ball.triangles).all()
    assert (split.parent == np.arange(len(ball.triangles))).all()


def test_vertices_may_have_lengths_of_their_own() -> None:
    plate = bumpy_plate(12, 1.0)
    is_left = plate.vertices[:, 0] < 0
    split = split_long_edges(plate, np.where(is_left, 0.03, 10.0))
    left = split.mesh.vertices[split.mesh.triangles].max(axis=1)[:, 0] < -0.1
    right = split.mesh.vertices[split.mesh.triangles].min(axis=1)[:, 0] > 0.1
    parts = [edge_statistics(TriangleMesh(split.mesh.vertices, split.mesh.triangles[rows])) for rows in (left, right)]
    assert parts[0].longest <= 0.03
    assert parts[1].mean > 0.05
    keys = edge_keys(directed_edges(split.mesh.triangles), len(split.mesh.vertices))
    assert (np.unique(keys, return_counts=True)[1] <= 2).all()

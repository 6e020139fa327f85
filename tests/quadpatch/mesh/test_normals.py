import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from quadpatch.mesh.normals import area_vectors, normals_at, triangle_normals, unit, vertex_areas, vertex_normals
from tests.quadpatch.shapes import bumpy_plate, open_grid, random_rotation, sphere


def test_normals_look_to_where_the_corners_run_counter_clockwise() -> None:
    mesh = open_grid(4)
    assert (triangle_normals(mesh.vertices, mesh.triangles) == [0, 0, 1]).all()
    assert (triangle_normals(mesh.vertices, mesh.triangles[:, ::-1]) == [0, 0, -1]).all()
    assert (vertex_normals(mesh.vertices, mesh.triangles) == [0, 0, 1]).all()


def test_area_vectors_are_twice_as_long_as_areas_and_add_up_to_nothing_on_a_closed_mesh() -> None:
    mesh = sphere(3, 2.0)
    vectors = area_vectors(mesh.vertices, mesh.triangles)
    assert abs(np.linalg.norm(vectors, axis=1).sum() / 2 / (4 * np.pi * 4) - 1) < 0.02
    np.testing.assert_allclose(vectors.sum(axis=0), 0, atol=1e-12)


def test_the_areas_at_vertices_add_up_to_that_of_the_surface() -> None:
    square = open_grid(11, 2.0)
    areas = vertex_areas(square.vertices, square.triangles)
    assert areas.sum() == pytest.approx(4.0)
    assert areas.reshape(11, 11)[1:-1, 1:-1] == pytest.approx(0.04)


def test_vertex_normals_of_a_sphere_point_away_from_its_centre() -> None:
    mesh = sphere(4)
    normals = vertex_normals(mesh.vertices, mesh.triangles)
    assert np.einsum("ij,ij->i", normals, mesh.vertices).min() > 0.9999


def test_a_vertex_normal_is_weighted_by_area() -> None:
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 3]])
    normals = vertex_normals(vertices, np.array([[0, 1, 2], [0, 2, 3]]))
    np.testing.assert_allclose(normals[0], np.array([3, 0, 1]) / np.sqrt(10), atol=1e-15)
    np.testing.assert_allclose(normals[1], [0, 0, 1], atol=1e-15)


def test_normals_at_some_vertices_are_those_of_all() -> None:
    mesh = bumpy_plate(12, 2.0)
    vertices = np.concatenate([mesh.vertices, [[9.0, 9.0, 9.0]]])
    wanted = np.array([144, 5, 77, 5, 0])
    found = normals_at(vertices, mesh.triangles, wanted)
    np.testing.assert_allclose(found, vertex_normals(vertices, mesh.triangles)[wanted], atol=1e-14)
    assert not found[0].any()
    assert normals_at(vertices, mesh.triangles, wanted[:0]).shape == (0, 3)


def test_without_area_or_triangles_there_is_no_normal() -> None:
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [5, 5, 5]])
    assert (triangle_normals(vertices, np.array([[0, 1, 2]])) == 0).all()
    assert (vertex_normals(vertices, np.array([[0, 1, 2]])) == 0).all()
    assert vertex_normals(vertices, np.zeros((0, 3), np.int64)).tolist() == np.zeros((4, 3)).tolist()


@given(seed=st.integers(0, 2**32 - 1))
@settings(max_examples=20)
def test_normals_turn_with_the_mesh_and_have_unit_length(seed: int) -> None:
    rng = np.random.default_rng(seed)
    mesh, rotation = bumpy_plate(8, 1.0, seed=seed), random_rotation(rng)
    flipped = mesh.vertices @ rotation.T + rng.normal(0, 5, 3)
    for normals_of in (triangle_normals, vertex_normals):
        here, there = (normals_of(vertices, mesh.triangles) for vertices in (mesh.vertices, flipped))
        np.testing.assert_allclose(np.linalg.norm(here, axis=1), 1, rtol=1e-14)
        np.testing.assert_allclose(there, here @ rotation.T, atol=1e-10)


def test_zero_vectors_stay_zero() -> None:
    assert unit(np.array([[0.0, 0, 0], [0, 0, 2]])).tolist() == [[0, 0, 0], [0, 0, 1]]

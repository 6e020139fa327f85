"""Joining vertices that a file repeats."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from quadpatch.mesh.weld import first_of_equal, weld
from quadpatch.types import FloatArray, Triangles, Vertices


def grid(n: int, m: int) -> tuple[Vertices, Triangles]:
    """An open grid of n x m cells."""
    rows, columns = np.mgrid[: n + 1, : m + 1]
    vertices = np.stack([columns.ravel() * 0.1, rows.ravel() * 0.3, np.sin(columns.ravel())], axis=1)
    corner = (np.arange(n)[:, None] * (m + 1) + np.arange(m)).ravel()
    lower = np.stack([corner, corner + 1, corner + m + 2], axis=1)
    upper = np.stack([corner, corner + m + 2, corner + m + 1], axis=1)
    return vertices, np.concatenate([lower, upper]).astype(np.int64)


def soup(vertices: Vertices, triangles: Triangles) -> tuple[Vertices, Triangles]:
    """Every triangle with vertices of its own, as STL has it."""
    return vertices[triangles.ravel()], np.arange(triangles.size, dtype=np.int64).reshape(-1, 3)


@given(n=st.integers(1, 8), m=st.integers(1, 8), seed=st.integers(0, 1000))
def test_a_soup_is_welded_to_the_mesh_it_came_from(n: int, m: int, seed: int) -> None:
    vertices, triangles = grid(n, m)
    shuffled = np.random.default_rng(seed).permutation(triangles)
    welded = weld(*soup(vertices, shuffled))
    assert len(welded.mesh.vertices) == len(vertices)
    assert (welded.mesh.vertices[welded.mesh.triangles] == vertices[shuffled]).all()


@given(n=st.integers(1, 6), m=st.integers(1, 6))
def test_a_mesh_without_repeats_comes_back_as_it_was(n: int, m: int) -> None:
    vertices, triangles = grid(n, m)
    welded = weld(vertices, triangles)
    assert welded.mesh.vertices.tobytes() == vertices.tobytes()
    assert (welded.mesh.triangles == triangles).all()
    assert (welded.to_file == np.arange(len(vertices))).all()


def test_the_maps_lead_there_and_back() -> None:
    vertices, triangles = soup(*grid(4, 5))
    welded = weld(vertices, triangles)
    assert (welded.from_file[welded.to_file] == np.arange(len(welded.to_file))).all()
    assert (welded.mesh.vertices[welded.from_file] == vertices).all()
    firsts = [int(np.flatnonzero(welded.from_file == i)[0]) for i in range(len(welded.to_file))]
    assert welded.to_file.tolist() == firsts


def test_vertices_inside_a_surface_are_never_joined() -> None:
    # Two pyramids over square rims, their tips at one point.
    rim = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    tip = np.array([[0.5, 0.5, 1]])
    vertices = np.concatenate([rim, tip, rim + np.array([0, 0, 2]), tip])
    pyramid = np.array([[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]], dtype=np.int64)
    welded = weld(vertices, np.concatenate([pyramid, pyramid[:, ::-1] + 5]))
    assert len(welded.mesh.vertices) == 10


def test_vertices_that_are_merely_close_stay_apart() -> None:
    vertices, triangles = soup(*grid(1, 1))
    vertices[0] = np.nextafter(vertices[0], 1.0)
    assert len(weld(vertices, triangles).mesh.vertices) == 5


def test_minus_zero_and_zero_are_one_coordinate() -> None:
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [-0.0, 0, 0], [0, 1, 0], [-1, 0, 0]])
    welded = weld(vertices, np.array([[0, 1, 2], [3, 4, 5]], dtype=np.int64))
    assert len(welded.mesh.vertices) == 4


def test_triangles_without_three_vertices_are_dropped() -> None:
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 0, 0], [1, 0, 0], [0, 1, 0]])
    triangles = np.array([[0, 1, 2], [1, 1, 2], [3, 4, 5]], dtype=np.int64)
    welded = weld(vertices, triangles)
    assert welded.mesh.triangles.tolist() == [[0, 1, 2]]


@given(points=st.lists(st.tuples(*[st.sampled_from([0.0, -0.0, 1.0, 2.5])] * 3), min_size=3, max_size=60))
def test_equal_positions_become_one_vertex_even_if_every_hash_collides(points: list[tuple[float, ...]]) -> None:
    vertices = np.array(points)
    plain = first_of_equal(vertices)
    assert (vertices[plain] == vertices).all()
    for i, first in enumerate(plain):
        assert first == int(np.flatnonzero((vertices == vertices[i]).all(axis=1))[0])


def test_points_that_share_a_hash_are_told_apart() -> None:
    # The y of `twin` is chosen so that it undoes what the other x did to the hash.
    first, other = (_mix(np.array([x])) for x in (1.0, 3.0))
    y = np.array([2.0]).view(np.uint64)
    twin_y = float((first ^ other ^ y).view(np.float64)[0])
    points = np.array([[1.0, 2.0, 0.5], [3.0, twin_y, 0.5], [1.0, 2.0, 0.5]])
    assert np.isfinite(twin_y)
    assert first_of_equal(points).tolist() == [0, 1, 0]


def _mix(x: FloatArray) -> NDArray[np.uint64]:
    mixed = x.view(np.uint64) * np.uint64(0x9E3779B97F4A7C15)
    return mixed ^ (mixed >> np.uint64(29))

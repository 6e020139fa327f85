from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from benchmarks.quality.own_meshes import clean, normalised, prepare
from quadpatch.types import TriangleMesh
from tests.quadpatch.shapes import open_grid, sphere


@given(scale=st.floats(1e-3, 1e3), shift=st.floats(-1e3, 1e3))
def test_normalising_takes_size_and_place_away(scale: float, shift: float) -> None:
    ball = sphere(1)
    moved = TriangleMesh(scale * ball.vertices + shift, ball.triangles)
    vertices = normalised(moved).vertices
    assert np.ptp(vertices, axis=0).max() == pytest.approx(1.0)
    np.testing.assert_allclose(vertices, normalised(ball).vertices, atol=1e-8 * (1 + shift / scale) ** 2)


def test_normalising_drops_vertices_of_no_triangle() -> None:
    ball = sphere(1)
    stray = TriangleMesh(np.concatenate([[[9.0, 9.0, 9.0]], ball.vertices]), ball.triangles + 1)
    mesh = normalised(stray)
    np.testing.assert_array_equal(mesh.triangles, ball.triangles)
    np.testing.assert_allclose(mesh.vertices, normalised(ball).vertices)


def test_repeated_triangles_are_dropped_and_the_others_keep_their_order() -> None:
    triangles = open_grid(4).triangles
    turned = np.roll(triangles[3], 1)
    np.testing.assert_array_equal(clean(np.concatenate([triangles, [turned]])), triangles)


def test_all_triangles_at_an_edge_of_three_are_dropped() -> None:
    fan = np.array([[0, 1, 2], [1, 0, 3], [0, 1, 4], [5, 6, 7]])
    np.testing.assert_array_equal(clean(fan), fan[3:])


def test_a_file_that_repeats_vertices_becomes_one_closed_surface(tmp_path: Path) -> None:
    ball = sphere(1)
    corners = ball.vertices[ball.triangles.ravel()]
    faces = "".join(f"f {i + 1} {i + 2} {i + 3}\n" for i in range(0, len(corners), 3))
    path = tmp_path / "ball.obj"
    path.write_text("".join(f"v {x!r} {y!r} {z!r}\n" for x, y, z in corners.tolist()) + faces)
    mesh = prepare(path)
    assert len(mesh.vertices) == len(ball.vertices)
    assert len(mesh.triangles) == len(ball.triangles)

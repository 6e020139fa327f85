import numpy as np
import pytest

from quadpatch.mesh.normals import area_vectors, length
from quadpatch.mesh.topology import face_components
from quadpatch.textures.charts import divide_into_charts, flatten
from quadpatch.types import FloatArray, TriangleMesh
from tests.quadpatch.shapes import bumpy_plate, open_grid, sphere


def areas_of(flat: FloatArray) -> FloatArray:
    a, b, c = (flat[:, corner] for corner in range(3))
    return np.asarray(((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]) / 2)


def one_group(mesh: TriangleMesh) -> np.ndarray:
    return np.zeros(len(mesh.triangles), np.int64)


def test_a_plane_is_one_chart_and_keeps_its_lengths() -> None:
    grid = open_grid(7)
    charts = divide_into_charts(grid.vertices, grid.triangles, one_group(grid))
    assert len(charts) == 1
    flat = flatten(grid.vertices, grid.triangles, charts)
    edges = grid.vertices[grid.triangles] - np.roll(grid.vertices[grid.triangles], 1, axis=1)
    assert np.allclose(np.linalg.norm(flat - np.roll(flat, 1, axis=1), axis=2), np.linalg.norm(edges, axis=2))


@pytest.mark.parametrize("mesh", [bumpy_plate(10, 2.0), sphere(3)], ids=["plate", "sphere"])
def test_no_triangle_is_turned_over_or_squeezed(mesh: TriangleMesh) -> None:
    charts = divide_into_charts(mesh.vertices, mesh.triangles, one_group(mesh))
    flat = areas_of(flatten(mesh.vertices, mesh.triangles, charts))
    true = length(area_vectors(mesh.vertices, mesh.triangles)) / 2
    assert (flat >= 0.35 * true * (1 - 1e-9)).all()
    assert (flat <= true * (1 + 1e-9)).all()


def test_a_sphere_takes_several_charts_each_of_a_piece() -> None:
    ball = sphere(3)
    charts = divide_into_charts(ball.vertices, ball.triangles, one_group(ball))
    assert 2 <= len(charts) <= 12
    assert sorted(set(charts.of_triangle.tolist())) == list(range(len(charts)))
    for number in range(len(charts)):
        rows = ball.triangles[charts.of_triangle == number]
        assert face_components(rows, len(ball.vertices)).max() == 0


def test_fills_of_different_holes_are_different_charts() -> None:
    grid = open_grid(7)
    group = (grid.vertices[grid.triangles].mean(axis=1)[:, 0] > 0).astype(np.int64)
    charts = divide_into_charts(grid.vertices, grid.triangles, group)
    assert len(charts) == 2
    assert (charts.of_triangle[group == 0] != charts.of_triangle[group == 1][0]).all()


def test_triangles_without_area_find_a_chart_too() -> None:
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0]])
    triangles = np.array([[0, 1, 2], [0, 1, 3]])
    charts = divide_into_charts(vertices, triangles, np.zeros(2, np.int64))
    assert np.isfinite(flatten(vertices, triangles, charts)).all()


def test_a_halved_chart_is_cut_across_its_longest_direction() -> None:
    grid = open_grid(9)
    long = TriangleMesh(grid.vertices * np.array([5.0, 1.0, 1.0]), grid.triangles)
    charts = divide_into_charts(long.vertices, long.triangles, one_group(long))
    halves = charts.halved(long.vertices, long.triangles, np.array([0]))
    middles = long.vertices[long.triangles].mean(axis=1)[:, 0]
    lower, upper = sorted((middles[halves.of_triangle == number] for number in (0, 1)), key=lambda part: part.mean())
    assert len(halves) == 2
    assert lower.max() <= upper.min()
    assert abs(len(lower) - len(upper)) <= 1

import io

import numpy as np
import pytest
from PIL import Image

from quadpatch.textures import page
from quadpatch.textures.page import GUTTER, lay_out, paint
from quadpatch.textures.raster import rasterise
from quadpatch.types import FloatArray, TriangleMesh
from tests.quadpatch.shapes import open_grid, sphere

GRID = open_grid(9)
NO_HOLE = np.zeros(len(GRID.triangles), np.int64)


def painted_page(mesh: TriangleMesh, texels_per_unit: float, colours: FloatArray) -> tuple[page.Layout, np.ndarray]:
    layout = lay_out(
        mesh.vertices, mesh.triangles, np.zeros(len(mesh.triangles), np.int64), np.array([texels_per_unit])
    )
    return layout, np.asarray(Image.open(io.BytesIO(paint(layout, layout.corners, mesh.triangles, colours))))


def test_a_page_has_the_density_that_is_asked_for() -> None:
    layout = lay_out(GRID.vertices, GRID.triangles, NO_HOLE, np.array([20.0]))
    edges = np.linalg.norm(layout.corners - np.roll(layout.corners, 1, axis=1), axis=2)
    corners = GRID.vertices[GRID.triangles]
    assert np.allclose(edges, 20 * np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2))


def test_coordinates_run_from_0_to_1_and_upwards() -> None:
    layout = lay_out(GRID.vertices, GRID.triangles, NO_HOLE, np.array([20.0]))
    assert layout.coordinates.min() > 0
    assert layout.coordinates.max() < 1
    assert np.allclose(layout.coordinates[..., 1], 1 - layout.corners[..., 1] / layout.height)


def test_a_page_that_would_be_too_large_is_drawn_smaller(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(page, "LARGEST_PAGE", 64)
    layout = lay_out(GRID.vertices, GRID.triangles, NO_HOLE, np.array([1000.0]))
    assert max(layout.width, layout.height) == 64


def test_gutters_go_on_with_the_colours_beside_them() -> None:
    layout, pixels = painted_page(GRID, 4.0, np.full((len(GRID.vertices), 3), 200.0))
    for covered in rasterise(layout.corners):
        for down in range(-GUTTER, GUTTER + 1):
            assert (pixels[covered.row + down, covered.column] == 200).all()


def test_alpha_is_painted_where_samples_have_it() -> None:
    _, pixels = painted_page(GRID, 4.0, np.tile([200.0, 100.0, 50.0, 30.0], (len(GRID.vertices), 1)))
    assert (pixels == [200, 100, 50, 30]).all()


def test_no_two_triangles_cover_the_same_texel() -> None:
    # A ball in charts that no axis sees as a whole.
    ball = sphere(3)
    hole = np.zeros(len(ball.triangles), np.int64)
    layout = lay_out(ball.vertices, ball.triangles, hole, np.array([60.0]))
    count = np.zeros((layout.height, layout.width), np.int64)
    for covered in rasterise(layout.corners):
        inner = (covered.weights > 1e-6).all(axis=1)
        np.add.at(count, (covered.row[inner], covered.column[inner]), 1)
    assert count.max() == 1


def test_a_ramp_that_winds_over_itself_is_cut(monkeypatch: pytest.MonkeyPatch) -> None:
    # Two turns of a screw: every triangle faces up, and the turns lie above each other.
    turn = np.linspace(0, 4 * np.pi, 60)
    inner, outer = (np.stack([r * np.cos(turn), r * np.sin(turn), 0.05 * turn], axis=1) for r in (1.0, 2.0))
    vertices = np.concatenate([inner, outer])
    a, b = np.arange(59), np.arange(59) + 60
    triangles = np.concatenate([np.stack([a, b, b + 1], axis=1), np.stack([a, b + 1, a + 1], axis=1)])
    layout = lay_out(vertices, triangles, np.zeros(len(triangles), np.int64), np.array([20.0]))
    assert layout.n_charts > 1
    count = np.zeros((layout.height, layout.width), np.int64)
    for covered in rasterise(layout.corners):
        inner_texels = (covered.weights > 1e-6).all(axis=1)
        np.add.at(count, (covered.row[inner_texels], covered.column[inner_texels]), 1)
    assert count.max() == 1

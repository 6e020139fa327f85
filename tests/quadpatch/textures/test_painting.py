"""Pages for fills whose true colours are known, without files around them.

So `quadpatch/textures/measured_texture.py` and `quadpatch/textures/samples.py` are tested too.
"""

import io

import numpy as np
import pytest
from PIL import Image

from quadpatch.formats.surface_texture import SurfaceTexture, TextureImage
from quadpatch.mesh.measures import mean_edge_length
from quadpatch.options import RepairOptions
from quadpatch.recipes.default import inpaint
from quadpatch.textures import measured_texture, samples
from quadpatch.textures.measured_texture import MeasuredTexture
from quadpatch.textures.painting import PaintedFills, paint_fills
from quadpatch.types import TriangleMesh
from tests.quadpatch.formats.textured_files import encoded
from tests.quadpatch.shapes import bumpy_plate, on_surface, punched

WHOLE = bumpy_plate(24, 2.0)
FILLED = inpaint(punched(WHOLE, *on_surface(WHOLE, (0.4, 0.3), (-0.4, -0.3)), radius=0.2), None, RepairOptions()).filled
LEVELS = np.tile(np.arange(64, dtype=np.uint8)[:, np.newaxis] * 3, (1, 64))[..., np.newaxis].repeat(3, axis=2)


def textured(scale: float = 1.0, wood: bytes = encoded(LEVELS)) -> SurfaceTexture:
    coordinates = (scale * (FILLED.mesh.vertices[:, :2] / 2.1 + 0.5))[FILLED.measured.triangles]
    return SurfaceTexture(coordinates, np.zeros(len(coordinates), np.int64), (TextureImage("wood", lambda: wood),))


def painted(texture: SurfaceTexture) -> PaintedFills:
    return paint_fills(FILLED, texture, np.random.default_rng(0), is_harmonic=True)


def test_a_page_is_as_dense_as_the_image_around() -> None:
    coarse, fine = (painted(textured(scale)).page for scale in (0.5, 1.0))
    assert coarse is not None
    assert fine is not None
    spans = [np.ptp(page.layout.corners.reshape(-1, 2), axis=0).max() for page in (coarse, fine)]
    density = MeasuredTexture(FILLED, textured()).texels_per_unit(np.zeros(len(FILLED.disagreement), np.int64))
    # The plate is bumpy, so that its surface is a little longer than its image.
    assert density[density > 0] == pytest.approx(64 / 2.1, rel=0.05)
    assert spans[1] > 1.3 * spans[0]


def test_triangles_without_an_image_at_their_hole_are_left_out() -> None:
    texture = textured()
    right = FILLED.mesh.vertices[FILLED.measured.triangles].mean(axis=1)[:, 0] > 0
    bare = SurfaceTexture(texture.coordinates, np.where(right, 0, -1), texture.images)
    page = painted(bare).page
    assert page is not None
    new = FILLED.mesh.triangles[FILLED.n_measured_triangles :][page.rows]
    assert (FILLED.mesh.vertices[new].mean(axis=1)[:, 0] > 0).all()
    assert 0 < len(page.rows) < len(FILLED.triangle_hole)


def test_without_any_image_there_is_no_page() -> None:
    texture = textured()
    nothing = SurfaceTexture(texture.coordinates, np.full(len(texture.material), -1), texture.images)
    result = painted(nothing)
    assert (result.page, result.method, result.problems) == (None, None, [])


def test_images_are_decoded_until_they_are_too_many(monkeypatch: pytest.MonkeyPatch) -> None:
    # Both halves have an image of 4096 texels.
    monkeypatch.setattr(measured_texture, "MOST_PIXELS_IN_ALL", 5000)
    whole = textured()
    right = FILLED.mesh.vertices[FILLED.measured.triangles].mean(axis=1)[:, 0] > 0
    both = SurfaceTexture(whole.coordinates, right.astype(np.int64), whole.images * 2)
    result = painted(both)
    assert [problem.code for problem in result.problems] == ["image_too_large"]
    assert result.page is not None
    assert set(result.page.material.tolist()) == {0}


def test_samples_of_fills_lie_as_dense_as_measured_ones() -> None:
    near = MeasuredTexture(FILLED, textured())
    taken = samples.take_samples(near, 0.02)
    fine = taken.filled
    new = TriangleMesh(fine.mesh.vertices, fine.mesh.triangles[fine.n_measured_triangles :])
    assert mean_edge_length(new) == pytest.approx(mean_edge_length(fine.measured), rel=0.15)
    assert mean_edge_length(fine.measured) < 0.02


def test_there_are_no_more_samples_than_can_be_afforded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(samples, "MOST_SAMPLES", 5000)
    taken = samples.take_samples(MeasuredTexture(FILLED, textured()), 0.001)
    assert len(taken.filled.mesh.vertices) < 10_000


def test_colours_at_the_border_of_a_chart_come_from_inside_of_it() -> None:
    # The image holds the surface's colour in its left half, as an atlas may, and another one right beside it.
    atlas = np.full((64, 64, 3), 250, np.uint8)
    atlas[:, :32] = 40
    texture = textured(wood=encoded(atlas))
    half = SurfaceTexture(texture.coordinates * np.array([0.5, 1.0]), texture.material, texture.images)
    right_side = FILLED.mesh.vertices[:, 0].max()
    stretched = half.coordinates.copy()
    stretched[..., 0] = 0.5 * (FILLED.mesh.vertices[:, 0] / (2 * right_side) + 0.5)[FILLED.measured.triangles]
    taken = samples.take_samples(MeasuredTexture(FILLED, SurfaceTexture(stretched, half.material, half.images)), 0.03)
    assert (taken.colours == 40).all()


def test_the_same_seed_paints_the_same_page() -> None:
    pages = [painted(textured()).page for _ in range(2)]
    assert pages[0] is not None
    assert pages[1] is not None
    assert pages[0].png == pages[1].png
    assert Image.open(io.BytesIO(pages[0].png)).mode == "RGB"

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from quadpatch.errors import EmptyMeshError
from quadpatch.preview.invented import SURE, TINT, UNSURE, Invented
from quadpatch.preview.shading import BACK
from quadpatch.preview.sheet import render_before_after
from quadpatch.types import FloatArray, TriangleMesh


def sphere(n: int = 40) -> TriangleMesh:
    u, v = np.meshgrid(np.linspace(0, np.pi, n), np.linspace(0, 2 * np.pi, 2 * n), indexing="ij")
    vertices = np.stack([np.sin(u) * np.sin(v), np.cos(u), np.sin(u) * np.cos(v)], axis=-1).reshape(-1, 3)
    index = np.arange(2 * n * n).reshape(n, 2 * n)
    a, b, c, d = (part.ravel() for part in (index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]))
    return TriangleMesh(vertices, np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)]))


def repaired() -> tuple[TriangleMesh, Invented]:
    mesh = sphere()
    return mesh, Invented.of_mask(mesh.vertices[mesh.triangles].mean(axis=1) @ np.array([0.6, 0, 0.8]) > 0.93)


def pixels(path: Path) -> FloatArray:
    with Image.open(path) as image:
        assert image.format == "PNG"
        return np.asarray(image, dtype=np.float64) / 255


def share_of_hue(picture: FloatArray, colour: FloatArray) -> float:
    """Share of pixels that are a shade of a colour, however lit."""
    dark = picture.max(axis=2) < 0.1
    level = picture / np.maximum(picture.max(axis=2, keepdims=True), 1e-9)
    alike = np.abs(level - colour / colour.max()).max(axis=2) < 0.03
    return float((alike & ~dark).mean())


@pytest.fixture(scope="module")
def plain(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("sheet") / "plain.png"
    render_before_after(*repaired(), path)
    return path


def test_holes_show_the_inside_before_and_the_tint_after(plain: Path) -> None:
    sheet = pixels(plain)
    middle = sheet.shape[1] // 2
    left, right = sheet[60:640, :middle], sheet[60:640, middle:]
    assert share_of_hue(left, BACK) > 0.01
    assert share_of_hue(left, TINT) == 0
    assert share_of_hue(right, TINT) > 0.01
    assert share_of_hue(right, BACK) == 0


def test_a_surface_turned_inside_out_gives_the_same_sheet(plain: Path, tmp_path: Path) -> None:
    mesh, invented = repaired()
    render_before_after(TriangleMesh(mesh.vertices, mesh.triangles[:, ::-1]), invented, tmp_path / "sheet.png")
    assert np.abs(pixels(plain) - pixels(tmp_path / "sheet.png")).mean() < 1e-3


def test_the_same_repair_gives_the_same_bytes(plain: Path, tmp_path: Path) -> None:
    render_before_after(*repaired(), tmp_path / "sheet.png")
    assert plain.read_bytes() == (tmp_path / "sheet.png").read_bytes()


def test_confidence_gives_the_colour_where_it_is_asked_for(tmp_path: Path) -> None:
    mesh, invented = repaired()
    for value, colour, other in ((1.0, SURE, UNSURE), (0.0, UNSURE, SURE)):
        shown = Invented(invented.hole, np.full(len(invented.hole), value))
        render_before_after(mesh, shown, tmp_path / "sheet.png")
        after = pixels(tmp_path / "sheet.png")[60:640, 790:]
        assert share_of_hue(after, colour) > 0.01
        assert share_of_hue(after, other) == 0


def test_close_ups_have_the_numbers_of_their_holes(plain: Path, tmp_path: Path) -> None:
    mesh, invented = repaired()
    sheets = []
    for number in (1, 7):
        render_before_after(mesh, Invented(np.where(invented.mask, number, -1)), tmp_path / "sheet.png")
        sheets.append(pixels(tmp_path / "sheet.png"))
    rows, columns = np.nonzero(np.abs(sheets[0] - sheets[1]).max(axis=2) > 0.1)
    # Nothing but the digit in the caption of the close-up differs.
    assert 0 < np.ptp(rows) < 20
    assert 0 < np.ptp(columns) < 12


def test_the_angle_does_not_depend_on_what_fills_the_holes(plain: Path, tmp_path: Path) -> None:
    mesh, invented = repaired()
    vertices = mesh.vertices.copy()
    inside = np.setdiff1d(mesh.triangles[invented.mask], mesh.triangles[~invented.mask])
    vertices[inside] *= 0.9
    render_before_after(TriangleMesh(vertices, mesh.triangles), invented, tmp_path / "sheet.png")
    before = (slice(60, 640), slice(0, 780))
    assert np.abs(pixels(plain)[before] - pixels(tmp_path / "sheet.png")[before]).mean() < 1e-3


def test_without_invented_surface_there_are_no_close_ups(plain: Path, tmp_path: Path) -> None:
    mesh, invented = repaired()
    render_before_after(mesh, Invented.of_mask(np.zeros_like(invented.mask)), tmp_path / "sheet.png")
    assert pixels(tmp_path / "sheet.png").shape[0] < pixels(plain).shape[0] - 200


def test_nothing_to_draw_is_said(tmp_path: Path) -> None:
    empty = TriangleMesh(np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int64))
    with pytest.raises(EmptyMeshError):
        render_before_after(empty, Invented.of_mask(np.zeros(0, dtype=bool)), tmp_path / "sheet.png")
    assert not (tmp_path / "sheet.png").exists()

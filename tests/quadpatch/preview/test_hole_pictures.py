from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from quadpatch.mesh.holes import find_holes
from quadpatch.options import HoleOptions, RepairOptions
from quadpatch.preview.hole_pictures import NumberedHole, draw_hole, mean_normal
from quadpatch.preview.invented import TINT, Invented
from quadpatch.preview.pair import Pair, filled_pair
from quadpatch.preview.shading import BACK
from quadpatch.recipes.default import inpaint
from quadpatch.types import FloatArray, TriangleMesh
from tests.quadpatch.filling.gaps import halves
from tests.quadpatch.preview.test_sheet import share_of_hue
from tests.quadpatch.shapes import cylinder, punched, sphere

DIRECTION = np.array([0.6, 0.0, 0.8])


def opened(mesh: TriangleMesh, direction: FloatArray, cosine: float) -> TriangleMesh:
    """A ball without the triangles around a direction."""
    kept = ~(mesh.vertices[mesh.triangles].mean(axis=1) @ direction > cosine)
    return TriangleMesh(mesh.vertices, mesh.triangles[kept])


def ball_with_a_hole() -> tuple[TriangleMesh, Pair, NumberedHole]:
    closed = sphere(4)
    before = opened(closed, DIRECTION, 0.95)
    (hole,) = find_holes(before)
    is_new = closed.vertices[closed.triangles].mean(axis=1) @ DIRECTION > 0.95
    order = np.argsort(is_new, kind="stable")
    after = TriangleMesh(closed.vertices, closed.triangles[order])
    return before, filled_pair(after, Invented.of_mask(is_new[order])), NumberedHole(7, before.vertices[hole.loop])


def picture(path: Path) -> FloatArray:
    with Image.open(path) as image:
        return np.asarray(image, dtype=np.float64) / 255


def test_the_mean_normal_of_a_hole_points_out_of_the_surface() -> None:
    before = opened(sphere(4), DIRECTION, 0.95)
    (hole,) = find_holes(before)
    assert mean_normal(before.vertices[hole.loop]) @ DIRECTION > 0.99


def test_the_mean_normal_of_an_open_end_points_along_the_tube() -> None:
    tube = cylinder(24, 5)
    normals = [mean_normal(tube.vertices[hole.loop]) for hole in find_holes(tube)]
    assert sorted(round(float(normal[2]), 6) for normal in normals) == [-1.0, 1.0]


@pytest.mark.parametrize("scale", [1e-30, 1.0, 1e15])
def test_a_rim_without_area_has_no_normal_and_one_of_any_size_has(scale: float) -> None:
    slit = scale * np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [1, 0, 0]])
    assert not mean_normal(slit).any()
    square = scale * np.array([[0.0, 0, 0], [0, 1, 0], [1, 1, 0], [1, 0, 0]])
    np.testing.assert_allclose(mean_normal(square), [0, 0, 1], atol=1e-12)


def test_the_hole_is_open_before_and_filled_after_and_lies_in_the_middle(tmp_path: Path) -> None:
    _, pair, hole = ball_with_a_hole()
    (tmp_path / "hole.png").write_bytes(draw_hole(pair, hole))
    sheet = picture(tmp_path / "hole.png")
    middle = sheet.shape[1] // 2
    left, right = sheet[30:, : middle - 4], sheet[30:, middle + 4 :]
    assert share_of_hue(left, BACK) > 0.08
    assert share_of_hue(left, TINT) == 0
    assert share_of_hue(right, TINT) > 0.08
    assert share_of_hue(right, BACK) < 0.002
    # Seen along its normal, the hole covers the middle of the picture.
    assert share_of_hue(right[160:260, 160:260], TINT) > 0.99


def test_the_number_is_drawn_in_both_pictures(tmp_path: Path) -> None:
    _, pair, hole = ball_with_a_hole()
    sheets = []
    for number in (7, 41):
        (tmp_path / f"{number}.png").write_bytes(draw_hole(pair, NumberedHole(number, hole.rim)))
        sheets.append(picture(tmp_path / f"{number}.png"))
    differs = (sheets[0] != sheets[1]).any(axis=2)
    middle = differs.shape[1] // 2
    for half in (differs[30:, :middle], differs[30:, middle:]):
        assert half[:60, :80].any()
        assert not half[80:].any()


def test_a_hole_without_extent_is_drawn_all_the_same(tmp_path: Path) -> None:
    _, pair, _ = ball_with_a_hole()
    for name, rim in (("point", np.zeros((3, 3))), ("slit", np.array([[0.0, 0, 1], [0, 0.1, 1], [0, 0.2, 1]]))):
        (tmp_path / f"{name}.png").write_bytes(draw_hole(pair, NumberedHole(0, rim)))
        assert (tmp_path / f"{name}.png").exists()


def test_a_surface_turned_inside_out_is_seen_from_outside(tmp_path: Path) -> None:
    before, pair, hole = ball_with_a_hole()
    after = TriangleMesh(pair.after.vertices, pair.after.triangles[:, ::-1])
    invented = np.arange(len(after.triangles)) >= len(before.triangles)
    inside_out = filled_pair(after, Invented.of_mask(invented))
    assert inside_out.is_flipped
    (tmp_path / "turned.png").write_bytes(draw_hole(inside_out, NumberedHole(7, hole.rim[::-1])))
    assert share_of_hue(picture(tmp_path / "turned.png"), TINT) > 0.04


def test_punched_holes_of_a_ball_face_outwards() -> None:
    mesh = punched(sphere(3), (0, 0, 1), (0, -1, 0), radius=0.3)
    holes = find_holes(mesh)
    assert len(holes) == 2
    for hole in holes:
        rim = mesh.vertices[hole.loop]
        assert mean_normal(rim) @ rim.mean(axis=0) > 0


def test_a_bridge_shows_both_its_numbers_and_rims_and_its_strip(tmp_path: Path) -> None:
    gap = halves(0.4, 4)
    repair = inpaint(gap.mesh, None, RepairOptions(HoleOptions(bridges=((0, 1),))))
    filled, holes = repair.filled, find_holes(gap.mesh)
    pair = filled_pair(filled.mesh, Invented.of_mask(filled.invented_triangles))
    rims = [gap.mesh.vertices[hole.loop] for hole in holes]
    joined = NumberedHole(0, rims[0], NumberedHole(1, rims[1]), np.array([1.0, 0.0, 0.0]))
    assert (joined.title, joined.number) == ("bridge 0:1", "0:1")
    (tmp_path / "bridge.png").write_bytes(draw_hole(pair, joined))
    whole = picture(tmp_path / "bridge.png")
    before, after = whole[:, : whole.shape[1] // 2], whole[:, whole.shape[1] // 2 :]
    assert share_of_hue(before, TINT) == 0
    assert share_of_hue(after, TINT) > 0.02

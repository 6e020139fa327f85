"""Pictures of tasks that move vertices."""

from pathlib import Path

import numpy as np
import pytest

from quadpatch.preview.comparison import changed_places, render_comparison
from quadpatch.preview.drawing import add_comparison
from quadpatch.preview.invented import TINT
from quadpatch.tasks.result import TaskResult
from quadpatch.types import FloatArray, TriangleMesh
from tests.quadpatch.preview.test_sheet import pixels, share_of_hue
from tests.quadpatch.shapes import sphere

BALL = sphere(4)


def noisy(scale: float = 0.01) -> tuple[TriangleMesh, FloatArray]:
    """Noise on one side of the ball, and how far each triangle is off."""
    is_front = BALL.vertices[:, 2] > 0
    lengths = np.random.default_rng(0).normal(size=len(BALL.vertices)) * scale * is_front
    shift = np.abs(lengths)[BALL.triangles].mean(axis=1) / (2 * scale)
    return TriangleMesh(BALL.vertices * (1 + lengths)[:, None], BALL.triangles), np.clip(shift, 0, 1)


def halves(path: Path) -> tuple[FloatArray, FloatArray]:
    sheet = pixels(path)
    middle = sheet.shape[1] // 2
    return sheet[60:640, :middle], sheet[60:640, middle:]


def test_what_changed_is_tinted_afterwards_alone(tmp_path: Path) -> None:
    before, shift = noisy()
    render_comparison(before, BALL, shift > 0, tmp_path / "sheet.png")
    left, right = halves(tmp_path / "sheet.png")
    assert share_of_hue(left, TINT) == 0
    assert share_of_hue(right, TINT) > 0.05


def test_a_small_shift_is_a_weak_tint(tmp_path: Path) -> None:
    before, shift = noisy()
    blue = []
    for strength in (0.2, 1.0):
        render_comparison(before, BALL, np.asarray(strength * (shift > 0), np.float64), tmp_path / "sheet.png")
        _, right = halves(tmp_path / "sheet.png")
        is_ball = right.max(axis=2) < 0.95
        blue.append(float((right[..., 2] / right[..., 0])[is_ball].mean()))
    assert blue[1] < blue[0] - 0.1


def test_missing_corners_are_left_out(tmp_path: Path) -> None:
    vertices = BALL.vertices.copy()
    vertices[BALL.vertices[:, 2] > 0.5] = np.nan
    before = TriangleMesh(vertices, BALL.triangles)
    changed = np.asarray(np.isnan(vertices[BALL.triangles]).any(axis=(1, 2)))
    render_comparison(before, BALL, changed, tmp_path / "sheet.png")
    left, right = halves(tmp_path / "sheet.png")
    assert share_of_hue(left, TINT) == 0
    assert share_of_hue(right, TINT) > 0.02


def test_close_ups_are_of_where_most_has_changed_and_apart() -> None:
    near_the_top = BALL.vertices[BALL.triangles].mean(axis=1)[:, 1]
    places = changed_places(BALL, np.clip(near_the_top, 0, 1) ** 8, 3)
    assert len(places) == 3
    assert near_the_top[places[0]].min() > 0.9
    assert len(np.unique(np.concatenate(places))) == sum(map(len, places))
    assert changed_places(BALL, np.zeros(len(BALL.triangles), dtype=bool), 3) == []


def test_a_task_gets_its_picture_or_a_warning(tmp_path: Path) -> None:
    before, shift = noisy()
    report: dict[str, list[object]] = {"stages": [], "warnings": []}
    result = TaskResult(report, before, BALL, shift > 0, shift)
    add_comparison(result, tmp_path / "sheet.png")
    assert pixels(tmp_path / "sheet.png").shape[1] > 1000
    assert report["warnings"] == []
    nothing = TriangleMesh(BALL.vertices, BALL.triangles[:0])
    add_comparison(TaskResult(report, before, nothing, shift[:0] > 0), tmp_path / "none.png")
    assert report["warnings"] == ["there is no picture: there is no surface to draw"]
    assert [stage["name"] for stage in report["stages"]] == ["preview", "preview"]  # type: ignore[index]
    assert not (tmp_path / "none.png").exists()


@pytest.mark.parametrize("kind", [bool, float])
def test_the_same_task_gives_the_same_bytes(kind: type, tmp_path: Path) -> None:
    before, shift = noisy()
    change = shift > 0 if kind is bool else shift
    for name in ("one.png", "two.png"):
        render_comparison(before, BALL, change, tmp_path / name)
    assert (tmp_path / "one.png").read_bytes() == (tmp_path / "two.png").read_bytes()

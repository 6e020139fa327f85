from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from quadpatch.mesh.measures import diagonal
from quadpatch.preview import comparison, drawing, sheet, thinning
from quadpatch.preview.comparison import render_comparison
from quadpatch.preview.drawing import add_close_ups
from quadpatch.preview.invented import Invented
from quadpatch.preview.pair import Pair, filled_pair
from quadpatch.preview.sheet import render_before_after
from quadpatch.preview.thinning import thinned
from quadpatch.repair import repair_and_keep
from quadpatch.types import TriangleMesh
from tests.quadpatch.shapes import bumpy_plate, on_surface, punched, write_ply

WHOLE = bumpy_plate(400, 2.0)
IS_FILL = np.linalg.norm(WHOLE.vertices[WHOLE.triangles].mean(axis=1)[:, :2] - [0.3, 0.2], axis=1) < 0.05
FILL = np.flatnonzero(IS_FILL)


@pytest.fixture(autouse=True)
def coarse_grid(monkeypatch: pytest.MonkeyPatch) -> None:
    """Cells of a small mesh that hold several vertices, as those of a large one do."""
    monkeypatch.setattr(thinning, "_CELLS", 250)


def test_a_large_mesh_keeps_its_shape_and_the_surroundings_of_a_hole() -> None:
    mesh, kept = thinned(WHOLE, [WHOLE.vertices[np.unique(WHOLE.triangles[FILL])]])
    assert len(mesh.triangles) < 0.5 * len(WHOLE.triangles)
    assert len(kept) == len(mesh.triangles)
    assert set(FILL.tolist()) <= set(kept.tolist())
    assert (mesh.vertices[mesh.triangles[np.isin(kept, FILL)]] == WHOLE.vertices[WHOLE.triangles[FILL]]).all()
    # Every corner moved by less than the diagonal of a cell.
    moved = np.linalg.norm(mesh.vertices[mesh.triangles] - WHOLE.vertices[WHOLE.triangles[kept]], axis=2)
    assert 0 < moved.max() < diagonal(WHOLE) / 100
    a, b, c = mesh.triangles.T
    assert ((a != b) & (b != c) & (c != a)).all()


def test_without_a_hole_all_of_a_mesh_is_thinned() -> None:
    mesh, kept = thinned(WHOLE, [])
    assert 0 < len(kept) == len(mesh.triangles) < 0.5 * len(WHOLE.triangles)


def test_a_vertex_that_no_triangle_uses_may_lie_anywhere() -> None:
    stray = TriangleMesh(np.concatenate([WHOLE.vertices, [[1e300, -1e300, 0.0]]]), WHOLE.triangles)
    assert (thinned(stray, [])[1] == thinned(WHOLE, [])[1]).all()


def test_the_picture_of_a_large_scan_is_about_that_of_all_its_triangles(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pictures = []
    for most in (10_000_000, 100_000):
        monkeypatch.setattr(sheet, "MOST_TRIANGLES", most)
        path = tmp_path / f"{most}.png"
        render_before_after(WHOLE, Invented.of_mask(IS_FILL), path)
        pictures.append(np.asarray(Image.open(path).convert("RGB"), np.float64))
    whole, thin = pictures
    assert whole.shape == thin.shape
    assert thin.mean() == pytest.approx(whole.mean(), rel=0.05)
    # What is tinted, in the overview and in the close-up.
    tinted = [(picture[..., 0] - picture[..., 2] > 60).mean() for picture in pictures]
    assert tinted[1] == pytest.approx(tinted[0], rel=0.2)
    assert tinted[0] > 0.005


def test_the_picture_of_a_large_task_is_about_that_of_all_its_triangles(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = TriangleMesh(WHOLE.vertices + np.array([0, 0, 0.01]), WHOLE.triangles)
    pictures = []
    for most in (10_000_000, 100_000):
        monkeypatch.setattr(comparison, "MOST_TRIANGLES", most)
        render_comparison(before, WHOLE, IS_FILL, tmp_path / f"{most}.png")
        pictures.append(np.asarray(Image.open(tmp_path / f"{most}.png").convert("RGB"), np.float64))
    whole, thin = pictures
    assert (whole != thin).any()
    assert thin.mean() == pytest.approx(whole.mean(), rel=0.05)


def test_close_ups_of_a_large_scan_keep_the_surroundings_of_the_holes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    plate = bumpy_plate(100, 2.0)
    scan = punched(plate, *on_surface(plate, (0.3, 0.2)), radius=0.06)
    done = repair_and_keep(write_ply(tmp_path / "in.ply", scan), tmp_path / "out.ply", "smooth")
    drawn: list[int] = []

    def counted(mesh: TriangleMesh, invented: Invented) -> Pair:
        drawn.append(len(mesh.triangles))
        return filled_pair(mesh, invented)

    monkeypatch.setattr(thinning, "_CELLS", 60)
    monkeypatch.setattr(drawing, "filled_pair", counted)
    pictures = []
    for most in (10_000_000, 10_000):
        monkeypatch.setattr(drawing, "MOST_TRIANGLES", most)
        add_close_ups(done, tmp_path / str(most))
        (path,) = (tmp_path / str(most)).iterdir()
        pictures.append(np.asarray(Image.open(path), np.float64))
    assert drawn[1] < 0.5 * drawn[0]
    whole, thin = pictures
    assert (np.abs(whole - thin).max(axis=2) > 4).mean() < 0.01

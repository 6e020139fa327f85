from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from onebox import relief
from onebox.relief import PunchedRelief
from quadpatch.filling.fairing import THIN_PLATE
from quadpatch.filling.fill import close_holes, fair_holes
from quadpatch.mesh.holes import find_holes
from quadpatch.types import TriangleMesh


@pytest.fixture
def punched(monkeypatch: pytest.MonkeyPatch) -> PunchedRelief:
    monkeypatch.setattr(relief, "_N_SIDE", 50)
    monkeypatch.setattr(relief, "_WAVES", 3)
    return PunchedRelief.make()


def closed(mesh: TriangleMesh) -> TriangleMesh:
    _, *loops = (hole.loop for hole in sorted(find_holes(mesh), key=lambda hole: -hole.diameter))
    return fair_holes(close_holes(mesh, loops), THIN_PLATE).mesh


def test_the_relief_has_nine_holes_and_its_border(punched: PunchedRelief) -> None:
    assert len(find_holes(punched.damaged)) == 10
    assert len(find_holes(punched.truth)) == 1


def test_the_error_is_that_of_the_new_vertices(punched: PunchedRelief) -> None:
    faired = closed(punched.damaged)
    vertices = faired.vertices.copy()
    n = len(punched.damaged.vertices)
    on_truth = TriangleMesh(np.concatenate([vertices[:n], punched.truth.vertices[:5]]), faired.triangles)
    assert punched.error(on_truth) == pytest.approx(0.0, abs=1e-12)
    assert 0.0 < punched.error(faired) < 1.0
    vertices[n:, 2] += 1.0
    assert punched.error(TriangleMesh(vertices, faired.triangles)) > 5.0


def test_the_damaged_relief_and_its_repairs_are_drawn_beside_each_other(punched: PunchedRelief, tmp_path: Path) -> None:
    faired = closed(punched.damaged)
    punched.draw({"geometry alone": faired, "learned from the mesh": faired}, tmp_path / "relief.png")
    sheet = np.asarray(Image.open(tmp_path / "relief.png").convert("RGB"), np.float64)
    tiles = [sheet[26:, left : left + 420] for left in (0, 428, 856)]
    # Invented surface is orange: more red than blue.
    orange = [float((tile[..., 0] - tile[..., 2] > 25).mean()) for tile in tiles]
    assert orange[0] == 0
    assert min(orange[1:]) > 0.02

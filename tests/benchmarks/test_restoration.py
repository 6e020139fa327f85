from pathlib import Path

import numpy as np
import pytest

from benchmarks.restoration import Score, hidden_at_random, in_unit_cube, main
from quadpatch.types import TriangleMesh
from tests.quadpatch.shapes import open_grid, sphere, write_ply


def test_a_score_tells_sliding_from_leaving_the_surface() -> None:
    plane = open_grid(9)
    missing = np.zeros(81, bool)
    missing[40] = True
    slid, lifted = plane.vertices.copy(), plane.vertices.copy()
    slid[40, 0] += 0.003
    lifted[40, 2] += 0.003
    sliding, leaving = Score.of(plane, slid, missing), Score.of(plane, lifted, missing)
    assert (sliding.coordinate, sliding.distance) == pytest.approx((np.sqrt(3), 0), abs=1e-9)
    assert (leaving.coordinate, leaving.distance) == pytest.approx((np.sqrt(3), 3), abs=1e-9)


def test_the_longest_side_becomes_one() -> None:
    mesh = in_unit_cube(TriangleMesh(sphere(2).vertices * [1, 5, 2] + 7, sphere(2).triangles))
    assert mesh.vertices.min() == 0
    assert np.ptp(mesh.vertices, axis=0).max() == pytest.approx(1)


def test_the_wanted_share_is_missing() -> None:
    assert hidden_at_random(1000, 0.7).sum() == 700


def test_the_table_has_the_published_figures_beside_ours(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "meshes").mkdir()
    write_ply(tmp_path / "meshes" / "stanford_bunny.ply", sphere(4))
    wanted = ["--mesh", "stanford_bunny", "--share", "0.2", "--model", "smooth", "--output", str(tmp_path / "table.md")]
    main([str(tmp_path), *wanted])
    shown = capsys.readouterr().out
    written = (tmp_path / "table.md").read_text()
    for method in ("Zhong 2016", "the paper", "least-squares mesh", "smooth"):
        assert method in shown
        assert method in written
    assert "1.11" in written

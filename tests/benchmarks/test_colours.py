from pathlib import Path

import numpy as np
import pytest

from benchmarks.colours import (
    ColouredMesh,
    colours_at,
    energy_per_area,
    expected,
    kept_triangles,
    normalised,
    read_coloured,
    score,
    write_coloured,
)
from quadpatch.types import TriangleMesh
from tests.quadpatch.shapes import open_grid, write_ply

GRID = open_grid(21, 10.0)
RAMP = ColouredMesh(GRID, 100 + GRID.vertices * np.array([3.0, -2.0, 0.0]))
INNER = np.abs(GRID.vertices[GRID.triangles].mean(axis=1)).max(axis=1) < 2
REMAINING = TriangleMesh(GRID.vertices, GRID.triangles[~INNER])


def closed(colours: np.ndarray) -> ColouredMesh:
    """Close the hole again by copies of its vertices, which are new, in colours of their own (n, 3)."""
    removed = np.unique(GRID.triangles[INNER])
    new = len(GRID.vertices) + np.searchsorted(removed, GRID.triangles[INNER])
    mesh = TriangleMesh(
        np.concatenate([GRID.vertices, GRID.vertices[removed]]), np.concatenate([REMAINING.triangles, new])
    )
    return ColouredMesh(mesh, np.concatenate([RAMP.colours, colours[removed]]))


def test_the_energy_of_an_even_change_is_its_squared_slope() -> None:
    assert energy_per_area(GRID.vertices, GRID.triangles, RAMP.colours) == pytest.approx(3**2 + 2**2)


def test_turning_a_surface_in_space_leaves_the_energy_as_it_is() -> None:
    turned = GRID.vertices @ np.linalg.qr(np.random.default_rng(0).normal(size=(3, 3)))[0]
    assert energy_per_area(turned, GRID.triangles, RAMP.colours) == pytest.approx(13)


def test_the_truth_itself_keeps_all_and_has_no_error() -> None:
    psnr, kept = score(RAMP, REMAINING, closed(RAMP.colours))
    assert psnr == np.inf
    assert kept == pytest.approx(1.0)


def test_one_colour_keeps_nothing_and_an_error_of_a_unit_has_48_decibels() -> None:
    _, kept = score(RAMP, REMAINING, closed(np.full_like(RAMP.colours, 100.0)))
    assert kept == pytest.approx(0.0)
    psnr, kept = score(RAMP, REMAINING, closed(RAMP.colours + 1.0))
    assert psnr == pytest.approx(20 * np.log10(255.0))
    assert kept == pytest.approx(1.0)


def test_triangles_that_remain_are_known_whatever_their_vertices_are_called() -> None:
    used, local = np.unique(REMAINING.triangles, return_inverse=True)
    order = np.random.default_rng(0).permutation(len(used))
    shuffled = TriangleMesh(GRID.vertices[used][order], np.argsort(order)[local.reshape(-1, 3)])
    assert (kept_triangles(GRID, shuffled) == ~INNER).all()
    assert (colours_at(RAMP, shuffled.vertices) == RAMP.colours[used][order]).all()


def test_a_coloured_file_comes_back(tmp_path: Path) -> None:
    write_coloured(tmp_path / "ramp.ply", RAMP)
    again = read_coloured(tmp_path / "ramp.ply")
    assert np.abs(again.colours - RAMP.colours).max() <= 0.5
    assert (again.mesh.triangles == GRID.triangles).all()
    assert np.ptp(normalised(again).mesh.vertices, axis=0).max() == pytest.approx(1.0)


def test_a_file_without_colours_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="no colours"):
        read_coloured(write_ply(tmp_path / "plain.ply", GRID))


def test_what_calibration_expects_is_said_where_it_was_asked() -> None:
    verdict = {"gain_db": -0.9, "kept": 0.625, "kept_harmonic": 0.2, "n_holes": 24}
    assert expected({"method": "exemplars", "calibration": verdict}) == "-0.90 dB, 0.62"
    assert expected({"method": "harmonic", "calibration": None}) == ""

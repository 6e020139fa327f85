import numpy as np
import pytest

from quadpatch.calibration.calibration_set import CalibrationSet, cut_calibration_set, error_per_hole, may_gain
from quadpatch.calibration.crease_selection import calibrate_creases
from quadpatch.calibration.energy_selection import EnergyBlend
from quadpatch.filling.creases import crease_displacement, crease_share
from quadpatch.filling.fairing import THIN_PLATE
from quadpatch.filling.fill import fair_holes
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.mesh.measures import mean_edge_length
from quadpatch.options import RepairOptions
from quadpatch.recipes.default import inpaint
from quadpatch.types import TriangleMesh
from tests.quadpatch.shapes import open_grid, punched, relief

BLEND = EnergyBlend.of_one(THIN_PLATE)


def folded_paper(n: int, n_creases: int = 8) -> TriangleMesh:
    """Planes that meet at right angles along parallel creases."""
    flat = open_grid(n, 2.0)
    x, y, _ = flat.vertices.T
    width = 2.0 / n_creases
    return TriangleMesh(np.stack([x, y, np.abs((x + 1.0) % (2 * width) - width)], axis=1), flat.triangles)


def calibration(mesh: TriangleMesh, diameter: float) -> tuple[CalibrationSet, FilledMesh]:
    holes = cut_calibration_set(mesh, diameter, mean_edge_length(mesh), np.random.default_rng(0))
    assert holes is not None
    return holes, fair_holes(holes.closed, THIN_PLATE)


PAPER = folded_paper(121)


def test_creases_are_believed_where_the_surface_has_them() -> None:
    holes, filled = calibration(PAPER, 0.2)
    creases = calibrate_creases(holes, BLEND, filled)
    assert creases.share == 1.0
    assert creases.filled is not None
    assert error_per_hole(holes, creases.filled).mean() < 0.4 * error_per_hole(holes, filled).mean()


@pytest.mark.parametrize("depth", [0.0, 0.05])
def test_creases_are_not_believed_on_other_surfaces(depth: float) -> None:
    holes, filled = calibration(relief(101, 2.0, depth, 8), 0.2)
    creases = calibrate_creases(holes, BLEND, filled)
    assert (creases.share, creases.filled) == (0.0, None)


@pytest.mark.parametrize(("mesh", "expected"), [(PAPER, True), (relief(101, 2.0, 0.05, 8), False)])
def test_the_first_round_tells_whether_creases_may_gain(mesh: TriangleMesh, expected: bool) -> None:
    holes, filled = calibration(mesh, 0.2)
    assert crease_share(holes.truth) > 0.01
    assert may_gain(holes, filled, crease_displacement(filled, rounds=1)) == expected
    assert not may_gain(holes, filled, np.zeros_like(filled.mesh.vertices[filled.n_measured_vertices :]))


def test_creases_that_few_holes_show_are_enough_where_the_others_lose_nothing() -> None:
    x, y, _ = (flat := open_grid(121, 2.0)).vertices.T
    roof = TriangleMesh(np.stack([x, y, -np.abs(x)], axis=1), flat.triangles)
    holes, filled = calibration(roof, 0.2)
    errors = error_per_hole(holes, filled)
    assert 1 <= (errors > 0.01 * errors.max()).sum() <= 4
    assert calibrate_creases(holes, BLEND, filled).share > 0.0


def test_a_repair_of_a_surface_with_creases_names_them_and_has_a_smaller_error() -> None:
    scan = punched(PAPER, (0.05, 0.0, 0.2), (-0.5, 0.5, 0.25), (0.45, -0.55, 0.2), radius=0.12)
    repair = inpaint(scan, None, RepairOptions())
    assert {result.fill for result in repair.results if result.verdict == "filled_smooth"} == {"creases"}
    assert all(result.energies for result in repair.results if result.fill)

from collections.abc import Iterator

import numpy as np
import pytest

from quadpatch.calibration.kept import KeptCalibrations
from quadpatch.filling.checked_fill import fill_checked
from quadpatch.filling.region import Region
from quadpatch.mesh.distance import distance_to_mesh
from quadpatch.mesh.measures import edge_statistics
from quadpatch.options import RepairOptions
from quadpatch.recipes.default import inpaint
from quadpatch.recipes.repair_region import Reach, repair_region
from quadpatch.recipes.result import Repair
from quadpatch.types import IntArray, TriangleMesh
from tests.quadpatch.shapes import bumpy_plate, on_surface, punched

TRUTH = bumpy_plate(300, 2.0)
SCAN = punched(TRUTH, *on_surface(TRUTH, (0.51, 0.4), (-0.6, -0.5)), radius=0.022)


def loops_of(repair: Repair) -> list[IntArray]:
    return [hole.loop for hole in repair.chosen]


@pytest.fixture(scope="module", autouse=True)
def few_sites() -> Iterator[None]:
    """Calibrate at few places, so that they are a small part of a small scan."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("quadpatch.recipes.repair_region.MAX_HOLES", 14)
        yield


@pytest.fixture(scope="module")
def repaired() -> Repair:
    return inpaint(SCAN, None, RepairOptions())


def region_of(mesh: TriangleMesh, loops: list[IntArray], diameter: float) -> Region:
    reach = Reach(diameter, 0.0, edge_statistics(mesh))
    return repair_region(mesh, loops, reach, None, np.random.default_rng(0)).region


def test_small_holes_need_a_part_of_a_large_scan(repaired: Repair) -> None:
    region = region_of(SCAN, loops_of(repaired), 0.044)
    assert len(region.mesh.triangles) < 0.5 * len(SCAN.triangles)


def test_large_holes_need_all_of_it(repaired: Repair) -> None:
    assert region_of(SCAN, loops_of(repaired), 0.5).mesh is SCAN


def test_a_part_gives_as_good_a_repair_as_the_whole(repaired: Repair, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("quadpatch.filling.region.MOST_OF_MESH", 0.0)
    whole = inpaint(SCAN, None, RepairOptions())
    errors = []
    for repair in (repaired, whole):
        filled = repair.filled
        assert filled.mesh.vertices[: len(SCAN.vertices)].tobytes() == SCAN.vertices.tobytes()
        assert filled.mesh.triangles[: len(SCAN.triangles)].tobytes() == SCAN.triangles.tobytes()
        errors.append(distance_to_mesh(filled.mesh.vertices[len(SCAN.vertices) :], TRUTH).mean())
    assert [hole.id for hole in repaired.chosen] == [hole.id for hole in whole.chosen]
    assert errors[0] == pytest.approx(errors[1], rel=0.3)


def test_a_fill_that_leaves_the_part_is_made_again_on_the_whole(monkeypatch: pytest.MonkeyPatch) -> None:
    seen: list[int] = []
    usual = fill_checked

    def watched(mesh: TriangleMesh, *rest: object) -> object:
        seen.append(len(mesh.triangles))
        return usual(mesh, *rest)  # type: ignore[arg-type]

    monkeypatch.setattr("quadpatch.recipes.default.fill_checked", watched)
    monkeypatch.setattr("quadpatch.recipes.repair_region._RINGS", 5.0)
    monkeypatch.setattr("quadpatch.recipes.repair_region.RepairRegion.holds", lambda self, filled: False)
    inpaint(SCAN, None, RepairOptions())
    assert len(seen) == 2
    assert seen[0] < seen[1] == len(SCAN.triangles)


def test_the_place_of_a_fill_tells_whether_the_part_was_enough(repaired: Repair) -> None:
    reach = Reach(0.044, 0.0, edge_statistics(SCAN))
    part = repair_region(SCAN, loops_of(repaired), reach, None, np.random.default_rng(0))
    assert part.holds(repaired.filled)
    new = repaired.filled.mesh.vertices[repaired.filled.n_measured_vertices :]
    assert not part.holds(repaired.filled.with_vertices(new + np.array([0.0, 0.0, 1.0])))


def test_a_kept_calibration_belongs_to_the_part_that_it_was_made_on(
    repaired: Repair, monkeypatch: pytest.MonkeyPatch
) -> None:
    kept = KeptCalibrations("scan")
    made, again = (inpaint(SCAN, None, RepairOptions(), kept=kept) for _ in range(2))
    assert (made.is_calibration_reused, again.is_calibration_reused) == (False, True)
    for repair in (made, again):
        assert repair.filled.mesh.vertices.tobytes() == repaired.filled.mesh.vertices.tobytes()
    monkeypatch.setattr("quadpatch.filling.region.MOST_OF_MESH", 0.0)
    assert not inpaint(SCAN, None, RepairOptions(), kept=kept).is_calibration_reused

"""Repairs that take what calibration found out from an earlier one: the same bytes, without its work.

Also tests `quadpatch.calibration.kept` and `quadpatch.calibration.record` from end to end.
"""

from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from quadpatch.calibration.kept import KeptCalibrations
from quadpatch.options import HoleOptions, HoleRule, RepairOptions
from quadpatch.recipes import default
from quadpatch.recipes.fairing_energies import CALIBRATED_ENERGIES
from quadpatch.repair import repair_and_keep
from quadpatch.types import TriangleMesh
from tests.quadpatch.calibration.test_crease_selection import folded_paper
from tests.quadpatch.shapes import bumpy_plate, punched, relief, write_ply

PLACES = [(x, y, 0.0) for x in (-0.5, 0.5) for y in (-0.45, 0.5)]


def plate_with_island() -> TriangleMesh:
    """A plate with a hole in which a piece of it still stands."""
    plate = bumpy_plate(80, 2.0)
    distance = np.linalg.norm(plate.vertices[plate.triangles].mean(axis=1)[:, :2], axis=1)
    return TriangleMesh(plate.vertices, plate.triangles[(distance < 0.06) | (distance > 0.16)])


# With calibration holes that are filled by fewer vertices than real ones (creased, rough), and with others.
SCANS: dict[str, Callable[[], TriangleMesh]] = {
    "smooth": lambda: punched(bumpy_plate(80, 2.0), *PLACES, radius=0.08),
    "creased": lambda: punched(folded_paper(111), (0.05, 0.0, 0.2), (-0.5, 0.5, 0.25), radius=0.12),
    "rough": lambda: punched(relief(110, 2.0, 0.03, 8), *PLACES, radius=0.13),
    "island": plate_with_island,
}


def repaired(
    scan: Path, model: str, kept: KeptCalibrations | None = None, options: RepairOptions | None = None
) -> tuple[bytes, dict[str, Any]]:
    """The bytes of a repair, and its report without what differs from run to run."""
    output = scan.with_name("repaired.ply")
    report = repair_and_keep(scan, output, model, options, kept=kept).report
    report["stages"] = [stage["name"] for stage in report["stages"]]
    return output.read_bytes(), report


@pytest.fixture(scope="module")
def calibrated(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], tuple[Path, bytes]]:
    """Return what gives a scan by name, and what a repair without a model found out by calibration."""

    @cache
    def of(name: str) -> tuple[Path, bytes]:
        scan, kept = write_ply(tmp_path_factory.mktemp(name) / f"{name}.ply", SCANS[name]()), KeptCalibrations()
        assert repaired(scan, "smooth", kept)[1]["calibration"]["reused"] is False
        return scan, kept.written()

    return of


@pytest.mark.parametrize(
    ("name", "model"),
    [
        *((name, model) for name in SCANS for model in ("smooth", "general-dictionary@1")),
        *(("smooth", "self"), ("island", "self")),
        *(pytest.param(name, "self", marks=pytest.mark.slow) for name in ("creased", "rough")),
    ],
)
def test_a_kept_calibration_gives_the_same_bytes_and_the_same_report(
    name: str, model: str, calibrated: Callable[[str], tuple[Path, bytes]], monkeypatch: pytest.MonkeyPatch
) -> None:
    scan, data = calibrated(name)
    plain_mesh, plain = repaired(scan, model)
    kept = KeptCalibrations.read(data, CALIBRATED_ENERGIES)
    monkeypatch.setattr(default, "suitable_blend", None)  # to calibrate again would fail
    mesh, report = repaired(scan, model, kept)
    reused, made = report.pop("calibration"), plain.pop("calibration")
    assert mesh == plain_mesh
    assert report == plain
    assert reused["holes"] == made["holes"] > 0
    assert (reused["reused"], made["reused"], kept.has_new) == (True, False, False)


def test_the_scans_differ_in_what_calibration_finds(tmp_path: Path) -> None:
    found = {}
    for name in ("smooth", "creased"):
        repair = repair_and_keep(write_ply(tmp_path / "in.ply", SCANS[name]()), tmp_path / "out.ply", "smooth").repair
        assert repair.calibration is not None
        found[name] = repair.calibration
    assert not found["smooth"].crease_share
    assert found["creased"].crease_share
    assert len(found["creased"].blend.energies) > 1
    assert (found["smooth"].is_graded, found["creased"].is_graded) == (False, True)


@pytest.fixture(scope="module")
def rough(calibrated: Callable[[str], tuple[Path, bytes]]) -> Path:
    return calibrated("rough")[0]


@pytest.fixture(scope="module")
def kept_of_rough(calibrated: Callable[[str], tuple[Path, bytes]]) -> bytes:
    return calibrated("rough")[1]


OTHER_OPTIONS = {
    "seed": (RepairOptions(seed=1), False),
    "weld tolerance": (RepairOptions(weld_tolerance=0.0), False),
    "plane patches": (RepairOptions(HoleOptions(rules=(HoleRule("flat"),))), None),
    # What calibration reads is the same: the median width of the holes, and the whole of the scan.
    "no model": (RepairOptions(HoleOptions(rules=(HoleRule("smooth"),))), True),
}


@pytest.mark.parametrize("name", OTHER_OPTIONS)
def test_a_calibration_for_other_options_is_not_used_and_is_no_error(
    rough: Path, kept_of_rough: bytes, name: str
) -> None:
    options, is_reused = OTHER_OPTIONS[name]
    kept = KeptCalibrations.read(kept_of_rough, CALIBRATED_ENERGIES)
    mesh, report = repaired(rough, "smooth", kept, options)
    plain_mesh, plain = repaired(rough, "smooth", None, options)
    assert report.pop("calibration")["reused"] is (is_reused is True)
    # With nothing but plane patches there is nothing to calibrate for, and nothing to be kept.
    assert kept.has_new is (is_reused is False)
    plain.pop("calibration")
    assert (mesh, report) == (plain_mesh, plain)


def test_a_calibration_of_another_scan_is_not_used(kept_of_rough: bytes, tmp_path: Path) -> None:
    mesh = SCANS["rough"]()
    vertices = mesh.vertices.copy()
    vertices[0, 2] = np.nextafter(vertices[0, 2], 1.0)
    kept = KeptCalibrations.read(kept_of_rough, CALIBRATED_ENERGIES)
    other = write_ply(tmp_path / "other.ply", TriangleMesh(vertices, mesh.triangles))
    assert repaired(other, "smooth", kept)[1]["calibration"]["reused"] is False
    again = KeptCalibrations.read(kept.written(), CALIBRATED_ENERGIES)
    assert repaired(other, "smooth", again)[1]["calibration"]["reused"] is True


def test_a_scan_that_is_named_is_not_hashed(rough: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    kept = KeptCalibrations("a name")
    monkeypatch.setattr(default, "array_digest", None)
    repaired(rough, "smooth", kept)
    named, renamed = (
        KeptCalibrations.read(kept.written(), CALIBRATED_ENERGIES, name) for name in ("a name", "another")
    )
    assert repaired(rough, "smooth", named)[1]["calibration"]["reused"] is True
    assert repaired(rough, "smooth", renamed)[1]["calibration"]["reused"] is False


def test_a_calibration_whose_holes_are_not_there_is_made_anew(rough: Path, kept_of_rough: bytes) -> None:
    first = kept_of_rough.index(b'"weights": [[') + len(b'"weights": [')
    end = kept_of_rough.index(b"], ", first)
    shortened = kept_of_rough[:first] + kept_of_rough[end + 3 :]
    kept = KeptCalibrations.read(shortened, CALIBRATED_ENERGIES)
    mesh, report = repaired(rough, "general-dictionary@1", kept)
    plain_mesh, plain = repaired(rough, "general-dictionary@1")
    assert report.pop("calibration")["holes"] == plain.pop("calibration")["holes"]
    assert (mesh, report) == (plain_mesh, plain)
    assert kept.has_new


def test_a_scan_without_room_for_calibration_keeps_that(tmp_path: Path) -> None:
    scan = write_ply(tmp_path / "small.ply", punched(bumpy_plate(14, 2.0), (0, 0, 0), radius=0.2))
    kept = KeptCalibrations()
    first, again = (repaired(scan, "smooth", kept) for _ in range(2))
    assert (first[1].pop("calibration")["holes"], again[1]["calibration"].pop("reused")) == (0, True)
    again[1].pop("calibration")
    assert first == again

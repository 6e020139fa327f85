from pathlib import Path
from typing import Any

import numpy as np
import pytest

from quadpatch.formats.reading import read_scan
from quadpatch.options import RepairOptions
from quadpatch.repair import repair_file
from quadpatch.types import TriangleMesh
from tests.quadpatch.colours.coloured import PLACES, grains
from tests.quadpatch.formats.coloured_files import FILES, coloured_ply, colours_of
from tests.quadpatch.shapes import bumpy_plate, on_surface, punched, write_ply

WHOLE = bumpy_plate(80, 2.0)
PLATE = punched(WHOLE, *on_surface(WHOLE, *PLACES), radius=0.1)
COLOURS = grains(WHOLE.vertices, np.random.default_rng(1), 0.06)
EVEN = np.full_like(COLOURS, 90.0)


def repaired(folder: Path, name: str, options: RepairOptions | None = None, suffix: str = "") -> dict[str, Any]:
    source = folder / name
    output = folder / f"out{suffix or source.suffix}"
    return repair_file(source, output, "smooth", options)


@pytest.mark.parametrize("name", ["bytes.ply", "fractions.obj", "scan.glb"])
def test_the_texture_goes_on_in_every_format_and_measured_colours_stay_bit_for_bit(name: str, tmp_path: Path) -> None:
    (tmp_path / name).write_bytes(FILES[name](PLATE, COLOURS))
    report = repaired(tmp_path, name)
    assert report["colours"]["method"] == "exemplars"
    assert report["colours"]["calibration"]["n_holes"] >= 12
    assert [stage["name"] for stage in report["stages"]][-2:] == ["colour", "write"]
    before, after = (read_scan(tmp_path / file) for file in (name, f"out{Path(name).suffix}"))
    n = len(before.vertices)
    assert after.vertices[:n].tobytes() == before.vertices.tobytes()
    assert colours_of(after)[:n].tobytes() == colours_of(before).tobytes()
    # Harmonic colours of grains are a grey mush: their spread is a few units.
    assert colours_of(after)[n:].std(axis=0).max() > 20


def test_a_file_without_colours_has_no_such_stage_and_no_such_line(tmp_path: Path) -> None:
    write_ply(tmp_path / "scan.ply", PLATE)
    report = repaired(tmp_path, "scan.ply")
    assert report["colours"] is None
    assert "colour" not in [stage["name"] for stage in report["stages"]]


def test_harmonic_colours_can_be_asked_for_and_cost_nothing(tmp_path: Path) -> None:
    (tmp_path / "scan.ply").write_bytes(coloured_ply(PLATE, COLOURS))
    report = repaired(tmp_path, "scan.ply", RepairOptions(colours="harmonic"))
    assert report["colours"] == {"method": "harmonic", "calibration": None}
    assert "colour" not in [stage["name"] for stage in report["stages"]]
    assert report["options"]["colours"] == "harmonic"


def test_where_there_is_no_texture_files_are_what_they_are_with_harmonic_colours(tmp_path: Path) -> None:
    (tmp_path / "scan.ply").write_bytes(coloured_ply(PLATE, EVEN))
    report = repaired(tmp_path, "scan.ply")
    assert report["colours"]["method"] == "harmonic"
    found = (tmp_path / "out.ply").read_bytes()
    repaired(tmp_path, "scan.ply", RepairOptions(colours="harmonic"))
    assert (tmp_path / "out.ply").read_bytes() == found


@pytest.mark.parametrize(("suffix", "has_colours"), [(".obj", True), (".glb", True), (".stl", False)])
def test_colours_go_into_other_formats_that_have_a_place_for_them(
    tmp_path: Path, suffix: str, has_colours: bool
) -> None:
    (tmp_path / "scan.ply").write_bytes(coloured_ply(PLATE, COLOURS))
    report = repaired(tmp_path, "scan.ply", suffix=suffix)
    assert (report["colours"] is not None) is has_colours
    if has_colours:
        after = read_scan(tmp_path / f"out{suffix}")
        n = len(read_scan(tmp_path / "scan.ply").vertices)
        assert colours_of(after)[n:].std(axis=0).max() > 20


def test_a_failure_is_a_warning_and_leaves_harmonic_colours(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object) -> None:
        raise MemoryError

    (tmp_path / "scan.ply").write_bytes(coloured_ply(PLATE, COLOURS))
    repaired(tmp_path, "scan.ply", RepairOptions(colours="harmonic"))
    harmonic = (tmp_path / "out.ply").read_bytes()
    monkeypatch.setattr("quadpatch.colours.continuation.hide_disks", fail)
    report = repaired(tmp_path, "scan.ply")
    assert report["colours"]["method"] == "harmonic"
    assert report["warnings"] == ["colours were not carried on over the fills: there is not enough memory"]
    assert (tmp_path / "out.ply").read_bytes() == harmonic


def test_a_mesh_without_holes_has_no_new_colours(tmp_path: Path) -> None:
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]])
    solid = TriangleMesh(corners, np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]))
    (tmp_path / "scan.ply").write_bytes(coloured_ply(solid, 40 * corners))
    assert repaired(tmp_path, "scan.ply")["colours"] is None

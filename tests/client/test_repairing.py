from pathlib import Path

import pytest

from client.errors import UsageError
from client.options import HoleChoice, MethodChoice
from client.repairing import Task, check_outputs, format_of


def task(source: Path, output: Path, report: Path | None = None) -> Task:
    return Task(source, output, HoleChoice(), MethodChoice(), report=report)


def test_the_repaired_mesh_may_take_the_place_of_the_scan_and_nothing_else(tmp_path: Path) -> None:
    scan, mesh, report = tmp_path / "scan.ply", tmp_path / "mesh.ply", tmp_path / "report.json"
    check_outputs(task(scan, mesh, report))
    check_outputs(task(scan, scan, report))
    for output, other in ((mesh, mesh), (mesh, scan), (scan, scan)):
        with pytest.raises(UsageError, match="named twice"):
            check_outputs(task(scan, output, other))


def test_an_output_needs_a_folder_and_must_be_none(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="there is no folder"):
        check_outputs(task(tmp_path / "scan.ply", tmp_path / "none" / "mesh.ply"))
    with pytest.raises(UsageError, match="is a folder"):
        check_outputs(task(tmp_path / "scan.ply", tmp_path / "mesh.ply", tmp_path))


def test_the_suffix_says_the_format_in_any_case() -> None:
    assert format_of(Path("a/part.STL")) == "stl"
    for name in ("part", "part.xyz", "part.gltf"):
        with pytest.raises(UsageError, match="rename it or give --format"):
            format_of(Path(name))

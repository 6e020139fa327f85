"""What the commands of all tasks do alike, and each of them from file to file.

Also tests `quadpatch.cli.restore`, `quadpatch.cli.denoise`, `quadpatch.cli.encode` and `quadpatch.cli.reconstruct`.
"""

import json
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner, Result

from quadpatch.cli.app import app
from quadpatch.cli.tasks import Files, given, run_task, vertices
from quadpatch.errors import StageError
from quadpatch.formats.moving import Moved, write_moved
from quadpatch.formats.reading import read_scan
from quadpatch.formats.vertex_properties import vertex_property
from quadpatch.progress import Progress
from quadpatch.tasks.result import TaskResult
from quadpatch.types import TriangleMesh
from tests.quadpatch.shapes import bumpy_plate, sphere, write_ply
from tests.waiting import GUARD_S


def lift(files: Files, progress: Progress) -> TaskResult:
    """Move every vertex of a scan up by 1."""
    scan = read_scan(files.source)
    progress("reconstruct", 0.5)
    moved = scan.vertices + np.array([0.0, 0.0, 1.0])
    warnings = write_moved(files.output, scan, Moved(moved))
    report: dict[str, Any] = {"length_unit": "mesh units", "stages": [{"name": "read", "seconds": 1.2}]}
    report |= {"moved_vertices": len(moved), "warnings": warnings}
    before, after = TriangleMesh(scan.vertices, scan.triangles), TriangleMesh(moved, scan.triangles)
    return TaskResult(report, before, after, np.ones(len(scan.triangles), dtype=bool))


def run(files: Files, quiet: bool = False) -> None:
    run_task(
        files,
        lambda progress: lift(files, progress),
        lambda report, unit: f"{vertices(report['moved_vertices'])} lifted by 1 {unit}",
        quiet,
    )


@pytest.fixture
def ball(tmp_path: Path) -> Path:
    return write_ply(tmp_path / "ball.ply", sphere(1))


def test_a_task_gives_mesh_report_picture_and_a_sentence(
    ball: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    run(Files(ball, tmp_path / "out.ply", tmp_path / "out.json", tmp_path / "out.png"))
    assert (
        read_scan(tmp_path / "out.ply").vertices.tobytes() == (sphere(1).vertices + np.array([0.0, 0.0, 1.0])).tobytes()
    )
    assert (tmp_path / "out.png").read_bytes().startswith(b"\x89PNG")
    report = json.loads((tmp_path / "out.json").read_text())
    assert [stage["name"] for stage in report["stages"]] == ["read", "preview"]
    told = capsys.readouterr()
    assert told.out == ""
    assert told.err.startswith("42 vertices lifted by 1 mesh units. ")
    assert told.err.endswith(" s.\n")


def test_quiet_tasks_say_nothing(ball: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    run(Files(ball, tmp_path / "out.ply", None, None), quiet=True)
    assert capsys.readouterr() == ("", "")


def test_no_file_that_is_read_is_overwritten(ball: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    raw = ball.read_bytes()
    other = write_ply(tmp_path / "clean.ply", sphere(0))
    for files in (
        Files(ball, ball, None, None),
        Files(ball, other, None, None, may_overwrite=True, inputs=[other]),
        Files(ball, tmp_path / "out.ply", other, None, inputs=[other]),
        Files(ball, tmp_path / "out.ply", tmp_path / "out.ply", None),
    ):
        with pytest.raises(SystemExit, match="1"):
            run(files)
        assert capsys.readouterr().err.startswith("invalid_option: ")
    assert ball.read_bytes() == raw
    assert not (tmp_path / "out.ply").exists()
    run(Files(ball, ball, None, None, may_overwrite=True), quiet=True)
    assert ball.read_bytes() != raw


def test_a_task_that_fails_is_one_line(ball: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    def fail(_: Progress) -> TaskResult:
        raise StageError("there is no way")

    with pytest.raises(SystemExit, match="1"):
        run_task(Files(ball, tmp_path / "out.ply", None, None), fail, lambda *_: "", False)
    assert capsys.readouterr().err == "stage_failed: there is no way\n"


def test_a_step_that_fails_is_a_warning_and_no_traceback(tmp_path: Path) -> None:
    """Integers can't hold vertices that move by less than one: the file is written anew."""
    plate = bumpy_plate(30, 200.0)
    lines = ["ply", "format ascii 1.0", f"element vertex {len(plate.vertices)}"]
    lines += [f"property short {axis}" for axis in "xyz"]
    lines += [f"element face {len(plate.triangles)}", "property list uchar int vertex_indices", "end_header"]
    lines += [" ".join(map(str, row)) for row in np.rint(plate.vertices).astype(int).tolist()]
    lines += [" ".join(map(str, (3, *row))) for row in plate.triangles.tolist()]
    (tmp_path / "in.ply").write_text("\n".join([*lines, ""]))
    command = [sys.executable, "-m", "quadpatch", "denoise", str(tmp_path / "in.ply"), "-o", str(tmp_path / "out.ply")]
    done = subprocess.run([*command, "--model", "smooth"], capture_output=True, text=True, check=True, timeout=GUARD_S)
    assert "Warning: the mesh is written anew" in " ".join(done.stderr.split())
    assert "Traceback" not in done.stderr


def test_options_that_were_not_given_are_left_out() -> None:
    assert given(seed=0, noise=None, patches={"length": None, "resolution": 12}, other={"atoms": None}) == {
        "seed": 0,
        "patches": {"resolution": 12},
    }


def call(*arguments: str | Path) -> Result:
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


@pytest.fixture(scope="module")
def plate(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_ply(tmp_path_factory.mktemp("plate") / "plate.ply", bumpy_plate(40, 2.0))


@pytest.mark.parametrize("flags", [[], ["--keep-connectivity"]], ids=["surface", "connectivity"])
def test_what_is_encoded_is_decoded_within_the_error(plate: Path, tmp_path: Path, flags: list[str]) -> None:
    packed, report = tmp_path / "plate.qpz", tmp_path / "plate.json"
    done = call("encode", plate, "-o", packed, "--max-error", "0.02", "--report", report, *flags)
    assert done.exit_code == 0, done.output
    assert done.stdout == ""
    told = " ".join(done.stderr.split())
    assert told.startswith(f"1,600 vertices encoded in {packed.stat().st_size:,} bytes (")
    assert "mesh units from the scan, 0.02 are allowed. " in told
    content = json.loads(report.read_text())
    assert content["task"] == "encode"
    assert content["options"]["max_error"] == 0.02
    assert content["options"]["keep_connectivity"] == bool(flags)
    page = tmp_path / "again.html"
    again = call("decode", packed, "-o", tmp_path / "again.obj", "--preview", tmp_path / "again.png", "--html", page)
    assert again.exit_code == 0, again.output
    kind = "in the order of the scan" if flags else "as a regular mesh over the quads"
    assert f"triangles, {kind}, at most 0.02 mesh units from the scan. " in " ".join(again.stderr.split())
    assert (tmp_path / "again.png").exists()
    assert f"Decompression report: {packed.name}" in page.read_text("utf-8")
    if flags:
        shift = read_scan(tmp_path / "again.obj").vertices - read_scan(plate).vertices
        assert np.linalg.norm(shift, axis=1).max() <= 0.02


def noisy(path: Path, seed: int = 0) -> Path:
    plate = bumpy_plate(30, 2.0)
    noise = np.random.default_rng(seed).normal(scale=0.008, size=len(plate.vertices))
    return write_ply(path, TriangleMesh(plate.vertices + noise[:, np.newaxis] * [0.0, 0.0, 1.0], plate.triangles))


def test_noise_is_taken_within_the_bound(tmp_path: Path) -> None:
    source, output, report = noisy(tmp_path / "in.ply"), tmp_path / "out.ply", tmp_path / "out.json"
    flags: list[str | Path] = ["--model", "smooth", "--noise", "0.008", "--max-shift", "0.02", "--report", report]
    done = call("denoise", source, "-o", output, *flags, "--preview", tmp_path / "out.png")
    assert done.exit_code == 0, done.output
    before, after = read_scan(source), read_scan(output)
    clean = bumpy_plate(30, 2.0).vertices
    assert np.linalg.norm(after.vertices - before.vertices, axis=1).max() <= 0.02
    assert np.abs(after.vertices - clean)[:, 2].mean() < 0.7 * np.abs(before.vertices - clean)[:, 2].mean()
    shift = vertex_property(after, "shift")
    assert shift == pytest.approx(np.linalg.norm(after.vertices - before.vertices, axis=1), abs=1e-6)
    content = json.loads(report.read_text())
    assert content["options"]["max_shift"] == 0.02
    told = " ".join(done.stderr.split())
    assert told.startswith(f"{content['moved_vertices']} vertices were moved, 95 of 100 of them by no more than ")
    assert "; the noise is 0.008 mesh units (given). " in told
    assert (tmp_path / "out.png").exists()


def test_vertices_outside_the_region_stay(tmp_path: Path) -> None:
    source, output = noisy(tmp_path / "in.ply"), tmp_path / "out.ply"
    box = ["--region", "-0.5", "-0.5", "-1", "0.5", "0.5", "1"]
    done = call("denoise", source, "-o", output, "--model", "smooth", *box)
    assert done.exit_code == 0, done.output
    before, after = read_scan(source), read_scan(output)
    inside = np.asarray((np.abs(before.vertices) <= [0.5, 0.5, 1.0]).all(axis=1))
    assert after.vertices[~inside].tobytes() == before.vertices[~inside].tobytes()
    assert (after.vertices[inside] != before.vertices[inside]).any()
    write_moved(tmp_path / "marked.ply", before, Moved(before.vertices, {"rough": inside}))
    marked = ["--region-property", "rough"]
    done = call("denoise", tmp_path / "marked.ply", "-o", tmp_path / "again.ply", "--model", "smooth", *marked)
    assert done.exit_code == 0, done.output
    again = read_scan(tmp_path / "again.ply")
    assert again.vertices[~inside].tobytes() == before.vertices[~inside].tobytes()
    assert call("denoise", source, "-o", output, *box, *marked).stderr.startswith("invalid_option: --region and ")


def test_a_clean_scan_is_a_reference(tmp_path: Path) -> None:
    clean = write_ply(tmp_path / "clean.ply", bumpy_plate(30, 2.0))
    report = tmp_path / "out.json"
    files: list[str | Path] = [noisy(tmp_path / "in.ply"), "-o", tmp_path / "out.ply", "--report", report]
    done = call("denoise", *files, "--reference", clean)
    assert done.exit_code == 0, done.output
    assert json.loads(report.read_text())["model"]["name"] == "reference"
    refused = call("denoise", files[0], "-o", clean, "--reference", clean)
    assert refused.stderr.startswith("invalid_option: ")


@pytest.fixture(scope="module")
def holey(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """A plate of which some vertices are missing: marked, without coordinates, and in a list."""
    folder = tmp_path_factory.mktemp("holey")
    scan = read_scan(write_ply(folder / "whole.ply", bumpy_plate(30, 2.0)))
    missing = np.random.default_rng(0).random(len(scan.vertices)) < 0.1
    write_moved(folder / "marked.ply", scan, Moved(scan.vertices, {"lost": missing}))
    unknown = TriangleMesh(np.where(missing[:, np.newaxis], np.nan, scan.vertices), scan.triangles)
    write_ply(folder / "nan.ply", unknown)
    (folder / "list.txt").write_text(" ".join(map(str, np.flatnonzero(missing))))
    return {name: folder / name for name in ("whole.ply", "marked.ply", "nan.ply", "list.txt")}


@pytest.mark.parametrize(
    ("source", "missing"),
    [("marked.ply", "lost"), ("marked.ply", "property:lost"), ("nan.ply", "nan"), ("whole.ply", "")],
)
def test_missing_vertices_get_a_position_however_they_are_named(
    holey: dict[str, Path], tmp_path: Path, source: str, missing: str
) -> None:
    report = tmp_path / "out.json"
    files: list[str | Path] = [holey[source], "-o", tmp_path / "out.ply", "--report", report]
    done = call("restore", *files, "--missing", missing or holey["list.txt"], "--model", "smooth")
    assert done.exit_code == 0, done.output
    whole, after = read_scan(holey["whole.ply"]), read_scan(tmp_path / "out.ply")
    restored = vertex_property(after, "restored") > 0
    assert restored.sum() == 79
    assert after.vertices[~restored].tobytes() == whole.vertices[~restored].tobytes()
    assert np.abs(after.vertices - whole.vertices).max() < 0.1
    counts = json.loads(report.read_text())["vertices"]
    assert (counts["missing"], counts["restored"]) == (79, 79)
    told = " ".join(done.stderr.split())
    assert told.startswith("79 of 79 missing vertices got a position, 95 of 100 of them expected to be off by no more")


def test_a_picture_of_what_was_restored_is_drawn(holey: dict[str, Path], tmp_path: Path) -> None:
    files: list[str | Path] = [holey["nan.ply"], "-o", tmp_path / "out.obj", "--preview", tmp_path / "out.png"]
    done = call("restore", *files, "--missing", "nan", "--model", "smooth")
    assert done.exit_code == 0, done.output
    assert (tmp_path / "out.png").read_bytes().startswith(b"\x89PNG")
    assert "obj has no place for numbers of vertices: restored, expected_error left out" in " ".join(
        done.stderr.split()
    )


def test_a_list_of_missing_vertices_is_not_overwritten(holey: dict[str, Path]) -> None:
    listed = holey["list.txt"].read_bytes()
    for flag in ("-o", "--report"):
        outputs: list[str | Path] = ["-o", holey["list.txt"].parent / "out.ply", flag, holey["list.txt"]]
        refused = call("restore", holey["whole.ply"], "--missing", holey["list.txt"], *outputs)
        assert refused.stderr.startswith("invalid_option: ")
    assert holey["list.txt"].read_bytes() == listed


def test_a_scan_is_rebuilt_from_its_patches(plate: Path, tmp_path: Path) -> None:
    report = tmp_path / "out.json"
    files: list[str | Path] = [plate, "-o", tmp_path / "out.ply", "--report", report]
    done = call("reconstruct", *files, "--atoms", "20", "--nonzero", "4", "--resolution", "10")
    assert done.exit_code == 0, done.output
    content = json.loads(report.read_text())
    assert content["dictionary"] == {"atoms": 20, "nonzero": 4}
    assert content["patches"]["resolution"] == 10
    shift = read_scan(tmp_path / "out.ply").vertices - read_scan(plate).vertices
    assert 0 < np.linalg.norm(shift, axis=1).max() < 0.1
    told = " ".join(done.stderr.split())
    assert f"rebuilt from {content['patches']['count']:,} patches with 4 of 20 atoms each, off by " in told


@pytest.mark.parametrize(
    ("arguments", "code"),
    [
        (["encode", "PLATE", "-o", "out.ply", "--max-error", "0.01"], "unsupported_format"),
        (["encode", "PLATE", "-o", "out.qpz", "--max-error", "0"], "invalid_option"),
        (["encode", "PLATE", "-o", "out.qpz", "--max-error", "0.01", "--resolution", "1"], "invalid_option"),
        (["encode", "PLATE", "-o", "out.qpz", "--max-error", "0.01", "--model", "no-such"], "unusable_model"),
        (["encode", "PLATE", "-o", "PLATE", "--max-error", "0.01"], "invalid_option"),
        (["restore", "PLATE", "-o", "out.ply", "--missing", "nan"], "invalid_option"),
        (["restore", "PLATE", "-o", "out.ply", "--missing", "lost"], "invalid_option"),
        (["restore", "PLATE", "-o", "out.ply", "--missing", "PLATE"], "invalid_option"),
        (["restore", "PLATE", "-o", "PLATE", "--missing", "nan"], "invalid_option"),
        (["reconstruct", "PLATE", "-o", "out.ply", "--atoms", "1"], "invalid_option"),
        (["reconstruct", "PLATE", "-o", "out.ply", "--model", "general-residual@1"], "invalid_option"),
        (["denoise", "PLATE", "-o", "out.ply", "--noise", "-1"], "invalid_option"),
        (["denoise", "PLATE", "-o", "out.ply", "--max-shift", "nan"], "invalid_option"),
        (["denoise", "PLATE", "-o", "out.ply", "--region", "1", "1", "1", "0", "0", "0"], "invalid_option"),
        (["denoise", "PLATE", "-o", "out.ply", "--region-property", "rough"], "invalid_option"),
        (["denoise", "PLATE", "-o", "out.ply", "--reference", "missing.ply"], "unreadable_mesh"),
        (["denoise", "PLATE", "-o", "PLATE"], "invalid_option"),
        (["decode", "PLATE", "-o", "out.ply"], "unreadable_mesh"),
        (["decode", "missing.qpz", "-o", "out.ply"], "unreadable_mesh"),
        (["decode", "missing.qpz", "-o", "out.docx"], "unsupported_format"),
    ],
)
def test_errors_of_tasks_are_one_line_of_code_and_message(
    plate: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, arguments: list[str], code: str
) -> None:
    monkeypatch.chdir(tmp_path)
    result = call(*[str(plate) if argument == "PLATE" else argument for argument in arguments])
    assert result.exit_code == 1, result.output
    assert list(tmp_path.iterdir()) == []
    assert result.stdout == ""
    (line,) = result.stderr.splitlines()
    assert re.fullmatch(rf"{code}: .+", line)


@pytest.mark.parametrize(
    "arguments",
    [
        ["encode", "a.ply", "-o", "a.qpz"],
        ["decode", "a.qpz"],
        ["denoise", "a.ply"],
        ["restore", "a.ply", "-o", "b.ply"],
    ],
)
def test_wrong_usage_of_a_task_has_its_own_exit_code(arguments: list[str]) -> None:
    assert call(*arguments).exit_code == 2

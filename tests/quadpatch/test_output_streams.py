"""Outputs of the command line: links are kept, and streams are written through, never replaced."""

import json
import os
import stat
import subprocess
import sys
import threading
from collections.abc import Callable
from pathlib import Path

import pytest

import quadpatch_client.outputs
from quadpatch.errors import FormatError, OptionError
from quadpatch.formats import output_files
from quadpatch.formats.output_files import check_folder, check_outputs, write_whole
from quadpatch.formats.writing import check_suffix
from quadpatch.repair import repair_file
from tests.quadpatch.shapes import bumpy_plate, punched, write_ply
from tests.waiting import GUARD_S

NAMES = (
    "-",
    "/dev/stdout",
    "/dev/stderr",
    "/dev/fd/1",
    "/dev/fd/17",
    "/proc/self/fd/1",
    "./-",
    "a/-",
    "/dev/null",
    "x",
)


@pytest.fixture(scope="module")
def scan(tmp_path_factory: pytest.TempPathFactory) -> Path:
    mesh = punched(bumpy_plate(12, 2.0), (0.0, 0.0, 0.0), radius=0.4)
    return write_ply(tmp_path_factory.mktemp("scan") / "scan.ply", mesh)


def filled(scan: Path, log: Path, *arguments: str | Path) -> subprocess.CompletedProcess[bytes]:
    """Run `fill` with its standard output behind what a file holds already."""
    log.write_bytes(b"before\n")
    command = [sys.executable, "-m", "quadpatch", "fill", str(scan), "--model", "smooth", *map(str, arguments)]
    with log.open("ab") as stdout:
        return subprocess.run(command, stdout=stdout, stderr=subprocess.PIPE, timeout=GUARD_S, check=False)


@pytest.mark.parametrize("name", ["-", "/dev/stdout"])
def test_standard_output_gets_the_mesh_behind_what_is_there_already(scan: Path, tmp_path: Path, name: str) -> None:
    repair_file(scan, tmp_path / "mesh.ply", "smooth")
    done = filled(scan, tmp_path / "log", "-o", name)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "log").read_bytes() == b"before\n" + (tmp_path / "mesh.ply").read_bytes()
    assert b"1 hole" in done.stderr or b"2 holes" in done.stderr


def test_a_report_goes_to_standard_output_once_although_pictures_are_drawn_after_the_mesh(
    scan: Path, tmp_path: Path
) -> None:
    arguments: list[str | Path] = ["-o", tmp_path / "mesh.ply", "--report", "-", "--picture", tmp_path / "p.png"]
    done = filled(scan, tmp_path / "log", *arguments)
    assert done.returncode == 0, done.stderr
    report = json.loads((tmp_path / "log").read_bytes().removeprefix(b"before\n"))
    assert report["stages"][-1]["name"] == "preview"


def test_the_names_of_streams_are_those_of_the_client(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    for path in (*map(Path, NAMES), tmp_path / "pipe", tmp_path):
        assert output_files.descriptor_of(path) == quadpatch_client.outputs.descriptor_of(path)
        assert output_files.is_stream(path) == quadpatch_client.outputs.is_stream(path)


def test_a_descriptor_is_written_where_it_stands(tmp_path: Path) -> None:
    with (tmp_path / "log").open("wb") as log:
        log.write(b"before\n")
        log.flush()
        write_whole(Path(f"/dev/fd/{log.fileno()}"), b"mesh")
        log.write(b"\nafter")
    assert [path.name for path in tmp_path.iterdir()] == ["log"]
    assert (tmp_path / "log").read_bytes() == b"before\nmesh\nafter"


def read_from(pipe: Path, write: Callable[[], object]) -> bytes:
    """Return what arrives at the other end of a pipe while something writes into it."""
    read: list[bytes] = []
    reader = threading.Thread(target=lambda: read.append(pipe.read_bytes()))
    reader.start()
    write()
    reader.join()
    return read[0]


def test_a_pipe_or_device_is_written_and_not_replaced_nor_is_a_link_to_it(tmp_path: Path) -> None:
    pipe, null = tmp_path / "pipe.ply", Path(os.devnull)
    os.mkfifo(pipe)
    links = [tmp_path / "to_pipe.ply", tmp_path / "to_null.ply"]
    for link, target in zip(links, (pipe, null), strict=True):
        link.symlink_to(target)
    assert read_from(pipe, lambda: write_whole(pipe, b"mesh")) == b"mesh"
    assert read_from(pipe, lambda: write_whole(links[0], b"mesh")) == b"mesh"
    for name in (null, links[1]):
        write_whole(name, b"mesh")
    assert all(link.is_symlink() for link in links)
    assert stat.S_ISFIFO(pipe.stat().st_mode)
    assert stat.S_ISCHR(null.stat().st_mode)


def test_a_stream_takes_the_format_of_the_scan_unless_its_name_says_another(scan: Path, tmp_path: Path) -> None:
    for name in ("-", "/dev/stdout", os.devnull):
        check_suffix(Path(name))
    with pytest.raises(FormatError, match="not written"):
        check_suffix(tmp_path / "mesh")
    with (tmp_path / "log").open("wb") as log:
        repair_file(scan, Path(f"/dev/fd/{log.fileno()}"), "smooth")
    assert (tmp_path / "log").read_bytes().startswith(b"ply\n")
    pipe = tmp_path / "pipe.obj"
    os.mkfifo(pipe)
    assert b"\nf " in read_from(pipe, lambda: repair_file(scan, pipe, "smooth"))


def test_one_stream_takes_one_output(tmp_path: Path) -> None:
    scan = tmp_path / "scan.ply"
    check_outputs(scan, Path("-"), [tmp_path / "report.json"])
    check_outputs(scan, Path("-"), [Path("/dev/stderr")])
    for names in (("-", "/dev/stdout"), ("/dev/fd/1", "-"), ("/dev/stderr", "/dev/fd/2")):
        with pytest.raises(OptionError, match="named twice"):
            check_outputs(scan, Path(names[0]), [Path(names[1])])


def test_a_link_into_a_folder_that_is_missing_is_refused_before_any_work(tmp_path: Path) -> None:
    link = tmp_path / "link.ply"
    link.symlink_to(tmp_path / "none" / "mesh.ply")
    with pytest.raises(FileNotFoundError, match="there is no folder"):
        check_outputs(tmp_path / "scan.ply", link, [])
    with pytest.raises(FileNotFoundError, match="there is no folder"):
        check_folder(link)


def test_close_ups_go_into_a_folder_and_overwrite_no_other_output(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    for wrong in (Path("-"), Path("/dev/stdout"), Path(os.devnull), tmp_path / "file"):
        with pytest.raises(NotADirectoryError):
            check_folder(wrong)
    folder = tmp_path / "holes"
    (tmp_path / "linked").symlink_to(folder)
    for name in (folder, tmp_path / "linked"):
        check_folder(name, [folder / "whole.png", tmp_path / "hole_1.png"])
        with pytest.raises(OptionError, match="name of a close-up"):
            check_folder(name, [folder / "hole_1.png"])

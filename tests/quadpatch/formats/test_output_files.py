import os
from collections.abc import Iterator
from pathlib import Path

import pytest

from quadpatch.errors import OptionError
from quadpatch.formats.output_files import check_outputs, write_whole


def test_a_file_is_written_and_nothing_beside_it(tmp_path: Path) -> None:
    write_whole(tmp_path / "mesh.ply", b"old")
    write_whole(tmp_path / "mesh.ply", b"new")
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == {"mesh.ply": b"new"}


def test_a_file_may_come_in_pieces(tmp_path: Path) -> None:
    pieces: list[bytes | memoryview] = [b"ne", memoryview(b"w")]
    write_whole(tmp_path / "mesh.ply", iter(pieces))
    assert (tmp_path / "mesh.ply").read_bytes() == b"new"


def test_a_failing_write_leaves_the_old_file_and_names_it(tmp_path: Path) -> None:
    path = tmp_path / "mesh.ply"
    path.write_bytes(b"old")

    def half() -> Iterator[bytes]:
        yield b"ne"
        raise OSError(28, "No space left on device")

    with pytest.raises(OSError, match="No space left on device") as caught:
        write_whole(path, half())
    assert caught.value.filename == str(path)
    assert {entry.name: entry.read_bytes() for entry in tmp_path.iterdir()} == {"mesh.ply": b"old"}


def test_a_link_stays_a_link_and_a_device_a_device(tmp_path: Path) -> None:
    link = tmp_path / "link.ply"
    link.symlink_to(tmp_path / "mesh.ply")
    write_whole(link, b"new")
    assert link.is_symlink()
    assert (tmp_path / "mesh.ply").read_bytes() == b"new"
    write_whole(Path(os.devnull), b"new")
    assert not Path(os.devnull).is_file()


def names_of(scan: Path) -> list[Path]:
    """Other names of a file: another spelling, a symbolic link, a hard link."""
    link, hard = scan.with_name("link.ply"), scan.with_name("hard.ply")
    link.symlink_to(scan)
    hard.hardlink_to(scan)
    return [scan, scan.parent / "folder" / ".." / scan.name, link, hard]


def test_the_scan_is_overwritten_on_request_alone_whatever_name_it_has(tmp_path: Path) -> None:
    scan, report = tmp_path / "scan.ply", tmp_path / "report.json"
    scan.write_bytes(b"raw")
    (tmp_path / "folder").mkdir()
    for name in names_of(scan):
        with pytest.raises(OptionError, match="--overwrite"):
            check_outputs(scan, name, [report])
        check_outputs(scan, name, [report], may_overwrite=True)
        for may_overwrite in (False, True):
            with pytest.raises(OptionError, match="named twice"):
                check_outputs(scan, tmp_path / "mesh.ply", [name], may_overwrite=may_overwrite)


def test_outputs_must_not_overwrite_each_other(tmp_path: Path) -> None:
    scan, mesh, report = tmp_path / "scan.ply", tmp_path / "mesh.ply", tmp_path / "report.json"
    check_outputs(scan, mesh, [report])
    for outputs in ([mesh], [tmp_path / "." / "mesh.ply"], [report, report]):
        with pytest.raises(OptionError, match="named twice"):
            check_outputs(scan, mesh, outputs, may_overwrite=True)


def test_outputs_need_a_folder_and_must_be_none(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match="there is no folder"):
        check_outputs(tmp_path / "scan.ply", tmp_path / "none" / "mesh.ply", [])
    with pytest.raises(IsADirectoryError):
        check_outputs(tmp_path / "scan.ply", tmp_path, [])

import os
from pathlib import Path

import pytest

from quadpatch.errors import OptionError
from quadpatch.files import check_outputs, write_whole


def test_a_file_is_written_and_nothing_beside_it(tmp_path: Path) -> None:
    write_whole(tmp_path / "mesh.ply", b"old")
    write_whole(tmp_path / "mesh.ply", b"new")
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == {"mesh.ply": b"new"}


def test_a_failing_write_leaves_the_old_file_and_names_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "mesh.ply"
    path.write_bytes(b"old")

    def half(self: Path, data: bytes) -> int:
        with self.open("wb") as file:
            file.write(data[:2])
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "write_bytes", half)
    with pytest.raises(OSError, match="No space left on device") as caught:
        write_whole(path, b"new bytes")
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


def test_outputs_must_not_overwrite_each_other_or_the_scan(tmp_path: Path) -> None:
    scan, mesh, report = tmp_path / "scan.ply", tmp_path / "mesh.ply", tmp_path / "report.json"
    check_outputs(scan, [mesh, report])
    check_outputs(scan, [scan, report])
    for outputs in ([mesh, mesh], [mesh, tmp_path / "." / "mesh.ply"], [mesh, scan], [scan, scan]):
        with pytest.raises(OptionError, match="named twice"):
            check_outputs(scan, outputs)


def test_outputs_need_a_folder_and_must_be_none(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match="there is no folder"):
        check_outputs(tmp_path / "scan.ply", [tmp_path / "none" / "mesh.ply"])
    with pytest.raises(IsADirectoryError):
        check_outputs(tmp_path / "scan.ply", [tmp_path])

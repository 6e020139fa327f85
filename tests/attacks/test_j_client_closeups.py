"""What a service sends as close-ups is unpacked into one folder, under names of close-ups, or not at all."""

import hashlib
import io
import stat
import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest

from quadpatch_client import closeups
from quadpatch_client.closeups import check_closeups_folder, unpack_closeups
from quadpatch_client.errors import ClientError, UsageError
from quadpatch_client.schema import Job
from quadpatch_client.sdk import Client
from tests.quadpatch_client import conftest as scripted
from tests.quadpatch_client.wire_jobs import PATH, body

server = scripted.server
PNG = b"\x89PNG\r\n\x1a\n" + bytes(100)


def archive(folder: Path, entries: list[tuple[str | zipfile.ZipInfo, bytes]], method: int = zipfile.ZIP_STORED) -> Path:
    path = folder / "closeups.zip"
    with zipfile.ZipFile(path, "w", method) as pack:
        for name, data in entries:
            pack.writestr(name, data)
    return path


def link_entry() -> zipfile.ZipInfo:
    entry = zipfile.ZipInfo("hole_1.png")
    entry.external_attr = (stat.S_IFLNK | 0o777) << 16
    return entry


def contents(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def test_pictures_lie_in_the_folder_the_widest_hole_first(tmp_path: Path) -> None:
    packed = archive(tmp_path, [("hole_3.png", PNG), ("hole_0.png", PNG + b"0")])
    folder = tmp_path / "holes"
    for _ in ("made", "there"):
        assert unpack_closeups(packed, folder) == [folder / "hole_3.png", folder / "hole_0.png"]
        assert contents(folder) == {"hole_3.png": PNG, "hole_0.png": PNG + b"0"}


@pytest.mark.parametrize(
    "name",
    [
        *("../hole_1.png", "/tmp/hole_1.png", "..\\hole_1.png", "a/hole_1.png", "hole_1.png/", "./hole_1.png"),
        *("C:hole_1.png", "hole_1.sh", ".bashrc", "hole_.png", "hole_-1.png", "hole_1.png\n", "hole_12345678901.png"),
        "hole_\u0661.png",
    ],
)
def test_no_other_name_is_written_anywhere_and_nothing_beside_it(tmp_path: Path, name: str) -> None:
    packed = archive(tmp_path, [("hole_0.png", PNG), (name, PNG)])
    before = contents(tmp_path)
    with pytest.raises(ClientError, match="other names"):
        unpack_closeups(packed, tmp_path / "holes")
    assert contents(tmp_path) == before


def big_header(folder: Path) -> Path:
    """A file whose directory states a size that the entry does not have."""
    packed = archive(folder, [("hole_0.png", PNG)])
    data = bytearray(packed.read_bytes())
    at = data.rindex(b"PK\x01\x02") + 24
    data[at : at + 4] = (2**32 - 2).to_bytes(4, "little")
    packed.write_bytes(data)
    return packed


def damaged(folder: Path) -> Path:
    packed = archive(folder, [("hole_0.png", PNG)])
    data = packed.read_bytes()
    packed.write_bytes(data.replace(PNG, PNG[:-1] + b"x", 1))
    return packed


def encrypted(folder: Path) -> Path:
    packed = archive(folder, [("hole_0.png", PNG)])
    data = bytearray(packed.read_bytes())
    for mark, offset in ((b"PK\x03\x04", 6), (b"PK\x01\x02", 8)):
        data[data.rindex(mark) + offset] |= 1
    packed.write_bytes(data)
    return packed


def no_archive(folder: Path) -> Path:
    (folder / "closeups.zip").write_bytes(b"<html>")
    return folder / "closeups.zip"


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (no_archive, "no readable ZIP"),
        (damaged, "no readable ZIP"),
        (encrypted, "no readable ZIP"),
        (big_header, "more than"),
        (lambda folder: archive(folder, [("hole_0.png", bytes(10**7))], zipfile.ZIP_DEFLATED), "compressed"),
        (lambda folder: archive(folder, [("hole_0.png", PNG)], zipfile.ZIP_LZMA), "compressed"),
        (lambda folder: archive(folder, [(f"hole_{i}.png", PNG) for i in range(1001)]), "more than"),
        (lambda folder: archive(folder, [("hole_0.png", b"#!/bin/sh")]), "no PNG"),
        (lambda folder: archive(folder, [("hole_0.png", PNG), (link_entry(), b"/etc/passwd")]), "no PNG"),
    ],
)
def test_what_is_no_bounded_archive_of_pictures_is_refused(
    tmp_path: Path, make: Callable[[Path], Path], words: str
) -> None:
    packed = make(tmp_path)
    with pytest.raises(ClientError, match=words):
        unpack_closeups(packed, tmp_path / "holes")
    assert not (tmp_path / "holes").exists()


@pytest.mark.filterwarnings("ignore:Duplicate name")
def test_a_name_that_comes_twice_is_refused(tmp_path: Path) -> None:
    packed = archive(tmp_path, [("hole_0.png", PNG), ("hole_0.png", PNG)])
    with pytest.raises(ClientError, match="other names"):
        unpack_closeups(packed, tmp_path / "holes")


def test_an_archive_that_is_too_large_is_not_even_opened(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    packed = archive(tmp_path, [("hole_0.png", PNG)])
    monkeypatch.setattr(closeups, "MOST_BYTES", len(packed.read_bytes()) - 1)
    with pytest.raises(ClientError, match="more than"):
        unpack_closeups(packed, tmp_path / "holes")


def test_a_link_of_a_pictures_name_is_replaced_and_what_it_leads_to_stays(tmp_path: Path) -> None:
    outside = tmp_path / "outside.png"
    outside.write_bytes(b"mine")
    folder = tmp_path / "holes"
    folder.mkdir()
    (folder / "hole_0.png").symlink_to(outside)
    unpack_closeups(archive(tmp_path, [("hole_0.png", PNG)]), folder)
    assert outside.read_bytes() == b"mine"
    assert not (folder / "hole_0.png").is_symlink()
    assert (folder / "hole_0.png").read_bytes() == PNG


def test_a_folder_for_close_ups_is_one_or_can_be_made_and_holds_no_other_output(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    (tmp_path / "linked").symlink_to(tmp_path / "holes")
    for wrong in (tmp_path / "file", tmp_path / "none" / "holes", Path("-"), Path("/dev/null"), Path("/dev/stdout")):
        with pytest.raises(UsageError):
            check_closeups_folder(wrong, [])
    holes = tmp_path / "holes"
    check_closeups_folder(holes, [holes / "mesh.ply", tmp_path / "hole_1.png"])
    for folder in (holes, tmp_path / "linked", tmp_path / "x" / ".." / "holes"):
        with pytest.raises(UsageError, match="name of a close-up"):
            check_closeups_folder(folder, [holes / "hole_1.png"])


def job_with(data: bytes) -> Job:
    file = {"role": "closeups", "name": "closeups.zip", "media_type": "application/zip", "size_bytes": len(data)}
    result = {"format": "ply", "files": [{**file, "sha256": hashlib.sha256(data).hexdigest()}]}
    links = {"self": PATH, "events": f"{PATH}/events", "mesh": "/v1/meshes/0", "rerun": f"{PATH}/rerun"}
    links["closeups"] = f"{PATH}/closeups.zip"
    return Job.model_validate_json(body("succeeded", 3, result=result, links=links))


def test_the_sdk_fetches_and_unpacks_close_ups(server: scripted.ScriptedServer, tmp_path: Path) -> None:
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as pack:
        pack.writestr("hole_2.png", PNG)
    server.answers = [scripted.answer(200, packed.getvalue())]
    without = Job.model_validate_json(body("succeeded", 3, result={"format": "ply"}))
    folder = tmp_path / "holes"
    with Client(server.url) as client:
        assert client.download_closeups(job_with(packed.getvalue()), folder) == [folder / "hole_2.png"]
        with pytest.raises(ClientError, match="has no closeups"):
            client.download_closeups(without, tmp_path / "x")
    assert contents(tmp_path) == {"holes/hole_2.png": PNG}

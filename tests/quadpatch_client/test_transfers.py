import hashlib
import os
from pathlib import Path
from typing import Any

import pytest

from quadpatch_client.errors import DamagedTransferError, UnreachableError
from quadpatch_client.progress import no_progress
from quadpatch_client.schema import JobSpec
from quadpatch_client.transfers import download, label_of
from quadpatch_client.transport import Transport

BODY = bytes(range(256)) * 4000
SHA256 = hashlib.sha256(BODY).hexdigest()


def test_a_broken_download_goes_on_where_it_broke(server: Any, answers: Any, tmp_path: Path) -> None:
    kept = 300_000
    server.answers = [answers["break_off"](BODY, kept), answers["rest_of"](BODY)]
    with Transport(server.url) as transport:
        download(transport, "/file", tmp_path / "file", SHA256, no_progress)
    assert (tmp_path / "file").read_bytes() == BODY
    start = int(server.requests[1][2]["Range"].removeprefix("bytes=").removesuffix("-"))
    assert 0 < start <= kept


def test_a_service_without_ranges_sends_everything_again(server: Any, answers: Any, tmp_path: Path) -> None:
    server.answers = [answers["break_off"](BODY, 300_000), answers["answer"](200, BODY)]
    with Transport(server.url) as transport:
        download(transport, "/file", tmp_path / "file", SHA256, no_progress)
    assert (tmp_path / "file").read_bytes() == BODY


def test_other_bytes_are_refused_and_the_old_file_stays(server: Any, answers: Any, tmp_path: Path) -> None:
    (tmp_path / "file").write_bytes(b"old")
    server.answers = [answers["answer"](200, b"x" + BODY[1:])]
    with Transport(server.url) as transport, pytest.raises(DamagedTransferError):
        download(transport, "/file", tmp_path / "file", SHA256, no_progress)
    assert [path.name for path in tmp_path.iterdir()] == ["file"]
    assert (tmp_path / "file").read_bytes() == b"old"


def test_a_line_that_never_holds_leaves_no_half_file(server: Any, answers: Any, tmp_path: Path) -> None:
    server.answers = [answers["break_off"](BODY, 1000)]
    with Transport(server.url, patience_s=0.5) as transport, pytest.raises(UnreachableError):
        download(transport, "/file", tmp_path / "file", SHA256, no_progress)
    assert list(tmp_path.iterdir()) == []


def test_progress_reaches_the_size_of_the_file(server: Any, answers: Any, tmp_path: Path) -> None:
    server.answers = [answers["answer"](200, BODY)]
    seen: list[tuple[int, int]] = []
    with Transport(server.url) as transport:
        download(transport, "/file", tmp_path / "file", SHA256, lambda done, total: seen.append((done, total)))
    assert seen[-1] == (len(BODY), len(BODY))
    assert seen == sorted(seen)


def test_a_file_gets_the_rights_that_the_user_gives_new_files(server: Any, answers: Any, tmp_path: Path) -> None:
    server.answers = [answers["answer"](200, BODY)]
    mask = os.umask(0o027)
    try:
        with Transport(server.url) as transport:
            download(transport, "/file", tmp_path / "file", SHA256, no_progress)
    finally:
        os.umask(mask)
    assert (tmp_path / "file").stat().st_mode & 0o777 == 0o640


def test_a_job_is_called_after_its_file_as_far_as_labels_go() -> None:
    assert label_of(Path("scans/part 7.ply")) == "part 7.ply"
    assert label_of(Path("a\nb\udcff.ply")) == "ab?.ply"
    name = "é" * 240 + ".ply"
    label = label_of(Path(name))
    assert label == name[-200:]
    assert JobSpec(mesh_id="0" * 64, label=label).label == label
    assert label_of(Path("\n")) is None

"""`quadpatch-client watch` against a real local stack, over a line that goes down.

Also tests `quadpatch_client.watch_command`.
"""

import json
import os
import random
import socket
import subprocess
import sys
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

from typer.testing import CliRunner

from quadpatch_client.cli import app
from quadpatch_client.exit_codes import ExitCode
from quadpatch_client.file_repair import JobOptions
from quadpatch_client.folder_watch import STATE, FolderWatch
from quadpatch_client.journal import Journal
from quadpatch_client.options import MethodChoice
from quadpatch_client.sdk import Client
from tests.integration.conftest import ply_bytes, punched_relief
from tests.integration.test_batch import SMOOTH, small_scans
from tests.resumption.proxy import Proxy
from tests.waiting import GUARD_S, end, wait_until

OPTIONS = ["--settle", "0.2", *SMOOTH]


class Line(Proxy):
    """A line that can be taken down: connections are closed at once then."""

    is_down = False
    n_refused = 0

    def _serve(self, client: socket.socket) -> None:
        if self.is_down:
            self.n_refused += 1
            client.close()
        else:
            super()._serve(client)


@contextmanager
def watching(folder: Path, url: str) -> Iterator[subprocess.Popen[bytes]]:
    command = [sys.executable, "-m", "quadpatch_client", "watch", str(folder), *OPTIONS]
    with (folder.parent / "log").open("ab") as log:
        process = subprocess.Popen(command, stderr=log, env={**os.environ, "QUADPATCH_CLIENT_URL": url})
        try:
            yield process
        finally:
            end(process)


def killed_in_an_upload(line: Line, folder: Path, name: str, content: bytes, accidents: list[Any]) -> None:
    """Let a client that watches a folder die in the middle of an upload, and the line go down at the same moment."""
    folder.mkdir()
    with watching(folder, line.url) as client:
        accidents.append(client)
        (folder / name).write_bytes(content)
        wait_until(lambda: line.is_down)
        client.wait(GUARD_S)


@contextmanager
def line_with_an_accident(url: str, size: int, seed: int) -> Iterator[tuple[Line, list[Any]]]:
    """A line that goes down in the middle of so many bytes, and kills the client that is listed first then."""
    clients: list[subprocess.Popen[bytes]] = []

    def accident() -> None:
        line.is_down = True
        clients[0].kill()

    line = Line(urlsplit(url).port or 0, size, [accident], random.Random(seed))
    with line.running():
        yield line, clients


def check_nothing_is_lost(url: str, folder: Path, names: set[str], label: str) -> None:
    """Assert that scans and results of all files are there, and each was repaired once."""
    assert {path.name for path in folder.glob(label) if "repaired" not in path.name} == names
    for name in names:
        report = json.loads((folder / name.replace(".ply", "-repaired.json")).read_text())
        assert report["counts"]["filled_smooth"] == report["counts"]["found"] - 1
    with Client(url) as service:
        assert Counter(job.mesh_name for job in service.jobs(label=label)) == dict.fromkeys(names, 1)


def test_nothing_is_lost_though_the_line_goes_down_and_the_client_dies_in_an_upload(
    local_stack: Any, tmp_path: Path
) -> None:
    folder, content = tmp_path / "drop", ply_bytes(*punched_relief(121, n_holes=3))
    with line_with_an_accident(local_stack.url, len(content), 0) as (line, clients):
        killed_in_an_upload(line, folder, "lost_0.ply", content, clients)
        small_scans(folder, 2, "lost_more")
        with watching(folder, line.url):
            wait_until(lambda: line.n_refused > 0)
            assert not list(folder.glob("*-repaired.*"))
            line.is_down = False
            wait_until(lambda: len(list(folder.glob("*-repaired.ply"))) == 3)
    names = {"lost_0.ply", "lost_more_000.ply", "lost_more_001.ply"}
    check_nothing_is_lost(local_stack.url, folder, names, "lost_*")


def test_ten_minutes_without_a_service_lose_nothing(local_stack: Any, tmp_path: Path) -> None:
    """The client dies in an upload and is started again; the minutes pass by a clock that is set by hand."""
    folder, content = tmp_path / "drop", ply_bytes(*punched_relief(123, n_holes=3))
    with line_with_an_accident(local_stack.url, len(content), 1) as (line, clients):
        killed_in_an_upload(line, folder, "away_0.ply", content, clients)
        small_scans(folder, 1, "away_before")
        waits = [said for said in watched_for_eleven_minutes(folder, line.url) if " waits, " in said]
        assert len(waits) >= 15
        assert "next try in 60 s" in waits[-1]
        assert not list(folder.glob("*-repaired.*"))
        assert not (folder / "failed").exists()
        line.is_down = False
        with watching(folder, line.url):
            wait_until(lambda: len(list(folder.glob("*-repaired.ply"))) == 3)
    assert (folder / "away_0.ply").read_bytes() == content
    names = {"away_0.ply", "away_before_000.ply", "away_during_000.ply"}
    check_nothing_is_lost(local_stack.url, folder, names, "away_*")


def watched_for_eleven_minutes(folder: Path, url: str) -> list[str]:
    """Watch a folder by a clock that is set by hand, while one more scan is dropped; return what was told."""
    now, told, options = 0.0, list[str](), JobOptions(method=MethodChoice("smooth"))
    with Client(url, patience_s=0.0) as service, Journal(folder / STATE / "journal.jsonl") as journal:
        watch = FolderWatch(service, folder, options, journal, 2, 0.2, told.append, clock=lambda: now)
        while now < 660.0:
            watch.look()
            wait_until(lambda: all(future.done() for future in watch._busy.values()))
            now += 5.0
            if now == 300.0:
                small_scans(folder, 1, "away_during")
        watch.look()
    return told


def test_what_lies_there_is_repaired_once_and_what_is_no_mesh_is_set_aside(
    local_stack: Any, tmp_path: Path, relief_file: Callable[[str], Path]
) -> None:
    relief_file("float.ply")
    (tmp_path / "garbage.ply").write_bytes(b"ply\n" + os.urandom(300))
    (tmp_path / "empty.stl").touch()
    arguments = ["watch", str(tmp_path), "--once", "--html", *OPTIONS, "--url", local_stack.url]
    done = CliRunner().invoke(app, arguments)
    assert done.exit_code == 0, done.stderr
    assert "float.ply: 4 of 5 holes filled, 1 left open" in done.stderr
    names = {"float.ply", "float-repaired.ply", "float-repaired.json", "float-repaired.html", "failed", "empty.stl"}
    assert {path.name for path in tmp_path.iterdir() if not path.name.startswith(".")} == names
    reason = (tmp_path / "failed" / "garbage.ply.reason.txt").read_text()
    assert reason.startswith("garbage.ply was not repaired.\nwhy: ")
    assert (tmp_path / "failed" / "garbage.ply").exists()
    again = CliRunner().invoke(app, arguments)
    assert "float.ply" not in again.stderr
    (tmp_path / "failed" / "garbage.ply").replace(tmp_path / "garbage.ply")
    again = CliRunner().invoke(app, arguments)
    assert "garbage.ply can't be repaired and was moved to" in again.stderr
    assert (tmp_path / "failed" / "garbage.ply").exists()


def test_a_rule_that_is_not_known_ends_a_single_look(local_stack: Any, tmp_path: Path) -> None:
    names = small_scans(tmp_path, 2, "unruled")
    arguments = ["watch", str(tmp_path), "--once", "--saved-rule", "no-such", *OPTIONS, "--url", local_stack.url]
    done = CliRunner().invoke(app, arguments)
    assert done.exit_code == ExitCode.REJECTED, done.stderr
    assert "(rule_not_found)" in done.stderr
    assert sorted(path.name for path in tmp_path.iterdir() if not path.name.startswith(".")) == names

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


def test_nothing_is_lost_though_the_line_goes_down_and_the_client_dies_in_an_upload(
    local_stack: Any, tmp_path: Path
) -> None:
    folder = tmp_path / "drop"
    folder.mkdir()
    content = ply_bytes(*punched_relief(121, n_holes=3))
    clients: list[subprocess.Popen[bytes]] = []

    def accident() -> None:
        line.is_down = True
        clients[0].kill()

    port = urlsplit(local_stack.url).port or 0
    line = Line(port, len(content), [accident], random.Random(0))
    with line.running():
        with watching(folder, line.url) as client:
            clients.append(client)
            (folder / "lost_0.ply").write_bytes(content)
            wait_until(lambda: line.is_down)
            client.wait(GUARD_S)
        small_scans(folder, 2, "lost_more")
        with watching(folder, line.url):
            wait_until(lambda: line.n_refused > 0)
            assert not list(folder.glob("*-repaired.*"))
            line.is_down = False
            wait_until(lambda: len(list(folder.glob("*-repaired.ply"))) == 3)
    names = {"lost_0.ply", "lost_more_000.ply", "lost_more_001.ply"}
    assert {path.name for path in folder.glob("lost*") if "repaired" not in path.name} == names
    for name in names:
        report = json.loads((folder / name.replace(".ply", "-repaired.json")).read_text())
        assert report["counts"]["filled_smooth"] == report["counts"]["found"] - 1
    with Client(local_stack.url) as service:
        assert Counter(job.mesh_name for job in service.jobs(label="lost_*")) == dict.fromkeys(names, 1)


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

"""The client writes through the names that it is given, and replaces no link, pipe or device."""

import hashlib
import json
import os
import stat
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from quadpatch_client.errors import UsageError
from quadpatch_client.exit_codes import ExitCode
from quadpatch_client.outputs import check_stdout, is_stream
from quadpatch_client.progress import no_progress
from quadpatch_client.repairing import format_of
from quadpatch_client.transfers import download
from quadpatch_client.transport import Transport
from tests.quadpatch_client import conftest as scripted
from tests.quadpatch_client.wire_jobs import JOB_ID, PATH, body
from tests.waiting import GUARD_S

server = scripted.server
MESH = b"ply\n" + bytes(range(256)) * 40
SHA256 = hashlib.sha256(MESH).hexdigest()
REPORT = json.dumps({"holes": [], "warnings": [], "stages": []}).encode()
Server = scripted.ScriptedServer


def fetched(server: Server, target: Path) -> None:
    server.answers = [scripted.answer(200, MESH)]
    with Transport(server.url) as transport:
        download(transport, "/file", target, SHA256, no_progress)


def test_a_link_stays_and_what_it_leads_to_gets_the_mesh(server: Server, tmp_path: Path) -> None:
    (tmp_path / "elsewhere").mkdir()
    real, link = tmp_path / "elsewhere" / "real.ply", tmp_path / "link.ply"
    for _ in ("absent", "there"):
        if not link.is_symlink():
            link.symlink_to(real)
        fetched(server, link)
        assert link.is_symlink()
        assert real.read_bytes() == MESH
    assert [path.name for path in (tmp_path / "elsewhere").iterdir()] == ["real.ply"]


def test_a_pipe_or_device_is_written_and_not_replaced(server: Server, tmp_path: Path) -> None:
    pipe = tmp_path / "pipe.ply"
    os.mkfifo(pipe)
    read: list[bytes] = []
    reader = threading.Thread(target=lambda: read.append(pipe.read_bytes()))
    reader.start()
    fetched(server, pipe)
    reader.join()
    assert read == [MESH]
    assert stat.S_ISFIFO(pipe.stat().st_mode)
    fetched(server, Path("/dev/null"))
    assert stat.S_ISCHR(Path("/dev/null").stat().st_mode)


@pytest.mark.parametrize("name", ["-", "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"])
def test_standard_output_gets_the_mesh_behind_what_is_there_already(server: Server, tmp_path: Path, name: str) -> None:
    server.answers = [
        scripted.answer(200, finished_job()),
        scripted.answer(200, MESH),
        scripted.answer(200, REPORT),
    ]
    command = [sys.executable, "-m", "quadpatch_client", "fetch", JOB_ID, "-o", name, "--url", server.url]
    log = tmp_path / "log"
    log.write_bytes(b"before\n")
    with log.open("ab") as stdout:
        done = subprocess.run(command, stdout=stdout, stderr=subprocess.PIPE, timeout=GUARD_S, check=False)
    assert done.returncode == ExitCode.OK, done.stderr
    assert log.read_bytes() == b"before\n" + MESH


def finished_job() -> bytes:
    files = [("result", "x.ply", MESH), ("report", "report.json", REPORT)]
    result = {
        "format": "ply",
        "files": [
            {
                "role": role,
                "name": name,
                "media_type": "application/octet-stream",
                "size_bytes": len(data),
                "sha256": hashlib.sha256(data).hexdigest(),
            }
            for role, name, data in files
        ],
    }
    links = {"self": PATH, "events": f"{PATH}/events", "mesh": "/v1/meshes/0", "rerun": f"{PATH}/rerun"}
    links |= {"result": f"{PATH}/result", "report": f"{PATH}/report"}
    return body("succeeded", 3, result=result, links=links)


def test_a_stream_takes_one_thing_and_asks_for_no_suffix() -> None:
    assert format_of(Path("-")) is format_of(Path("/dev/null")) is None
    assert not is_stream(Path("absent.ply"))
    check_stdout([Path("-"), Path("report.json"), None], as_json=False)
    for outputs, as_json in (([Path("-"), Path("/dev/stdout")], False), ([Path("-")], True)):
        with pytest.raises(UsageError, match="only one"):
            check_stdout(outputs, as_json)

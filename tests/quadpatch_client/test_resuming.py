"""What the SDK makes of a service's answers; whole uploads: `tests/integration/test_resumable_uploads.py`."""

import hashlib
import json
from pathlib import Path
from typing import Any

import pytest

from quadpatch_client import mesh_calls
from quadpatch_client.errors import DamagedTransferError
from quadpatch_client.sdk import Client
from quadpatch_client.transfers import file_chunks

DATA = b"ply" * 1000
SHA256 = hashlib.sha256(DATA).hexdigest()


def problem(status: int, code: str) -> bytes:
    words = {"type": "about:blank", "title": "x", "detail": "x", "instance": "x"}
    return json.dumps({**words, "status": status, "code": code}).encode()


@pytest.fixture
def path(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(mesh_calls, "RESUMABLE_BYTES", 10)
    (tmp_path / "scan.ply").write_bytes(DATA)
    return tmp_path / "scan.ply"


def mesh_body() -> bytes:
    links = {"self": f"/v1/meshes/{SHA256}", "content": f"/v1/meshes/{SHA256}/content"}
    known = {"id": SHA256, "state": "analysing", "size_bytes": len(DATA), "created_at": "2026-11-30T12:00:00Z"}
    return json.dumps({**known, "links": links}).encode()


def test_a_conflict_a_full_service_and_a_slow_one_are_waited_for(server: Any, answers: Any, path: Path) -> None:
    answer, here = answers["answer"], {"Upload_Offset": "0"}
    problems = {"Content_Type": "application/problem+json"}
    mesh = {"Quadpatch_Mesh": f"/v1/meshes/{SHA256}"}
    server.answers = [
        answer(404, problem(404, "mesh_not_found"), **problems),
        answer(503, problem(503, "too_many_uploads"), Retry_After="0", **problems),
        answer(201, b"{}", Location="/v1/uploads/u"),
        answer(200, b"", **here),
        answer(409, problem(409, "upload_offset_conflict"), **problems),
        answer(200, b"", Upload_Offset="1000"),
        answers["hang_up"](),
        answer(200, b"", Upload_Offset="1700"),
        answer(204, b"", Upload_Offset=str(len(DATA))),
        answer(200, b"", Upload_Offset=str(len(DATA)), **mesh),
        answer(200, mesh_body(), Content_Type="application/json"),
    ]
    done: list[int] = []
    with Client(server.url) as client:
        assert client.upload(path, lambda sent, _: done.append(sent)).id == SHA256
    made = server.requests[1][2]
    assert (made["Upload-Length"], made["Tus-Resumable"]) == (str(len(DATA)), "1.0.0")
    sent = [(headers["Upload-Offset"], body) for method, _, headers, body in server.requests if method == "PATCH"]
    assert [offset for offset, _ in sent] == ["0", "1000", "1700"]
    assert all(body == DATA[int(offset) :] for offset, body in sent)
    assert done[-1] == len(DATA)


def test_what_was_begun_before_and_has_expired_is_begun_anew(server: Any, answers: Any, path: Path) -> None:
    problems = {"Content_Type": "application/problem+json"}
    server.answers = [
        answers["answer"](404, problem(404, "mesh_not_found"), **problems),
        answers["answer"](404, problem(404, "upload_not_found"), **problems),
        answers["answer"](201, b"{}", Location="/v1/uploads/u"),
        answers["answer"](200, b"", Upload_Offset=str(len(DATA)), Quadpatch_Mesh=f"/v1/meshes/{SHA256}"),
        answers["answer"](200, mesh_body(), Content_Type="application/json"),
    ]
    with Client(server.url) as client:
        client.upload(path)
    first, second = (request[2]["Idempotency-Key"] for request in server.requests[1:3])
    assert first.startswith(f"upload-{SHA256}-")
    assert first != second


def test_a_service_that_knows_no_such_uploads_gets_the_file_at_once(server: Any, answers: Any, path: Path) -> None:
    problems = {"Content_Type": "application/problem+json"}
    server.answers = [
        answers["answer"](404, problem(404, "mesh_not_found"), **problems),
        answers["answer"](404, problem(404, "route_not_found"), **problems),
        answers["answer"](201, mesh_body(), Content_Type="application/json"),
    ]
    with Client(server.url) as client:
        assert client.upload(path).id == SHA256
    assert [request[1].partition("?")[0] for request in server.requests[1:]] == ["/v1/uploads", "/v1/meshes"]
    assert server.requests[2][3] == DATA


def test_bytes_that_arrive_as_others_are_an_error_of_the_transfer(server: Any, answers: Any, path: Path) -> None:
    problems = {"Content_Type": "application/problem+json"}
    server.answers = [
        answers["answer"](404, problem(404, "mesh_not_found"), **problems),
        answers["answer"](201, b"{}", Location="/v1/uploads/u"),
        answers["answer"](200, b"", Upload_Offset="0"),
        answers["answer"](410, problem(410, "digest_mismatch"), **problems),
    ]
    with Client(server.url) as client, pytest.raises(DamagedTransferError):
        client.upload(path)


def test_chunks_start_anywhere(path: Path) -> None:
    seen: list[tuple[int, int]] = []
    assert b"".join(file_chunks(path, lambda *step: seen.append(step), 700)) == DATA[700:]
    assert seen[-1] == (len(DATA), len(DATA))

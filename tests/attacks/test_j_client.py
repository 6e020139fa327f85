"""The client retries, reads answers of newer services, and finds its job again."""

import base64
import hashlib
import json
import socket
import threading
from pathlib import Path
from typing import Any, cast

import httpx
import pytest
from pydantic import ValidationError

from quadpatch_client.errors import JobFailedError, MeshRejectedError, UnreachableError, UsageError
from quadpatch_client.exit_codes import ExitCode, exit_code_of
from quadpatch_client.lenient_json import read_leniently
from quadpatch_client.options import HoleChoice, MethodChoice
from quadpatch_client.packing import packed
from quadpatch_client.progress import no_progress
from quadpatch_client.repairing import Task, repair
from quadpatch_client.schema import Job, JobPage, JobSpec, JobState, Mesh, MeshProblem, MeshState, SmoothMethod
from quadpatch_client.screen import Screen
from quadpatch_client.sdk import Client
from quadpatch_client.transfers import download
from quadpatch_client.transport import Transport
from tests.quadpatch_client import conftest as scripted
from tests.quadpatch_client.wire_jobs import JOB_ID, body
from tests.waiting import GUARD_S

server = scripted.server
MESH = b"ply\n" + bytes(range(256)) * 40
SHA256 = hashlib.sha256(MESH).hexdigest()
REPORT = json.dumps({"holes": [], "warnings": [], "stages": []}).encode()
Server = scripted.ScriptedServer


# Retries


def test_a_line_that_breaks_before_the_first_answer_is_no_wrong_address(server: Server) -> None:
    server.answers = [scripted.hang_up, scripted.hang_up, scripted.answer(200)]
    with Transport(server.url, first_contact_s=0.0) as transport:
        assert transport.request("GET", "/").is_success
    assert len(server.requests) == 3


def test_where_nothing_listens_the_client_gives_up_soon() -> None:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        url = f"http://127.0.0.1:{probe.getsockname()[1]}"
    with Transport(url, patience_s=GUARD_S, first_contact_s=0.0) as transport, pytest.raises(UnreachableError):
        transport.request("GET", "/")


def test_an_upload_that_breaks_after_longer_than_the_timeout_is_sent_again(server: Server) -> None:
    tries = []

    def attempt() -> str:
        tries.append(1)
        if len(tries) == 1:
            threading.Event().wait(0.95)
            raise httpx.WriteError("broken")
        return "sent"

    with Transport(server.url, patience_s=0.9) as transport:
        assert transport.patiently(attempt) == "sent"


def test_a_download_that_gets_on_is_not_given_up(server: Server, tmp_path: Path) -> None:
    steps = range(1000, len(MESH), 1000)
    server.answers = [part_of(MESH, end) for end in steps] + [scripted.rest_of(MESH)]
    with Transport(server.url, patience_s=0.5) as transport:
        download(transport, "/file", tmp_path / "file", SHA256, no_progress)
    assert (tmp_path / "file").read_bytes() == MESH


def part_of(whole: bytes, end: int) -> scripted.Answer:
    """Go on where the request asks for, and break off at a place."""

    def send(handler: Any) -> None:
        start = int(handler.headers.get("Range", "bytes=0-").removeprefix("bytes=").removesuffix("-"))
        handler.send_response(206 if start else 200)
        handler.send_header("Content-Length", str(len(whole) - start))
        handler.end_headers()
        handler.wfile.write(whole[start:end])
        handler.wfile.flush()
        scripted.hang_up(handler)

    return send


# A newer service


def test_unknown_options_words_and_fields_are_passed_over() -> None:
    spec = {
        "mesh_id": "0" * 64,
        "method": {"method": "dictionary", "recipe": "tomorrow", "novel": 1},
        "weld_tolerance": {"mode": "new"},
        "holes": {"rules": [{"action": "bridge", "if": "wide"}], "novel": True},
        "dream": {"deep": [1]},
    }
    file = {"role": "texture", "name": "x.png", "media_type": "image/png", "size_bytes": 1, "sha256": "0" * 64}
    result = {"format": "usdz", "files": [file], "novel": 3}
    answer = body("succeeded", 3, spec=spec, result=result, novel=1, model={"requested": "x", "kind": "transformer"})
    job = read_leniently(Job, answer)
    assert job.state == JobState.SUCCEEDED
    assert job.result is not None
    assert (job.result.format, job.result.files[0].role, job.model.kind) == ("usdz", "texture", "transformer")
    unknown_method = read_leniently(Job, body("queued", 1, spec={"mesh_id": "0" * 64, "method": {"method": "novel"}}))
    assert unknown_method.state == JobState.QUEUED


@pytest.mark.parametrize(
    ("more", "state"),
    [
        ({}, JobState.RUNNING),
        ({"finished_at": "2026-11-22T09:15:02.250Z", "result": {"format": "ply"}}, JobState.SUCCEEDED),
        ({"finished_at": "2026-11-22T09:15:02.250Z"}, JobState.FAILED),
    ],
)
def test_an_unknown_state_of_a_job_is_read_from_the_rest(more: dict[str, Any], state: JobState) -> None:
    assert read_leniently(Job, body("archiving", 2, **more)).state is state
    page = {"items": [json.loads(body("archiving", 2, **more)), json.loads(body("queued", 1))]}
    assert [job.state for job in read_leniently(JobPage, json.dumps(page).encode()).items] == [state, JobState.QUEUED]


def test_an_unknown_state_of_a_mesh_is_read_from_the_rest() -> None:
    links = {"self": "/v1/meshes/0", "content": "/v1/meshes/0/content"}
    mesh = {"id": "0" * 64, "state": "novel", "size_bytes": 3, "created_at": "2026-11-22T09:15:02.250Z", "links": links}
    assert read_leniently(Mesh, json.dumps(mesh).encode()).state is MeshState.ANALYSING
    mesh["problem"] = {"code": "novel", "message": "why"}
    assert read_leniently(Mesh, json.dumps(mesh).encode()).state is MeshState.REJECTED


@pytest.mark.parametrize("answer", [b"[]", b'{"state": "novel"}', b"{", b"null", body("queued", 1, percent="much")])
def test_what_is_no_job_is_not_taken_for_one(answer: bytes) -> None:
    with pytest.raises(ValidationError):
        read_leniently(Job, answer)


def test_what_is_sent_is_checked_strictly() -> None:
    with pytest.raises(ValidationError):
        JobSpec.model_validate({"mesh_id": "0" * 64, "novel": 1})


# The way back to a job


def test_the_same_file_and_spec_come_under_the_same_key_until_the_job_fails(server: Server) -> None:
    spec = JobSpec(mesh_id="0" * 64, method=SmoothMethod(method="smooth"))
    server.answers = [
        scripted.answer(202, body("queued", 1)),
        scripted.answer(202, body("running", 2)),
        scripted.answer(200, body("failed", 3)),
        scripted.answer(202, body("queued", 1)),
        scripted.answer(202, body("queued", 1)),
    ]
    with Client(server.url) as client:
        client.create_job_once(spec)
        client.create_job_once(spec)
        client.create_job_once(spec)
        client.create_job_once(spec.model_copy(update={"seed": 1}))
    keys = [headers["Idempotency-Key"] for _, _, headers, _ in server.requests]
    assert keys[0] == keys[1] == keys[2]
    assert len(set(keys)) == 3


class Service:
    """A service on which a bad mesh ends a job before it is analysed, or that is gone once the job is accepted."""

    def __init__(self, error: Exception, mesh: Exception | None = None) -> None:
        self._error, self._mesh = error, mesh

    def upload(self, path: Path, progress: object) -> Mesh:
        links = {"self": "/v1/meshes/0", "content": "/v1/meshes/0/content"}
        facts = {"id": "0" * 64, "state": "analysing", "size_bytes": 3, "created_at": "2026-11-22T09:15:02.250Z"}
        return Mesh.model_validate({**facts, "links": links})

    def create_job_once(self, spec: JobSpec) -> Job:
        return Job.model_validate_json(body("queued", 1))

    def wait(self, *_: object) -> Job:
        raise self._error

    def wait_for_mesh(self, mesh_id: str, timeout_s: float) -> None:
        if self._mesh is not None:
            raise self._mesh


def failed(stage: str) -> JobFailedError:
    error = {"code": "unreadable_mesh", "message": "no mesh", "stage": stage}
    return JobFailedError(Job.model_validate_json(body("failed", 2, error=error)))


REJECTED = MeshRejectedError(MeshProblem(code="unreadable_mesh", message="no mesh"))


@pytest.mark.parametrize(
    ("service", "code"),
    [
        (Service(failed("read"), REJECTED), ExitCode.REJECTED),
        (Service(REJECTED), ExitCode.REJECTED),
        (Service(failed("read")), ExitCode.JOB_FAILED),
        (Service(failed("fill"), REJECTED), ExitCode.JOB_FAILED),
    ],
)
def test_a_bad_mesh_ends_with_the_same_code_wherever_it_is_found_first(
    service: Service, code: ExitCode, tmp_path: Path
) -> None:
    (tmp_path / "scan.ply").write_bytes(b"ply")
    task = Task(tmp_path / "scan.ply", tmp_path / "out.ply", HoleChoice(), MethodChoice())
    with pytest.raises((JobFailedError, MeshRejectedError)) as caught:
        repair(cast(Client, service), Screen(quiet=True), task)
    assert exit_code_of(caught.value) is code


def test_a_command_that_loses_its_service_says_how_to_come_back(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "scan.ply").write_bytes(b"ply")
    task = Task(tmp_path / "scan.ply", tmp_path / "out.ply", HoleChoice(), MethodChoice())
    with pytest.raises(UnreachableError):
        repair(cast(Client, Service(UnreachableError("no answer"))), Screen(), task)
    said = capsys.readouterr().err
    assert said.index(f"job {JOB_ID} accepted") < said.index(f"fetch {JOB_ID} -o FILE")


# glTF


def gltf(folder: Path, uri: str, kind: str = "buffers") -> Path:
    path = folder / "scan.gltf"
    path.write_text(json.dumps({"asset": {"version": "2.0"}, kind: [{"uri": uri, "byteLength": 3}]}))
    return path


def test_a_gltf_is_sent_with_its_files_inside(tmp_path: Path) -> None:
    (tmp_path / "the data").mkdir()
    (tmp_path / "the data" / "scan.bin").write_bytes(b"\x00\x01\xff")
    for kind in ("buffers", "images"):
        path = gltf(tmp_path, "the%20data/scan.bin", kind)
        with packed(path) as whole:
            (entry,) = json.loads(whole.read_text())[kind]
            assert whole.name == path.name
        head, _, data = entry["uri"].partition(";base64,")
        assert head == "data:application/octet-stream"
        assert base64.b64decode(data) == b"\x00\x01\xff"


def test_a_gltf_sends_no_file_from_elsewhere(tmp_path: Path) -> None:
    secret, folder = tmp_path / "secret", tmp_path / "scans"
    secret.write_bytes(b"key")
    folder.mkdir()
    (folder / "link.bin").symlink_to(secret)
    names = ["../secret", str(secret), f"file://{secret}", "link.bin", "%2e%2e/secret", "absent.bin", "x\x00", "."]
    for name in names:
        with pytest.raises(UsageError, match="not there or not in the same folder"), packed(gltf(folder, name)):
            pass


@pytest.mark.parametrize(
    "text", ['{"buffers": [{"uri": "data:;base64,AA=="}]}', "{", "[" * 100_000, "[]", '{"buffers": 3}']
)
def test_files_that_need_no_other_are_sent_as_they_are(tmp_path: Path, text: str) -> None:
    for name in ("scan.gltf", "scan.ply"):
        path = tmp_path / name
        path.write_text(text)
        with packed(path) as whole:
            assert whole == path

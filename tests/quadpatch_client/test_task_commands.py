"""Also tests `quadpatch_client.task_summary`, `quadpatch_client.missing_vertices` and `quadpatch_client/running.py`."""

import hashlib
import json
from collections.abc import Callable
from http.server import BaseHTTPRequestHandler
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner, Result

from quadpatch_client.cli import app
from quadpatch_client.errors import UsageError
from quadpatch_client.exit_codes import ExitCode
from quadpatch_client.missing_vertices import read_missing
from quadpatch_client.schema import AutoMethod, JobResult, Task
from quadpatch_client.task_summary import task_sentence
from tests.quadpatch_client.conftest import ScriptedServer
from tests.quadpatch_client.wire_jobs import JOB_ID, PATH, body

SHA256 = hashlib.sha256(b"result").hexdigest()
STAGES = [{"name": "read", "seconds": 0.25}]
REPORT = json.dumps({"length_unit": "mm", "holes": [], "stages": STAGES, "warnings": []}).encode()


def file_of(role: str, data: bytes) -> dict[str, Any]:
    facts = {"media_type": "application/octet-stream", "size_bytes": len(data)}
    return {"role": role, "name": role, "sha256": hashlib.sha256(data).hexdigest(), **facts}


def answer(path: str, spec: dict[str, Any]) -> bytes:
    """Answer like a service that has every mesh, and has done the job."""
    if path.endswith("/result"):
        return b"result"
    if path.endswith("/report"):
        return REPORT
    if path.startswith("/v1/meshes/"):
        mesh_id = path.removeprefix("/v1/meshes/")
        facts = {"id": mesh_id, "state": "ready", "size_bytes": 3, "created_at": "2026-11-22T09:15:02.250Z"}
        return json.dumps({**facts, "links": {"self": path, "content": f"{path}/content"}}).encode()
    files = [file_of("result", b"result"), file_of("report", REPORT)]
    result = {"format": "ply", "seconds": 1.5, "files": files, "restored_vertices": 12, "moved_vertices": 9}
    links = {"self": PATH, "events": f"{PATH}/events", "mesh": "/", "rerun": "/"}
    links |= {"result": f"{PATH}/result", "report": f"{PATH}/report"}
    return body("succeeded", 2, spec=spec, result=result, links=links)


@pytest.fixture
def run(server: ScriptedServer, tmp_path: Path) -> Callable[..., Result]:
    """Runs a command of the client on `scan.ply`, against a service that has done the job."""
    (tmp_path / "scan.ply").write_bytes(b"ply")

    def serve(handler: BaseHTTPRequestHandler) -> None:
        data = answer(handler.path, sent_spec(server))
        handler.send_response(200)
        handler.send_header("Content-Length", str(len(data)))
        handler.end_headers()
        handler.wfile.write(data)

    server.answers.append(serve)

    def run_client(command: str, output: str, *arguments: str | Path) -> Result:
        whole = [command, tmp_path / "scan.ply", "-o", tmp_path / output, *arguments]
        return CliRunner().invoke(app, [*map(str, whole)], env={"QUADPATCH_CLIENT_URL": server.url})

    return run_client


def sent_spec(server: ScriptedServer) -> dict[str, Any]:
    """Return the spec of the last job that was asked for, or nothing."""
    texts = [data for method, path, _, data in server.requests if (method, path) == ("POST", "/v1/jobs")]
    spec: dict[str, Any] = json.loads(texts[-1]) if texts else {}
    return spec


@pytest.mark.parametrize(
    ("flags", "method"),
    [
        ([], {"effort": "standard"}),
        (["--effort", "fast"], {"effort": "fast"}),
        (["--effort", "best", "--fit-steps", "30"], {"effort": "best", "fitting": {"steps": 30}}),
    ],
)
def test_the_effort_of_a_repair_reaches_its_spec(
    run: Callable[..., Result], server: ScriptedServer, flags: list[str], method: dict[str, Any]
) -> None:
    done = run("repair", "out.ply", *flags)
    assert done.exit_code == ExitCode.OK, done.stderr
    assert AutoMethod.model_validate(sent_spec(server)["method"]) == AutoMethod.model_validate(
        {"method": "auto", **method}
    )


@pytest.mark.parametrize("flags", [["--method", "smooth"], ["--model", "self"], ["--recipe", "paper"]])
def test_an_effort_beside_another_method_is_wrong_usage(
    run: Callable[..., Result], server: ScriptedServer, flags: list[str]
) -> None:
    refused = run("repair", "out.ply", "--effort", "best", *flags)
    assert refused.exit_code == ExitCode.USAGE
    assert "an effort goes with the method 'auto' alone" in " ".join(refused.stderr.split())
    assert server.requests == []


def test_restore_says_which_vertices_are_missing(run: Callable[..., Result], server: ScriptedServer) -> None:
    done = run("restore", "out.ply", "--missing", "lost", "--seed", "4", "--html", "page.html")
    assert done.exit_code == ExitCode.OK, done.stderr
    spec = sent_spec(server)
    assert (spec["task"], spec["seed"], spec["method"]["model"]) == ("restore", 4, "self")
    assert spec["restore"] == {"missing": {"kind": "property", "name": "lost"}, "base": "mesh"}
    output = {
        "format": "ply",
        "attributes": None,
        "preview": False,
        "closeups": False,
        "html_report": True,
        "tint": "invented",
    }
    assert spec["output"] == output
    assert "scan.ply: 12 missing vertices got a position; all others kept their bits." in done.stderr


def test_denoise_uploads_its_reference_and_sends_its_bounds(
    run: Callable[..., Result], server: ScriptedServer, tmp_path: Path
) -> None:
    (tmp_path / "clean.ply").write_bytes(b"clean")
    region = ["--region", "0", "0", "-1", "5", "5", "1"]
    bounds = ["--noise", "0.1", "--max-shift", "0.25", *region]
    done = run("denoise", "out.stl", "--reference", tmp_path / "clean.ply", *bounds)
    assert done.exit_code == ExitCode.OK, done.stderr
    assert sent_spec(server)["denoise"] == {
        "noise": 0.1,
        "max_shift": 0.25,
        "region": {"kind": "box", "min": [0.0, 0.0, -1.0], "max": [5.0, 5.0, 1.0]},
        "reference": hashlib.sha256(b"clean").hexdigest(),
    }
    assert sent_spec(server)["mesh_id"] == hashlib.sha256(b"ply").hexdigest()
    assert "9 vertices were moved" in done.stderr
    assert (tmp_path / "out.stl").read_bytes() == b"result"


def test_a_task_by_geometry_alone_has_no_model(run: Callable[..., Result], server: ScriptedServer) -> None:
    assert run("denoise", "out.ply", "--model", "smooth").exit_code == ExitCode.OK
    assert sent_spec(server)["method"] == {"method": "smooth"}


def test_encode_writes_a_qpz_file_and_nothing_else(run: Callable[..., Result], server: ScriptedServer) -> None:
    refused = run("encode", "out.ply", "--max-error", "0.01")
    assert refused.exit_code == ExitCode.USAGE
    assert "does not end in .qpz" in refused.stderr
    assert server.requests == []
    done = run("encode", "out.qpz", "--max-error", "0.01", "--keep-connectivity", "--model", "mine@2")
    assert done.exit_code == ExitCode.OK, done.stderr
    spec = sent_spec(server)
    assert (spec["encode"], spec["output"]["format"]) == ({"max_error": 0.01, "keep_connectivity": True}, None)
    assert spec["method"]["model"] == "mine@2"
    assert "scan.ply: encoded in 6 bytes. The work took 1.5 s (read 0.2 s)." in done.stderr


def test_decode_writes_the_format_of_its_output(run: Callable[..., Result], server: ScriptedServer) -> None:
    done = run("decode", "out.obj", "--json", "--quiet")
    assert done.exit_code == ExitCode.OK, done.stderr
    assert (sent_spec(server)["task"], sent_spec(server)["output"]["format"]) == ("decode", "obj")
    assert json.loads(done.stdout)["id"] == JOB_ID


def test_an_output_never_takes_the_place_of_the_reference(
    run: Callable[..., Result], server: ScriptedServer, tmp_path: Path
) -> None:
    (tmp_path / "clean.ply").write_bytes(b"clean")
    done = run("denoise", "clean.ply", "--reference", tmp_path / "clean.ply")
    assert done.exit_code == ExitCode.USAGE
    assert "is the reference itself" in done.stderr
    assert server.requests == []


@pytest.mark.parametrize(
    ("command", "arguments"),
    [
        ("denoise", ["--noise", "0"]),
        ("denoise", ["--max-shift", "-1"]),
        ("denoise", ["--region", "1", "0", "0", "0", "1", "1"]),
        ("restore", ["--missing", "two words"]),
        ("denoise", ["--reference", "SCAN", "--model", "general-dictionary"]),
    ],
)
def test_what_makes_no_sense_is_refused_before_anything_is_sent(
    run: Callable[..., Result], server: ScriptedServer, tmp_path: Path, command: str, arguments: list[str]
) -> None:
    words = [str(tmp_path / "scan.ply") if word == "SCAN" else word for word in arguments]
    assert run(command, "out.ply", *words).exit_code == ExitCode.USAGE
    assert server.requests == []


def test_missing_vertices_are_nan_a_property_or_a_list_in_a_file(tmp_path: Path) -> None:
    plain, listed = tmp_path / "lost.txt", tmp_path / "lost.json"
    plain.write_text("3 4\n7\n")
    listed.write_text(" [3, 4, 7]")
    assert read_missing("nan") == {"kind": "nan"}
    assert read_missing("lost") == {"kind": "property", "name": "lost"}
    assert read_missing(f"property:{plain}") == {"kind": "property", "name": str(plain)}
    for path in (plain, listed):
        assert read_missing(str(path)) == {"kind": "indices", "indices": [3, 4, 7]}


@pytest.mark.parametrize("text", ["1 two", "[1, 2", "[1.5]", "[true]", '["1"]', "\udcff"])
def test_a_file_that_is_no_list_of_numbers_is_refused(tmp_path: Path, text: str) -> None:
    path = tmp_path / "lost.txt"
    path.write_bytes(text.encode("utf-8", "surrogateescape"))
    with pytest.raises(UsageError, match=r"lost\.txt holds"):
        read_missing(str(path))


@pytest.mark.parametrize(
    ("task", "facts", "sentence"),
    [
        ("restore", {"restored_vertices": 1}, "1 missing vertex got a position; all others kept their bits"),
        ("restore", {}, "missing vertices got a position; all others kept their bits"),
        ("denoise", {"moved_vertices": 1}, "1 vertex was moved"),
        (
            "denoise",
            {"moved_vertices": 85_000, "shift_95": 0.03125},
            "85,000 vertices were moved, 95 of 100 of them by no more than 0.0312 mm",
        ),
        ("encode", {"max_error": 0.0098}, "encoded, no farther than 0.0098 mm from the scan"),
        ("decode", {}, "decoded as ply"),
    ],
)
def test_each_task_is_told_in_a_sentence(task: Task, facts: dict[str, Any], sentence: str) -> None:
    result = JobResult.model_validate({"format": "ply", **facts})
    assert task_sentence("scan", task, result, "mm") == f"scan: {sentence}."

import io
import logging
from collections.abc import Iterator

import pytest
from starlette.testclient import TestClient

from jobkit.errors import JobkitError
from jobkit.logs import set_up_logs
from jobkit.settings import Settings
from service.app import create_app
from service.problems import STATUS_BY_ERROR, to_problem_error

JSON = {"Content-Type": "application/json"}


def all_subclasses(kind: type[JobkitError]) -> Iterator[type[JobkitError]]:
    for child in kind.__subclasses__():
        yield child
        yield from all_subclasses(child)


def test_every_error_has_a_code_of_its_own() -> None:
    kinds: list[type[JobkitError]] = [JobkitError, *all_subclasses(JobkitError)]
    assert len({kind.code for kind in kinds}) == len(kinds)
    assert set(STATUS_BY_ERROR) <= set(kinds)


def test_an_error_that_is_no_fault_of_the_request_tells_nothing() -> None:
    class InnerError(JobkitError):
        code = "inner"

    problem = to_problem_error(InnerError("password hunter2"))
    assert problem.status == 500
    assert "hunter2" not in problem.detail


@pytest.mark.parametrize(
    ("request_line", "body", "headers", "status", "code"),
    [
        ("GET /nowhere", None, {}, 404, "route_not_found"),
        ("GET /v1/jobs/", None, {}, 404, "route_not_found"),
        ("DELETE /v1/jobs", None, {}, 405, "method_not_allowed"),
        ("TRACE /healthz", None, {}, 405, "method_not_allowed"),
        ("POST /v1/jobs", b"{", JSON, 400, "malformed_json"),
        ("POST /v1/jobs", b'{"\xff\xff"}', JSON, 400, "malformed_json"),
        ("POST /v1/jobs", b"[" * 100_000, JSON, 400, "malformed_json"),
        ("POST /v1/jobs", b"9" * 5000, JSON, 400, "malformed_json"),
        ("POST /v1/jobs", b'{"mesh_id": "\\ud800"}', JSON, 400, "malformed_json"),
        ("POST /v1/jobs", b"", JSON, 422, "invalid_request"),
        ("POST /v1/jobs", b"{}", {}, 415, "unsupported_media_type"),
        ("POST /v1/jobs", b"{}", {"Content-Type": "text/plain"}, 415, "unsupported_media_type"),
        ("POST /v1/jobs", b"{}", JSON, 422, "invalid_request"),
        ("POST /v1/jobs", b" " * 2_000_000, JSON, 413, "body_too_large"),
        ("GET /v1/jobs?limit=0", None, {}, 422, "invalid_request"),
        ("GET /v1/jobs?limits=5", None, {}, 422, "invalid_request"),
        ("GET /v1/jobs?cursor=x", None, {}, 422, "invalid_request"),
        ("GET /v1/jobs/job_1", None, {}, 422, "invalid_request"),
        ("GET /v1/jobs/job_01jd7z3v5qk8m2x4c6b8n0a9de", None, {}, 404, "job_not_found"),
        ("GET /v1/meshes/" + "0" * 64, None, {}, 404, "mesh_not_found"),
        ("GET /v1/models/none", None, {}, 404, "model_not_found"),
    ],
)
def test_every_error_is_a_problem_document(
    client: TestClient,
    request_line: str,
    body: bytes | None,
    headers: dict[str, str],
    status: int,
    code: str,
) -> None:
    answer = client.request(*request_line.split(), content=body, headers=headers)
    assert answer.headers["content-type"] == "application/problem+json"
    problem = answer.json()
    assert (answer.status_code, problem["status"], problem["code"]) == (status, status, code)
    assert problem["type"] == f"urn:quadpatch:problem:{code}"
    assert problem["instance"].endswith(answer.headers["x-request-id"])
    assert problem["title"]
    assert problem["detail"]
    assert bool(problem["errors"]) == (code == "invalid_request")


@pytest.mark.parametrize(
    ("path", "allowed"),
    [
        ("/v1/jobs", "GET, HEAD, POST"),
        ("/v1/meshes", "GET, HEAD, POST"),
        ("/v1/repairs", "POST"),
        ("/v1/jobs/job_01jd7z3v5qk8m2x4c6b8n0a9de/cancel", "POST"),
        ("/v1/aliases/default", "DELETE, PUT"),
    ],
)
def test_a_wrong_method_is_told_all_right_ones(client: TestClient, path: str, allowed: str) -> None:
    assert client.patch(path).headers["allow"] == allowed


def test_each_wrong_field_is_pointed_at(client: TestClient) -> None:
    spec = {
        "mesh_id": "x",
        "method": {"method": "cnn", "patches": {"overlap": 99}},
        "metadata": {"a/b": "1"},
        "restore": {"missing": {"kind": "indices", "indices": [-1]}},
        "denoise": {"region": {"kind": "property", "name": ""}},
    }
    problem = client.post("/v1/jobs", json=spec).json()
    assert {(error["location"], error["pointer"]) for error in problem["errors"]} == {
        ("body", "/mesh_id"),
        ("body", "/method/patches/overlap"),
        ("body", "/metadata/a~1b/[key]"),
        ("body", "/restore/missing/indices/0"),
        ("body", "/denoise/region/name"),
    }
    problem = client.get("/v1/jobs?limit=many&staet=queued").json()
    assert [(error["location"], error["pointer"]) for error in problem["errors"]] == [("query", "staet")]


def test_a_fault_is_answered_without_its_traceback_and_logged_with_it(
    settings: Settings, monkeypatch: pytest.MonkeyPatch
) -> None:
    app, log = create_app(settings), io.StringIO()
    monkeypatch.setattr(logging.getLogger(), "handlers", [])  # put back afterwards
    set_up_logs(settings, log)

    @app.get("/fault")
    def fault() -> None:
        raise RuntimeError("hunter2")

    with TestClient(app, base_url="http://127.0.0.1") as client:
        answer = client.get("/fault", headers={"X-Request-Id": "trace-me"})
    assert answer.status_code == 500
    assert answer.json()["code"] == "internal_error"
    assert "hunter2" not in answer.text
    assert answer.headers["x-content-type-options"] == "nosniff"
    assert "hunter2" in log.getvalue()
    assert "trace-me" in log.getvalue()

"""Also tests `jobkit/database/job_rows.py`."""

import json
from collections.abc import Callable

import pytest
from starlette.testclient import TestClient

from jobkit.settings import Settings
from quadpatch_client.schema import Job, JobError, JobResult
from service.app import create_app
from service.services import Services

PATHS = [
    ("result", "application/octet-stream", b"ply, repaired", "part 7-repaired.ply"),
    ("report", "application/json", b'{"schema": 1}', "part 7-repaired.json"),
    ("preview.png", "image/png", b"\x89PNG\r\n\x1a\n", "part 7-repaired.png"),
    ("closeups.zip", "application/zip", b"PK\x05\x06" + bytes(18), "part 7-repaired-closeups.zip"),
    ("report.html", "text/html; charset=utf-8", b"<!DOCTYPE html>", "part 7-repaired.html"),
    ("report.pdf", "application/pdf", b"%PDF-1.4", "part 7-repaired.pdf"),
]


@pytest.mark.parametrize("expected", PATHS)
def test_each_file_comes_with_its_type_and_a_sensible_name(
    client: TestClient,
    job_id: str,
    finish: Callable[[str], Job],
    expected: tuple[str, str, bytes, str],
) -> None:
    path, media_type, data, filename = expected
    finish(job_id)
    answer = client.get(f"/v1/jobs/{job_id}/{path}")
    assert answer.content == data
    assert answer.headers["content-type"] == media_type
    assert answer.headers["content-disposition"] == f'attachment; filename="{filename}"'
    part = client.get(f"/v1/jobs/{job_id}/{path}", headers={"Range": "bytes=2-3"})
    assert (part.status_code, part.content) == (206, data[2:4])
    same = client.get(f"/v1/jobs/{job_id}/{path}", headers={"If-None-Match": answer.headers["etag"]})
    assert same.status_code == 304


def test_a_page_of_a_client_s_words_is_kept_out_of_the_origin_of_the_service(
    client: TestClient, job_id: str, finish: Callable[[str], Job]
) -> None:
    finish(job_id)
    path = f"/v1/jobs/{job_id}/report.html"
    whole = client.get(path)
    part = client.get(path, headers={"Range": "bytes=2-3"})
    same = client.get(path, headers={"If-None-Match": whole.headers["etag"]})
    for answer in (whole, part, same, client.head(path)):
        policy = answer.headers["content-security-policy"].split("; ")
        assert policy[:3] == ["sandbox", "default-src 'none'", "img-src data:"]
        assert not any("script" in part for part in policy)
        assert answer.headers["content-disposition"].startswith("attachment; ")
        assert answer.headers["x-content-type-options"] == "nosniff"


def test_a_result_is_named_after_the_file_of_its_job_whatever_its_bytes_are_called_elsewhere(
    client: TestClient, finish: Callable[[str], Job]
) -> None:
    """Two uploads of the same bytes under two names, by the two ways to make a job."""
    data, spec = b"ply\n", {"method": {"method": "smooth"}}
    client.headers["Cache-Control"] = "no-cache"
    jobs = []
    for name in ("left.ply", "right.ply"):
        mesh = client.post("/v1/meshes", params={"filename": name}, content=data).json()
        jobs.append(client.post("/v1/jobs", json={"mesh_id": mesh["id"], **spec}).json())
    for name in ("upper.ply", "lower.ply"):
        files: dict[str, tuple[str, bytes] | tuple[None, str, str]] = {
            "mesh": (name, data),
            "spec": (None, json.dumps(spec), "application/json"),
        }
        jobs.append(client.post("/v1/repairs", files=files).json())
    named = {"mesh_id": jobs[0]["mesh_id"], "mesh_name": "folder/inner.ply", **spec}
    jobs.append(client.post("/v1/jobs", json=named).json())
    jobs.append(client.post(f"/v1/jobs/{jobs[-1]['id']}/rerun").json())
    names = ["left", "right", "upper", "lower", "inner", "inner"]
    for job, name in zip(jobs, names, strict=True):
        finish(job["id"])
        assert client.get(f"/v1/jobs/{job['id']}").json()["mesh_name"] == f"{name}.ply"
        for path, suffix in (("result", "ply"), ("report", "json"), ("preview.png", "png")):
            header = client.get(f"/v1/jobs/{job['id']}/{path}").headers["content-disposition"]
            assert header == f'attachment; filename="{name}-repaired.{suffix}"'


@pytest.mark.parametrize("path", ["result", "report", "preview.png", "closeups.zip", "report.html", "report.pdf"])
def test_a_job_that_has_not_ended_has_no_result_yet(client: TestClient, job_id: str, path: str) -> None:
    answer = client.get(f"/v1/jobs/{job_id}/{path}")
    assert (answer.status_code, answer.json()["code"]) == (409, "job_not_finished")
    assert answer.headers["retry-after"] == "2"
    assert answer.json()["retryable"] is True


@pytest.mark.parametrize(("renderer", "said"), [("", "no renderer is installed"), ("/usr/bin/chromium", "left no pdf")])
def test_a_job_without_a_pdf_says_whether_there_could_be_one(settings: Settings, renderer: str, said: str) -> None:
    app = create_app(settings.model_copy(update={"pdf_renderer": renderer}))
    with TestClient(app, base_url="http://127.0.0.1") as client:
        mesh_id = client.post("/v1/meshes", content=b"ply").json()["id"]
        job = client.post("/v1/jobs", json={"mesh_id": mesh_id, "method": {"method": "smooth"}}).json()
        attempts = app.state.services.attempts
        attempts.publish(attempts.start(job["id"], "test", 30).attempt, JobResult(format="ply"))
        answer = client.get(f"/v1/jobs/{job['id']}/report.pdf")
        assert (answer.status_code, answer.json()["code"]) == (404, "object_not_found")
        assert said in answer.json()["detail"]
        assert client.get(f"/v1/jobs/{job['id']}").json()["links"]["pdf_report"] is None
        assert client.get("/v1/limits").json()["pdf_reports"] is bool(renderer)


def test_a_failed_job_says_why_there_is_no_result(client: TestClient, services: Services, job_id: str) -> None:
    attempt = services.attempts.start(job_id, "test", 30).attempt
    error = JobError(code="time_limit", message="the repair took longer than 120 s", stage="learn", retryable=False)
    services.attempts.fail(attempt, error)
    assert client.get(f"/v1/jobs/{job_id}").json()["error"] == error.model_dump()
    answer = client.get(f"/v1/jobs/{job_id}/result")
    assert (answer.status_code, answer.json()["code"]) == (409, "job_has_no_result")
    assert "longer than 120 s" in answer.json()["detail"]


def test_the_files_of_a_lost_attempt_are_never_handed_out(
    client: TestClient, services: Services, job_id: str, finish: Callable[[str], Job]
) -> None:
    """The first attempt writes its files and is lost; what clients see is the second one's."""
    first = services.attempts.start(job_id, "lost", 30).attempt
    with services.store.writer("") as writer:
        writer.write(b"of the lost attempt")
        writer.commit(f"results/{job_id}/1/repaired.ply")
    services.attempts.requeue(first, JobError(code="worker_lost", message="lost", retryable=True))
    assert finish(job_id).attempt == 2
    assert client.get(f"/v1/jobs/{job_id}/result").content == b"ply, repaired"


def test_a_file_that_the_store_has_lost_is_a_clear_error(
    client: TestClient, services: Services, job_id: str, finish: Callable[[str], Job]
) -> None:
    finish(job_id)
    services.store.delete_prefix(f"results/{job_id}")
    answer = client.get(f"/v1/jobs/{job_id}/result")
    assert (answer.status_code, answer.json()["code"]) == (410, "result_missing")

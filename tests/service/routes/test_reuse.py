"""Also tests `service/caching.py`: the module service.caching says what a request asks of stored results."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from starlette.testclient import TestClient

from dispatcher.missing_objects import MissingObjects
from jobkit.database.clock import utc_now
from jobkit.database.tables import JobRow
from jobkit.jobs import reuse
from jobkit.storage.damage import NamedObject, note_damaged
from quadpatch_client.schema import Job, JobResult, ResultFile
from service.caching import asks_anew
from service.services import Services

SMOOTH = {"method": "smooth"}
Finish = Callable[[str], Job]


def start(client: TestClient, mesh_id: str, **fields: Any) -> Any:
    headers = fields.pop("headers", {})
    return client.post("/v1/jobs", json={"mesh_id": mesh_id, "method": SMOOTH, **fields}, headers=headers)


@pytest.fixture
def first(client: TestClient, mesh_id: str, finish: Finish) -> Job:
    """A job that has ended with a result."""
    answer = start(client, mesh_id)
    assert answer.headers["Cache-Status"] == "quadpatch; fwd=miss"
    return finish(answer.json()["id"])


def test_an_equal_job_has_the_result_at_once_byte_for_byte(client: TestClient, mesh_id: str, first: Job) -> None:
    again = start(client, mesh_id, label="another label", priority="interactive", metadata={"order": "A-17"})
    assert (again.status_code, again.headers["Cache-Status"]) == (200, "quadpatch; hit")
    job = again.json()
    assert (job["state"], job["cached_from"], job["attempt"]) == ("succeeded", first.id, 0)
    assert job["id"] != first.id
    assert job["result"] == first.model_dump(mode="json")["result"]
    for role in ("result", "report", "preview.png", "closeups.zip"):
        own, others = (client.get(f"/v1/jobs/{job_id}/{role}") for job_id in (job["id"], first.id))
        assert own.status_code == 200
        assert (own.content, own.headers["ETag"]) == (others.content, others.headers["ETag"])
    events = client.get(f"/v1/jobs/{job['id']}/events").json()["items"]
    assert [(event["sequence"], event["type"]) for event in events] == [(1, "queued"), (2, "succeeded")]
    assert events[1]["data"]["cached_from"] == first.id


@pytest.mark.parametrize("change", [{"seed": 1}, {"method": {"method": "dictionary", "model": "self"}}])
def test_another_option_runs(client: TestClient, mesh_id: str, first: Job, change: dict[str, Any]) -> None:
    answer = start(client, mesh_id, **change)
    assert (answer.status_code, answer.headers["Cache-Status"]) == (202, "quadpatch; fwd=miss")


def test_no_cache_runs(client: TestClient, mesh_id: str, first: Job) -> None:
    answer = start(client, mesh_id, headers={"Cache-Control": "max-stale, No-Cache"})
    assert (answer.status_code, answer.headers["Cache-Status"]) == (202, "quadpatch; fwd=request")
    assert answer.json()["state"] == "queued"


@pytest.mark.parametrize(
    ("header", "asked"), [(None, False), ("no-store", False), ("no-cache", True), ("a,no-cache", True)]
)
def test_only_no_cache_asks_for_a_new_result(header: str | None, asked: bool) -> None:
    assert asks_anew(header) is asked


def test_a_repeated_request_gets_its_own_job_and_no_word_of_a_cache(
    client: TestClient, mesh_id: str, first: Job
) -> None:
    key = {"Idempotency-Key": "part-1187"}
    made, repeated = (start(client, mesh_id, headers=key) for _ in range(2))
    assert made.json()["id"] == repeated.json()["id"] != first.id
    assert "Cache-Status" not in repeated.headers
    assert repeated.headers["Idempotent-Replayed"] == "true"


def test_a_job_without_a_change_is_run_again_and_one_with_a_known_change_is_not(
    client: TestClient, mesh_id: str, first: Job, finish: Finish
) -> None:
    other = finish(start(client, mesh_id, seed=7).json()["id"])
    again = client.post(f"/v1/jobs/{first.id}/rerun")
    assert (again.status_code, again.headers["Cache-Status"]) == (202, "quadpatch; fwd=bypass")
    changed = client.post(f"/v1/jobs/{first.id}/rerun", json={"seed": 7})
    assert (changed.status_code, changed.headers["Cache-Status"]) == (200, "quadpatch; hit")
    assert (changed.json()["rerun_of"], changed.json()["cached_from"]) == (first.id, other.id)


def test_a_failed_job_is_no_source(client: TestClient, services: Services, mesh_id: str) -> None:
    failed = start(client, mesh_id).json()["id"]
    client.post(f"/v1/jobs/{failed}/cancel")
    assert start(client, mesh_id).headers["Cache-Status"] == "quadpatch; fwd=miss"


def test_the_result_outlives_the_job_that_made_it(client: TestClient, mesh_id: str, first: Job) -> None:
    second = start(client, mesh_id).json()["id"]
    assert client.delete(f"/v1/jobs/{first.id}").status_code == 204
    assert client.get(f"/v1/jobs/{second}/result").content == b"ply, repaired"
    third = start(client, mesh_id).json()
    assert third["cached_from"] == first.id
    assert client.delete(f"/v1/jobs/{second}").status_code == 204
    assert client.get(f"/v1/jobs/{third['id']}/result").content == b"ply, repaired"


def test_the_files_go_with_the_last_job_that_names_them(
    client: TestClient, services: Services, mesh_id: str, first: Job
) -> None:
    second = start(client, mesh_id).json()["id"]
    for job_id in (first.id, second):
        assert list(services.store.keys(f"results/{first.id}"))
        client.delete(f"/v1/jobs/{job_id}")
    assert list(services.store.keys(f"results/{first.id}")) == []
    assert start(client, mesh_id).headers["Cache-Status"] == "quadpatch; fwd=miss"


def test_lost_and_damaged_files_are_made_again(
    client: TestClient, services: Services, mesh_id: str, first: Job, finish: Finish
) -> None:
    _, keys = services.jobs.with_files(first.id)
    services.store.delete(keys["repaired.ply"])
    lost = start(client, mesh_id)
    assert lost.headers["Cache-Status"] == "quadpatch; fwd=miss"
    second = finish(lost.json()["id"])
    assert start(client, mesh_id).json()["cached_from"] == second.id
    _, keys = services.jobs.with_files(second.id)
    with services.database.write() as session:
        note_damaged(session, NamedObject("result", keys["repaired.ply"], "0" * 64), utc_now())
    assert start(client, mesh_id).headers["Cache-Status"] == "quadpatch; fwd=miss"


def test_a_job_whose_files_a_sweep_misses_is_no_source(services: Services, client: TestClient, first: Job) -> None:
    _, keys = services.jobs.with_files(first.id)
    services.store.delete(keys["repaired.ply"])
    assert MissingObjects(services.database, services.store).look().results == 1
    with services.database.read() as session:
        assert reuse.source_of(session, session.get_one(JobRow, first.id), utc_now()) is None


def test_a_result_without_the_picture_that_was_asked_for_is_no_source(
    client: TestClient, services: Services, mesh_id: str, tmp_path: Path
) -> None:
    job_id = start(client, mesh_id).json()["id"]
    attempt = services.attempts.start(job_id, "test", 30).attempt
    (tmp_path / "r.ply").write_bytes(b"ply")
    stored = services.store.put_file(f"results/{job_id}/1/r.ply", tmp_path / "r.ply")
    file = ResultFile(role="result", name="r.ply", media_type="model/ply", size_bytes=3, sha256=stored.sha256)
    services.attempts.publish(attempt, JobResult(format="ply", files=[file]))
    assert start(client, mesh_id).headers["Cache-Status"] == "quadpatch; fwd=miss"


def test_a_repair_in_one_request_has_a_known_result_at_once(client: TestClient, mesh_id: str, first: Job) -> None:
    content = client.get(f"/v1/meshes/{mesh_id}/content").content
    answer = client.post(
        "/v1/repairs",
        files={"mesh": ("again.ply", content), "spec": (None, b'{"method":{"method":"smooth"}}', "application/json")},
    )
    assert (answer.status_code, answer.headers["Cache-Status"]) == (200, "quadpatch; hit")
    assert answer.json()["mesh_name"] == "again.ply"

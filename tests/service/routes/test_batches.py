"""Also tests `service/batches.py`, `jobkit/batches/meshes.py` and `quadpatch_client/schema/batches.py`."""

import json
from collections.abc import Callable
from typing import Any

import pytest
from sqlalchemy import func, select
from starlette.testclient import TestClient

from jobkit.batches.progress import note_progress
from jobkit.database.tables import DeliveryRow, JobRow
from jobkit.errors import StaleAttemptError
from jobkit.jobs.estimates import Estimates, QueueEstimate
from quadpatch_client.schema import MOST_JOBS, Job, JobError, MeshProblem, NewBatch
from service.services import Services

SMOOTH = {"method": {"method": "smooth"}}
HOOK = "https://93.184.216.34/hook"
Finish = Callable[[str], Job]


@pytest.fixture
def mesh_ids(client: TestClient) -> list[str]:
    answers = [
        client.post(f"/v1/meshes?filename=face{i}.ply", content=f"ply\nformat ascii 1.{i}\nend_header\n".encode())
        for i in range(3)
    ]
    return [answer.json()["id"] for answer in answers]


@pytest.fixture
def batch(client: TestClient, mesh_ids: list[str]) -> dict[str, Any]:
    answer = client.post("/v1/batches", json={"mesh_ids": mesh_ids, "spec": SMOOTH, "label": "night shift"})
    assert answer.status_code == 202, answer.text
    made: dict[str, Any] = answer.json()
    return made


def jobs_of(client: TestClient, batch: dict[str, Any], **search: str) -> list[dict[str, Any]]:
    answer = client.get("/v1/jobs", params={"batch_id": batch["id"], "oldest_first": "true", **search})
    items: list[dict[str, Any]] = answer.raise_for_status().json()["items"]
    return items


def fail(services: Services, job_id: str) -> None:
    services.attempts.fail(services.attempts.start(job_id, "test", 30).attempt, JobError(code="no_quads", message="x"))


def test_every_mesh_gets_a_job_in_the_order_of_the_request(
    client: TestClient, batch: dict[str, Any], mesh_ids: list[str]
) -> None:
    assert (batch["state"], batch["n_jobs"], batch["counts"]) == ("running", 3, {"queued": 3})
    jobs = jobs_of(client, batch)
    assert [job["mesh_id"] for job in jobs] == mesh_ids
    assert {(job["batch_id"], job["spec"]["priority"], job["state"]) for job in jobs} == {
        (batch["id"], "bulk", "queued")
    }
    assert [job["mesh_name"] for job in jobs] == ["face0.ply", "face1.ply", "face2.ply"]
    events = client.get(f"/v1/jobs/{jobs[0]['id']}/events").json()["items"]
    assert [event["type"] for event in events] == ["queued"]
    assert client.get("/v1/batches").json()["items"][0]["id"] == batch["id"]


def test_its_jobs_lie_in_the_queue(services: Services, client: TestClient, batch: dict[str, Any]) -> None:
    assert {f"{job['id']}-1" for job in jobs_of(client, batch)} <= services.queue.entries()


def test_a_filter_takes_what_fits_and_was_not_rejected(
    client: TestClient, services: Services, mesh_ids: list[str]
) -> None:
    analysis = services.meshes.start_analysis(mesh_ids[1], "test", 30)
    services.meshes.reject(analysis, MeshProblem(code="not_finite", message="x"))
    answer = client.post("/v1/batches", json={"filter": {"filename": "FACE*"}, "spec": SMOOTH})
    assert [job["mesh_id"] for job in jobs_of(client, answer.json())] == [mesh_ids[2], mesh_ids[0]]
    of_state = client.post("/v1/batches", json={"filter": {"state": ["analysing"]}, "spec": SMOOTH})
    assert [job["mesh_id"] for job in jobs_of(client, of_state.json())] == [mesh_ids[2], mesh_ids[0]]
    empty = client.post("/v1/batches", json={"filter": {"filename": "other*"}})
    assert (empty.status_code, empty.json()["code"]) == (409, "batch_size")


def test_jobs_may_have_a_spec_each(client: TestClient, mesh_ids: list[str]) -> None:
    jobs = [
        {"mesh_id": mesh_ids[0], **SMOOTH, "label": "a"},
        {"mesh_id": mesh_ids[0], **SMOOTH, "seed": 2, "priority": "interactive", "mesh_name": "named.ply"},
    ]
    made = client.post("/v1/batches", json={"jobs": jobs}).json()
    found = jobs_of(client, made)
    assert [(job["spec"]["label"], job["spec"]["seed"], job["spec"]["priority"]) for job in found] == [
        ("a", 0, "bulk"),
        (None, 2, "interactive"),
    ]
    assert found[1]["mesh_name"] == "named.ply"


@pytest.mark.parametrize(
    ("change", "status", "code"),
    [
        ({"mesh_ids": ["0" * 64]}, 404, "mesh_not_found"),
        ({"spec": {"method": {"method": "dictionary", "model": "unknown"}}}, 404, "model_not_found"),
        ({"spec": {"task": "encode"}}, 422, "options_conflict"),
        ({"spec": {"limits": {"time_s": 80_000}}}, 403, "over_service_limit"),
        ({"filter": {}}, 422, "invalid_request"),
        ({"mesh_ids": None}, 422, "invalid_request"),
        ({"callback_url": HOOK}, 409, "callback_secret_missing"),
    ],
)
def test_one_job_that_can_not_be_started_refuses_all_of_them(
    client: TestClient, services: Services, mesh_ids: list[str], change: dict[str, Any], status: int, code: str
) -> None:
    body = {"mesh_ids": mesh_ids, **change}
    if change.get("mesh_ids"):
        body["mesh_ids"] = [*mesh_ids, *change["mesh_ids"]]
    answer = client.post("/v1/batches", json={name: value for name, value in body.items() if value is not None})
    assert (answer.status_code, answer.json()["code"]) == (status, code)
    with services.database.read() as session:
        assert session.scalar(select(func.count()).select_from(JobRow)) == 0
    assert client.get("/v1/batches").json()["items"] == []


def test_a_rejected_mesh_that_is_named_refuses_the_batch(
    client: TestClient, services: Services, mesh_ids: list[str]
) -> None:
    analysis = services.meshes.start_analysis(mesh_ids[2], "test", 30)
    services.meshes.reject(analysis, MeshProblem(code="empty_mesh", message="x"))
    answer = client.post("/v1/batches", json={"mesh_ids": mesh_ids, "spec": SMOOTH})
    assert (answer.status_code, answer.json()["code"]) == (409, "mesh_rejected")
    assert mesh_ids[2] in answer.json()["detail"]


def test_holes_that_are_named_are_looked_up(
    client: TestClient, mesh_ids: list[str], analyse: Callable[[str], None]
) -> None:
    analyse(mesh_ids[0])
    jobs = [{"mesh_id": mesh_ids[0], **SMOOTH, "holes": {"ids": [17]}}]
    answer = client.post("/v1/batches", json={"jobs": jobs})
    assert (answer.status_code, answer.json()["code"]) == (409, "unknown_hole")


def test_no_batch_is_larger_than_ten_thousand_jobs() -> None:
    with pytest.raises(ValueError, match="at most 10000"):
        NewBatch.model_validate({"mesh_ids": [f"{i:064x}" for i in range(MOST_JOBS + 1)]})


def test_a_mesh_that_comes_twice_is_a_mistake(client: TestClient, mesh_ids: list[str]) -> None:
    answer = client.post("/v1/batches", json={"mesh_ids": [mesh_ids[0], mesh_ids[0]]})
    assert answer.status_code == 422


def test_a_repeated_key_makes_one_batch(client: TestClient, mesh_ids: list[str]) -> None:
    body = {"mesh_ids": mesh_ids, "spec": SMOOTH}
    made, repeated = (client.post("/v1/batches", json=body, headers={"Idempotency-Key": "night"}) for _ in range(2))
    assert made.json()["id"] == repeated.json()["id"]
    assert repeated.headers["Idempotent-Replayed"] == "true"
    assert len(client.get("/v1/jobs?limit=100").json()["items"]) == 3
    other = client.post("/v1/batches", json={**body, "label": "x"}, headers={"Idempotency-Key": "night"})
    assert other.json()["code"] == "idempotency_conflict"


def test_it_ends_with_its_last_job_and_tells_it_once(
    client: TestClient, services: Services, batch: dict[str, Any], finish: Finish
) -> None:
    client.post("/v1/webhooks", json={"url": HOOK, "events": ["batch.ended"]})
    jobs = jobs_of(client, batch)
    finish(jobs[0]["id"])
    note_progress(services.database)
    shown = client.get(f"/v1/batches/{batch['id']}").json()
    assert (shown["state"], shown["counts"]) == ("running", {"queued": 2, "succeeded": 1})
    finish(jobs[1]["id"])
    fail(services, jobs[2]["id"])
    for _ in range(3):
        note_progress(services.database)
    ended = client.get(f"/v1/batches/{batch['id']}").json()
    assert (ended["state"], ended["counts"]) == ("ended", {"failed": 1, "succeeded": 2})
    assert ended["expires_at"] is not None
    events = client.get(f"/v1/batches/{batch['id']}/events").json()["items"]
    assert [(event["sequence"], event["type"]) for event in events] == [(1, "started"), (2, "progress"), (3, "ended")]
    assert events[-1]["data"]["counts"] == ended["counts"]
    with services.database.read() as session:
        (delivery,) = session.scalars(select(DeliveryRow))
    assert (delivery.type, delivery.batch_id) == ("batch.ended", batch["id"])
    assert delivery.payload["data"]["batch"]["counts"] == ended["counts"]


def test_events_are_streamed_from_any_of_them_on(
    client: TestClient, services: Services, batch: dict[str, Any], finish: Finish
) -> None:
    for job in jobs_of(client, batch):
        finish(job["id"])
        note_progress(services.database)
    path, stream = f"/v1/batches/{batch['id']}/events", {"Accept": "text/event-stream"}
    for header, numbers in ((None, [1, 2, 3, 4]), ("2", [3, 4])):
        headers = stream if header is None else {**stream, "Last-Event-ID": header}
        lines = client.get(path, headers=headers).text.splitlines()
        data = [json.loads(line.removeprefix("data: ")) for line in lines if line.startswith("data: ")]
        assert [event["sequence"] for event in data] == numbers
    assert data[-1]["type"] == "ended"
    assert client.get(path, headers={**stream, "Last-Event-ID": "4"}).status_code == 204
    assert client.get(path, params={"after": 2, "limit": 1}).json()["next_after"] == 3


def test_a_cancel_reaches_all_that_has_not_ended(
    client: TestClient, services: Services, batch: dict[str, Any], finish: Finish
) -> None:
    done, running, _ = (job["id"] for job in jobs_of(client, batch))
    finish(done)
    attempt = services.attempts.start(running, "test", 30).attempt
    asked = [client.post(f"/v1/batches/{batch['id']}/cancel") for _ in range(2)]
    assert {(answer.status_code, answer.json()["state"]) for answer in asked} == {(202, "canceling")}
    note_progress(services.database)
    assert [job["state"] for job in jobs_of(client, batch)] == ["succeeded", "canceling", "canceled"]
    services.attempts.acknowledge_cancel(attempt)
    note_progress(services.database)
    ended = client.get(f"/v1/batches/{batch['id']}").json()
    assert (ended["state"], ended["counts"]) == ("ended", {"canceled": 2, "succeeded": 1})
    late = client.post(f"/v1/batches/{batch['id']}/cancel")
    assert (late.status_code, late.json()["code"]) == (409, "batch_finished")
    types = [event["type"] for event in client.get(f"/v1/batches/{batch['id']}/events").json()["items"]]
    assert types == ["started", "cancel_requested", "progress", "ended"]


def test_what_failed_is_run_again_once_for_each_key(
    client: TestClient, services: Services, batch: dict[str, Any], finish: Finish
) -> None:
    done, failed, canceled = (job["id"] for job in jobs_of(client, batch))
    nothing = client.post(f"/v1/batches/{batch['id']}/rerun")
    assert (nothing.status_code, nothing.json()["code"]) == (409, "batch_size")
    finish(done)
    fail(services, failed)
    client.post(f"/v1/jobs/{canceled}/cancel")
    path, key = f"/v1/batches/{batch['id']}/rerun", {"Idempotency-Key": "again"}
    made, repeated = (client.post(path, headers=key) for _ in range(2))
    assert (made.status_code, made.json()["rerun_of"], made.json()["label"]) == (202, batch["id"], "night shift")
    assert repeated.json()["id"] == made.json()["id"]
    (job,) = jobs_of(client, made.json())
    assert (job["rerun_of"], job["state"]) == (failed, "queued")
    both = client.post(f"{path}?canceled=true").json()
    assert [job["rerun_of"] for job in jobs_of(client, both)] == [failed, canceled]


def test_it_is_deleted_with_all_it_left(
    client: TestClient, services: Services, batch: dict[str, Any], finish: Finish
) -> None:
    path = f"/v1/batches/{batch['id']}"
    early = client.delete(path)
    assert (early.status_code, early.json()["code"]) == (409, "batch_not_finished")
    for job in jobs_of(client, batch):
        finish(job["id"])
    note_progress(services.database)
    assert client.delete(path).status_code == 204
    assert [client.get(path).status_code, client.delete(path).status_code] == [404, 404]
    assert client.get("/v1/jobs").json()["items"] == []
    assert list(services.store.keys("results")) == []


def test_its_end_is_that_of_its_last_job_where_all_of_them_are_known(
    client: TestClient, services: Services, batch: dict[str, Any]
) -> None:
    assert client.get(f"/v1/batches/{batch['id']}").json()["eta_s"] is None
    ids = [job["id"] for job in jobs_of(client, batch)]
    clock = Estimates(services.database, lambda: 100.0)
    clock._queue_estimate = QueueEstimate(90.0, {}, {ids[0]: 20.0, ids[1]: 50.0})
    assert clock.remaining_s(ids[:2]) == 40.0
    assert clock.remaining_s(ids) is None
    assert clock.remaining_s([]) is None


def test_its_jobs_take_over_results_when_their_turn_comes(
    client: TestClient, services: Services, mesh_ids: list[str], finish: Finish
) -> None:
    earlier = client.post("/v1/jobs", json={"mesh_id": mesh_ids[0], **SMOOTH}).json()["id"]
    finish(earlier)
    body = {"mesh_ids": mesh_ids, "spec": SMOOTH}
    for headers, state in (({}, "succeeded"), ({"Cache-Control": "no-cache"}, "running")):
        made = client.post("/v1/batches", json=body, headers=headers).json()
        job_id = jobs_of(client, made)[0]["id"]
        try:
            services.attempts.start(job_id, "test", 30)
        except StaleAttemptError:
            assert client.get(f"/v1/jobs/{job_id}").json()["cached_from"] == earlier
        assert client.get(f"/v1/jobs/{job_id}").json()["state"] == state

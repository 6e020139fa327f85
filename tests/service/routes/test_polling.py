"""Polls of a job: waiting for its end, entity tags, places in the queue."""

import threading
from collections.abc import Callable
from typing import Any

from starlette.testclient import TestClient

from quadpatch_client.schema import Job
from service.services import Services
from tests.waiting import wait_until

SMOOTH = {"method": "smooth"}


def test_a_client_that_prefers_to_wait_gets_the_end(
    client: TestClient, services: Services, mesh_id: str, finish: Callable[[str], Job]
) -> None:
    def work() -> None:
        finish(wait_until(lambda: services.jobs.page(1).items)[0].id)

    worker = threading.Thread(target=work)
    worker.start()
    spec = {"mesh_id": mesh_id, "method": SMOOTH}
    answer = client.post("/v1/jobs", json=spec, headers={"Prefer": "wait=30"})
    worker.join()
    assert answer.status_code == 200
    assert answer.json()["state"] == "succeeded"
    assert answer.headers["preference-applied"] == "wait=30"


def test_a_poller_is_told_when_nothing_has_changed(client: TestClient, services: Services, job_id: str) -> None:
    first = client.get(f"/v1/jobs/{job_id}")
    same = client.get(f"/v1/jobs/{job_id}", headers={"If-None-Match": first.headers["etag"]})
    assert (same.status_code, same.content) == (304, b"")
    attempt = services.attempts.start(job_id, "test", 30).attempt
    services.attempts.report_progress(attempt, "fill", 12.5)
    changed = client.get(f"/v1/jobs/{job_id}", headers={"If-None-Match": first.headers["etag"]})
    assert changed.status_code == 200
    assert (changed.json()["stage"], changed.json()["percent"]) == ("fill", 12.5)


def test_a_poller_that_waits_is_told_when_it_moves_up_in_the_queue(
    client: TestClient, services: Services, mesh_id: str
) -> None:
    spec = {"mesh_id": mesh_id, "method": SMOOTH}
    first, second = (client.post("/v1/jobs", json=spec).json()["id"] for _ in range(2))
    path = f"/v1/jobs/{second}"
    behind = poll_until(client, path, lambda job: job["queue_position"] == 2)
    assert client.get(path, headers={"If-None-Match": behind.headers["etag"]}).status_code == 304
    services.attempts.start(first, "test", 30)
    ahead = poll_until(client, path, lambda job: job["queue_position"] == 1)
    assert ahead.json()["revision"] == behind.json()["revision"]
    assert ahead.headers["etag"] != behind.headers["etag"]
    services.attempts.start(second, "test", 30)
    assert client.get(path).json()["queue_position"] is None


def test_the_short_way_to_an_unchanged_job_knows_the_tag_of_the_long_way(
    client: TestClient, services: Services, job_id: str, finish: Callable[[str], Job]
) -> None:
    path = f"/v1/jobs/{job_id}"
    for step in (lambda: None, lambda: finish(job_id)):
        step()
        tag = client.get(path).headers["etag"]
        short = client.get(path, headers={"If-None-Match": tag})
        long = client.get(path, headers={"If-None-Match": tag, "Prefer": "wait=1"})
        assert (short.status_code, short.headers["etag"]) == (304, tag)
        other = client.get(path, headers={"If-None-Match": 'W/"0"', "Prefer": "wait=0"})
        assert (long.status_code, other.status_code, other.headers["etag"]) == (304, 200, tag)
    missing = client.get("/v1/jobs/job_" + "0" * 26, headers={"If-None-Match": tag})
    assert (missing.status_code, missing.json()["code"]) == (404, "job_not_found")


def poll_until(client: TestClient, path: str, is_seen: Callable[[Any], bool]) -> Any:
    """Poll while the places in the queue are those of a moment ago."""

    def seen() -> Any:
        answer = client.get(path)
        return answer if is_seen(answer.json()) else None

    return wait_until(seen)

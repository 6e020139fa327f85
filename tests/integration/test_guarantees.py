"""What a 202 guarantees: the job outlives the process that answered, and the queue."""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from datetime import timedelta
from typing import Any

import httpx
import pytest
from rq import Queue
from rq.serializers import JSONSerializer
from sqlalchemy import update

from jobkit.database.clock import utc_now
from jobkit.database.session import Database
from jobkit.database.tables import JobRow
from jobkit.queue import TaskQueue, job_entry
from jobkit.requeue import GRACE_S
from jobkit.settings import Settings
from tests.dispatcher.process import dispatching
from tests.waiting import GUARD_S, wait_until

SMOOTH = {"method": "smooth"}


def post_job(url: str, **headers: str) -> httpx.Response:
    mesh = httpx.post(f"{url}/v1/meshes?filename=a.ply", content=b"ply", timeout=GUARD_S).raise_for_status().json()
    spec = {"mesh_id": mesh["id"], "method": SMOOTH}
    return httpx.post(f"{url}/v1/jobs", json=spec, headers=headers, timeout=GUARD_S)


def get(url: str, **headers: str) -> Any:
    return httpx.get(url, headers=headers, timeout=GUARD_S).json()


@pytest.mark.slow
def test_a_job_outlives_the_service_and_the_queue(
    serve: Callable[..., Any], settings: Settings, database: Database
) -> None:
    with serve() as service:
        job = post_job(service.url).raise_for_status().json()
        service.process.kill()
        service.process.wait()
    queue = TaskQueue(settings.redis_url.get_secret_value(), settings.queue_name, 60)
    Queue(settings.queue_name, connection=queue.connection, serializer=JSONSerializer).empty()
    with database.write() as session:
        session.execute(update(JobRow).values(enqueued_at=utc_now() - timedelta(seconds=GRACE_S + 1)))
    with serve() as service, dispatching(settings):
        again = get(f"{service.url}/v1/jobs/{job['id']}", Prefer="wait=1")
        assert again == job
        wait_until(lambda: job_entry(job["id"], 1) in queue.entries())
    queue.close()


@pytest.mark.slow
def test_services_that_start_at_once_share_one_database(
    serve: Callable[..., Any], settings: Settings, dictionary_bytes: Callable[[int], bytes]
) -> None:
    (settings.data_dir / "quadpatch.db").unlink()
    assert settings.models_dir is not None
    settings.models_dir.mkdir()
    (settings.models_dir / "general-dictionary@1.safetensors").write_bytes(dictionary_bytes(1))
    with ExitStack() as stack, ThreadPoolExecutor(2) as pool:
        first, second = pool.map(lambda _: stack.enter_context(serve()), range(2))
        job = post_job(first.url).raise_for_status().json()
        assert get(f"{second.url}/v1/jobs/{job['id']}") == job
        models = get(f"{second.url}/v1/models")
        assert [(model["name"], model["latest"]) for model in models["models"]] == [("general-dictionary", 1)]


@pytest.mark.slow
def test_a_station_that_repeats_itself_through_a_bad_line_gets_one_job(serve: Callable[..., Any]) -> None:
    with serve() as service, ThreadPoolExecutor(8) as pool:
        answers = list(pool.map(lambda _: post_job(service.url, **{"Idempotency-Key": "order-17"}), range(16)))
        jobs = get(f"{service.url}/v1/jobs")["items"]
    assert {answer.status_code for answer in answers} == {202}
    assert {answer.json()["id"] for answer in answers} == {jobs[0]["id"]}
    assert len(jobs) == 1

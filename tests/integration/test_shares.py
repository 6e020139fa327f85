"""Shares of tenants on real processes: quotas over two processes of the API, and a batch beside other tenants."""

import logging
import statistics
import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import AbstractContextManager, ExitStack
from dataclasses import dataclass
from typing import Any

import httpx
import pytest

from jobkit.settings import Settings
from quadpatch_client.schema import Job, JobSpec, JobState, SmoothMethod
from quadpatch_client.sdk import Client
from tests.conftest import RunningService
from tests.integration.conftest import RunningStack, punched_relief, stl_bytes
from tests.waiting import GUARD_S, wait_until

OPERATOR_KEY = "the-key-of-the-operator"
TENANT = "plant-north"
N_TENANTS, N_BATCH = 10, 1000
PLY = b"ply\nformat ascii 1.0\ncomment %d\nend_header\n"

_log = logging.getLogger(__name__)


@dataclass(frozen=True)
class Processes:
    """Processes of the API on one database, store and Valkey; requests take turns among them."""

    urls: list[str]
    http: httpx.Client

    def at_once(self, n: int, method: str, path: str, make: Callable[[int], dict[str, Any]]) -> list[httpx.Response]:
        """Send requests in the same moment, each to the next process."""
        barrier = threading.Barrier(n)

        def send(i: int) -> httpx.Response:
            rest = make(i)
            barrier.wait(GUARD_S)
            return self.http.request(method, self.urls[i % len(self.urls)] + path, **rest)

        with ThreadPoolExecutor(n) as pool:
            return list(pool.map(send, range(n)))

    def set(self, **quotas: int) -> None:
        path = f"{self.urls[0]}/v1/tenants/{TENANT}"
        self.http.patch(path, json=quotas, headers={"X-API-Key": OPERATOR_KEY}).raise_for_status()


@pytest.fixture
def processes(settings: Settings, run_service: Callable[..., AbstractContextManager[RunningService]]) -> Any:
    with ExitStack() as stack:
        urls = [stack.enter_context(run_service(settings, api_keys=OPERATOR_KEY)).url for _ in range(2)]
        new = {"name": "station", "tenant": TENANT}
        made = httpx.post(f"{urls[0]}/v1/keys", json=new, headers={"X-API-Key": OPERATOR_KEY}, timeout=GUARD_S)
        headers = {"X-API-Key": made.raise_for_status().json()["key"]}
        limits = httpx.Limits(max_connections=64)
        yield Processes(urls, stack.enter_context(httpx.Client(headers=headers, timeout=GUARD_S, limits=limits)))


def statuses(answers: list[httpx.Response]) -> dict[tuple[int, str], int]:
    found: dict[tuple[int, str], int] = {}
    for answer in answers:
        key = answer.status_code, answer.json().get("code", "")
        found[key] = found.get(key, 0) + 1
    return found


def test_quotas_hold_over_two_processes_whatever_comes_at_once(processes: Processes) -> None:
    mesh = processes.http.post(f"{processes.urls[0]}/v1/meshes", content=PLY % 0).json()
    processes.set(jobs_waiting=7)
    jobs = processes.at_once(24, "POST", "/v1/jobs", lambda _: {"json": {"mesh_id": mesh["id"]}})
    assert statuses(jobs) == {(202, ""): 7, (429, "quota_jobs"): 17}
    assert all(job.headers["retry-after"] for job in jobs if job.status_code == 429)
    size = mesh["size_bytes"]
    processes.set(stored_bytes=6 * size, jobs_waiting=0)
    # One is there already; each has as many bytes.
    meshes = processes.at_once(16, "POST", "/v1/meshes", lambda i: {"content": PLY % (i % 10) + b"%d" % (i // 10)})
    found = statuses(meshes)
    assert set(found) == {(201, ""), (507, "quota_bytes")}
    used = processes.http.get(f"{processes.urls[1]}/v1/limits").json()["use"]["stored_bytes"]
    assert used == size + found[(201, "")] * (size + 1) <= 6 * size < used + size + 1


def test_streams_are_counted_over_two_processes(processes: Processes) -> None:
    mesh = processes.http.post(f"{processes.urls[0]}/v1/meshes", content=PLY % 0).json()
    job = processes.http.post(f"{processes.urls[0]}/v1/jobs", json={"mesh_id": mesh["id"]}).json()
    processes.set(streams=3)
    headers = {"Accept": "text/event-stream"}
    with ExitStack() as opened:
        answers = []
        for i in range(5):
            stream = processes.http.stream("GET", processes.urls[i % 2] + job["links"]["events"], headers=headers)
            answers.append(opened.enter_context(stream))
        assert [answer.status_code for answer in answers] == [200, 200, 200, 429, 429]
        assert all(answer.headers["retry-after"] for answer in answers[3:])

    def has_room() -> bool:
        with processes.http.stream("GET", processes.urls[0] + job["links"]["events"], headers=headers) as answer:
            return answer.status_code == 200

    # Their clients are gone, so their places are free.
    wait_until(has_room)


@pytest.mark.slow
def test_a_batch_of_a_thousand_jobs_delays_no_other_tenant_by_more_than_the_jobs_at_work(
    run_stack: Callable[..., AbstractContextManager[RunningStack]], tmp_path: Any
) -> None:
    source = tmp_path / "scan.stl"
    source.write_bytes(stl_bytes(*punched_relief(40)))
    with run_stack(QUADPATCH_API_KEYS=OPERATOR_KEY) as stack, ExitStack() as opened:
        clients = []
        for i in range(N_TENANTS):
            new = {"name": "station", "tenant": f"plant-{i}"}
            made = httpx.post(f"{stack.url}/v1/keys", json=new, headers={"X-API-Key": OPERATOR_KEY}, timeout=GUARD_S)
            clients.append(opened.enter_context(Client(stack.url, made.raise_for_status().json()["key"], GUARD_S)))
        batch, *others = clients
        spec = JobSpec(mesh_id=batch.upload(source).id, method=SmoothMethod(method="smooth"))
        for _ in range(N_BATCH):
            # Equal jobs would take the result of the first.
            batch.create_job(spec, runs_anew=True)
        waits = [_urgent_job(other, source) for other in others]
        ran = [job for job in batch.jobs() if job.started_at is not None]
        n_workers = len(stack.workers())
        ended = [_seconds(job) for job in ran if job.finished_at is not None]
        assert any(job.state is JobState.QUEUED for job in batch.jobs(limit=1)), "the batch was over too soon"
    _log.warning(
        "batch of %d jobs, %d of them ended, %d workers: a job takes %.2f s (median, %.2f s at most); "
        "urgent jobs of %d other tenants started after %s s",
        *(N_BATCH, len(ended), n_workers, statistics.median(ended), max(ended), len(others)),
        ", ".join(f"{(job.started_at - job.created_at).total_seconds():.2f}" for job in waits if job.started_at),
    )
    for job in waits:
        assert job.started_at is not None
        # A worker that was choosing at that moment may still have taken one; none of them took two.
        between = [other for other in ran if other.started_at and job.created_at < other.started_at < job.started_at]
        assert len(between) <= n_workers


def _urgent_job(client: Client, source: Any) -> Job:
    spec = JobSpec(mesh_id=client.upload(source).id, method=SmoothMethod(method="smooth"), priority="interactive")
    return client.wait(client.create_job(spec, runs_anew=True).id, timeout_s=GUARD_S)


def _seconds(job: Job) -> float:
    assert job.started_at is not None
    assert job.finished_at is not None
    return (job.finished_at - job.started_at).total_seconds()

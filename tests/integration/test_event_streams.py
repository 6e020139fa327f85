"""Event streams over HTTP, of a service that is killed, stopped and crowded."""

import json
import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import httpx
import pytest

from jobkit.database.session import Database
from jobkit.jobs.attempts import Attempts
from jobkit.jobs.jobs import Jobs
from quadpatch_client.schema import JobResult
from tests.service.sse import SentEvent, sent_events
from tests.waiting import GUARD_S, wait_until

STREAM = {"Accept": "text/event-stream"}
# The second falls on a stream that was itself taken up after a kill.
N_KILLS = 2


@contextmanager
def stream(url: str, job_id: str, after: int) -> Iterator[Iterator[SentEvent]]:
    headers = STREAM | {"Last-Event-ID": str(after)}
    with httpx.stream("GET", f"{url}/v1/jobs/{job_id}/events", headers=headers, timeout=GUARD_S) as answer:
        answer.raise_for_status()
        yield sent_events(answer.iter_lines())


def start_job(url: str) -> str:
    mesh = httpx.post(f"{url}/v1/meshes?filename=scan.ply", content=b"ply\n", timeout=GUARD_S).raise_for_status().json()
    spec = {"mesh_id": mesh["id"], "method": {"method": "smooth"}}
    return str(httpx.post(f"{url}/v1/jobs", json=spec, timeout=GUARD_S).raise_for_status().json()["id"])


class Work:
    """What a worker does: report progress many times a second, then publish."""

    def __init__(self, database: Database, job_id: str) -> None:
        self._attempts = Attempts(database)
        self._attempt = self._attempts.start(job_id, "test", 600).attempt
        self._may_end = threading.Event()
        self._thread = threading.Thread(target=self._work)

    def __enter__(self) -> "Work":
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.end()
        self._thread.join()

    def end(self) -> None:
        self._may_end.set()

    def _work(self) -> None:
        step = 0
        while not self._may_end.wait(0.02):
            step += 1
            self._attempts.report_progress(self._attempt, "fill", step % 1000 / 10)
        self._attempts.publish(self._attempt, JobResult(format="ply"))


def read_and_kill(service: Any, job_id: str, got: list[SentEvent], n_then: int) -> None:
    """Go on after what is there, and kill the service in the middle."""
    with stream(service.url, job_id, len(got)) as events:
        for event in events:
            got.append(event)
            if len(got) == n_then:
                service.process.send_signal(signal.SIGKILL)


@pytest.mark.slow
def test_a_service_killed_in_the_middle_of_a_stream_costs_no_event_and_repeats_none(
    serve: Callable[..., Any], database: Database
) -> None:
    got: list[SentEvent] = []
    with serve() as service:
        job_id = start_job(service.url)
    with Work(database, job_id) as work:
        for _ in range(N_KILLS):
            with serve() as service:
                fifty_more = len(got) + 50
                with pytest.raises(httpx.TransportError):
                    read_and_kill(service, job_id, got, fifty_more)
                assert len(got) >= fifty_more
        with serve() as service, stream(service.url, job_id, len(got)) as events:
            for event in events:
                got.append(event)
                work.end()
    log = Jobs(database).events(job_id, 0, 100_000).items
    assert [event.id for event in got] == list(range(1, len(log) + 1))
    assert [json.loads(event.data) for event in got] == [json.loads(event.model_dump_json()) for event in log]
    assert got[-1].type == "succeeded"


@pytest.mark.slow
def test_a_service_that_stops_ends_its_streams_in_order(serve: Callable[..., Any], database: Database) -> None:
    with serve() as service:
        job_id = start_job(service.url)
        Attempts(database).start(job_id, "test", 600)
        with stream(service.url, job_id, 0) as events:
            got = [next(events).id, next(events).id]
            service.process.send_signal(signal.SIGTERM)
            # A stream that is cut off in the middle would raise here.
            assert list(events) == []
        assert service.process.wait(GUARD_S) in (0, -signal.SIGTERM)
    assert got == [1, 2]


def test_a_client_that_hangs_up_leaves_its_place_to_the_next(serve: Callable[..., Any], database: Database) -> None:
    with serve(max_streams=1) as service:
        job_id = start_job(service.url)
        with stream(service.url, job_id, 0) as events:
            assert next(events).id == 1
            with pytest.raises(httpx.HTTPStatusError, match="503"), stream(service.url, job_id, 0):
                pass

        def is_let_in() -> bool:
            try:
                with stream(service.url, job_id, 0) as events:
                    return next(events).id == 1
            except httpx.HTTPStatusError:
                return False

        wait_until(is_let_in)

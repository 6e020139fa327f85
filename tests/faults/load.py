"""Stations at work: they upload meshes, ask for repairs, cancel some, and repeat what was not answered."""

import itertools
import random
import threading
import time
from collections import Counter
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from datetime import datetime
from typing import Any, Literal

import httpx
import numpy as np

from jobkit.database.clock import utc_now
from quadpatch_client.schema import JobState
from tests.faults.cluster import API_KEY
from tests.integration.conftest import ply_bytes
from tests.quadpatch.shapes import punched, relief, sphere
from tests.waiting import GUARD_S

CancelKind = Literal["queued", "running", "killed worker"]
SMOOTH: dict[str, Any] = {"method": "smooth"}
# Learns from the mesh itself: seconds in native code, long enough to be killed in.
LEARN: dict[str, Any] = {"method": "dictionary", "model": "self"}
_ANSWER_TIMEOUT_S = 2 * GUARD_S
_TRY_AGAIN = frozenset({429, 502, 503, 504, 507})


class NoAnswerError(AssertionError):
    """A request was not answered although it was repeated for minutes."""


@dataclass(frozen=True)
class Cancel:
    """A request to cancel that was accepted, when it was sent, and where the job stood then."""

    job_id: str
    at: datetime
    kind: CancelKind
    stage: str | None


@dataclass
class ExpectedState:
    """What clients were answered, and so what must be true at the end; written by many threads."""

    accepted: dict[str, str] = field(default_factory=dict)
    cancels: list[Cancel] = field(default_factory=list)
    answers: Counter[str] = field(default_factory=Counter)
    ended: Counter[str] = field(default_factory=Counter)
    lock: threading.Lock = field(default_factory=threading.Lock)

    def note(self, answer: str) -> None:
        """Count an answer."""
        with self.lock:
            self.answers[answer] += 1


class Station:
    """A client that sends each request to one of several addresses, the next one after a failure.

    Parameters
    ----------
    urls : sequence of str
    expected : ExpectedState
    number : int
        Index of the address that it begins with.
    """

    def __init__(self, urls: Sequence[str], expected: ExpectedState, number: int = 0) -> None:
        self._urls = itertools.cycle([*urls[number % len(urls) :], *urls[: number % len(urls)]])
        self._expected = expected
        self._url = next(self._urls)
        self._client = httpx.Client(
            headers={"Authorization": f"Bearer {API_KEY}"}, timeout=httpx.Timeout(60, connect=3), trust_env=False
        )

    def close(self) -> None:
        """Close all connections."""
        self._client.close()

    def request(self, method: str, path: str, **options: Any) -> tuple[httpx.Response, datetime]:
        """Repeat a request until it is answered; return the answer, and when the request that brought it was sent."""
        deadline, pause_s = time.monotonic() + _ANSWER_TIMEOUT_S, 0.2
        while True:
            at = utc_now()
            try:
                answer = self._client.request(method, self._url + path, **options)
            except httpx.TransportError as error:
                self._expected.note(f"no answer ({type(error).__name__})")
            else:
                self._expected.note(f"{answer.status_code} {_code(answer)}".strip())
                if answer.status_code not in _TRY_AGAIN:
                    return answer, at
            if time.monotonic() > deadline:
                raise NoAnswerError(f"{method} {path} was not answered for {_ANSWER_TIMEOUT_S:.0f} s")
            self._url = next(self._urls)
            time.sleep(pause_s)
            pause_s = min(2 * pause_s, 2.0)

    def upload(self, mesh: bytes) -> str:
        """Upload a mesh and return its id."""
        answer, _ = self.request("POST", "/v1/meshes?filename=scan.ply", content=mesh)
        return str(answer.raise_for_status().json()["id"])

    def submit(self, mesh_id: str, method: dict[str, Any], key: str) -> str:
        """Ask for a repair and return the job's id."""
        spec = {"mesh_id": mesh_id, "method": method, "output": {"preview": False}}
        answer, _ = self.request(
            "POST", "/v1/jobs", json=spec, headers={"Idempotency-Key": key, "Cache-Control": "no-cache"}
        )
        # 200: an earlier try had arrived without an answer, and the job has ended since.
        assert answer.status_code in (httpx.codes.ACCEPTED, httpx.codes.OK), answer.text
        job_id = str(answer.json()["id"])
        with self._expected.lock:
            self._expected.accepted[key] = job_id
        return job_id

    def cancel(self, job_id: str, kind: CancelKind, stage: str | None) -> None:
        """Cancel a job, which may have ended by now."""
        answer, at = self.request("POST", f"/v1/jobs/{job_id}/cancel")
        if answer.is_success:
            with self._expected.lock:
                self._expected.cancels.append(Cancel(job_id, at, kind, stage))

    def job(self, job_id: str) -> dict[str, Any]:
        """Look at a job."""
        answer, _ = self.request("GET", f"/v1/jobs/{job_id}")
        job: dict[str, Any] = answer.raise_for_status().json()
        return job


@dataclass(frozen=True)
class Workload:
    """What the stations do.

    Attributes
    ----------
    seed : int
    n_jobs : int
        Lower bound: stations go on until all faults are injected.
    n_stations : int
        Each has one job at a time.
    long_share : float
        Share of jobs that learn.
    cancel_share : float
        Share of jobs that are cancelled.
    long_width : int
        Vertices along a side of the mesh of a long job.
    job_timeout_s : float
        How long a station waits for the end of its job; then the job counts as stuck.
    """

    seed: int
    n_jobs: int
    n_stations: int = 7
    long_share: float = 0.3
    cancel_share: float = 0.2
    long_width: int = 80
    job_timeout_s: float = 2 * GUARD_S


class Load:
    """All stations, at work until there were enough jobs and `wants_more` is false."""

    def __init__(
        self, workload: Workload, urls: Sequence[str], expected: ExpectedState, wants_more: Callable[[], bool]
    ) -> None:
        self._workload = workload
        self._urls = urls
        self._expected = expected
        self._wants_more = wants_more
        self._numbers = itertools.count()
        self._pool = ThreadPoolExecutor(workload.n_stations, thread_name_prefix="station")
        self._futures = [self._pool.submit(self._work, number) for number in range(workload.n_stations)]

    def finish(self) -> None:
        """Wait for all stations; raise what one of them raised."""
        for future in self._futures:
            future.result()
        self._pool.shutdown()

    def _work(self, number: int) -> None:
        rng = random.Random(f"{self._workload.seed}-{number}")
        station = Station(self._urls, self._expected, number)
        try:
            while (job := next(self._numbers)) < self._workload.n_jobs or self._wants_more():
                self._do_job(station, rng, f"{self._workload.seed}-{job}")
        finally:
            station.close()

    def _do_job(self, station: Station, rng: random.Random, key: str) -> None:
        is_long = rng.random() < self._workload.long_share
        mesh_id = station.upload(make_mesh(rng.randrange(2**32), self._workload.long_width if is_long else 0))
        job_id = station.submit(mesh_id, LEARN if is_long else SMOOTH, key)
        if rng.random() < self._workload.cancel_share:
            self._cancel_later(station, job_id, rng)
        job = self._wait(station, job_id, lambda job: JobState(job["state"]).is_terminal)
        with self._expected.lock:
            self._expected.ended[str(job["state"])] += 1

    def _cancel_later(self, station: Station, job_id: str, rng: random.Random) -> None:
        if rng.random() < 0.3:
            station.cancel(job_id, "queued", None)
            return
        self._wait(station, job_id, lambda job: job["state"] != JobState.QUEUED)
        time.sleep(rng.uniform(0.0, 2.0))
        station.cancel(job_id, "running", station.job(job_id)["stage"])

    def _wait(self, station: Station, job_id: str, is_done: Callable[[dict[str, Any]], bool]) -> dict[str, Any]:
        deadline = time.monotonic() + self._workload.job_timeout_s
        while not is_done(job := station.job(job_id)):
            if time.monotonic() > deadline:
                break
            time.sleep(0.4)
        return job


def make_mesh(seed: int, width: int) -> bytes:
    """Write a mesh with a hole, another one for each seed: a sphere, or a relief of `width` squared vertices."""
    if width:
        mesh = punched(relief(width), (0.3, 0.2, 0.0), radius=0.25)
    else:
        mesh = punched(sphere(3), (0.0, 0.0, 1.0), radius=0.3)
    noise = np.random.default_rng(seed).normal(scale=1e-4, size=mesh.vertices.shape)
    return ply_bytes(mesh.vertices + noise, mesh.triangles)


def _code(answer: httpx.Response) -> str:
    if answer.is_success:
        return ""
    try:
        return str(answer.json()["code"])
    except (ValueError, KeyError):
        return ""

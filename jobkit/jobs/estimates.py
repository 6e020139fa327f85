"""Estimates of how long jobs still take, from past jobs of their size, and their positions in the queue.

A past job is similar if its task is the same, its model of the same kind and its mesh of about the same size: the
median of their seconds for each byte, times the bytes, is the estimate. A kind or size with too few past jobs has no
estimate. A job without one counts as if it never freed its worker, so that estimates of the jobs behind it are rather
too long.
"""

import heapq
import math
import statistics
import threading
import time
from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from sqlalchemy import Row, Select, select
from sqlalchemy.orm import Session

from jobkit.database.clock import shared_now
from jobkit.database.session import Database
from jobkit.database.tables import JobRow, MeshRow
from jobkit.schema import Job, JobState

_SUCCEEDED = [state.value for state in JobState if state.has_result]
_AT_WORK = (JobState.RUNNING.value, JobState.CANCELING.value)
# Fewer past jobs are no basis; older ones may have run on another machine or version.
MIN_PAST = 3
_MAX_PAST = 500
# A long queue takes long to read: refreshes take a fiftieth of the time at most.
_REFRESH_S, _RATES_REFRESH_S, _PAUSE_PER_REFRESH = 1.0, 30.0, 50
_STALE_S = 2.0
_NEVER = math.inf


@dataclass(frozen=True)
class PastJob:
    """How long a job took that succeeded; `kind` is its task with the kind of its model."""

    kind: str
    size_bytes: int
    seconds: float


@dataclass(frozen=True)
class QueueEstimate:
    """Positions and remaining seconds of all jobs that have not ended, as they were read.

    Attributes
    ----------
    read_at : float
        When, by the clock of `Estimates`.
    positions : mapping
        Place of each job that waits, from 1.
    remaining_s : mapping
        Seconds that each job still takes, waiting included, where that is known.
    """

    read_at: float
    positions: Mapping[str, int]
    remaining_s: Mapping[str, float]


class Rates:
    """Seconds for each byte of past jobs, by kind and size class."""

    def __init__(self, past: Iterable[PastJob]) -> None:
        self._by_class: dict[tuple[str, int], list[float]] = defaultdict(list)
        for job in past:
            if job.size_bytes:
                self._by_class[job.kind, job.size_bytes.bit_length()].append(job.seconds / job.size_bytes)
        self._rates: dict[tuple[str, int], float | None] = {}

    def seconds(self, kind: str, size_bytes: int) -> float | None:
        """Return the expected seconds of a job from start to end; None where too few are similar."""
        size_class = size_bytes.bit_length()
        if (kind, size_class) not in self._rates:
            # Sizes of a class differ by two at most, with its neighbours by four.
            similar_rates = [
                r for c in (size_class - 1, size_class, size_class + 1) for r in self._by_class.get((kind, c), ())
            ]
            self._rates[kind, size_class] = statistics.median(similar_rates) if len(similar_rates) >= MIN_PAST else None
        rate = self._rates[kind, size_class]
        return None if rate is None else rate * size_bytes


def remaining_running_s(
    total_s: float | None, done_share: float, running_s: float, since_update_s: float
) -> float | None:
    """Estimate the seconds left of a job at work.

    Parameters
    ----------
    total_s : float or None
        Its expected seconds, from past jobs.
    done_share : float
        Share that was done at its last update, 0 to 1.
    running_s, since_update_s : float
        Since its start, and since its last update.

    Returns
    -------
    float or None
        The weight of past jobs falls as the job progresses: (1 - done_share) of their time is left. Once that time is
        over, only the pace of the job itself counts.
    """
    if total_s is None:
        return None
    remaining_s = (1.0 - done_share) * total_s - since_update_s
    if remaining_s > 0.0:
        return remaining_s
    return running_s * (1.0 - done_share) / done_share if done_share > 0.0 else None


def remaining_queued_s(
    worker_free_s: list[float], queued_jobs: Iterable[tuple[float | None, float]]
) -> list[float | None]:
    """Estimate when each waiting job ends: the first one goes to the worker that is free first, and so on.

    Parameters
    ----------
    worker_free_s : list of float
        Seconds until each worker is free; infinite where unknown.
    queued_jobs : iterable of (float or None, float)
        For each job, first to last: its expected seconds, and the seconds before which it will not start.

    Returns
    -------
    list of float or None
        Seconds until the end of each.
    """
    workers = list(worker_free_s)
    heapq.heapify(workers)
    ends: list[float | None] = []
    for total_s, delay_s in queued_jobs:
        if not workers:
            ends.append(None)
            continue
        end_s = max(heapq.heappop(workers), delay_s) + (_NEVER if total_s is None else total_s)
        heapq.heappush(workers, end_s)
        ends.append(None if math.isinf(end_s) else end_s)
    return ends


class Estimates:
    """Estimates for all jobs of a database, read again every second or so and shared by all threads.

    Parameters
    ----------
    database : Database
    clock : callable
        Seconds that never go back.
    """

    def __init__(self, database: Database, clock: Callable[[], float] = time.monotonic) -> None:
        self._database = database
        self._clock = clock
        self._lock = threading.Lock()
        self._queue_estimate = QueueEstimate(-_NEVER, {}, {})
        self._refresh_at = self._rates_refresh_at = -_NEVER
        self._rates_of_past_jobs = Rates(())

    @property
    def is_due(self) -> bool:
        """Whether `refresh` would read the database."""
        return self._clock() >= self._refresh_at

    @property
    def is_old(self) -> bool:
        """Whether the last estimates are too old to be shown, or there are none."""
        return self._clock() > self._refresh_at + _STALE_S

    def refresh(self) -> None:
        """Read the database if the last estimates are over a second old."""
        # A caller that comes during a refresh takes the estimates before, unless they are too old.
        if not self.is_due or not self._lock.acquire(blocking=self.is_old):
            return
        try:
            started = self._clock()
            if started >= self._refresh_at:
                self._queue_estimate = self._read_queue(started)
                self._refresh_at = started + max(_REFRESH_S, _PAUSE_PER_REFRESH * (self._clock() - started))
        finally:
            self._lock.release()

    def complete(self, job: Job) -> Job:
        """Return the job with its place in the queue and the seconds that it still takes, as of the last refresh."""
        if job.state.is_terminal:
            return job
        estimate = self._queue_estimate
        remaining_s = estimate.remaining_s.get(job.id) if job.state != JobState.CANCELING else None
        if remaining_s is not None:
            remaining_s = round(max(remaining_s - (self._clock() - estimate.read_at), 0.0), 1)
        return job.model_copy(update={"queue_position": self.position(job.id, job.state), "eta_s": remaining_s})

    def position(self, job_id: str, state: JobState) -> int | None:
        """Return a waiting job's place in the queue; one that came after the last refresh is at the end."""
        if state != JobState.QUEUED:
            return None
        positions = self._queue_estimate.positions
        return positions.get(job_id, len(positions) + 1)

    def _read_queue(self, started: float) -> QueueEstimate:
        with self._database.read() as session:
            if started >= self._rates_refresh_at:
                self._rates_of_past_jobs = Rates(read_past(session))
                self._rates_refresh_at = started + _RATES_REFRESH_S
            positions, remaining_s = read_queue_estimate(session, self._rates_of_past_jobs)
        return QueueEstimate(started, positions, remaining_s)


def read_past(session: Session) -> list[PastJob]:
    """Return the jobs that succeeded last."""
    rows = session.execute(
        _kinds_and_sizes(JobRow.started_at, JobRow.finished_at)
        .where(JobRow.state.in_(_SUCCEEDED), JobRow.finished_at.is_not(None), JobRow.started_at.is_not(None))
        .order_by(JobRow.finished_at.desc())
        .limit(_MAX_PAST)
    )
    return [PastJob(row.kind, row.size_bytes, (row.finished_at - row.started_at).total_seconds()) for row in rows]


def read_queue_estimate(session: Session, rates: Rates) -> tuple[dict[str, int], dict[str, float]]:
    """Read all jobs that have not ended; return places and seconds left, as `QueueEstimate` has them."""
    now = shared_now(session)
    at_work = session.execute(
        _kinds_and_sizes(JobRow.percent, JobRow.started_at, JobRow.updated_at, JobRow.worker, JobRow.lease_until).where(
            JobRow.state.in_(_AT_WORK)
        )
    ).all()
    remaining_s = {
        row.id: remaining_s for row in at_work if (remaining_s := _remaining_s_of(row, rates, now)) is not None
    }
    # The worker of a lease that ran out does not count.
    worker_free_s = [remaining_s.get(row.id, _NEVER) for row in at_work if row.lease_until and row.lease_until > now]
    queued_jobs = session.execute(
        _kinds_and_sizes(JobRow.not_before)
        .where(JobRow.state == JobState.QUEUED.value)
        .order_by(JobRow.queued_at, JobRow.id)
    ).all()
    ends = remaining_queued_s(
        worker_free_s,
        [(rates.seconds(row.kind, row.size_bytes), _seconds_until(row.not_before, now)) for row in queued_jobs],
    )
    remaining_s |= {row.id: end for row, end in zip(queued_jobs, ends, strict=True) if end is not None}
    return {row.id: place for place, row in enumerate(queued_jobs, 1)}, remaining_s


def _kinds_and_sizes(*columns: Any) -> Select[*tuple[Any, ...]]:
    kind = JobRow.task.concat(" ").concat(JobRow.model["kind"].as_string()).label("kind")
    return select(JobRow.id, kind, MeshRow.size_bytes, *columns).join(MeshRow, MeshRow.id == JobRow.mesh_id)


def _remaining_s_of(row: Row[*tuple[Any, ...]], rates: Rates, now: datetime) -> float | None:
    running_s = max((now - row.started_at).total_seconds(), 0.0)
    since_update_s = max((now - row.updated_at).total_seconds(), 0.0)
    return remaining_running_s(rates.seconds(row.kind, row.size_bytes), row.percent / 100.0, running_s, since_update_s)


def _seconds_until(moment: datetime | None, now: datetime) -> float:
    return 0.0 if moment is None else max((moment - now).total_seconds(), 0.0)

"""Estimates of how long jobs still take, from past jobs of their size, and their positions in the queue.

The median of the seconds for each byte that similar past jobs took (`jobkit.jobs.past_jobs`), times the bytes, is the
estimate. A job without one counts as if it never freed its worker, so that estimates of the jobs behind it are rather
too long.
"""

import heapq
import math
import threading
import time
from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from sqlalchemy import Row
from sqlalchemy.orm import Session

from jobkit.database.clock import shared_now
from jobkit.database.session import Database
from jobkit.database.tables import JobRow
from jobkit.jobs.past_jobs import Rates, kinds_and_sizes, read_past
from jobkit.jobs.turns import last_turns, order_of_turns
from quadpatch_client.schema import Job, JobState

_AT_WORK = (JobState.RUNNING.value, JobState.CANCELING.value)
# A long queue takes long to read: refreshes take a fiftieth of the time at most.
_REFRESH_S, _RATES_REFRESH_S, _PAUSE_PER_REFRESH = 1.0, 30.0, 50
_STALE_S = 2.0
_NEVER = math.inf


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

    def remaining_s(self, job_ids: Collection[str]) -> float | None:
        """Return the seconds until all of some jobs that have not ended will have; None where it is not known."""
        estimate = self._queue_estimate
        found = [estimate.remaining_s[job_id] for job_id in job_ids if job_id in estimate.remaining_s]
        if not found or len(found) < len(job_ids):
            return None
        return round(max(max(found) - (self._clock() - estimate.read_at), 0.0), 1)

    def position(self, job_id: str, state: JobState) -> int | None:
        """Return a waiting job's place in the queue; one that came after the last refresh is at the end."""
        if state != JobState.QUEUED:
            return None
        positions = self._queue_estimate.positions
        return positions.get(job_id, len(positions) + 1)

    def _read_queue(self, started: float) -> QueueEstimate:
        with self._database.read() as session:
            if started >= self._rates_refresh_at:
                self._rates_of_past_jobs = Rates(job.seconds_by_size for job in read_past(session))
                self._rates_refresh_at = started + _RATES_REFRESH_S
            positions, remaining_s = read_queue_estimate(session, self._rates_of_past_jobs)
        return QueueEstimate(started, positions, remaining_s)


def read_queue_estimate(session: Session, rates: Rates) -> tuple[dict[str, int], dict[str, float]]:
    """Read all jobs that have not ended; return places and seconds left, as `QueueEstimate` has them."""
    now = shared_now(session)
    at_work = session.execute(
        kinds_and_sizes(JobRow.percent, JobRow.started_at, JobRow.updated_at, JobRow.worker, JobRow.lease_until).where(
            JobRow.state.in_(_AT_WORK)
        )
    ).all()
    remaining_s = {
        row.id: remaining_s for row in at_work if (remaining_s := _remaining_s_of(row, rates, now)) is not None
    }
    # The worker of a lease that ran out does not count.
    worker_free_s = [remaining_s.get(row.id, _NEVER) for row in at_work if row.lease_until and row.lease_until > now]
    queued_jobs = session.execute(
        kinds_and_sizes(JobRow.not_before, JobRow.tenant, JobRow.priority)
        .where(JobRow.state == JobState.QUEUED.value)
        .order_by(JobRow.queued_at, JobRow.id)
    ).all()
    queued_jobs = order_of_turns(queued_jobs, last_turns(session))
    ends = remaining_queued_s(
        worker_free_s,
        [(rates.amount(row.kind, row.size_bytes), _seconds_until(row.not_before, now)) for row in queued_jobs],
    )
    remaining_s |= {row.id: end for row, end in zip(queued_jobs, ends, strict=True) if end is not None}
    return {row.id: place for place, row in enumerate(queued_jobs, 1)}, remaining_s


def _remaining_s_of(row: Row[*tuple[Any, ...]], rates: Rates, now: datetime) -> float | None:
    running_s = max((now - row.started_at).total_seconds(), 0.0)
    since_update_s = max((now - row.updated_at).total_seconds(), 0.0)
    return remaining_running_s(rates.amount(row.kind, row.size_bytes), row.percent / 100.0, running_s, since_update_s)


def _seconds_until(moment: datetime | None, now: datetime) -> float:
    return 0.0 if moment is None else max((moment - now).total_seconds(), 0.0)

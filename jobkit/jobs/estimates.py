"""How long jobs still take, learned from past jobs of their size, and where they stand in the queue.

A past job is like another one if its model is of the same kind and its mesh of about the same size: the middle one of
their seconds for each byte, times the bytes, is what a job should take. What can't be known stays unknown: of a kind
or size that was hardly seen there is no estimate, and a job without one is taken to hold its worker for ever, so that
estimates of those behind it err on the long side.
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
# Fewer past jobs say nothing; older ones ran on another machine or version.
MIN_PAST = 3
_MAX_PAST = 500
# A long queue takes long to look at: looks take a fiftieth of the time at most.
_LOOK_S, _PAST_S, _LOOK_SHARE = 1.0, 30.0, 50
_OLD_S = 2.0
_NEVER = math.inf


@dataclass(frozen=True)
class PastJob:
    """What a job took that succeeded; `kind` is that of its model."""

    kind: str
    size_bytes: int
    seconds: float


@dataclass(frozen=True)
class Outlook:
    """What was seen of all jobs that have not ended.

    Attributes
    ----------
    taken_at : float
        When, by the clock of `Estimates`.
    positions : mapping
        Place of each job that waits, from 1.
    left_s : mapping
        Seconds that each job still takes, waiting included, where that is known.
    """

    taken_at: float
    positions: Mapping[str, int]
    left_s: Mapping[str, float]


class Speeds:
    """What past jobs say of others."""

    def __init__(self, past: Iterable[PastJob]) -> None:
        self._by_class: dict[tuple[str, int], list[float]] = defaultdict(list)
        for job in past:
            if job.size_bytes:
                self._by_class[job.kind, job.size_bytes.bit_length()].append(job.seconds / job.size_bytes)
        self._rates: dict[tuple[str, int], float | None] = {}

    def seconds(self, kind: str, size_bytes: int) -> float | None:
        """Return what a job should take from start to end; None where too few were like it."""
        size_class = size_bytes.bit_length()
        if (kind, size_class) not in self._rates:
            # Sizes of a class differ by two at most, with its neighbours by four.
            near = [r for c in (size_class - 1, size_class, size_class + 1) for r in self._by_class.get((kind, c), ())]
            self._rates[kind, size_class] = statistics.median(near) if len(near) >= MIN_PAST else None
        rate = self._rates[kind, size_class]
        return None if rate is None else rate * size_bytes


def left_at_work(whole_s: float | None, done: float, worked_s: float, silent_s: float) -> float | None:
    """Estimate the seconds left of a job at work.

    Parameters
    ----------
    whole_s : float or None
        What past jobs say that it takes.
    done : float
        Share that it had done when it was heard of last, 0 to 1.
    worked_s, silent_s : float
        Since its start, and since it was heard of last.

    Returns
    -------
    float or None
        Past jobs have a say that fades as the job gets on: what it took itself weighs as much as it has done, which
        comes to (1 - done) of what past jobs took. Once that time is over, the job's own pace alone counts.
    """
    if whole_s is None:
        return None
    left_s = (1.0 - done) * whole_s - silent_s
    if left_s > 0.0:
        return left_s
    return worked_s * (1.0 - done) / done if done > 0.0 else None


def left_in_queue(free_in_s: list[float], waiting: Iterable[tuple[float | None, float]]) -> list[float | None]:
    """Estimate when each waiting job ends: the first one goes to the worker that is free first, and so on.

    Parameters
    ----------
    free_in_s : list of float
        Seconds until each worker is free; infinite where unknown.
    waiting : iterable of (float or None, float)
        For each job, first to last: what it takes, and before how many seconds it will not start.

    Returns
    -------
    list of float or None
        Seconds until the end of each.
    """
    workers = list(free_in_s)
    heapq.heapify(workers)
    ends: list[float | None] = []
    for whole_s, delay_s in waiting:
        if not workers:
            ends.append(None)
            continue
        end_s = max(heapq.heappop(workers), delay_s) + (_NEVER if whole_s is None else whole_s)
        heapq.heappush(workers, end_s)
        ends.append(None if math.isinf(end_s) else end_s)
    return ends


class Estimates:
    """Estimates for all jobs of a database, looked up anew every second or so and shared by all threads.

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
        self._outlook = Outlook(-_NEVER, {}, {})
        self._due_at = self._past_due_at = -_NEVER
        self._speeds = Speeds(())

    @property
    def is_due(self) -> bool:
        """Whether `refresh` would look."""
        return self._clock() >= self._due_at

    @property
    def is_old(self) -> bool:
        """Whether what was seen last should not be shown any more: looks are long overdue, or there was none."""
        return self._clock() > self._due_at + _OLD_S

    def refresh(self) -> None:
        """Look anew if the last look is over a second old."""
        # A caller that comes during a look takes what was seen before, unless that is too old.
        if not self.is_due or not self._lock.acquire(blocking=self.is_old):
            return
        try:
            started = self._clock()
            if started >= self._due_at:
                self._outlook = self._look(started)
                self._due_at = started + max(_LOOK_S, _LOOK_SHARE * (self._clock() - started))
        finally:
            self._lock.release()

    def complete(self, job: Job) -> Job:
        """Return the job with its place in the queue and the seconds that it still takes, as of the last look."""
        if job.state.is_terminal:
            return job
        outlook = self._outlook
        left_s = outlook.left_s.get(job.id) if job.state != JobState.CANCELING else None
        if left_s is not None:
            left_s = round(max(left_s - (self._clock() - outlook.taken_at), 0.0), 1)
        return job.model_copy(update={"queue_position": self.position(job.id, job.state), "eta_s": left_s})

    def position(self, job_id: str, state: JobState) -> int | None:
        """Return a waiting job's place in the queue; one that came after the last look stands at the end."""
        if state != JobState.QUEUED:
            return None
        positions = self._outlook.positions
        return positions.get(job_id, len(positions) + 1)

    def _look(self, started: float) -> Outlook:
        with self._database.read() as session:
            if started >= self._past_due_at:
                self._speeds = Speeds(read_past(session))
                self._past_due_at = started + _PAST_S
            positions, left_s = read_outlook(session, self._speeds)
        return Outlook(started, positions, left_s)


def read_past(session: Session) -> list[PastJob]:
    """Return the jobs that succeeded last."""
    rows = session.execute(
        _kinds_and_sizes(JobRow.started_at, JobRow.finished_at)
        .where(JobRow.state.in_(_SUCCEEDED), JobRow.finished_at.is_not(None), JobRow.started_at.is_not(None))
        .order_by(JobRow.finished_at.desc())
        .limit(_MAX_PAST)
    )
    return [PastJob(row.kind, row.size_bytes, (row.finished_at - row.started_at).total_seconds()) for row in rows]


def read_outlook(session: Session, speeds: Speeds) -> tuple[dict[str, int], dict[str, float]]:
    """Look at all jobs that have not ended; return places and seconds left, as `Outlook` has them."""
    now = shared_now(session)
    at_work = session.execute(
        _kinds_and_sizes(JobRow.percent, JobRow.started_at, JobRow.updated_at, JobRow.worker, JobRow.lease_until).where(
            JobRow.state.in_(_AT_WORK)
        )
    ).all()
    left_s = {row.id: left for row in at_work if (left := _left_of(row, speeds, now)) is not None}
    # A lease that ran out tells of a worker that is gone.
    free_in_s = [left_s.get(row.id, _NEVER) for row in at_work if row.lease_until and row.lease_until > now]
    waiting = session.execute(
        _kinds_and_sizes(JobRow.not_before)
        .where(JobRow.state == JobState.QUEUED.value)
        .order_by(JobRow.queued_at, JobRow.id)
    ).all()
    ends = left_in_queue(
        free_in_s,
        [(speeds.seconds(row.kind, row.size_bytes), _seconds_until(row.not_before, now)) for row in waiting],
    )
    left_s |= {row.id: end for row, end in zip(waiting, ends, strict=True) if end is not None}
    return {row.id: place for place, row in enumerate(waiting, 1)}, left_s


def _kinds_and_sizes(*columns: Any) -> Select[*tuple[Any, ...]]:
    kind = JobRow.model["kind"].as_string().label("kind")
    return select(JobRow.id, kind, MeshRow.size_bytes, *columns).join(MeshRow, MeshRow.id == JobRow.mesh_id)


def _left_of(row: Row[*tuple[Any, ...]], speeds: Speeds, now: datetime) -> float | None:
    worked_s = max((now - row.started_at).total_seconds(), 0.0)
    silent_s = max((now - row.updated_at).total_seconds(), 0.0)
    return left_at_work(speeds.seconds(row.kind, row.size_bytes), row.percent / 100.0, worked_s, silent_s)


def _seconds_until(moment: datetime | None, now: datetime) -> float:
    return 0.0 if moment is None else max((moment - now).total_seconds(), 0.0)

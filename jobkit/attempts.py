"""Attempts at a job, as a worker knows them. Every write is fenced by the attempt's number.

An attempt that lost its lease may still be at work: its twin has a higher number, and whatever the old one writes is
refused with StaleAttemptError.
"""

from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Any

from sqlalchemy import select, update
from sqlalchemy.orm import Session

from jobkit.clock import utc_now
from jobkit.database import Database
from jobkit.errors import StaleAttemptError
from jobkit.events import append_event
from jobkit.jobs import existing_job, to_job
from jobkit.schema import EventType, Job, JobError, JobResult, JobState
from jobkit.tables import AttemptRow, JobRow
from jobkit.transitions import Move, make_move, update_job

_AT_WORK = (JobState.RUNNING.value, JobState.CANCELING.value)


@dataclass(frozen=True)
class Attempt:
    """The right to write to a job, until a later attempt starts."""

    job_id: str
    number: int


@dataclass(frozen=True)
class StartedAttempt:
    """An attempt, and the job as it was when it started."""

    attempt: Attempt
    job: Job


@dataclass(frozen=True)
class _Ending:
    """How an attempt ends: the target if it runs undisturbed, and what is written then."""

    target: JobState
    event: EventType
    values: dict[str, Any]
    data: dict[str, Any]
    outcome: str
    error: JobError | None = None


class Attempts:
    """All attempts of a database."""

    def __init__(self, database: Database) -> None:
        self._database = database

    def start(self, job_id: str, worker: str, lease_s: float) -> StartedAttempt:
        """Take a queued job: raise its attempt number and lease it.

        Parameters
        ----------
        job_id : str
        worker : str
            Name of the taker, for people.
        lease_s : float
            Seconds until the attempt is taken for lost unless it is renewed.

        Raises
        ------
        JobNotFoundError
            If there is no such job.
        StaleAttemptError
            If the job is not queued: another worker has it, or it has ended.
        """
        now = utc_now()
        with self._database.write() as session:
            row = existing_job(session, job_id)
            number = row.attempt + 1
            values = {
                "attempt": number,
                "worker": worker,
                "lease_until": now + timedelta(seconds=lease_s),
                "started_at": now,
                "stage": None,
                "percent": 0.0,
            }
            move = Move(JobState.QUEUED, JobState.RUNNING, "started", values)
            if not make_move(session, job_id, move, now, JobRow.attempt == number - 1):
                raise StaleAttemptError(f"job {job_id} is {row.state} and can't be started")
            session.add(AttemptRow(job_id=job_id, number=number, worker=worker, started_at=now))
            return StartedAttempt(Attempt(job_id, number), to_job(existing_job(session, job_id)))

    def heartbeat(self, attempt: Attempt, lease_s: float) -> bool:
        """Renew the lease; return whether the job is to be canceled. Raise StaleAttemptError."""
        with self._database.write() as session:
            values = {"lease_until": utc_now() + timedelta(seconds=lease_s)}
            _require(update_job(session, attempt.job_id, values, *_fences(attempt)), attempt)
            state = session.scalars(select(JobRow.state).where(JobRow.id == attempt.job_id)).one()
            return state == JobState.CANCELING

    def report_progress(self, attempt: Attempt, stage: str, percent: float) -> None:
        """Write the stage at work and the percentage done of the whole repair; raise StaleAttemptError."""
        now = utc_now()
        with self._database.write() as session:
            values = {"stage": stage, "percent": percent, "revision": JobRow.revision + 1, "updated_at": now}
            _require(update_job(session, attempt.job_id, values, *_fences(attempt)), attempt)
            append_event(session, attempt.job_id, "progress", now, {"stage": stage, "percent": percent})

    def publish(self, attempt: Attempt, result: JobResult) -> JobState:
        """Make the result the job's: the one update that lets clients see its files.

        Returns
        -------
        JobState
            `succeeded`, `succeeded_with_warnings` where the result has warnings, or `canceled` where somebody asked
            for that in time; then the files belong to nobody.

        Raises
        ------
        StaleAttemptError
            If the attempt is not the latest any more.
        """
        target = JobState.SUCCEEDED_WITH_WARNINGS if result.warnings else JobState.SUCCEEDED
        values = {"result": result.model_dump(mode="json"), "percent": 100.0}
        return self._end(attempt, _Ending(target, "succeeded", values, {}, target.value))

    def fail(self, attempt: Attempt, error: JobError) -> JobState:
        """End the job without a result; return `failed`, or `canceled`. Raise StaleAttemptError."""
        return self._end(attempt, _failure(error))

    def requeue(self, attempt: Attempt, error: JobError) -> JobState:
        """Give the job back so that another attempt starts; where none is left, fail it.

        Returns
        -------
        JobState
            `queued`, `failed` or `canceled`. A queued job still has to be put into the queue.

        Raises
        ------
        StaleAttemptError
            If the attempt is not the latest any more.
        """
        with self._database.read() as session:
            row = existing_job(session, attempt.job_id)
            is_last = row.attempt >= row.max_attempts
        return self._end(attempt, _failure(error) if is_last else _return_to_queue(error))

    def acknowledge_cancel(self, attempt: Attempt) -> None:
        """Say that the attempt has stopped as asked; raise StaleAttemptError."""
        with self._database.write() as session:
            _require(_cancel(session, attempt, utc_now()), attempt)

    def take_back_expired(self, now: datetime) -> list[tuple[str, JobState]]:
        """End every attempt whose lease ran out before `now`; return each job with its new state."""
        with self._database.read() as session:
            query = select(JobRow.id, JobRow.attempt).where(JobRow.state.in_(_AT_WORK), JobRow.lease_until < now)
            expired = [Attempt(job_id, number) for job_id, number in session.execute(query)]
        error = JobError(code="worker_lost", message="the worker went silent in the middle of the job", retryable=True)
        taken = []
        for attempt in expired:
            try:
                taken.append((attempt.job_id, self._requeue_if_expired(attempt, error, now)))
            except StaleAttemptError:
                continue  # a heartbeat or an ending came in between
        return taken

    def _requeue_if_expired(self, attempt: Attempt, error: JobError, now: datetime) -> JobState:
        with self._database.write() as session:
            row = existing_job(session, attempt.job_id)
            if row.lease_until is None or row.lease_until >= now or row.attempt != attempt.number:
                raise StaleAttemptError(f"attempt {attempt.number} of job {attempt.job_id} is not expired")
            is_last = row.attempt >= row.max_attempts
            return _end(session, attempt, _failure(error) if is_last else _return_to_queue(error))

    def _end(self, attempt: Attempt, ending: _Ending) -> JobState:
        with self._database.write() as session:
            return _end(session, attempt, ending)


def _end(session: Session, attempt: Attempt, ending: _Ending) -> JobState:
    now = utc_now()
    move = Move(JobState.RUNNING, ending.target, ending.event, ending.values, ending.data)
    if make_move(session, attempt.job_id, move, now, JobRow.attempt == attempt.number):
        _close_attempt(session, attempt, ending.outcome, now, ending.error)
        return ending.target
    _require(_cancel(session, attempt, now), attempt)
    return JobState.CANCELED


def _cancel(session: Session, attempt: Attempt, now: datetime) -> bool:
    move = Move(JobState.CANCELING, JobState.CANCELED, "canceled")
    if not make_move(session, attempt.job_id, move, now, JobRow.attempt == attempt.number):
        return False
    _close_attempt(session, attempt, JobState.CANCELED.value, now, None)
    return True


def _failure(error: JobError) -> _Ending:
    wire = error.model_dump(mode="json")
    return _Ending(JobState.FAILED, "failed", {"error": wire}, {"error": wire}, JobState.FAILED.value, error)


def _return_to_queue(error: JobError) -> _Ending:
    values = {"stage": None, "percent": 0.0, "enqueued_at": None}
    data = {"error": error.model_dump(mode="json")}
    return _Ending(JobState.QUEUED, "requeued", values, data, "requeued", error)


def _close_attempt(session: Session, attempt: Attempt, outcome: str, now: datetime, error: JobError | None) -> None:
    session.execute(
        update(AttemptRow)
        .where(AttemptRow.job_id == attempt.job_id, AttemptRow.number == attempt.number)
        .values(outcome=outcome, finished_at=now, error=None if error is None else error.model_dump(mode="json"))
    )


def _fences(attempt: Attempt) -> tuple[Any, Any]:
    return JobRow.attempt == attempt.number, JobRow.state.in_(_AT_WORK)


def _require(is_written: bool, attempt: Attempt) -> None:
    if not is_written:
        raise StaleAttemptError(f"attempt {attempt.number} of job {attempt.job_id} may write no more")

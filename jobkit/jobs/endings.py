"""How attempts end: one fenced transaction that moves the job, closes the attempt and logs both.

Tested in `tests/jobkit/jobs/test_attempts.py`.
"""

from dataclasses import dataclass, field
from datetime import datetime, timedelta
from typing import Any

from sqlalchemy import update
from sqlalchemy.orm import Session

from jobkit.database.counters import count_attempt
from jobkit.database.job_rows import existing_job
from jobkit.database.tables import AttemptRow, JobRow
from jobkit.errors import StaleAttemptError
from jobkit.jobs.transitions import Transition, make_transition
from jobkit.version import VERSION
from quadpatch_client.schema import EventType, JobError, JobResult, JobState


@dataclass(frozen=True)
class Attempt:
    """The right to write to a job, until a later attempt starts."""

    job_id: str
    number: int


@dataclass(frozen=True)
class Ending:
    """How an attempt ends: the job's next state if no cancel was asked for, and what is written then."""

    target: JobState
    event: EventType
    outcome: str
    values: dict[str, Any] = field(default_factory=dict)
    data: dict[str, Any] = field(default_factory=dict)
    error: JobError | None = None


def success(result: JobResult) -> Ending:
    """Publish a result."""
    target = JobState.SUCCEEDED_WITH_WARNINGS if result.warnings else JobState.SUCCEEDED
    size_bytes = sum(file.size_bytes for file in result.files)
    stored = {**result.model_dump(mode="json"), "version": VERSION}
    values = {"result": stored, "result_bytes": size_bytes, "percent": 100.0}
    return Ending(target, "succeeded", target.value, values)


def failure(error: JobError) -> Ending:
    """Give the job up."""
    wire = error.model_dump(mode="json")
    return Ending(JobState.FAILED, "failed", JobState.FAILED.value, {"error": wire}, {"error": wire}, error)


def retry_ending(error: JobError) -> Ending:
    """Let another attempt start at once."""
    return _return_to_queue(error, {"not_before": None}, {})


def uncounted_ending(error: JobError, now: datetime, delay_s: float) -> Ending:
    """Let another attempt start after some seconds, and don't count this one: its reason lies outside of the job."""
    not_before = now + timedelta(seconds=delay_s) if delay_s else None
    values = {"forgiven": JobRow.forgiven + 1, "not_before": not_before}
    return _return_to_queue(error, values, {"forgiven": True, "delay_s": delay_s})


def is_last_attempt(row: JobRow) -> bool:
    """Tell whether the present attempt is the last one of the job."""
    return row.attempt - row.forgiven >= row.max_attempts


def may_publish(session: Session, attempt: Attempt) -> bool:
    """Tell whether the attempt is the one at work, and keep that so until the session ends."""
    row = existing_job(session, attempt.job_id, locked=True)
    return row.attempt == attempt.number and row.state == JobState.RUNNING


def end_attempt(session: Session, attempt: Attempt, ending: Ending, now: datetime) -> JobState:
    """End an attempt; return the job's state afterwards, which is `canceled` where that was asked for in time.

    Raises
    ------
    StaleAttemptError
        If the attempt is not the latest any more, or the job has ended.
    """
    transition = Transition(JobState.RUNNING, ending.target, ending.event, ending.values, ending.data)
    if make_transition(session, attempt.job_id, transition, now, JobRow.attempt == attempt.number):
        _close(session, attempt, ending.outcome, now, ending.error)
        return ending.target
    cancel_attempt(session, attempt, now)
    return JobState.CANCELED


def cancel_attempt(session: Session, attempt: Attempt, now: datetime) -> None:
    """End an attempt whose job is to be canceled; raise StaleAttemptError."""
    transition = Transition(JobState.CANCELING, JobState.CANCELED, "canceled")
    if not make_transition(session, attempt.job_id, transition, now, JobRow.attempt == attempt.number):
        raise stale_error(attempt)
    _close(session, attempt, JobState.CANCELED.value, now, None)


def stale_error(attempt: Attempt) -> StaleAttemptError:
    """Make the error of an attempt that may write no more."""
    return StaleAttemptError(f"attempt {attempt.number} of job {attempt.job_id} may write no more")


def _return_to_queue(error: JobError, values: dict[str, Any], data: dict[str, Any]) -> Ending:
    values = {"stage": None, "percent": 0.0, "enqueued_at": None, **values}
    data = {"error": error.model_dump(mode="json"), **data}
    return Ending(JobState.QUEUED, "requeued", "requeued", values, data, error)


def _close(session: Session, attempt: Attempt, outcome: str, now: datetime, error: JobError | None) -> None:
    count_attempt(session, outcome, None if error is None else error.code)
    session.execute(
        update(AttemptRow)
        .where(AttemptRow.job_id == attempt.job_id, AttemptRow.number == attempt.number)
        .values(outcome=outcome, finished_at=now, error=None if error is None else error.model_dump(mode="json"))
    )

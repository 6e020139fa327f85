"""Jobs whose time is over: expired leases, cancels that no worker acknowledged, exceeded limits.

Everything here is a fenced step of its own, so two dispatchers that do it at the same moment do it once.
"""

from collections.abc import Callable
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Any

from sqlalchemy import ColumnElement, select
from sqlalchemy.orm import Session

from jobkit.database.job_rows import existing_job
from jobkit.database.session import Database
from jobkit.database.tables import AttemptRow, JobRow
from jobkit.errors import JobNotFoundError, StaleAttemptError
from jobkit.jobs.attempts import AT_WORK
from jobkit.jobs.endings import Attempt, Ending, cancel_attempt, end_attempt, failure, is_last_attempt, retry_ending
from jobkit.jobs.transitions import Transition, make_transition
from quadpatch_client.schema import JobError, JobState

# A running worker acknowledges a cancel within a second.
CANCEL_TIMEOUT_S = 1.5
# A worker whose last heartbeat was this close to its memory limit was killed by the kernel.
_FULL_MEMORY = 0.9
# Of one run; the rest follows in the next.
_MOST = 500


@dataclass(frozen=True)
class TimeLimits:
    """How long a job may wait and last in all, in seconds, and the memory of one attempt, in MiB."""

    queue_s: float
    total_s: float
    memory_mb: int


def end_overdue(database: Database, limits: TimeLimits, now: datetime, *, takes_leases: bool = True) -> int:
    """Take back, cancel or fail every job whose time is over at `now`; return how many there were.

    Without `takes_leases`, leases that ran out are not taken back.
    """
    is_queued = JobRow.state == JobState.QUEUED.value
    is_running = JobRow.state == JobState.RUNNING.value
    is_old = JobRow.created_at < now - timedelta(seconds=limits.total_s)
    is_over_queue_time = is_queued & (JobRow.queued_at < now - timedelta(seconds=limits.queue_s))
    is_cancel_unacknowledged = (JobRow.state == JobState.CANCELING.value) & (
        JobRow.cancel_requested_at < now - timedelta(seconds=CANCEL_TIMEOUT_S)
    )
    is_lease_over = JobRow.state.in_(AT_WORK) & (JobRow.lease_until < now)
    steps: list[tuple[ColumnElement[bool], Callable[[Session, JobRow], None]]] = [
        (is_cancel_unacknowledged, lambda session, row: cancel_attempt(session, _latest(row), now)),
        (is_running & is_old, lambda session, row: _end(session, row, failure(_total_time_error(limits)), now)),
        (is_queued & is_old, lambda session, row: _give_up(session, row, _total_time_error(limits), now)),
        (is_over_queue_time, lambda session, row: _give_up(session, row, _queue_time_error(limits), now)),
    ]
    if takes_leases:
        steps.append((is_lease_over, lambda session, row: _end(session, row, _lease_ending(session, row, limits), now)))
    return sum(_apply_to_all(database, condition, step) for condition, step in steps)


def _apply_to_all(database: Database, condition: ColumnElement[bool], step: Callable[[Session, JobRow], None]) -> int:
    """Apply a step to every job that meets the condition, and still does when it is locked."""
    with database.read() as session:
        ids = list(session.scalars(select(JobRow.id).where(condition).order_by(JobRow.id).limit(_MOST)))
    n_applied = 0
    for job_id in ids:
        try:
            with database.write() as session:
                # Locked: a heartbeat that comes now waits, and one that came just before is seen.
                query = select(JobRow).where(JobRow.id == job_id, condition).with_for_update()
                row = session.scalars(query).one_or_none()
                if row is not None:
                    step(session, row)
                    n_applied += 1
        except (StaleAttemptError, JobNotFoundError):
            continue  # a heartbeat or an ending came in between
    return n_applied


def _lease_ending(session: Session, row: JobRow, limits: TimeLimits) -> Ending:
    """Derive from the last heartbeat why the attempt was lost; the last attempt ends the job."""
    is_last = is_last_attempt(row)
    peak_mb = session.scalars(
        select(AttemptRow.peak_memory_mb).where(AttemptRow.job_id == row.id, AttemptRow.number == row.attempt)
    ).one_or_none()
    limit_mb = min(limits.memory_mb, _own_limit(row) or limits.memory_mb)
    if peak_mb is not None and peak_mb >= _FULL_MEMORY * limit_mb:
        message = f"the worker fell silent when the job used {peak_mb} of {limit_mb} MiB"
        error = JobError(code="out_of_memory", message=message, stage=row.stage, retryable=not is_last)
    else:
        message = "the worker fell silent in the middle of the job"
        error = JobError(code="worker_lost", message=message, stage=row.stage, retryable=not is_last)
    return failure(error) if is_last else retry_ending(error)


def _own_limit(row: JobRow) -> int | None:
    limits: dict[str, Any] = row.spec.get("limits") or {}
    return limits.get("memory_mb")


def _end(session: Session, row: JobRow, ending: Ending, now: datetime) -> None:
    end_attempt(session, _latest(row), ending, now)


def _give_up(session: Session, row: JobRow, error: JobError, now: datetime) -> None:
    wire = error.model_dump(mode="json")
    transition = Transition(JobState.QUEUED, JobState.FAILED, "failed", {"error": wire}, {"error": wire})
    if not make_transition(session, row.id, transition, now, JobRow.attempt == row.attempt):
        existing_job(session, row.id)
        raise StaleAttemptError(f"job {row.id} waits no more")


def _latest(row: JobRow) -> Attempt:
    return Attempt(row.id, row.attempt)


def _queue_time_error(limits: TimeLimits) -> JobError:
    message = f"no worker took the job within {limits.queue_s:g} s"
    return JobError(code="queue_time_exceeded", message=message, retryable=True)


def _total_time_error(limits: TimeLimits) -> JobError:
    message = f"the job did not end within {limits.total_s:g} s of its acceptance"
    return JobError(code="total_time_exceeded", message=message)

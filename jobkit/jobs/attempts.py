"""Attempts at a job, as a worker uses them. Every write is fenced by the attempt's number.

An attempt that lost its lease may still be at work: the next attempt has a higher number, and a write of the old one is
refused with StaleAttemptError.
"""

import contextlib
from collections.abc import Callable
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Any

from sqlalchemy import func, or_, select, update
from sqlalchemy.orm import Session

from jobkit.database.clock import shared_now, utc_now
from jobkit.database.job_rows import existing_job, to_job
from jobkit.database.quotas import admit_attempt, check_places
from jobkit.database.session import Database
from jobkit.database.tables import AttemptRow, JobRow
from jobkit.errors import JobNotFoundError, MemoryFullError, StaleAttemptError, TenantBusyError
from jobkit.jobs.admission import Admission, Grant
from jobkit.jobs.endings import (
    Attempt,
    Ending,
    cancel_attempt,
    end_attempt,
    failure,
    is_last_attempt,
    may_publish,
    retry_ending,
    stale_error,
    success,
    uncounted_ending,
)
from jobkit.jobs.events import append_event
from jobkit.jobs.reuse import reuse_result
from jobkit.jobs.stage_seconds import StageSeconds, add_stages
from jobkit.jobs.transitions import Transition, make_transition, update_job
from jobkit.jobs.turns import NETWORK_KIND, next_in_turn, note_turn
from quadpatch_client.schema import Job, JobError, JobResult, JobState
from quadpatch_rules.tasks import TRAIN

AT_WORK = (JobState.RUNNING.value, JobState.CANCELING.value)
# Jobs that a worker tries at one turn: each of them may have to wait for memory.
_MOST_TRIED = 8


@dataclass(frozen=True)
class StartedAttempt:
    """An attempt, and the job as it was when it started, with its owner.

    `request_id` and `traceparent` name the request that made the job, and `asked_by` its key; `memory_mb` is the most
    memory of its engine, in MiB, where its machine has less than it is expected to need.
    """

    attempt: Attempt
    job: Job
    tenant: str
    request_id: str | None = None
    traceparent: str | None = None
    memory_mb: int | None = None
    asked_by: str | None = None


class Attempts:
    """All attempts of a database.

    Parameters
    ----------
    database : Database
    fits_networks : bool
        Whether the worker that starts them can fit networks: else it starts no training of one.
    """

    def __init__(self, database: Database, *, fits_networks: bool = True) -> None:
        self._database = database
        self._fits_networks = fits_networks

    def start_next(self, job_id: str, worker: str, lease_s: float, admission: Admission) -> StartedAttempt:
        """Start the job whose turn it is.

        Parameters
        ----------
        job_id : str
            The one that the entry of the queue names. It is started if it has waited for memory, or no other one can
            be.
        worker, lease_s, admission
            As for `start`.

        Raises
        ------
        JobNotFoundError, MemoryFullError, StaleAttemptError, TenantBusyError
            As `start` does, for the last job that was tried.
        """
        tried: set[str] = set()
        most = 0 if self._has_waited(job_id) else _MOST_TRIED
        while len(tried) < most:
            with self._database.read() as session:
                chosen = next_in_turn(session, shared_now(session), fits_networks=self._fits_networks)
            if chosen is None or chosen in tried:
                break
            tried.add(chosen)
            # Where it has to wait for memory, or another worker was faster, it is the turn of another one.
            with contextlib.suppress(MemoryFullError, StaleAttemptError, JobNotFoundError, TenantBusyError):
                return self.start(chosen, worker, lease_s, admission)
        return self.start(job_id, worker, lease_s, admission)

    def start(self, job_id: str, worker: str, lease_s: float, admission: Admission | None = None) -> StartedAttempt:
        """Take a queued job: raise its attempt number and lease it.

        Parameters
        ----------
        job_id : str
        worker : str
            Name of the worker, for people.
        lease_s : float
            Seconds until the attempt is taken for lost unless it is renewed.
        admission : Admission, optional
            Reserves the memory that the job is expected to need; without it, no memory is asked for.

        Raises
        ------
        JobNotFoundError
            If there is no such job.
        MemoryFullError
            If the job does not fit into the memory of the worker's machine now: it waits.
        StaleAttemptError
            If the job is not queued, or not to be started yet: another worker has it, or it has ended. So it has, at
            this very moment, where it takes over the result of an equal job that ended after it came.
        TenantBusyError
            If its tenant runs as many jobs as it may: it waits for the end of one.
        """
        with self._database.write() as session:
            now = shared_now(session)
            row = existing_job(session, job_id)
            if row.state != JobState.QUEUED or (row.not_before is not None and row.not_before > now):
                raise _not_startable(row)
            if row.task == TRAIN and row.model["kind"] == NETWORK_KIND and not self._fits_networks:
                raise StaleAttemptError(f"job {job_id} is for a worker that fits networks")
            has_ended = row.may_reuse and reuse_result(session, row, now)
            if not has_ended:
                check_places(session, row.tenant)
            grant = Grant() if admission is None or has_ended else admission.admit(session, row, lease_s, now)
            if grant is not None and not has_ended:
                attempt = _start(session, row, worker, lease_s, now)
                session.flush()
                admit_attempt(session, row.tenant)
                row = existing_job(session, job_id)
                request = (row.request_id, row.traceparent, grant.limit_mb, row.asked_by)
                return StartedAttempt(attempt, to_job(row), row.tenant, *request)
        if has_ended:
            raise StaleAttemptError(f"job {job_id} has taken over the result of an equal one")
        raise MemoryFullError(f"job {job_id} waits for memory")

    def heartbeat(self, attempt: Attempt, lease_s: float, memory_mb: int = 0) -> bool:
        """Renew the lease and note the most memory seen; return whether the job is to be canceled.

        Raises
        ------
        StaleAttemptError
            If the attempt is not the latest any more.
        """
        with self._database.write() as session:
            values = {"lease_until": shared_now(session) + timedelta(seconds=lease_s)}
            if not update_job(session, attempt.job_id, values, *_fences(attempt)):
                raise stale_error(attempt)
            if memory_mb:
                session.execute(
                    update(AttemptRow)
                    .where(AttemptRow.job_id == attempt.job_id, AttemptRow.number == attempt.number)
                    .where(func.coalesce(AttemptRow.peak_memory_mb, 0) < memory_mb)
                    .values(peak_memory_mb=memory_mb)
                )
            state = session.scalars(select(JobRow.state).where(JobRow.id == attempt.job_id)).one()
            return state == JobState.CANCELING

    def is_canceling(self, attempt: Attempt) -> bool:
        """Read whether the job is to be canceled.

        Raises
        ------
        StaleAttemptError
            If the attempt is not the latest any more, or has ended without its worker: the dispatcher does not wait
            long for a worker that is slow to acknowledge a cancel.
        """
        with self._database.read() as session:
            state = session.scalars(select(JobRow.state).where(JobRow.id == attempt.job_id, *_fences(attempt))).first()
        if state is None:
            raise stale_error(attempt)
        return state == JobState.CANCELING

    def report_progress(self, attempt: Attempt, stage: str, percent: float) -> None:
        """Write the stage at work and the percentage done of the whole repair; raise StaleAttemptError."""
        now = utc_now()
        with self._database.write() as session:
            values = {"stage": stage, "percent": percent, "revision": JobRow.revision + 1, "updated_at": now}
            if not update_job(session, attempt.job_id, values, *_fences(attempt)):
                raise stale_error(attempt)
            append_event(session, attempt.job_id, "progress", now, {"stage": stage, "percent": percent})

    def publish(
        self,
        attempt: Attempt,
        result: JobResult,
        stages: StageSeconds | None = None,
        complete: Callable[[Session, JobResult], JobResult] | None = None,
    ) -> JobState:
        """Make the result the job's: the one update that lets clients see its files.

        Parameters
        ----------
        attempt : Attempt
        result : JobResult
        stages : StageSeconds, optional
            How long the repair took; added to the sums together with the result, or not at all.
        complete : callable, optional
            Writes what else is published, in the same transaction, and returns the result with what came of it.

        Returns
        -------
        JobState
            `succeeded`, `succeeded_with_warnings`, or `canceled` where that was asked for in time; then no row names
            the files.

        Raises
        ------
        StaleAttemptError
            If the attempt is not the latest any more.
        """
        with self._database.write() as session:
            if complete is not None and may_publish(session, attempt):
                result = complete(session, result)
            state = end_attempt(session, attempt, success(result), utc_now())
            if stages is not None and state.has_result:
                add_stages(session, stages)
            return state

    def fail(self, attempt: Attempt, error: JobError) -> JobState:
        """End the job without a result; return `failed`, or `canceled`. Raise StaleAttemptError."""
        return self._end(attempt, failure(error))

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
        with self._database.write() as session:
            is_last = is_last_attempt(existing_job(session, attempt.job_id))
            return end_attempt(session, attempt, failure(error) if is_last else retry_ending(error), utc_now())

    def hand_back(self, attempt: Attempt, error: JobError, delay_s: float = 0.0) -> JobState:
        """Give the job back, and don't count the attempt: the reason lies outside of the job.

        Parameters
        ----------
        attempt : Attempt
        error : JobError
            The reason, for people.
        delay_s : float
            Seconds before which no other attempt starts.

        Returns
        -------
        JobState
            `queued` or `canceled`.

        Raises
        ------
        StaleAttemptError
            If the attempt is not the latest any more.
        """
        with self._database.write() as session:
            return end_attempt(session, attempt, uncounted_ending(error, shared_now(session), delay_s), utc_now())

    def acknowledge_cancel(self, attempt: Attempt) -> None:
        """Say that the attempt has stopped as asked; raise StaleAttemptError."""
        with self._database.write() as session:
            cancel_attempt(session, attempt, utc_now())

    def _has_waited(self, job_id: str) -> bool:
        """Tell whether a job has waited for memory, or for another attempt."""
        has_waited = JobRow.memory_wait_since.is_not(None) | (JobRow.attempt > 0)
        is_it = (JobRow.id == job_id) & (JobRow.state == JobState.QUEUED.value) & has_waited
        with self._database.read() as session:
            return session.scalars(select(JobRow.id).where(is_it)).first() is not None

    def _end(self, attempt: Attempt, ending: Ending) -> JobState:
        with self._database.write() as session:
            return end_attempt(session, attempt, ending, utc_now())


def _start(session: Session, row: JobRow, worker: str, lease_s: float, now: datetime) -> Attempt:
    number = row.attempt + 1
    values = {
        "attempt": number,
        "worker": worker,
        "lease_until": now + timedelta(seconds=lease_s),
        "started_at": now,
        "stage": None,
        "percent": 0.0,
    }
    transition = Transition(JobState.QUEUED, JobState.RUNNING, "started", values)
    # The row may have changed since it was read.
    is_due = or_(JobRow.not_before.is_(None), JobRow.not_before <= now)
    if not make_transition(session, row.id, transition, now, JobRow.attempt == number - 1, is_due):
        raise _not_startable(row)
    session.add(AttemptRow(job_id=row.id, number=number, worker=worker, started_at=now))
    note_turn(session, row.tenant, now)
    return Attempt(row.id, number)


def _not_startable(row: JobRow) -> StaleAttemptError:
    return StaleAttemptError(f"job {row.id} is {row.state} and can't be started now")


def _fences(attempt: Attempt) -> tuple[Any, Any]:
    return JobRow.attempt == attempt.number, JobRow.state.in_(AT_WORK)

"""The life of one attempt at a job, from the start to exactly one ending.

The attempt is settled last, when the engine is dead and its folder is gone: who reads `canceled` or `failed` finds
nothing left of it.
"""

import logging
import time

from jobkit.attempts import StartedAttempt
from jobkit.errors import QueueUnavailableError, StaleAttemptError
from jobkit.reconcile import submit_job
from jobkit.schema import JobError, JobResult, JobState
from worker.context import Context
from worker.failures import Failure, StopReason
from worker.limits import EngineLimits
from worker.models import model_argument
from worker.outcomes import folder_with_mesh, outcome_of
from worker.pulse import Pulse, Vitals
from worker.results import drop_result, store_result
from worker.spec import repair_request
from worker.watch import Observer, run_engine

# A repair that is nearly done may finish when its worker is asked to stop; the others are handed back.
_DRAIN_GRACE_S = 2.0
_DRAINED = JobError(code="worker_drained", message="the worker was stopped in the middle of the job", retryable=True)

_log = logging.getLogger("quadpatch.worker.repairs")


def repair(context: Context, started: StartedAttempt) -> None:
    """Work on a started attempt and settle it."""
    outcome = outcome_of(lambda: _run(context, started), f"job {started.attempt.job_id}")
    if not isinstance(outcome, JobResult):
        drop_result(started.attempt, context.store)
    try:
        state = _settle(context, started, outcome)
    except StaleAttemptError as error:
        _log.warning("the attempt may write no more: %s", error)
        drop_result(started.attempt, context.store)
        return
    if isinstance(outcome, JobResult) and not state.has_result:
        drop_result(started.attempt, context.store)
    _log.info("job %s, attempt %d: %s", started.attempt.job_id, started.attempt.number, state.value)
    if state == JobState.QUEUED:
        _resubmit(context, started)


def _run(context: Context, started: StartedAttempt) -> JobResult:
    with Pulse(_vitals(context, started)) as pulse:
        return _work(context, started, pulse)


def _work(context: Context, started: StartedAttempt, pulse: Pulse) -> JobResult:
    job, began = started.job, time.monotonic()
    source = context.meshes.source(job.mesh_id)
    model = model_argument(job.model, context.registry, context.store, context.cache_folder)
    settings = context.settings
    limits = EngineLimits(settings.job_time_limit_s, settings.job_memory_limit_mb, n_threads=context.n_threads)
    request = repair_request(job.spec, source, model, limits)
    observer = Observer(pulse.reach, _StopRule(context, started, pulse))
    with folder_with_mesh(context, source) as folder:
        run_engine(context.nursery, request, folder, observer)
        return store_result(folder, request, started.attempt, context.store, time.monotonic() - began)


class _StopRule:
    """Tells the watch whether to end the engine."""

    def __init__(self, context: Context, started: StartedAttempt, pulse: Pulse) -> None:
        self._draining = context.draining
        self._pulse = pulse
        # Handing back the last attempt would fail the job: better to finish it if there is time.
        self._may_hand_back = started.attempt.number < started.job.max_attempts
        self._drained_at: float | None = None

    def __call__(self) -> StopReason | None:
        if self._pulse.stop_reason is not None:
            return self._pulse.stop_reason
        if not self._draining.is_set() or not self._may_hand_back:
            return None
        now = time.monotonic()
        self._drained_at = self._drained_at or now
        return StopReason.DRAINED if now - self._drained_at > _DRAIN_GRACE_S else None


def _vitals(context: Context, started: StartedAttempt) -> Vitals:
    attempts, jobs, attempt, settings = context.attempts, context.jobs, started.attempt, context.settings
    return Vitals(
        renew=lambda: attempts.heartbeat(attempt, settings.lease_s),
        is_canceled=lambda: jobs.get(attempt.job_id).state == JobState.CANCELING,
        report=lambda stage, percent: attempts.report_progress(attempt, stage, percent),
        heartbeat_s=settings.heartbeat_s,
        lease_s=settings.lease_s,
    )


def _settle(context: Context, started: StartedAttempt, outcome: JobResult | Failure | StopReason) -> JobState:
    attempts, attempt = context.attempts, started.attempt
    if isinstance(outcome, JobResult):
        return attempts.publish(attempt, outcome)
    if isinstance(outcome, Failure):
        error = JobError(
            code=outcome.code, message=outcome.message, stage=outcome.stage or None, retryable=outcome.retryable
        )
        return attempts.requeue(attempt, error) if outcome.retryable else attempts.fail(attempt, error)
    if outcome is StopReason.DRAINED:
        return attempts.requeue(attempt, _DRAINED)
    if outcome is StopReason.LOST:
        raise StaleAttemptError(f"attempt {attempt.number} of job {attempt.job_id} lost its lease")
    attempts.acknowledge_cancel(attempt)
    return JobState.CANCELED


def _resubmit(context: Context, started: StartedAttempt) -> None:
    try:
        submit_job(context.database, context.queue, started.attempt.job_id, started.attempt.number)
    except QueueUnavailableError:
        _log.warning("the queue does not answer; job %s is put into it later", started.attempt.job_id)

"""One attempt at a job, from its start to exactly one ending.

The attempt is settled last, when the engine has ended and its folder is removed: once a client reads `canceled` or
`failed`, nothing of the attempt is left.
"""

import logging
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

from tenacity import Retrying, retry_if_exception_type, stop_after_delay, wait_fixed

from jobkit.database.tables import ModelRow
from jobkit.errors import (
    DatabaseUnavailableError,
    JobNotFoundError,
    QueueUnavailableError,
    StaleAttemptError,
    StoreUnavailableError,
)
from jobkit.jobs.attempts import StartedAttempt
from jobkit.jobs.stage_seconds import StageSeconds
from jobkit.meshes import Meshes
from jobkit.models.registry import Registry
from jobkit.requeue import submit_job
from jobkit.telemetry import StageSpans
from quadpatch.stages import failure_of
from quadpatch_client.schema import JobError, JobResult, JobState
from quadpatch_rules.tasks import TRAIN
from worker.acceptance import check_acceptance
from worker.calibrations import hand_on, take_back
from worker.context import Context
from worker.engine.limits import EngineLimits
from worker.engine.request import LOG_NAME, EngineRequest
from worker.engine.supervision import Observer, log_engine_tail, run_engine
from worker.failures import OUTAGE_DELAY_S, Failure, StopReason
from worker.heartbeat import OUTAGE_TIMEOUT_S, Heartbeat, HeartbeatCalls
from worker.models import deprecation, model_argument, network_card
from worker.outcomes import folder_with_mesh, outcome_of
from worker.pdf import add_pdf
from worker.progress import Progress
from worker.results import (
    Cost,
    drop_result,
    missing_pictures,
    note_deprecation,
    note_lost_pictures,
    stage_seconds,
    store_result,
)
from worker.spec import filled_by, job_request, who_asked
from worker.trainings import folder_with_meshes, meshes_of, prepared_version, publish_training, training_request

# A repair that is nearly done may finish when its worker is asked to stop; the others are handed back.
_DRAIN_GRACE_S = 2.0
# Between two tries to settle an attempt while the database is unavailable.
_PAUSE_S = 1.0
_DRAINED = JobError(code="worker_drained", message="the worker was stopped in the middle of the job", retryable=True)

_log = logging.getLogger("quadpatch.worker.repairs")
# Settles an attempt, and waits while the database is unavailable, so that finished work need not be repeated.
_settle_when_available = Retrying(
    retry=retry_if_exception_type(DatabaseUnavailableError),
    stop=stop_after_delay(OUTAGE_TIMEOUT_S),
    wait=wait_fixed(_PAUSE_S),
    before_sleep=lambda state: _log.warning(
        "the attempt waits to be settled: %s", state.outcome and state.outcome.exception()
    ),
    reraise=True,
)


@dataclass(frozen=True)
class _Repaired:
    """A result whose files are stored, how long its stages took, and the version that a training made."""

    result: JobResult
    stages: StageSeconds
    version: ModelRow | None = None


def repair(context: Context, started_attempt: StartedAttempt) -> JobState | None:
    """Work on a started attempt and settle it; return the job's state then, None where the attempt was taken away."""
    outcome = outcome_of(lambda: _run(context, started_attempt), f"job {started_attempt.attempt.job_id}")
    if not isinstance(outcome, _Repaired):
        _drop(context, started_attempt)
    try:
        state = _settle_when_available(lambda: _settle(context, started_attempt, outcome))
    except StaleAttemptError as error:
        _log.warning("the attempt may write no more: %s", error)
        # The connection may have broken after the commit that published the result: then the files are in use.
        if _settle_when_available(lambda: _has_published(context, started_attempt)):
            return context.jobs.get(started_attempt.attempt.job_id).state
        _drop(context, started_attempt)
        return None
    if isinstance(outcome, _Repaired) and not state.has_result:
        _drop(context, started_attempt)
    _log.info("job %s, attempt %d: %s", started_attempt.attempt.job_id, started_attempt.attempt.number, state.value)
    if state == JobState.QUEUED and not (isinstance(outcome, Failure) and outcome.is_outside):
        _resubmit(context, started_attempt)
    return state


def _has_published(context: Context, started_attempt: StartedAttempt) -> bool:
    try:
        job = context.jobs.get(started_attempt.attempt.job_id)
    except JobNotFoundError:
        return False
    return job.attempt == started_attempt.attempt.number and job.state.has_result


def _drop(context: Context, started_attempt: StartedAttempt) -> None:
    """Remove the files of an attempt that published nothing; an unavailable store leaves them to the sweep."""
    try:
        drop_result(started_attempt.attempt, context.store)
    except (StoreUnavailableError, OSError) as error:
        _log.warning("files of %s are left to the sweep: %s", started_attempt.attempt, error)


def _run(context: Context, started_attempt: StartedAttempt) -> _Repaired:
    spec = started_attempt.job.spec
    progress = Progress(spec.task, filled_by(spec.method))
    with Heartbeat(_heartbeat_calls(context, started_attempt), progress) as heartbeat:
        return (_train if spec.task == TRAIN else _work)(context, started_attempt, heartbeat)


def _work(context: Context, started_attempt: StartedAttempt, heartbeat: Heartbeat) -> _Repaired:
    job, started_at = started_attempt.job, time.monotonic()
    owner = context.database.of(started_attempt.tenant)
    meshes, registry = Meshes(owner), Registry(owner, context.store)
    source = meshes.source(job.mesh_id)
    reference = None if job.spec.reference_id is None else meshes.source(job.spec.reference_id)
    model = model_argument(job.model, registry, context.store, context.cache_folder)
    deprecated = deprecation(job.model, registry)
    limits = _limits(context, started_attempt)
    request = replace(
        job_request(job.spec, source, model, limits, reference),
        model_card=network_card(job.model, registry),
        html_report=who_asked(started_attempt),
    )
    with folder_with_mesh(context, source, reference) as folder:
        before = hand_on(meshes, job.mesh_id, folder) if request.scan else b""
        failure = _run_engine(context, request, folder, heartbeat)
        if failure is not None:
            note_lost_pictures(folder, request, failure)
        elif missing_pictures(folder, request):
            log_engine_tail(folder / LOG_NAME)
        if request.scan:
            take_back(meshes, job.mesh_id, folder, before)
        add_pdf(folder, context.settings.pdf_renderer, request.limits, _StopRule(context, heartbeat))
        if deprecated is not None:
            note_deprecation(folder, f"{job.model.name}@{job.model.version}", deprecated.reason)
        check_acceptance(folder, job.spec)
        cost = Cost(time.monotonic() - started_at, heartbeat.peak_mb)
        result = store_result(folder, request, started_attempt.attempt, context.store, cost)
        return _Repaired(result, stage_seconds(folder, job.spec))


def _train(context: Context, started_attempt: StartedAttempt, heartbeat: Heartbeat) -> _Repaired:
    started_at, meshes = time.monotonic(), meshes_of(context, started_attempt)
    request = training_request(started_attempt, meshes, _limits(context, started_attempt))
    with folder_with_meshes(context, meshes) as folder:
        _run_engine(context, request, folder, heartbeat)
        version = prepared_version(context, started_attempt, folder)
        cost = Cost(time.monotonic() - started_at, heartbeat.peak_mb)
        result = store_result(folder, request, started_attempt.attempt, context.store, cost)
        return _Repaired(result, stage_seconds(folder, started_attempt.job.spec), version)


def _limits(context: Context, started_attempt: StartedAttempt) -> EngineLimits:
    settings = context.settings
    memory_mb = min(settings.job_memory_limit_mb, started_attempt.memory_mb or settings.job_memory_limit_mb)
    return EngineLimits(
        settings.job_time_limit_s, memory_mb, n_threads=context.n_threads, n_processes=context.n_processes
    )


def _run_engine(context: Context, request: EngineRequest, folder: Path, heartbeat: Heartbeat) -> Failure | None:
    with context.telemetry.stages() as spans:
        observer = Observer(
            _report_to_both(heartbeat, spans),
            _StopRule(context, heartbeat),
            heartbeat.note_memory,
            heartbeat.note_peak,
        )
        return run_engine(context.fork_server, request, folder, observer)


def _report_to_both(heartbeat: Heartbeat, spans: StageSpans) -> Callable[[str, float], None]:
    """Report progress to the database and to the trace."""

    def reach(stage: str, fraction: float) -> None:
        heartbeat.reach(stage, fraction)
        failure_of(lambda: spans.reach(stage))

    return reach


class _StopRule:
    """Tells the supervision whether to end the engine."""

    def __init__(self, context: Context, heartbeat: Heartbeat) -> None:
        self._draining = context.draining
        self._heartbeat = heartbeat
        self._drained_at: float | None = None

    def __call__(self) -> StopReason | None:
        if self._heartbeat.stop_reason is not None:
            return self._heartbeat.stop_reason
        if not self._draining.is_set():
            return None
        now = time.monotonic()
        self._drained_at = self._drained_at or now
        return StopReason.DRAINED if now - self._drained_at > _DRAIN_GRACE_S else None


def _heartbeat_calls(context: Context, started_attempt: StartedAttempt) -> HeartbeatCalls:
    attempts, attempt, settings = context.attempts, started_attempt.attempt, context.settings

    def renew(memory_mb: int, peak_mb: int) -> bool:
        is_cancel_requested = attempts.heartbeat(attempt, settings.lease_s, peak_mb)
        context.admission.renew(settings.lease_s, memory_mb)
        return is_cancel_requested

    return HeartbeatCalls(
        renew=renew,
        is_cancel_requested=lambda: attempts.is_canceling(attempt),
        report=lambda stage, percent: attempts.report_progress(attempt, stage, percent),
        heartbeat_s=settings.heartbeat_s,
    )


def _settle(context: Context, started_attempt: StartedAttempt, outcome: _Repaired | Failure | StopReason) -> JobState:
    attempts, attempt = context.attempts, started_attempt.attempt
    if isinstance(outcome, _Repaired) and outcome.version is not None:
        return publish_training(context, started_attempt, outcome.result, outcome.stages, outcome.version)
    if isinstance(outcome, _Repaired):
        return attempts.publish(attempt, outcome.result, outcome.stages)
    if isinstance(outcome, Failure):
        error = JobError(
            code=outcome.code, message=outcome.message, stage=outcome.stage or None, retryable=outcome.retryable
        )
        if outcome.is_outside:
            return attempts.hand_back(attempt, error, OUTAGE_DELAY_S)
        return attempts.requeue(attempt, error) if outcome.retryable else attempts.fail(attempt, error)
    if outcome is StopReason.DRAINED:
        return attempts.hand_back(attempt, _DRAINED)
    if outcome is StopReason.LOST:
        raise StaleAttemptError(f"attempt {attempt.number} of job {attempt.job_id} lost its lease")
    attempts.acknowledge_cancel(attempt)
    return JobState.CANCELED


def _resubmit(context: Context, started_attempt: StartedAttempt) -> None:
    try:
        submit_job(context.database, context.queue, started_attempt.attempt.job_id, started_attempt.attempt.number)
    except QueueUnavailableError:
        _log.warning("the queue does not answer; job %s is put into it later", started_attempt.attempt.job_id)

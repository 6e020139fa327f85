"""The tasks that the queue names by their dotted path.

A task that comes twice, or too late, does nothing: only one can start an attempt.
"""

import logging

from opentelemetry.trace import SpanKind, StatusCode
from tenacity import Retrying, retry_if_exception_type, stop_after_delay, stop_when_event_set, wait_fixed

from jobkit.errors import (
    DatabaseUnavailableError,
    MemoryFullError,
    NotFoundError,
    StaleAttemptError,
    TenantBusyError,
)
from jobkit.logs import log_about
from jobkit.requeue import GRACE_S
from quadpatch_client.schema import JobState
from worker import views
from worker.analyses import analyse
from worker.context import Context, current_context
from worker.memory import memory_given_back, submit_fitting
from worker.places import place_given_back
from worker.proofs import prove
from worker.repairs import repair
from worker.shadows import measure, note_shadow

_PAUSE_S = 0.5

_log = logging.getLogger("quadpatch.worker.jobs")


def run_job(job_id: str) -> None:
    """Start an attempt at the job whose turn it is, and work on it; the queue names one that waits."""
    context = current_context()
    try:
        started = _available(context)(
            lambda: context.attempts.start_next(job_id, context.name, context.settings.lease_s, context.admission)
        )
    except MemoryFullError as error:
        _log.info("%s", error)
        submit_fitting(context)
        return
    except (StaleAttemptError, NotFoundError, DatabaseUnavailableError, TenantBusyError) as error:
        _log.info("nothing to do: %s", error)
        return
    attempt = started.attempt
    with (
        place_given_back(context, started.tenant),
        memory_given_back(context),
        log_about(job_id=attempt.job_id, attempt=attempt.number, request_id=started.request_id),
        context.telemetry.span(
            "attempt",
            SpanKind.CONSUMER,
            started.traceparent,
            {
                "quadpatch.job_id": attempt.job_id,
                "quadpatch.attempt": attempt.number,
                "quadpatch.task": started.job.spec.task,
            },
        ) as span,
    ):
        state = repair(context, started)
        span.set_attribute("quadpatch.state", "taken away" if state is None else state.value)
        if state is None or not (state.has_result or state is JobState.CANCELED):
            span.set_status(StatusCode.ERROR, "the attempt ended without a result")
    if state is not None and state.has_result:
        note_shadow(context, attempt.job_id, started.tenant)


def inspect_mesh(mesh_id: str) -> None:
    """Analyse an uploaded mesh: format, size, boundary loops."""
    context = current_context()
    try:
        analysis = _available(context)(
            lambda: context.meshes.start_analysis(mesh_id, context.name, context.settings.lease_s)
        )
    except (StaleAttemptError, NotFoundError, DatabaseUnavailableError) as error:
        _log.info("nothing to do: %s", error)
        return
    with log_about(mesh_id=mesh_id, attempt=analysis.attempt), memory_given_back(context):
        analyse(context, analysis)


def prove_model(reference: str) -> None:
    """Prove a published version of a model, `name@version`."""
    context = current_context()
    try:
        proof = _available(context)(lambda: context.proofs.start(reference, context.name, context.settings.lease_s))
    except (StaleAttemptError, NotFoundError, DatabaseUnavailableError) as error:
        _log.info("nothing to do: %s", error)
        return
    with log_about(model=reference, attempt=proof.attempt), memory_given_back(context):
        prove(context, proof)


def make_view(view_id: str) -> None:
    """Make what a viewer asks for of a mesh, a job or a model."""
    context = current_context()
    try:
        attempt = _available(context)(lambda: context.views.start(view_id, context.name, context.settings.lease_s))
    except (StaleAttemptError, DatabaseUnavailableError) as error:
        _log.info("nothing to do: %s", error)
        return
    with log_about(view=view_id, attempt=attempt.attempt), memory_given_back(context):
        views.make_view(context, attempt)


def run_shadow(job_id: str) -> None:
    """Run a candidate on the mesh of a job that has its result, unless something else waits for a worker."""
    context = current_context()
    try:
        run = _available(context)(lambda: context.shadow_runs.start(job_id, context.name, context.settings.lease_s))
    except (StaleAttemptError, DatabaseUnavailableError) as error:
        _log.info("nothing to do: %s", error)
        return
    with log_about(job_id=job_id, model=run.candidate, attempt=run.attempt), memory_given_back(context):
        measure(context, run)


def _available(context: Context) -> Retrying:
    """Return what starts a task, and waits while the database is unavailable.

    Workers that drop their entries would soon empty the queue. After GRACE_S the dispatcher takes the entry for lost
    and puts it into the queue again, so a longer wait gains nothing.
    """
    return Retrying(
        retry=retry_if_exception_type(DatabaseUnavailableError),
        stop=stop_after_delay(GRACE_S) | stop_when_event_set(context.draining),
        wait=wait_fixed(_PAUSE_S),
        before_sleep=lambda state: _log.warning(
            "a task waits to be started: %s", state.outcome and state.outcome.exception()
        ),
        reraise=True,
    )

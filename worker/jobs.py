"""The two tasks that the queue names by their dotted path.

A task that comes twice, or too late, does nothing: only one can start an attempt.
"""

import logging

from jobkit.errors import NotFoundError, StaleAttemptError
from jobkit.logs import log_about
from jobkit.schema import JobState
from worker.analyses import analyse
from worker.context import current_context
from worker.repairs import repair

_log = logging.getLogger("quadpatch.worker.jobs")


def run_job(job_id: str) -> None:
    """Start an attempt at a job and work on it."""
    context = current_context()
    try:
        started = context.attempts.start(job_id, context.name, context.settings.lease_s)
    except (StaleAttemptError, NotFoundError) as error:
        _log.info("nothing to do: %s", error)
        return
    attempt = started.attempt
    with (
        log_about(job_id=attempt.job_id, attempt=attempt.number, request_id=started.request_id),
        context.telemetry.span(
            "attempt",
            "consumer",
            started.traceparent,
            {"quadpatch.job_id": attempt.job_id, "quadpatch.attempt": attempt.number},
        ) as span,
    ):
        state = repair(context, started)
        span.note("quadpatch.state", "taken away" if state is None else state.value)
        if state is None or not (state.has_result or state is JobState.CANCELED):
            span.fail("the attempt ended without a result")


def inspect_mesh(mesh_id: str) -> None:
    """Analyse an uploaded mesh: format, size, boundary loops."""
    context = current_context()
    try:
        analysis = context.meshes.start_analysis(mesh_id, context.name, context.settings.lease_s)
    except (StaleAttemptError, NotFoundError) as error:
        _log.info("nothing to do: %s", error)
        return
    with log_about(mesh_id=mesh_id, attempt=analysis.attempt):
        analyse(context, analysis)

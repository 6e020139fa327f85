"""The two tasks that the queue names by their dotted path.

A task that comes twice, or too late, does nothing: only one can start an attempt.
"""

import logging

from jobkit.errors import NotFoundError, StaleAttemptError
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
    repair(context, started)


def inspect_mesh(mesh_id: str) -> None:
    """Analyse an uploaded mesh: format, size, boundary loops."""
    context = current_context()
    try:
        analysis = context.meshes.start_analysis(mesh_id, context.name, context.settings.lease_s)
    except (StaleAttemptError, NotFoundError) as error:
        _log.info("nothing to do: %s", error)
        return
    analyse(context, analysis)

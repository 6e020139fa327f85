"""The life of one analysis of an uploaded mesh."""

import json
import logging

from jobkit.errors import QueueUnavailableError, StaleAttemptError
from jobkit.meshes import Analysis
from jobkit.reconcile import submit_analysis
from jobkit.schema import MeshFacts, MeshProblem
from worker.context import Context
from worker.facts import mesh_facts
from worker.failures import OUTAGE_DELAY_S, Failure, StopReason
from worker.limits import EngineLimits
from worker.outcomes import folder_with_mesh, outcome_of
from worker.pulse import Pulse, Vitals
from worker.request import FACTS_NAME
from worker.spec import inspect_request
from worker.watch import Observer, run_engine

# Finding holes takes seconds even in a mesh of millions of vertices.
_TIME_LIMIT_S = 300.0

_log = logging.getLogger("quadpatch.worker.analyses")


def analyse(context: Context, analysis: Analysis) -> None:
    """Work on a started analysis and settle it."""
    outcome = outcome_of(lambda: _run(context, analysis), f"the analysis of mesh {analysis.source.mesh_id}")
    try:
        _settle(context, analysis, outcome)
    except StaleAttemptError as error:
        _log.warning("the analysis may write no more: %s", error)
    else:
        _log.info("mesh %s: %s", analysis.source.mesh_id, _in_words(outcome))


def _run(context: Context, analysis: Analysis) -> MeshFacts:
    with Pulse(_vitals(context, analysis)) as pulse:
        return _work(context, analysis, pulse)


def _work(context: Context, analysis: Analysis, pulse: Pulse) -> MeshFacts:
    settings = context.settings
    time_limit_s = min(settings.job_time_limit_s, _TIME_LIMIT_S)
    limits = EngineLimits(time_limit_s, settings.job_memory_limit_mb, n_threads=context.n_threads)
    request = inspect_request(analysis.source, limits)

    def stop_reason() -> StopReason | None:
        return StopReason.DRAINED if context.draining.is_set() else pulse.stop_reason

    with folder_with_mesh(context, analysis.source) as folder:
        run_engine(context.nursery, request, folder, Observer(pulse.reach, stop_reason, pulse.note_memory))
        return mesh_facts(json.loads((folder / FACTS_NAME).read_text(encoding="utf-8")))


def _vitals(context: Context, analysis: Analysis) -> Vitals:
    meshes, settings = context.meshes, context.settings
    return Vitals(
        renew=lambda memory_mb: meshes.renew(analysis, settings.lease_s),
        is_canceled=lambda: False,
        report=lambda stage, percent: None,
        heartbeat_s=settings.heartbeat_s,
    )


def _settle(context: Context, analysis: Analysis, outcome: MeshFacts | Failure | StopReason) -> None:
    if isinstance(outcome, MeshFacts):
        context.meshes.publish(analysis, outcome)
        return
    if outcome is StopReason.LOST:
        raise StaleAttemptError(f"the analysis of mesh {analysis.source.mesh_id} lost its lease")
    if isinstance(outcome, Failure) and outcome.is_outside:
        # The dispatcher puts it into the queue again when the time has come.
        context.meshes.forgive(analysis, OUTAGE_DELAY_S)
        return
    if isinstance(outcome, Failure) and (not outcome.retryable or analysis.is_last):
        context.meshes.reject(analysis, MeshProblem(code=outcome.code, message=outcome.message))
        return
    if outcome is StopReason.DRAINED:
        context.meshes.forgive(analysis)
    else:
        context.meshes.release(analysis)
    try:
        submit_analysis(context.database, context.queue, analysis.source.mesh_id)
    except QueueUnavailableError:
        _log.warning("the queue does not answer; mesh %s is put into it later", analysis.source.mesh_id)


def _in_words(outcome: MeshFacts | Failure | StopReason) -> str:
    if isinstance(outcome, MeshFacts):
        return f"{outcome.vertices} vertices, {len(outcome.holes)} holes"
    return outcome.code if isinstance(outcome, Failure) else outcome.value

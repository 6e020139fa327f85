"""One analysis of an uploaded mesh, from its start to its result."""

import json

from jobkit.jobs.memory_needs import BY_GEOMETRY, expected_from_bytes
from jobkit.meshes import Analysis
from jobkit.requeue import submit_analysis
from quadpatch_client.schema import MeshFacts, MeshProblem
from worker.checks import Check, run_check
from worker.context import Context
from worker.engine.limits import EngineLimits
from worker.engine.request import FACTS_NAME
from worker.engine.supervision import Observer, run_engine
from worker.facts import mesh_facts
from worker.outcomes import folder_with_mesh
from worker.spec import inspect_request

# Finding holes takes seconds even in a mesh of millions of vertices.
_TIME_LIMIT_S = 300.0


def analyse(context: Context, analysis: Analysis) -> None:
    """Work on a started analysis and settle it."""
    meshes, mesh_id = context.meshes, analysis.source.mesh_id
    check = Check(
        subject=f"the analysis of mesh {mesh_id}",
        is_last=analysis.is_last,
        renew=lambda lease_s: meshes.renew(analysis, lease_s),
        refuse=lambda code, message: meshes.reject(analysis, MeshProblem(code=code, message=message)),
        release=lambda: meshes.release(analysis),
        forgive=lambda delay_s: meshes.forgive(analysis, delay_s),
        submit=lambda: submit_analysis(context.database, context.queue, mesh_id),
        needed_mb=expected_from_bytes(BY_GEOMETRY, analysis.size_bytes),
    )
    run_check(
        context,
        check,
        lambda observer: _work(context, analysis, observer),
        lambda facts: meshes.publish(analysis, facts),
        lambda facts: f"{facts.format}, {facts.vertices} vertices, {len(facts.holes)} holes",
    )


def _work(context: Context, analysis: Analysis, observer: Observer) -> MeshFacts:
    settings = context.settings
    time_limit_s = min(settings.job_time_limit_s, _TIME_LIMIT_S)
    limits = EngineLimits(time_limit_s, settings.job_memory_limit_mb, n_threads=context.n_threads)
    with folder_with_mesh(context, analysis.source) as folder:
        run_engine(context.fork_server, inspect_request(analysis.source, limits), folder, observer)
        return mesh_facts(json.loads((folder / FACTS_NAME).read_text(encoding="utf-8")))

"""Runs of candidates: on the mesh of a job that has its result, whose holes are compared by calibration.

What the engine makes stays in its folder and goes with it; nothing of a run reaches the job.
"""

import json
import logging
import shutil
from contextlib import suppress
from dataclasses import replace
from typing import Any

from jobkit.errors import (
    ConflictError,
    DatabaseError,
    DatabaseUnavailableError,
    JobNotFoundError,
    ModelNotFoundError,
    NotFoundError,
    StaleAttemptError,
)
from jobkit.jobs.past_jobs import kind_of
from jobkit.meshes import Meshes
from jobkit.models.registry import Registry
from jobkit.shadows.choice import pinned_beside
from jobkit.shadows.comparison import error_ratio
from jobkit.shadows.runs import Comparison, StartedRun
from quadpatch_client.schema import Method, ResolvedModel
from worker.calibrations import hand_on
from worker.checks import Check, run_check
from worker.context import Context
from worker.engine.limits import EngineLimits
from worker.engine.request import REPORT_NAME
from worker.engine.supervision import Observer, run_engine
from worker.failures import EngineFailedError, Failure
from worker.models import model_argument, network_card
from worker.outcomes import folder_with_mesh
from worker.spec import job_request

# Until a machine that had no memory to spare is asked again.
_MEMORY_PAUSE_S = 10.0
# Failures that say nothing of the candidate.
_DROPPED = ("not_calibrated", "job_missing", "mesh_missing", "candidate_missing")

_log = logging.getLogger("quadpatch.worker.shadows")


def note_shadow(context: Context, job_id: str, tenant: str) -> None:
    """Let the candidate run later on a job that has its result, where one is set; no failure here reaches the job."""
    try:
        registry = Registry(context.database.of(tenant), context.store)
        if context.shadow_runs.add(registry, context.jobs.get(job_id), tenant):
            _log.info("a candidate is to run on job %s", job_id)
    except (DatabaseUnavailableError, DatabaseError, JobNotFoundError) as error:
        _log.warning("no candidate runs on job %s: %s", job_id, error)


def measure(context: Context, run: StartedRun) -> None:
    """Work on a started run and settle it."""
    runs = context.shadow_runs
    with suppress(StaleAttemptError):
        if shutil.disk_usage(context.settings.data_dir).free < context.settings.disk_reserve_mb << 20:
            runs.drop(run, "disk_low", "the disk has no room for more than jobs")
            return
        needed_mb = _room(context, run)
        if needed_mb is None:
            runs.hand_back(run, _MEMORY_PAUSE_S)
            return
        check = Check(
            subject=f"the run of {run.candidate} on job {run.job_id}",
            is_last=run.is_last,
            renew=lambda lease_s: runs.renew(run, lease_s),
            refuse=lambda code, message: (runs.drop if code in _DROPPED else runs.fail)(run, code, message),
            release=lambda: runs.hand_back(run, is_forgiven=False),
            forgive=lambda delay_s: runs.hand_back(run, delay_s),
            submit=lambda: None,  # the dispatcher does, when nothing else waits
            needed_mb=needed_mb,
            gives_way=runs.gives_way,
        )
        run_check(
            context,
            check,
            lambda observer: _work(context, run, observer),
            lambda comparison: runs.measure(run, comparison),
            lambda comparison: f"{comparison.ratio:.3f} times the error on {comparison.holes} holes",
        )


def _room(context: Context, run: StartedRun) -> int | None:
    """Return the MiB that the engine is expected to need, if the machine has them to spare; else None."""
    try:
        job = context.jobs.get(run.job_id)
        size_bytes = Meshes(context.database.of(run.tenant)).get(job.mesh_id).size_bytes
    except NotFoundError:
        return 0  # the work says what is missing
    return context.admission.has_room(kind_of(job.spec.task, "dictionary"), size_bytes)


def _work(context: Context, run: StartedRun, observer: Observer) -> Comparison:
    settings, owner = context.settings, context.database.of(run.tenant)
    meshes, registry = Meshes(owner), Registry(owner, context.store)
    try:
        job, files = context.jobs.with_files(run.job_id)
        source = meshes.source(job.mesh_id)
        with context.store.local_file(files[REPORT_NAME]) as path:
            baseline: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    except (NotFoundError, KeyError) as error:
        raise EngineFailedError(Failure("job_missing", "the job, or what it left, was deleted")) from error
    method, candidate = _candidate(registry, job.spec.method, run.candidate)
    spec = job.spec.model_copy(update={"method": method})
    limits = EngineLimits(
        settings.job_time_limit_s,
        settings.job_memory_limit_mb,
        n_threads=context.n_threads,
        n_processes=context.n_processes,
    )
    model = model_argument(candidate, registry, context.store, context.cache_folder)
    request = replace(
        job_request(spec, source, model, limits),
        model_card=network_card(candidate, registry),
        with_preview=False,
        with_close_ups=False,
    )
    with folder_with_mesh(context, source) as folder:
        hand_on(meshes, job.mesh_id, folder)
        run_engine(context.fork_server, request, folder, observer)
        report = json.loads((folder / REPORT_NAME).read_text(encoding="utf-8"))
    found = error_ratio(report, baseline)
    if found is None:
        raise EngineFailedError(Failure("not_calibrated", "the scan has no room for holes to compare by"))
    return Comparison(*found)


def _candidate(registry: Registry, method: Method, reference: str) -> tuple[Method, ResolvedModel]:
    try:
        return pinned_beside(registry, method, reference)
    except (ModelNotFoundError, ConflictError) as error:
        raise EngineFailedError(Failure("candidate_missing", str(error))) from error

"""From a spec to a queued job: everything that is checked before a 202.

Tested in `tests/service/routes/test_jobs.py`.
"""

import logging
from dataclasses import dataclass, replace

from jobkit.batches.meshes import MeshOutline
from jobkit.database.idempotency import Idempotency
from jobkit.errors import (
    MeshNotReadyError,
    ObjectNotFoundError,
    OptionsConflictError,
    OverLimitError,
    QueueUnavailableError,
)
from jobkit.jobs.new_jobs import NewJob
from jobkit.logs import current_request_id
from jobkit.models.resolution import resolve_decoding, resolve_method
from jobkit.requeue import submit_analysis, submit_job, submit_proof
from jobkit.settings import Settings
from jobkit.telemetry import current_traceparent
from quadpatch_client.schema import (
    DictionaryMethod,
    Job,
    JobSpec,
    Limits,
    MeshState,
    Plan,
    ResolvedModel,
    conflict_of,
    identity_of,
)
from quadpatch_rules.tasks import FILL
from service.formats import clean_filename
from service.idempotency import idempotency_of
from service.mesh_checks import check_mesh, check_reference
from service.plan import check_hole_ids, make_plan, plan_of_task
from service.rules import with_rule
from service.services import Services

_logger = logging.getLogger("service")


@dataclass(frozen=True)
class Submission:
    """A spec, and who sends it under which idempotency key; reports name the key of the service by `asked_by`.

    `rerun_of` names the job that it repeats. `runs_because` says in the word of `Cache-Status` why the job runs in any
    case; without it, it takes over the result of an equal one.
    """

    spec: JobSpec
    principal: str
    key: str | None = None
    rerun_of: str | None = None
    runs_because: str | None = None
    asked_by: str | None = None

    @property
    def idempotency(self) -> Idempotency | None:
        """The key with a digest of the request, None where none was sent."""
        return idempotency_of(self.principal, self.key, self.rerun_of or "", identity_of(self.spec))


def submit(services: Services, submission: Submission) -> tuple[Job, bool]:
    """Write a job and put it into the queue.

    Returns
    -------
    Job, bool
        The job, and whether it is new.

    Raises
    ------
    MeshNotFoundError, MeshRejectedError, MeshEncodedError, MeshNotEncodedError, UnknownHoleError
        If the mesh, or the reference, can't be worked on as asked.
    ModelNotFoundError, ModelKindError, NoNetworkError, ModelNotProvenError, ModelRefusedError
        If the method's model can't be used.
    RuleNotFoundError
        If there is no rule of the spec's name.
    OptionsConflictError
        If options of the spec exclude each other, or the rule says something else.
    CallbackSecretMissingError, AddressRefusedError, TlsRequiredError, HostUnknownError
        If its callback URL can't be used.
    OverLimitError
        If the spec asks for more time or memory than the service grants.
    IdempotencyError
        If the key came before with another request.
    JobQuotaError, StorageQuotaError
        If as many jobs of the tenant wait as may, or it stores as much as it may.
    """
    idempotency = submission.idempotency
    if idempotency is not None and (earlier := services.jobs.earlier(idempotency)) is not None:
        return earlier, False
    services.full_tenants.check(services.database)
    spec = with_rule(services, submission.spec)
    model = check_spec(services, spec)
    services.callbacks.check(spec.callback_url)
    new = NewJob(
        spec.model_copy(update={"mesh_name": clean_filename(spec.mesh_name)}),
        model,
        services.settings.max_attempts,
        submission.rerun_of,
        current_request_id(),
        current_traceparent(),
        asked_by=submission.asked_by,
    )
    may_reuse = submission.runs_because is None and _is_in_store(services, new)
    return accept(services, replace(new, may_reuse=may_reuse), idempotency)


def accept(services: Services, new: NewJob, idempotency: Idempotency | None) -> tuple[Job, bool]:
    """Write a job that was checked, and put it into the queue; returns as `submit`, and raises as `Jobs.create`."""
    job, is_new = services.jobs.create(new, idempotency)
    if is_new and not job.state.is_terminal:
        try:
            is_urgent = job.spec.priority == "interactive"
            submit_job(services.database, services.queue, job.id, job.attempt, at_front=is_urgent)
        except QueueUnavailableError as error:
            # The row of the job is committed; the dispatcher refills the queue from it as soon as the queue answers.
            _logger.warning("job %s waits for the queue: %s", job.id, error)
    return job, is_new


def plan(services: Services, spec: JobSpec) -> Plan:
    """Return what a job would do, without making it; raises as `submit`, and MeshNotReadyError."""
    spec = with_rule(services, spec)
    model = check_spec(services, spec)
    mesh = services.meshes.get(spec.mesh_id)
    if mesh.state is MeshState.ANALYSING:
        raise MeshNotReadyError(f"mesh {mesh.id} is still being analysed; ask again, or send Prefer: wait=10")
    if spec.task == FILL and mesh.facts is not None:
        return make_plan(spec, mesh.facts, model, services.settings)
    return plan_of_task(spec, model, services.settings)


def request_analysis(services: Services, mesh_id: str) -> None:
    """Put a fresh mesh into the queue for its analysis."""
    try:
        submit_analysis(services.database, services.queue, mesh_id)
    except QueueUnavailableError as error:
        _logger.warning("mesh %s waits for the queue: %s", mesh_id, error)


def request_proof(services: Services, reference: str) -> None:
    """Put a published version of a model into the queue for its proof."""
    try:
        submit_proof(services.database, services.queue, reference)
    except QueueUnavailableError as error:
        _logger.warning("model %s waits for the queue: %s", reference, error)


def _is_in_store(services: Services, new: NewJob) -> bool:
    """Tell whether no file is lost of the result that the job would take over."""
    try:
        for key in services.jobs.files_to_reuse(new):
            services.store.size(key)
    except ObjectNotFoundError:
        return False
    return True


def check_spec(services: Services, spec: JobSpec) -> ResolvedModel:
    """Check all that a job names, and return the model that it means now; raises as `submit`."""
    _check_conflicts(spec, services.settings)
    mesh = services.meshes.get(spec.mesh_id)
    check_mesh(MeshOutline.of(mesh), spec)
    if spec.reference_id is not None:
        check_reference(services.meshes.get(spec.reference_id))
    if mesh.facts is not None:
        check_hole_ids(spec.holes, mesh.facts)
    encoded = None if mesh.facts is None else mesh.facts.encoded
    if encoded is not None and isinstance(spec.method, DictionaryMethod):
        return resolve_decoding(services.registry, spec.method, encoded)
    return resolve_method(services.registry, spec.method)


def check_options(services: Services, spec: JobSpec) -> ResolvedModel:
    """Check what a job asks for whatever its mesh, and return the model that it means now."""
    _check_conflicts(spec, services.settings)
    return resolve_method(services.registry, spec.method)


def _check_conflicts(spec: JobSpec, settings: Settings) -> None:
    conflict = conflict_of(spec)
    if conflict is not None:
        raise OptionsConflictError(conflict)
    check_limits(spec.limits, settings)


def check_limits(limits: Limits, settings: Settings) -> None:
    """Raise OverLimitError where ceilings lie above those of the service."""
    limits_of_service: list[tuple[str, float | None, float]] = [
        ("time_s", limits.time_s, settings.job_time_limit_s),
        ("memory_mb", limits.memory_mb, settings.job_memory_limit_mb),
    ]
    for name, requested, most in limits_of_service:
        if requested is not None and requested > most:
            raise OverLimitError(f"limits.{name} is {requested}; this service grants at most {most}")

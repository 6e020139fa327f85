"""From a request to a batch: everything that is checked before its 202.

Tested in `tests/service/routes/test_batches.py`.
"""

import logging
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import TypeVar

from jobkit.batches.batches import BatchFacts
from jobkit.batches.meshes import MeshOutline, matching, outlines
from jobkit.database.idempotency import Idempotency, is_repeated
from jobkit.database.searching import Period
from jobkit.egress import destination_of
from jobkit.errors import BatchSizeError, MeshNotFoundError, QueueUnavailableError
from jobkit.jobs.new_jobs import NewJob
from jobkit.logs import current_request_id
from jobkit.meshes import MeshSearch
from jobkit.requeue import MOST_ENQUEUED, submit_jobs
from jobkit.telemetry import current_traceparent
from quadpatch_client.schema import (
    MOST_JOBS,
    Batch,
    JobSpec,
    JobState,
    MeshFilter,
    NewBatch,
    RepairSpec,
    ResolvedModel,
    Rule,
)
from service.formats import clean_filename
from service.mesh_checks import check_mesh
from service.rules import with_rule
from service.services import Services
from service.submission import check_options, check_spec

Spec = TypeVar("Spec", bound=RepairSpec)
_logger = logging.getLogger("service")


@dataclass(frozen=True)
class BatchRequest:
    """A request for a batch: its idempotency, whether its jobs may take over results of equal ones, and its key."""

    idempotency: Idempotency | None
    may_reuse: bool
    asked_by: str | None = None


def submit_batch(services: Services, new: NewBatch, request: BatchRequest) -> tuple[Batch, bool]:
    """Write a batch with its jobs, and put them into the queue.

    Returns
    -------
    Batch, bool
        The batch, and whether it is new.

    Raises
    ------
    BatchSizeError
        If no mesh fits the filter, or too many do.
    CallbackSecretMissingError, AddressRefusedError, TlsRequiredError, HostUnknownError
        If a callback URL can't be used.
    IdempotencyError
        If the key came before with another request.
    Also everything that `service.submission.submit` raises, for the first job that can't be started.
    """
    facts = BatchFacts(new.label, new.metadata, new.callback_url)
    if is_repeated(services.database, request.idempotency):
        return services.batches.create(facts, list, request.idempotency)
    return _create(services, facts, [(spec, None) for spec in _specs_of(services, new)], request)


def rerun_batch(
    services: Services, batch_id: str, states: Iterable[JobState], request: BatchRequest
) -> tuple[Batch, bool]:
    """Start a batch of those jobs of another one that ended in some states; raises as `submit_batch` does.

    Raises
    ------
    BatchNotFoundError
        If there is no such batch.
    BatchSizeError
        If none of its jobs ended so.
    """
    old = services.batches.get(batch_id)
    facts = BatchFacts(old.label, old.metadata, old.callback_url, batch_id)
    if is_repeated(services.database, request.idempotency):
        return services.batches.create(facts, list, request.idempotency)
    ids = services.batches.job_ids(batch_id, list(states))
    if not ids:
        raise BatchSizeError(f"no job of batch {batch_id} is to be run again")
    jobs = services.jobs.get_many(ids)
    specs = [(jobs[job_id].spec, job_id) for job_id in ids if job_id in jobs]
    return _create(services, facts, specs, request)


def _specs_of(services: Services, new: NewBatch) -> list[JobSpec]:
    if new.jobs is not None:
        known: dict[str, Rule] = {}
        return [with_rule(services, _as_of_a_batch(spec), known) for spec in new.jobs]
    mesh_ids = new.mesh_ids if new.filter is None else _filtered(services, new.filter)
    shared = with_rule(services, _as_of_a_batch(new.spec))
    fields = {name: getattr(shared, name) for name in RepairSpec.model_fields}
    # They were checked once; nested options are shared by all of them.
    return [JobSpec.model_construct(mesh_id=mesh_id, mesh_name=None, **fields) for mesh_id in mesh_ids or ()]


def _as_of_a_batch(spec: Spec) -> Spec:
    update: dict[str, object] = {} if "priority" in spec.model_fields_set else {"priority": "bulk"}
    if isinstance(spec, JobSpec):
        update["mesh_name"] = clean_filename(spec.mesh_name)
    return spec.model_copy(update=update)


def _filtered(services: Services, wanted: MeshFilter) -> list[str]:
    period = Period(wanted.created_since, wanted.created_before)
    search = MeshSearch(tuple(wanted.state), wanted.filename, wanted.format, period)
    mesh_ids = matching(services.database, search, MOST_JOBS + 1)
    if not mesh_ids:
        raise BatchSizeError("no mesh fits the filter")
    if len(mesh_ids) > MOST_JOBS:
        raise BatchSizeError(f"more than {MOST_JOBS} meshes fit the filter, which is the limit of a batch")
    return mesh_ids


def _create(
    services: Services, facts: BatchFacts, specs: Sequence[tuple[JobSpec, str | None]], request: BatchRequest
) -> tuple[Batch, bool]:
    services.full_tenants.check(services.database)
    _check_callbacks(services, {facts.callback_url, *(spec.callback_url for spec, _ in specs)})
    checks = _Checks(services, outlines(services.database, {spec.mesh_id for spec, _ in specs}))
    origin = (current_request_id(), current_traceparent(), request.may_reuse, request.asked_by)
    most = services.settings.max_attempts
    jobs = [NewJob(spec, checks.model_of(spec), most, rerun_of, *origin) for spec, rerun_of in specs]
    batch, is_new = services.batches.create(facts, lambda: jobs, request.idempotency)
    if is_new:
        try:
            ids = services.batches.job_ids(batch.id)[:MOST_ENQUEUED]
            submit_jobs(services.database, services.queue, [(job_id, 0) for job_id in ids])
        except QueueUnavailableError as error:
            # The dispatcher puts them, and all others, into the queue.
            _logger.warning("jobs of batch %s wait for the queue: %s", batch.id, error)
    return batch, is_new


def _check_callbacks(services: Services, urls: Iterable[str | None]) -> None:
    """Check one URL for each host: nothing else decides."""
    destinations = {url: destination_of(url) for url in urls if url is not None}
    by_host = {(destination.scheme, destination.authority): url for url, destination in destinations.items()}
    for url in by_host.values():
        services.callbacks.check(url)


@dataclass
class _Checks:
    """Checks of specs that mostly are the same but for their mesh."""

    services: Services
    meshes: dict[str, MeshOutline]
    models: dict[str, ResolvedModel] = field(default_factory=dict)

    def model_of(self, spec: JobSpec) -> ResolvedModel:
        """Check a spec, and return the model that it means now."""
        mesh = self.meshes.get(spec.mesh_id)
        if mesh is None:
            raise MeshNotFoundError(f"there is no mesh {spec.mesh_id}")
        check_mesh(mesh, spec)
        if _needs_facts(spec):
            return check_spec(self.services, spec)
        options = spec.model_dump_json(include={*RepairSpec.model_fields} - {"label", "metadata", "callback_url"})
        if options not in self.models:
            self.models[options] = check_options(self.services, spec)
        return self.models[options]


def _needs_facts(spec: JobSpec) -> bool:
    """Tell whether the check of a spec needs more of its mesh than the outline, or another mesh."""
    holes = spec.holes
    names_holes = holes.ids or holes.bridges or any(rule.ids for rule in holes.rules)
    return bool(names_holes or spec.task == "decode" or spec.reference_id)

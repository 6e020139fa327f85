"""From what is to be learned to a queued training: everything that is checked before a 202.

Tested in `tests/service/routes/test_trainings.py`.
"""

from jobkit.access.keys import Holder
from jobkit.database.searching import Period
from jobkit.errors import NoNetworkWorkerError, NoTrainingMeshError
from jobkit.jobs.new_jobs import NewJob
from jobkit.jobs.trainings import check_names
from jobkit.jobs.turns import NETWORK_KIND
from jobkit.logs import current_request_id
from jobkit.meshes import MeshSearch
from jobkit.queue import NETWORKS
from jobkit.telemetry import current_traceparent
from quadpatch_client.schema import Job, MeshState, NewTraining, ResolvedModel, TrainingFilter
from service.idempotency import idempotency_of
from service.mesh_checks import check_reference
from service.services import Services
from service.submission import accept, check_limits

_ENCODED = "qpz"


def submit_training(services: Services, new: NewTraining, principal: Holder, key: str | None) -> tuple[Job, bool]:
    """Write a training and put it into the queue.

    Returns
    -------
    Job, bool
        The job, and whether it is new.

    Raises
    ------
    MeshNotFoundError, MeshRejectedError, MeshEncodedError, NoTrainingMeshError
        If a mesh is not there or can't be learned from, or a filter finds none.
    NoNetworkWorkerError
        If a network is to be fitted, and no running worker can do that.
    QueueUnavailableError
        If a network is to be fitted, and the queue does not answer which workers run.
    NameTakenError
        If the model can't have that name.
    OverLimitError
        If it asks for more time or memory than the service grants.
    IdempotencyError
        If the key came before with another request.
    """
    # Of the request, not of the meshes that its filter finds: a repeated request stays the same.
    idempotency = idempotency_of(principal.key_id, key, "create_training", new.model_dump_json())
    if idempotency is not None and (earlier := services.jobs.earlier(idempotency)) is not None:
        return earlier, False
    check_limits(new.limits, services.settings)
    if new.kind == "network" and NETWORKS not in services.queue.abilities():
        raise NoNetworkWorkerError(
            "no worker that runs can fit networks: they need the extra 'networks' (torch); dictionaries need none"
        )
    sizes = _listed(services, new.meshes) if new.filter is None else _found(services, new.filter)
    spec = new.job_spec(list(sizes), max(sizes, key=lambda mesh_id: sizes[mesh_id]))
    if spec.train is not None:
        check_names(services.database, spec.train)
    model = ResolvedModel(requested=new.model, kind=NETWORK_KIND if new.kind == "network" else "none")
    job = NewJob(
        spec,
        model,
        services.settings.max_attempts,
        request_id=current_request_id(),
        traceparent=current_traceparent(),
        asked_by=principal.public_name,
    )
    return accept(services, job, idempotency)


def _listed(services: Services, mesh_ids: list[str] | None) -> dict[str, int]:
    """Return the bytes of meshes by their ids; one that is still to be analysed may turn out to be none."""
    meshes = [services.meshes.get(mesh_id) for mesh_id in mesh_ids or ()]
    for mesh in meshes:
        check_reference(mesh, "mesh")
    return {mesh.id: mesh.size_bytes for mesh in meshes}


def _found(services: Services, sought: TrainingFilter) -> dict[str, int]:
    """Return the same of the meshes that a filter finds; those that nothing can be learned from are left out."""
    period = Period(sought.created_since, sought.created_before)
    search = MeshSearch((MeshState.READY,), sought.filename, sought.format, period)
    page = services.meshes.page(sought.most, None, search)
    sizes = {mesh.id: mesh.size_bytes for mesh in page.items if mesh.format != _ENCODED}
    if not sizes:
        raise NoTrainingMeshError("the filter finds no mesh that is analysed and that can be learned from")
    return sizes

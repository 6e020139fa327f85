"""One attempt at a view, from its start to its end."""

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

from jobkit.errors import MeshNotFoundError, NotFoundError, ObjectDamagedError
from jobkit.jobs.memory_needs import BY_GEOMETRY, expected_from_bytes
from jobkit.meshes import MeshSource
from jobkit.storage.base import CHUNK_BYTES, StoredObject
from jobkit.storage.digests import verified_file
from jobkit.storage.removals import assure
from jobkit.views import VIEW_PREFIX, ViewAttempt, ViewOrder
from quadpatch_client.schema import Job, ResolvedModel, ResultFile
from worker.checks import Check, run_check
from worker.context import Context
from worker.engine.limits import EngineLimits
from worker.engine.request import MESH_FOLDER, REFERENCE_FOLDER, VIEW_NAME, EngineRequest
from worker.engine.supervision import Observer, run_engine
from worker.failures import EngineFailedError, Failure
from worker.folders import request_folder
from worker.models import model_argument
from worker.outcomes import linked
from worker.spec import source_name

# A person waits for it. The finer level of a scan of ten million triangles takes a quarter of a minute.
_TIME_LIMIT_S = 300.0
# Files of a job that its view is made of.
_ROLES = ("result", "report")


def make_view(context: Context, attempt: ViewAttempt) -> None:
    """Work on a started view and settle it."""
    views, order = context.views, attempt.order
    check = Check(
        subject=f"view {attempt.view_id}",
        is_last=attempt.is_last,
        renew=lambda lease_s: views.renew(attempt, lease_s),
        refuse=lambda code, message: views.refuse(attempt, code, message),
        release=lambda: views.release(attempt),
        forgive=lambda delay_s: views.forgive(attempt, delay_s),
        submit=lambda: views.resubmit(context.queue, attempt),
        needed_mb=expected_from_bytes(BY_GEOMETRY, _size_of(context, order)),
    )
    run_check(
        context,
        check,
        lambda observer: _work(context, order, observer),
        lambda stored: views.publish(attempt, stored),
        lambda stored: f"{order.kind}, {stored.size_bytes} bytes",
    )


def _size_of(context: Context, order: ViewOrder) -> int:
    """Return the bytes of what is read; 0 where it is gone meanwhile, which the work finds out."""
    try:
        meshes = [mesh_id for mesh_id in (order.mesh_id, order.reference_id) if mesh_id is not None]
        n_bytes = sum(context.meshes.get(mesh_id).size_bytes for mesh_id in meshes)
        if order.job_id is not None:
            n_bytes += sum(file.size_bytes for file in _files(context.jobs.get(order.job_id)).values())
    except NotFoundError:
        return 0
    return n_bytes


def _work(context: Context, order: ViewOrder, observer: Observer) -> StoredObject:
    limits = EngineLimits(
        min(context.settings.job_time_limit_s, _TIME_LIMIT_S),
        context.settings.job_memory_limit_mb,
        n_threads=context.n_threads,
    )
    with _folder_with_inputs(context, order) as (folder, inputs):
        options = {"kind": order.kind, "level": order.level}
        request = EngineRequest(task="view", output=VIEW_NAME, options=options, limits=limits, **inputs)
        run_engine(context.fork_server, request, folder, observer)
        with context.store.writer(VIEW_PREFIX) as writer, (folder / VIEW_NAME).open("rb") as made:
            while chunk := made.read(CHUNK_BYTES):
                writer.write(chunk)
            stored = writer.commit()
    assure(context.database, context.store, stored.key)
    return stored


@contextmanager
def _folder_with_inputs(context: Context, order: ViewOrder) -> Iterator[tuple[Path, dict[str, Any]]]:
    """Make the folder of the request, and say in the fields of a request what lies in it.

    Raises
    ------
    EngineFailedError
        If something is gone from the store, or its bytes are not those that were stored.
    """
    with request_folder(context.work_folder) as folder, ExitStack() as files:
        inputs: dict[str, Any] = {"source": "", "model": _model(context, order)}
        if order.job_id is not None:
            inputs["meshes"] = files.enter_context(_linked_results(context, order.job_id, folder))
        meshes = (("source", order.mesh_id, MESH_FOLDER), ("reference", order.reference_id, REFERENCE_FOLDER))
        for name, mesh_id, subfolder in meshes:
            if mesh_id is not None:
                source = _source(context, mesh_id)
                files.enter_context(linked(context, source, folder, subfolder, f"the {name}"))
                inputs[name] = source_name(source, subfolder)
        yield folder, inputs


def _model(context: Context, order: ViewOrder) -> str:
    """Return the path of the model that is drawn; empty where none is."""
    if order.model_name is None or order.model_version is None:
        return ""
    kind = context.registry.resolve(f"{order.model_name}@{order.model_version}").kind
    pinned = ResolvedModel(requested=order.model_name, kind=kind, name=order.model_name, version=order.model_version)
    return model_argument(pinned, context.registry, context.store, context.cache_folder)


def _source(context: Context, mesh_id: str) -> MeshSource:
    try:
        return context.meshes.source(mesh_id)
    except MeshNotFoundError as error:
        raise EngineFailedError(Failure("mesh_missing", "the mesh was deleted")) from error


def _files(job: Job) -> dict[str, ResultFile]:
    """Return the files of a job that its view is made of, by their roles."""
    return {file.role: file for file in (job.result.files if job.result else []) if file.role in _ROLES}


@contextmanager
def _linked_results(context: Context, job_id: str, folder: Path) -> Iterator[dict[str, str]]:
    """Link the verified result and report of a job, each into a folder of its own; yield their names by role."""
    with ExitStack() as files:
        names = {}
        try:
            job, keys = context.jobs.with_files(job_id)
            for role, file in _files(job).items():
                path = files.enter_context(verified_file(context.store, keys[file.name], file.sha256))
                (folder / role).mkdir()
                names[role] = f"{role}/{file.name}"
                (folder / names[role]).symlink_to(path)
        except NotFoundError as error:
            raise EngineFailedError(Failure("result_missing", "the result is gone from the store")) from error
        except ObjectDamagedError as error:
            message = "the bytes of the result in the store are not those that were stored"
            raise EngineFailedError(Failure("object_damaged", message)) from error
        yield names

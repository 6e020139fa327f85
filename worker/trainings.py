"""One attempt at a training: its meshes for the engine, and what the engine learned for the registry.

Tested in `tests/integration/test_trainings_over_http.py`.
"""

from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager
from functools import partial
from pathlib import Path

from jobkit.database.tables import ModelRow
from jobkit.errors import MeshNotFoundError, NameTakenError, RowConflictError
from jobkit.jobs.attempts import Attempts, StartedAttempt
from jobkit.jobs.stage_seconds import StageSeconds
from jobkit.jobs.trainings import register_learned
from jobkit.meshes import Meshes, MeshSource
from jobkit.models.registry import MODEL_PREFIX, MOST_CONFLICTS, Registry
from jobkit.storage.base import CHUNK_BYTES, StoredObject
from quadpatch_client.schema import JobError, JobResult, JobState, TrainedKind, TrainingSpec
from quadpatch_rules.tasks import DONE, TRAIN
from worker.context import Context
from worker.engine.limits import EngineLimits
from worker.engine.request import EngineRequest
from worker.failures import EngineFailedError, Failure
from worker.folders import request_folder
from worker.outcomes import linked
from worker.spec import source_name, tighter_limits

_SUFFIXES: Mapping[TrainedKind, str] = {"dictionary": "safetensors", "network": "onnx"}
_SUBFOLDER = "mesh-"


def meshes_of(context: Context, started_attempt: StartedAttempt) -> list[MeshSource]:
    """Return where the meshes of a training lie; raise EngineFailedError."""
    meshes = Meshes(context.database.of(started_attempt.tenant))
    try:
        return [meshes.source(mesh_id) for mesh_id in _training(started_attempt).meshes]
    except MeshNotFoundError as error:
        raise EngineFailedError(Failure("mesh_missing", str(error))) from error


def training_request(started_attempt: StartedAttempt, meshes: list[MeshSource], limits: EngineLimits) -> EngineRequest:
    """Translate a training; `limits` are those of the worker, which the spec may only lower."""
    spec, training = started_attempt.job.spec, _training(started_attempt)
    options = training.network if training.kind == "network" else training.options
    files = {source.mesh_id: source_name(source, f"{_SUBFOLDER}{i}") for i, source in enumerate(meshes)}
    return EngineRequest(
        task="train",
        source=next(iter(files.values())),
        output=_learned_name(training),
        options={"name": training.model, "seed": spec.seed, **options.model_dump()},
        limits=tighter_limits(limits, spec),
        meshes=files,
    )


@contextmanager
def folder_with_meshes(context: Context, meshes: list[MeshSource]) -> Iterator[Path]:
    """Make the folder of a request with the meshes in it, each in a folder of its own; raises as `folder_with_mesh`."""
    with request_folder(context.work_folder) as folder, ExitStack() as files:
        for i, source in enumerate(meshes):
            files.enter_context(linked(context, source, folder, f"{_SUBFOLDER}{i}", f"mesh {source.mesh_id}"))
        yield folder


def prepared_version(context: Context, started_attempt: StartedAttempt, folder: Path) -> ModelRow:
    """Store the learned file, and return the version that the training is to publish; no row names the file yet.

    It needs no proof: the engine has proven a network, and repaired meshes with a dictionary. Raises UnusableModelError
    where the engine wrote no model.
    """
    learned = folder / _learned_name(_training(started_attempt))
    with learned.open("rb") as source, context.store.writer(MODEL_PREFIX) as writer:
        while chunk := source.read(CHUNK_BYTES):
            writer.write(chunk)
        stored: StoredObject = writer.commit()
    registry = Registry(context.database.of(started_attempt.tenant), context.store)
    return registry.prepared(_training(started_attempt).model, stored, is_proven=True)


def publish_training(
    context: Context, started_attempt: StartedAttempt, result: JobResult, stages: StageSeconds, row: ModelRow
) -> JobState:
    """Publish the result and the version together; returns and raises as `Attempts.publish`.

    The training fails where the name of its model has been taken meanwhile.
    """
    attempts = Attempts(context.database.of(started_attempt.tenant))
    complete = partial(register_learned, row=row, train=_training(started_attempt))
    for _ in range(MOST_CONFLICTS):
        try:
            return attempts.publish(started_attempt.attempt, result, stages, complete)
        except RowConflictError:
            continue  # another version was published at the same moment: now the next number is another one
        except NameTakenError as error:
            return attempts.fail(started_attempt.attempt, JobError(code="model_name_taken", message=str(error)))
    return attempts.publish(started_attempt.attempt, result, stages, complete)


def _learned_name(training: TrainingSpec) -> str:
    return f"{DONE[TRAIN]}.{_SUFFIXES[training.kind]}"


def _training(started_attempt: StartedAttempt) -> TrainingSpec:
    training = started_attempt.job.spec.train
    if training is None:
        raise EngineFailedError(Failure("engine_error", "the job says nothing of what is to be learned"))
    return training

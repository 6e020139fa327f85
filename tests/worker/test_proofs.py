"""A worker proves what was published: each model in an engine of its own, and settles it once.

Also tests `worker.checks`.
"""

import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from onnx import TensorProto, helper, numpy_helper

from jobkit.database.session import Database
from jobkit.errors import ModelNotFoundError, StaleAttemptError
from jobkit.jobs.new_jobs import NewJob
from jobkit.models.lifetime import delete_version, deprecate_version
from jobkit.models.proofs import MAX_PROOFS
from jobkit.models.registry import MODEL_PREFIX, Registry
from jobkit.models.resolution import resolve_method
from jobkit.requeue import submit_proof
from jobkit.settings import Settings
from jobkit.storage.base import ObjectStore
from quadpatch_client.schema import JobSpec, ModelProblem, ModelState, ModelVersion
from tests.integration.conftest import ply_bytes, punched_relief
from tests.quadpatch.inpainters.test_onnx_network import PAPER, N, write_network
from tests.worker.test_repairs import working
from worker.context import Context
from worker.jobs import prove_model, run_job


@pytest.fixture
def context(settings: Settings, database: Database, store: ObjectStore) -> Iterator[Context]:
    with working(settings, database, store) as context:
        yield context


def publish(registry: Registry, store: ObjectStore, data: bytes, card: dict[str, Any] | None = None) -> ModelVersion:
    with store.writer(MODEL_PREFIX) as writer:
        writer.write(data)
        return registry.publish("parts", writer.commit(), card)[0]


def network(folder: Path, *, gain: float = 1.0, card: dict[str, Any] | None = None) -> bytes:
    return write_network(folder / "copy.onnx", card, 1, gain=gain).read_bytes()


def test_a_dictionary_is_ready_once_it_is_proven(context: Context, dictionary_bytes: Callable[[int], bytes]) -> None:
    assert publish(context.registry, context.store, dictionary_bytes(1)).state is ModelState.PROVING
    prove_model("parts@1")
    proven = context.registry.resolve("parts@1")
    assert (proven.state, proven.problem) == (ModelState.READY, None)


def test_a_network_is_proven_by_the_card_that_came_beside_it(context: Context, tmp_path: Path) -> None:
    publish(context.registry, context.store, network(tmp_path), PAPER)
    prove_model("parts@1")
    assert context.registry.resolve("parts@1").state is ModelState.READY


def test_a_refusal_names_the_model_and_the_check_and_a_better_card_gets_another_proof(
    context: Context, tmp_path: Path
) -> None:
    publish(context.registry, context.store, network(tmp_path), {**PAPER, "patch_resolution": 2 * N})
    prove_model("parts@1")
    refused = context.registry.resolve("parts@1")
    assert refused.state is ModelState.REFUSED
    assert refused.problem is not None
    assert refused.problem.code == "unusable_model"
    assert refused.problem.message.startswith("parts@1 takes tensor(float)")
    again = publish(context.registry, context.store, network(tmp_path), PAPER)
    assert (again.version, again.state, again.problem) == (1, ModelState.PROVING, None)
    prove_model("parts@1")
    assert context.registry.resolve("parts@1").state is ModelState.READY


def test_a_network_that_never_ends_is_ended(settings: Settings, database: Database, store: ObjectStore) -> None:
    with working(settings.model_copy(update={"job_time_limit_s": 1.0}), database, store) as context:
        publish(context.registry, context.store, endless_network())
        prove_model("parts@1")
        problem = context.registry.resolve("parts@1").problem
    assert problem is not None
    assert problem.code == "time_limit_exceeded"


def endless_network() -> bytes:
    """Return a network whose answer is the input, after a loop of 2**62 rounds."""

    def value(name: str, form: int, shape: list[Any]) -> Any:
        return helper.make_tensor_value_info(name, form, shape)

    shape = ["batch", 1, N, N]
    body = helper.make_graph(
        [helper.make_node("Identity", ["go"], ["goes"]), helper.make_node("Tanh", ["state"], ["next"])],
        "body",
        [
            value("i", TensorProto.INT64, []),
            value("go", TensorProto.BOOL, []),
            value("state", TensorProto.FLOAT, shape),
        ],
        [value("goes", TensorProto.BOOL, []), value("next", TensorProto.FLOAT, shape)],
    )
    graph = helper.make_graph(
        [helper.make_node("Loop", ["rounds", "yes", "patches"], ["clean"], body=body)],
        "endless",
        [value("patches", TensorProto.FLOAT, shape)],
        [value("clean", TensorProto.FLOAT, shape)],
        [numpy_helper.from_array(np.array(2**62), "rounds"), numpy_helper.from_array(np.array(True), "yes")],
    )
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 17)], ir_version=8)
    helper.set_model_props(model, {"card": json.dumps(PAPER)})
    return bytes(model.SerializeToString())


def test_a_model_whose_proofs_crash_is_refused_in_the_end(
    settings: Settings, database: Database, store: ObjectStore, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PYTHONPATH", str(Path(__file__).parent))
    with working(settings, database, store, "engine_killed_while_drawing") as context:
        publish(context.registry, context.store, network(tmp_path, card=PAPER))
        for _ in range(MAX_PROOFS):
            assert context.registry.resolve("parts@1").state is ModelState.PROVING
            prove_model("parts@1")
        refused = context.registry.resolve("parts@1")
    assert refused.problem is not None
    assert refused.problem.code == "engine_crashed"


def test_only_the_latest_proof_may_write(context: Context, dictionary_bytes: Callable[[int], bytes]) -> None:
    publish(context.registry, context.store, dictionary_bytes(1))
    proof = context.proofs.start("parts@1", "w-1", 0.0)
    context.proofs.renew(context.proofs.start("parts@1", "w-2", 60.0), 60.0)
    with pytest.raises(StaleAttemptError):
        context.proofs.accept(proof)
    with pytest.raises(StaleAttemptError):
        context.proofs.start("parts@1", "w-3", 60.0)
    assert context.registry.resolve("parts@1").state is ModelState.PROVING


def test_a_version_that_is_deleted_meanwhile_is_left_alone(
    context: Context, dictionary_bytes: Callable[[int], bytes]
) -> None:
    publish(context.registry, context.store, dictionary_bytes(1))
    proof = context.proofs.start("parts@1", "w-1", 60.0)
    delete_version(context.database, "parts", 1)
    with pytest.raises(StaleAttemptError):
        context.proofs.refuse(proof, ModelProblem(code="unusable_model", message="no"))
    prove_model("parts@1")
    submit_proof(context.database, context.queue, "parts@1")
    with pytest.raises(ModelNotFoundError):
        context.registry.resolve("parts@1")


def test_a_job_with_a_deprecated_model_ends_with_a_warning(
    context: Context, dictionary_bytes: Callable[[int], bytes]
) -> None:
    publish(context.registry, context.store, dictionary_bytes(1))
    prove_model("parts@1")
    deprecate_version(context.database, "parts", 1, "parts@2 does better")
    with context.store.writer("meshes") as writer:
        writer.write(ply_bytes(*punched_relief(20, 1)))
        mesh = context.meshes.add(writer.commit(), "scan.ply", "ply")[0]
    method = {"method": "dictionary", "model": "parts@1"}
    spec = JobSpec.model_validate({"mesh_id": mesh.id, "method": method, "output": {"preview": False}})
    job = context.jobs.create(NewJob(spec, resolve_method(context.registry, spec.method), 3))[0]
    assert job.model.deprecated_at is not None
    run_job(job.id)
    ended = context.jobs.get(job.id)
    assert ended.result is not None, ended.error
    assert "the model parts@1 is deprecated: parts@2 does better" in ended.result.warnings

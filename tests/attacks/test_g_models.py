"""Letter G: what a published model, its card and an alias may be."""

import json
import random
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from onnx import TensorProto, helper
from sqlalchemy import text
from starlette.testclient import TestClient

from jobkit.database.session import Database
from jobkit.errors import ModelKindError, UnusableModelError
from jobkit.jobs.jobs import Jobs
from jobkit.jobs.new_jobs import NewJob
from jobkit.jobs.timeouts import TimeLimits
from jobkit.meshes import Meshes
from jobkit.models.header import MAX_CARD_BYTES
from jobkit.models.registry import MODEL_PREFIX, Registry
from jobkit.queue import TaskQueue, model_entry
from jobkit.requeue import reconcile
from jobkit.settings import Settings
from jobkit.storage.base import ObjectStore
from quadpatch.inpainters.model_file import SHIPPED_MODELS
from quadpatch_client.schema import JobSpec, ModelState, ResolvedModel
from service.app import create_app
from tests.integration.conftest import ply_bytes, punched_relief
from tests.quadpatch.inpainters.test_onnx_network import N, write_network
from tests.worker.test_repairs import working
from worker.jobs import prove_model, run_job

Files = dict[str, tuple[str, bytes] | tuple[None, str, str]]
CARD = {"patch_resolution": N, "recipe": "paper", "height_low": -0.5, "height_high": 0.5}


@pytest.fixture
def registry(database: Database, store: ObjectStore) -> Registry:
    return Registry(database, store)


def test_the_card_beside_a_network_reaches_the_engine(
    settings: Settings, database: Database, store: ObjectStore, tmp_path: Path
) -> None:
    network = write_network(tmp_path / "copy.onnx", None, 1)
    with TestClient(create_app(settings), base_url="http://127.0.0.1") as client:
        card = (None, json.dumps(CARD), "application/json")
        files: Files = {"artifact": ("copy.onnx", network.read_bytes()), "card": card}
        answer = client.post("/v1/models/copy/versions", files=files, headers={"Prefer": "wait=0"})
        assert answer.status_code == 202
    with store.writer("meshes") as writer:
        writer.write(ply_bytes(*punched_relief(40, 1)))
        mesh = Meshes(database).add(writer.commit(), "scan.ply", "ply")[0]
    method = {"method": "cnn", "model": "copy@1"}
    spec = JobSpec.model_validate({"mesh_id": mesh.id, "method": method, "output": {"preview": False}})
    pinned = ResolvedModel(requested="copy@1", kind="autoencoder", name="copy", version=1)
    job = Jobs(database).create(NewJob(spec, pinned, 3))[0]
    with working(settings, database, store) as context:
        prove_model("copy@1")
        assert context.registry.usable("copy@1").version == 1
        run_job(job.id)
        ended = context.jobs.get(job.id)
    assert ended.state.has_result, ended.error


@pytest.mark.parametrize(
    "card",
    [
        {"note": "x" * MAX_CARD_BYTES},
        {"metrics": {str(i): 0.5 for i in range(10_000)}},
        {"note": float("nan")},
        {"metrics": {"error": float("inf")}},
        {"note": "\ud800"},
        {"\udfff": 1},
        {"deep": [[{"note": "\ud800"}]]},
    ],
)
def test_a_card_that_would_break_the_list_of_models_is_refused(
    registry: Registry, tmp_path: Path, card: dict[str, Any]
) -> None:
    network = write_network(tmp_path / "copy.onnx", None, 1)
    with pytest.raises(UnusableModelError):
        registry.publish_file("copy", network, {**CARD, **card})
    assert registry.page(100).models == []


@pytest.mark.parametrize("alias", ["default", "default-network", "ours"])
def test_an_alias_keeps_its_kind(
    registry: Registry, tmp_path: Path, dictionary_bytes: Callable[[int], bytes], alias: str
) -> None:
    for number in (1, 2):
        path = tmp_path / "reliefs.safetensors"
        path.write_bytes(dictionary_bytes(number))
        registry.publish_file("reliefs", path)
        registry.publish_file("copy", write_network(tmp_path / "copy.onnx", None, 1, gain=number), CARD)
    kinds = ("copy", "reliefs") if alias == "default-network" else ("reliefs", "copy")
    registry.set_alias(alias, f"{kinds[0]}@1")
    with pytest.raises(ModelKindError):
        registry.set_alias(alias, f"{kinds[1]}@1")
    assert registry.set_alias(alias, f"{kinds[0]}@2").version == 2


def test_default_cannot_begin_as_a_network(registry: Registry, tmp_path: Path) -> None:
    registry.publish_file("copy", write_network(tmp_path / "copy.onnx", None, 1), CARD)
    with pytest.raises(ModelKindError):
        registry.set_alias("default", "copy@1")


def helper_model(domain: str, functions: bool) -> bytes:
    values = [helper.make_tensor_value_info(name, TensorProto.FLOAT, [1]) for name in ("patches", "clean")]
    graph = helper.make_graph([helper.make_node("Identity", ["patches"], ["clean"])], "g", values[:1], values[1:])
    function = helper.make_function("own", "f", ["a"], ["b"], [helper.make_node("Identity", ["a"], ["b"])], [], [])
    opsets = [helper.make_opsetid("", 17), *([helper.make_opsetid(domain, 1)] if domain else [])]
    model = helper.make_model(graph, opset_imports=opsets, functions=[function] if functions else [])
    return bytes(model.SerializeToString())


GOOD = helper_model("", functions=False)
NO_NETWORKS = {
    "two bytes": b"\x08\x0a",
    "any byte": b"\x08\x7f",
    "cut off": GOOD[:-3],
    "followed by junk": GOOD + b"\xff\xff",
    "no graph": b"\x08\x0a\x42\x02\x10\x11",
    "no operators": b"\x08\x0a\x3a\x03\x12\x01g",
    "endless fields": b"\x08\x0a" * 5000,
    "operators of another vendor": helper_model("com.microsoft", functions=False),
    "functions of its own": helper_model("", functions=True),
}


@pytest.mark.parametrize("case", NO_NETWORKS)
def test_what_only_begins_like_a_network_is_not_published(registry: Registry, tmp_path: Path, case: str) -> None:
    path = tmp_path / "network.onnx"
    path.write_bytes(NO_NETWORKS[case])
    with pytest.raises(UnusableModelError):
        registry.publish_file("junk", path, CARD)
    assert registry.page(100).models == []


def test_a_network_of_standard_operators_is_published(registry: Registry, tmp_path: Path) -> None:
    path = tmp_path / "network.onnx"
    path.write_bytes(GOOD)
    assert registry.publish_file("good", path, CARD)[1]


@pytest.mark.parametrize("path", sorted(SHIPPED_MODELS.glob("*.onnx")), ids=lambda path: str(path.stem))
def test_every_network_that_ships_is_published(registry: Registry, path: Path) -> None:
    assert registry.publish_file("shipped", path)[1]


def wide_network() -> bytes:
    """Return what passes for a network, and answers by two channels."""
    shapes = {"patches": ["batch", 1, N, N], "clean": ["batch", 2, N, N]}
    values = [helper.make_tensor_value_info(name, TensorProto.FLOAT, shape) for name, shape in shapes.items()]
    nodes = [helper.make_node("Concat", ["patches", "patches"], ["clean"], axis=1)]
    model = helper.make_model(
        helper.make_graph(nodes, "g", values[:1], values[1:]), opset_imports=[helper.make_opsetid("", 17)], ir_version=8
    )
    return bytes(model.SerializeToString())


# A header in order, and no model behind it.
UNPROVEN = {
    "a graph of nothing": b"\x08\x0a\x3a\x03\x12\x01g\x42\x02\x10\x11",
    "a vector": GOOD,
    "an operator that is none": helper_model("", functions=False).replace(b"Identity", b"Idendity"),
    "two channels": wide_network(),
}


@pytest.mark.parametrize("case", UNPROVEN)
def test_what_a_worker_cannot_prove_is_never_used(
    settings: Settings, database: Database, store: ObjectStore, case: str
) -> None:
    files: Files = {"artifact": ("a.onnx", UNPROVEN[case]), "card": (None, json.dumps(CARD), "application/json")}
    with TestClient(create_app(settings), base_url="http://127.0.0.1") as client:
        published = client.post("/v1/models/copy/versions", files=files, headers={"Prefer": "wait=0"})
        assert published.json()["state"] == "proving"
        with working(settings, database, store):
            prove_model("copy@1")
        again = client.get("/v1/models/copy/versions/1").json()
        assert (again["state"], again["problem"]["code"]) == ("refused", "unusable_model")
        mesh = client.post("/v1/meshes?filename=a.ply", content=b"ply").json()["id"]
        for reference in ("copy", "copy@1"):
            job = {"mesh_id": mesh, "method": {"method": "cnn", "model": reference}}
            assert client.post("/v1/jobs", json=job).status_code == 409
            for alias in ("default-network", "ours"):
                refused = client.put(f"/v1/aliases/{alias}", json={"model": reference})
                assert (refused.status_code, refused.json()["code"]) == (409, "model_refused")
        assert client.get("/v1/models").json()["aliases"] == []


@pytest.mark.parametrize("n_bytes", [1, 10, 64, 200])
def test_a_network_that_is_cut_off_or_flipped_is_refused_and_ends_no_engine(
    settings: Settings, database: Database, store: ObjectStore, tmp_path: Path, n_bytes: int
) -> None:
    data = bytearray(write_network(tmp_path / "copy.onnx", CARD | {"kind": "autoencoder"}, 1).read_bytes())
    rng = random.Random(n_bytes)
    for _ in range(n_bytes):
        data[rng.randrange(len(data))] = rng.randrange(256)
    registry = Registry(database, store)
    with store.writer(MODEL_PREFIX) as writer:
        writer.write(bytes(data))
        stored = writer.commit()
    try:
        registry.publish("copy", stored, CARD)
    except UnusableModelError:
        return
    with working(settings, database, store) as context:
        prove_model("copy@1")
        proven = context.registry.resolve("copy@1")
    assert proven.state is not ModelState.PROVING
    assert proven.problem is None or proven.problem.code == "unusable_model"


def test_versions_of_earlier_releases_are_proven_after_an_upgrade(
    settings: Settings, database: Database, store: ObjectStore, tmp_path: Path
) -> None:
    database.migrate("0003")
    columns = "name, version, kind, format, sha256, size_bytes, key, card, created_at"
    moment = "2026-11-22 10:00:00+00:00" if database.engine.dialect.name == "postgresql" else "2026-11-22 10:00:00"
    with store.writer(MODEL_PREFIX) as writer:
        writer.write(b"\x08\x07")
        stored = writer.commit()
    with database.engine.begin() as connection:
        row = f"'junk', 1, 'autoencoder', 'onnx', '{stored.sha256}', 2, '{stored.key}', '{{}}', '{moment}'"
        connection.execute(text(f"INSERT INTO models ({columns}) VALUES ({row})"))
    database.migrate()
    queue = TaskQueue(settings.redis_url.get_secret_value(), settings.queue_name, 60)
    assert reconcile(database, queue, TimeLimits(60.0, 60.0, 1024)).enqueued_models == 1
    assert queue.entries() == {model_entry("junk@1", 1)}
    queue.close()
    with working(settings, database, store) as context:
        prove_model("junk@1")
        assert context.registry.resolve("junk@1").state is ModelState.REFUSED

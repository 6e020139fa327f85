"""Letter G: what a published model, its card and an alias may be."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from starlette.testclient import TestClient

from jobkit.database import Database
from jobkit.errors import ModelKindError, UnusableModelError
from jobkit.jobs import Jobs, NewJob
from jobkit.meshes import Meshes
from jobkit.model_header import MAX_CARD_BYTES
from jobkit.registry import Registry
from jobkit.schema import JobSpec, ResolvedModel
from jobkit.settings import Settings
from jobkit.store import ObjectStore
from service.app import create_app
from tests.integration.conftest import ply_bytes, punched_relief
from tests.quadpatch.inpainters.test_autoencoder import N, write_network
from tests.worker.test_repairs import working
from worker.jobs import run_job

CARD = {"patch_resolution": N, "recipe": "paper", "height_low": -0.5, "height_high": 0.5}


@pytest.fixture
def registry(database: Database, store: ObjectStore) -> Registry:
    return Registry(database, store)


def test_the_card_beside_a_network_reaches_the_engine(
    settings: Settings, database: Database, store: ObjectStore, tmp_path: Path
) -> None:
    network = write_network(tmp_path / "copy.onnx", None, 1)
    with TestClient(create_app(settings), base_url="http://127.0.0.1") as client:
        files = {"artifact": ("copy.onnx", network.read_bytes()), "card": (None, json.dumps(CARD), "application/json")}
        assert client.post("/v1/models/copy/versions", files=files).status_code == 201
    with store.writer("meshes") as writer:
        writer.write(ply_bytes(*punched_relief(40, 1)))
        mesh = Meshes(database).add(writer.commit(), "scan.ply", "ply")[0]
    method = {"method": "cnn", "model": "copy@1"}
    spec = JobSpec.model_validate({"mesh_id": mesh.id, "method": method, "output": {"preview": False}})
    pinned = ResolvedModel(requested="copy@1", kind="autoencoder", name="copy", version=1)
    job = Jobs(database).create(NewJob(spec, pinned, 3))[0]
    with working(settings, database, store) as context:
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
    assert registry.list_all().models == []


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

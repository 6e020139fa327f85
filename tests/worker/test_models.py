from pathlib import Path

import numpy as np
import pytest

from jobkit.database.session import Database
from jobkit.models.registry import Registry
from jobkit.storage.base import ObjectStore
from quadpatch.inpainters.model_file import save_dictionary
from quadpatch.sparse.dictionary import Dictionary
from quadpatch_client.schema import ModelVersion, ResolvedModel
from worker.failures import EngineFailedError
from worker.models import model_argument


@pytest.fixture
def model_file(tmp_path: Path) -> Path:
    """A small dictionary: every atom is one bin."""
    path = tmp_path / "ripples.safetensors"
    save_dictionary(path, Dictionary(np.eye(64), resolution=8, n_nonzero=4), {"name": "ripples"})
    return path


@pytest.fixture
def registry(database: Database, store: ObjectStore) -> Registry:
    return Registry(database, store)


@pytest.fixture
def version(registry: Registry, model_file: Path) -> ModelVersion:
    return registry.publish_file("ripples", model_file)[0]


def pinned(version: ModelVersion) -> ResolvedModel:
    return ResolvedModel(
        requested="ripples",
        kind="dictionary",
        name=version.name,
        version=version.version,
        sha256=version.sha256,
    )


@pytest.mark.parametrize(("kind", "argument"), [("none", "smooth"), ("self", "self"), ("self_network", "self-network")])
def test_methods_without_a_file_have_a_name(
    registry: Registry, store: ObjectStore, tmp_path: Path, kind: str, argument: str
) -> None:
    model = ResolvedModel.model_validate({"requested": kind, "kind": kind})
    assert model_argument(model, registry, store, tmp_path / "cache") == argument


def test_a_pinned_version_is_fetched_once_and_kept(
    registry: Registry, store: ObjectStore, tmp_path: Path, model_file: Path, version: ModelVersion
) -> None:
    path = Path(model_argument(pinned(version), registry, store, tmp_path / "cache"))
    assert path.read_bytes() == model_file.read_bytes()
    assert path.suffix == ".safetensors"
    inode = path.stat().st_ino
    assert Path(model_argument(pinned(version), registry, store, tmp_path / "cache")).stat().st_ino == inode


def test_bytes_that_have_changed_in_the_store_are_refused(
    registry: Registry, store: ObjectStore, tmp_path: Path, version: ModelVersion
) -> None:
    artifact = registry.artifact(version.name, version.version)
    (tmp_path / "forged").write_bytes(b"something else")
    store.put_file(artifact.key, tmp_path / "forged")
    with pytest.raises(EngineFailedError) as caught:
        model_argument(pinned(version), registry, store, tmp_path / "cache")
    assert caught.value.failure.code == "model_damaged"
    assert list((tmp_path / "cache").iterdir()) == []


def test_a_version_that_is_gone_is_a_clear_failure(
    registry: Registry, store: ObjectStore, tmp_path: Path, version: ModelVersion
) -> None:
    store.delete(registry.artifact(version.name, version.version).key)
    with pytest.raises(EngineFailedError) as caught:
        model_argument(pinned(version), registry, store, tmp_path / "cache")
    assert caught.value.failure.code == "model_missing"

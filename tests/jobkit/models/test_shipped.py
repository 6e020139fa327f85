import logging
from collections.abc import Callable
from pathlib import Path

import pytest

from jobkit.database.session import Database
from jobkit.errors import ModelNotFoundError
from jobkit.models.lifetime import delete_version, deprecate_version
from jobkit.models.registry import MODEL_PREFIX, Registry
from jobkit.models.shipped import seed_shipped
from jobkit.storage.base import ObjectStore
from quadpatch_client.schema import ModelState
from tests.jobkit.models.test_registry import NETWORK

Make = Callable[[int], bytes]


@pytest.fixture
def registry(database: Database, store: ObjectStore) -> Registry:
    return Registry(database, store)


@pytest.fixture
def folder(tmp_path: Path, dictionary_bytes: Make) -> Path:
    shipped = tmp_path / "shipped"
    shipped.mkdir()
    (shipped / "general-dictionary@1.safetensors").write_bytes(dictionary_bytes(1))
    (shipped / "small@3.onnx").write_bytes(NETWORK)
    (shipped / "small@3.json").write_text('{"description": "a small network", "kind": "autoencoder"}')
    (shipped / "README.md").write_text("not a model")
    return shipped


def test_shipped_models_are_registered_under_their_numbers(registry: Registry, folder: Path) -> None:
    assert [(v.name, v.version) for v in seed_shipped(registry, folder)] == [("general-dictionary", 1), ("small", 3)]
    assert registry.resolve("default").name == "general-dictionary"
    assert registry.resolve("default-network").card.description == "a small network"


def test_the_defaults_of_the_paper_are_its_own_models(registry: Registry, folder: Path, dictionary_bytes: Make) -> None:
    (folder / "a-paper@2.safetensors").write_bytes(dictionary_bytes(-1))
    (folder / "a-small@1.onnx").write_bytes(NETWORK)
    (folder / "a-small@1.json").write_text('{"kind": "autoencoder", "recipe": "paper"}')
    seed_shipped(registry, folder)
    aliases = ("default", "default-network", "default-paper", "default-paper-network")
    assert [registry.resolve(alias).name for alias in aliases] == ["general-dictionary", "small", "a-paper", "a-small"]


def test_the_default_is_the_latest_version(registry: Registry, folder: Path, dictionary_bytes: Make) -> None:
    for version in (2, 10):
        (folder / f"general-dictionary@{version}.safetensors").write_bytes(dictionary_bytes(version))
    seed_shipped(registry, folder)
    assert registry.resolve("default").version == 10


def test_registering_again_changes_nothing(registry: Registry, folder: Path, dictionary_bytes: Make) -> None:
    seed_shipped(registry, folder)
    (folder.parent / "own").write_bytes(dictionary_bytes(2))
    registry.publish_file("own", folder.parent / "own")
    registry.set_alias("default", "own")
    before = registry.page(100)
    seed_shipped(registry, folder)
    assert registry.page(100) == before


def test_a_changed_file_without_a_new_number_is_left_out(
    registry: Registry, folder: Path, dictionary_bytes: Make, caplog: pytest.LogCaptureFixture
) -> None:
    seed_shipped(registry, folder)
    before = registry.resolve("general-dictionary@1")
    (folder / "general-dictionary@1.safetensors").write_bytes(dictionary_bytes(9))
    with caplog.at_level(logging.WARNING):
        seed_shipped(registry, folder)
    assert registry.resolve("general-dictionary@1") == before
    assert "general-dictionary@1" in caplog.text


def test_a_folder_that_is_not_there_ships_nothing(registry: Registry, tmp_path: Path) -> None:
    assert seed_shipped(registry, tmp_path / "none") == []


def test_versions_that_were_deprecated_or_deleted_stay_so(
    database: Database, registry: Registry, folder: Path, dictionary_bytes: Make
) -> None:
    for number in (2, 3):
        path = folder / f"general-dictionary@{number}.safetensors"
        path.write_bytes(dictionary_bytes(number))
        registry.publish_file("general-dictionary", path, version=number)
    deprecate_version(database, "general-dictionary", 2, "")
    delete_version(database, "general-dictionary", 3)
    for path in folder.glob("*@1.*"):
        path.unlink()
    seed_shipped(registry, folder)
    with pytest.raises(ModelNotFoundError):
        registry.resolve("default")
    assert [version.version for version in registry.get("general-dictionary").versions] == [2]


def test_what_ships_is_ready_even_where_it_was_uploaded_before(
    registry: Registry, store: ObjectStore, folder: Path, dictionary_bytes: Make
) -> None:
    with store.writer(MODEL_PREFIX) as writer:
        writer.write(dictionary_bytes(1))
        assert registry.publish("general-dictionary", writer.commit())[0].state is ModelState.PROVING
    seed_shipped(registry, folder)
    assert registry.usable("default").state is ModelState.READY

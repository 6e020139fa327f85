"""Also tests `jobkit.models.rows`."""

import threading
from collections.abc import Callable
from pathlib import Path

import pytest

from dispatcher.unreferenced_objects import GRACE, sweep_objects
from jobkit.database.clock import utc_now
from jobkit.database.session import Database
from jobkit.errors import ModelNotFoundError, NameTakenError, UnusableModelError
from jobkit.models.registry import Registry
from jobkit.storage.base import ObjectStore
from jobkit.storage.local import LocalStore

Make = Callable[[int], bytes]
# A graph without nodes, and standard operators: as much as is looked at here.
NETWORK = b"\x08\x0a\x12\x07pytorch\x3a\x03\x12\x01g\x42\x02\x10\x11"


@pytest.fixture
def registry(database: Database, store: ObjectStore) -> Registry:
    return Registry(database, store)


@pytest.fixture
def publish(registry: Registry, tmp_path: Path) -> Callable[[str, bytes], tuple[int, bool]]:
    def run(name: str, data: bytes) -> tuple[int, bool]:
        path = tmp_path / f"upload-{threading.get_ident()}"
        path.write_bytes(data)
        version, is_new = registry.publish_file(name, path)
        return version.version, is_new

    return run


Publish = Callable[[str, bytes], tuple[int, bool]]


def test_versions_count_up_and_the_same_bytes_are_the_same_version(publish: Publish, dictionary_bytes: Make) -> None:
    assert publish("reliefs", dictionary_bytes(1)) == (1, True)
    assert publish("reliefs", dictionary_bytes(2)) == (2, True)
    assert publish("reliefs", dictionary_bytes(1)) == (1, False)
    assert publish("scans", dictionary_bytes(1)) == (1, True)


def test_the_card_of_a_dictionary_is_read_from_its_file(
    registry: Registry, publish: Publish, dictionary_bytes: Make
) -> None:
    publish("reliefs", dictionary_bytes(1))
    version = registry.resolve("reliefs@1")
    assert version.kind == "dictionary"
    assert (version.card.patch_resolution, version.card.n_atoms, version.card.n_nonzero) == (8, 5, 3)
    assert version.card.licence == "GPL-3.0-or-later"
    assert version.card.extra == {"seed": 1}
    assert version.size_bytes == len(dictionary_bytes(1))


def test_a_reference_means_a_version_the_latest_or_what_an_alias_points_to(
    registry: Registry, publish: Publish, dictionary_bytes: Make
) -> None:
    publish("reliefs", dictionary_bytes(1))
    publish("reliefs", dictionary_bytes(2))
    registry.set_alias("default", "reliefs@1")
    assert [registry.resolve(name).version for name in ("reliefs", "reliefs@1", "reliefs@2", "default")] == [2, 1, 2, 1]
    registry.set_alias("default", "reliefs")
    assert registry.resolve("default").version == 2
    assert registry.get("reliefs").versions[0].aliases == ["default"]


@pytest.mark.parametrize("reference", ["none", "reliefs@2", "none@1"])
def test_a_reference_that_means_nothing_is_an_error(
    registry: Registry, publish: Publish, dictionary_bytes: Make, reference: str
) -> None:
    publish("reliefs", dictionary_bytes(1))
    with pytest.raises(ModelNotFoundError):
        registry.resolve(reference)
    with pytest.raises(ModelNotFoundError):
        registry.set_alias("candidate", reference)


def test_a_model_and_an_alias_never_share_a_name(registry: Registry, publish: Publish, dictionary_bytes: Make) -> None:
    publish("reliefs", dictionary_bytes(1))
    registry.set_alias("default", "reliefs")
    with pytest.raises(NameTakenError):
        publish("default", dictionary_bytes(2))
    for name in ("reliefs", "self", "smooth"):
        with pytest.raises(NameTakenError):
            registry.set_alias(name, "reliefs")


def test_bytes_that_are_no_model_become_no_version_and_are_left_to_the_sweep(
    database: Database, tmp_path: Path, dictionary_bytes: Make
) -> None:
    """To remove them at once could take them from another version, made of the same bytes and a better card."""
    store = LocalStore(tmp_path / "objects")
    registry = Registry(database, store)
    path = tmp_path / "upload"
    path.write_bytes(dictionary_bytes(1))
    registry.publish_file("good", path)
    path.write_bytes(b"neither one nor the other")
    with pytest.raises(UnusableModelError):
        registry.publish_file("junk", path)
    assert [model.name for model in registry.page(100).models] == ["good"]
    assert sweep_objects(database, store, utc_now() + 2 * GRACE).objects == 1
    assert store.size(registry.artifact("good", 1).key) == len(dictionary_bytes(1))


def test_a_network_is_an_autoencoder(registry: Registry, publish: Publish) -> None:
    assert not registry.has_kind("autoencoder")
    publish("small", NETWORK)
    assert registry.has_kind("autoencoder")
    assert registry.resolve("small").format == "onnx"


def test_versions_published_at_once_get_numbers_of_their_own(
    registry: Registry, publish: Publish, dictionary_bytes: Make
) -> None:
    files = [dictionary_bytes(seed) for seed in range(6)]
    threads = [threading.Thread(target=publish, args=("reliefs", data)) for data in files]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert [version.version for version in registry.get("reliefs").versions] == [6, 5, 4, 3, 2, 1]


def test_the_artifact_lies_in_the_store(
    registry: Registry, store: ObjectStore, publish: Publish, dictionary_bytes: Make
) -> None:
    publish("reliefs", dictionary_bytes(1))
    assert b"".join(store.read(registry.artifact("reliefs", 1).key)) == dictionary_bytes(1)

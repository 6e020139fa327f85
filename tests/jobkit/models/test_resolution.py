from collections.abc import Callable
from pathlib import Path

import pytest

from jobkit.database.session import Database
from jobkit.errors import ModelKindError, ModelNotFoundError, NoNetworkError
from jobkit.models.registry import Registry
from jobkit.models.resolution import resolve_method
from jobkit.storage.base import ObjectStore
from quadpatch_client.schema import AutoMethod, CnnMethod, DictionaryMethod, Fitting, SmoothMethod
from tests.jobkit.models.test_registry import NETWORK


@pytest.fixture
def registry(
    database: Database, store: ObjectStore, tmp_path: Path, dictionary_bytes: Callable[[int], bytes]
) -> Registry:
    registry = Registry(database, store)
    (tmp_path / "atoms").write_bytes(dictionary_bytes(1))
    registry.publish_file("reliefs", tmp_path / "atoms")
    return registry


def test_a_reference_is_pinned_to_the_version_it_means_now(registry: Registry) -> None:
    registry.set_alias("default", "reliefs@1")
    pinned = resolve_method(registry, DictionaryMethod(method="dictionary"))
    assert (pinned.requested, pinned.name, pinned.version, pinned.kind) == ("default", "reliefs", 1, "dictionary")
    assert pinned.sha256 == registry.resolve("reliefs").sha256


def test_self_and_smooth_need_no_registered_model(registry: Registry) -> None:
    assert resolve_method(registry, DictionaryMethod(method="dictionary", model="self")).kind == "self"
    assert resolve_method(registry, SmoothMethod(method="smooth")).kind == "none"
    assert resolve_method(registry, AutoMethod(method="auto")).kind == "auto"


def test_a_network_is_fitted_to_the_mesh_without_being_registered(registry: Registry) -> None:
    method = CnnMethod(method="cnn", model="self", fitting=Fitting(steps=30))
    pinned = resolve_method(registry, method)
    assert (pinned.requested, pinned.kind, pinned.name, pinned.version) == ("self", "self_network", None, None)


def test_a_network_that_is_taken_as_it_is_takes_no_time_to_be_fitted(registry: Registry, tmp_path: Path) -> None:
    (tmp_path / "net").write_bytes(NETWORK)
    registry.publish_file("small", tmp_path / "net")
    for fitting in (Fitting(steps=30), Fitting(seconds=30.0)):
        with pytest.raises(ModelKindError, match="small@1 is taken as it is; fitting goes with the model self only"):
            resolve_method(registry, CnnMethod(method="cnn", model="small", fitting=fitting))
    assert resolve_method(registry, CnnMethod(method="cnn", model="small", fitting=Fitting())).name == "small"


def test_a_network_is_asked_for_in_vain_until_one_is_registered(registry: Registry, tmp_path: Path) -> None:
    with pytest.raises(NoNetworkError, match="upload one with POST"):
        resolve_method(registry, CnnMethod(method="cnn"))
    (tmp_path / "net").write_bytes(NETWORK)
    registry.publish_file("small", tmp_path / "net")
    with pytest.raises(ModelNotFoundError):
        resolve_method(registry, CnnMethod(method="cnn"))
    assert resolve_method(registry, CnnMethod(method="cnn", model="small")).kind == "autoencoder"
    with pytest.raises(ModelKindError, match="needs kind autoencoder"):
        resolve_method(registry, CnnMethod(method="cnn", model="reliefs"))
    with pytest.raises(ModelKindError):
        resolve_method(registry, DictionaryMethod(method="dictionary", model="small"))


def test_a_dictionary_is_used_by_the_recipe_that_it_was_learned_for(
    registry: Registry, tmp_path: Path, dictionary_bytes: Callable[[int], bytes]
) -> None:
    (tmp_path / "heights").write_bytes(dictionary_bytes(-1))
    registry.publish_file("heights", tmp_path / "heights")
    ours, papers = (DictionaryMethod(method="dictionary", model=name) for name in ("reliefs", "heights"))
    assert resolve_method(registry, ours).name == "reliefs"
    assert resolve_method(registry, papers.model_copy(update={"recipe": "paper"})).name == "heights"
    with pytest.raises(ModelKindError, match="heights@1 was learned for the recipe paper, not for default"):
        resolve_method(registry, papers)
    with pytest.raises(ModelKindError, match="ask for the recipe default, or take the model self"):
        resolve_method(registry, ours.model_copy(update={"recipe": "paper"}))
    own = DictionaryMethod(method="dictionary", model="self", recipe="paper")
    assert resolve_method(registry, own).kind == "self"


def test_the_defaults_of_the_paper_are_others(
    registry: Registry, tmp_path: Path, dictionary_bytes: Callable[[int], bytes]
) -> None:
    method = DictionaryMethod(method="dictionary", recipe="paper")
    with pytest.raises(ModelNotFoundError, match="default-paper"):
        resolve_method(registry, method)
    (tmp_path / "heights").write_bytes(dictionary_bytes(-1))
    registry.publish_file("heights", tmp_path / "heights")
    registry.set_alias("default-paper", "heights")
    pinned = resolve_method(registry, method)
    assert (pinned.requested, pinned.name) == ("default", "heights")


def test_the_recipe_of_the_paper_takes_its_own_networks_alone(registry: Registry, tmp_path: Path) -> None:
    (tmp_path / "net").write_bytes(NETWORK)
    for name, recipe in (("papers", "paper"), ("correcting", "residual")):
        registry.publish_file(name, tmp_path / "net", {"kind": "autoencoder", "recipe": recipe})
    registry.set_alias("default-paper-network", "papers")
    assert resolve_method(registry, CnnMethod(method="cnn", recipe="paper")).name == "papers"
    assert resolve_method(registry, CnnMethod(method="cnn", model="papers")).name == "papers"
    with pytest.raises(ModelKindError, match="correcting@1 corrects a faired fill"):
        resolve_method(registry, CnnMethod(method="cnn", model="correcting", recipe="paper"))

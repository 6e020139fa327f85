import json
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from onnx import TensorProto, helper

from jobkit.database.session import Database
from jobkit.models.network_header import read_network_card
from jobkit.models.registry import Registry
from jobkit.storage.local import LocalStore

CARD = {"kind": "autoencoder", "patch_resolution": 24, "description": "a network of ours", "metrics": {"error": 0.5}}


def network_bytes(properties: dict[str, str], n_weights: int = 10) -> bytes:
    graph = helper.make_graph(
        [helper.make_node("Identity", ["patches"], ["clean"])],
        "network",
        [helper.make_tensor_value_info("patches", TensorProto.FLOAT, ["batch"])],
        [helper.make_tensor_value_info("clean", TensorProto.FLOAT, ["batch"])],
        [helper.make_tensor("weight", TensorProto.FLOAT, [n_weights], [0.5] * n_weights)],
    )
    model = helper.make_model(graph)
    helper.set_model_props(model, properties)
    return bytes(model.SerializeToString())


@given(n_weights=st.integers(0, 5000), others=st.dictionaries(st.text(max_size=300), st.text(max_size=300), max_size=3))
def test_the_card_is_found_behind_any_graph_and_among_any_metadata(
    tmp_path_factory: pytest.TempPathFactory, n_weights: int, others: dict[str, str]
) -> None:
    path = tmp_path_factory.mktemp("model") / "network.onnx"
    path.write_bytes(network_bytes({**others, "card": json.dumps(CARD)}, n_weights))
    assert read_network_card(path) == CARD


@pytest.mark.parametrize("card", [None, "", "[", "[]", '"text"', '{"metrics": NaN}', "[" * 100_000])
def test_a_network_without_a_readable_card_has_none(tmp_path: Path, card: str | None) -> None:
    path = tmp_path / "network.onnx"
    path.write_bytes(network_bytes({} if card is None else {"card": card}))
    assert read_network_card(path) is None


@given(data=st.binary(max_size=200), keep=st.integers(0, 400))
def test_damaged_bytes_have_no_card_or_the_whole_one(
    tmp_path_factory: pytest.TempPathFactory, data: bytes, keep: int
) -> None:
    path = tmp_path_factory.mktemp("model") / "network.onnx"
    path.write_bytes(network_bytes({"card": json.dumps(CARD)})[:keep] + data)
    assert read_network_card(path) in (None, CARD)


def test_a_published_network_brings_its_card_unless_another_is_given(database: Database, tmp_path: Path) -> None:
    registry = Registry(database, LocalStore(tmp_path / "objects"))
    path = tmp_path / "network.onnx"
    path.write_bytes(network_bytes({"card": json.dumps(CARD)}))
    own, _ = registry.publish_file("own", path)
    assert (own.card.description, own.card.patch_resolution, own.card.metrics) == (
        "a network of ours",
        24,
        {"error": 0.5},
    )
    other, _ = registry.publish_file("other", path, {"description": "another"})
    assert other.card.description == "another"

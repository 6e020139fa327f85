"""Models are proven: each check has a file that fails it and no other."""

import json
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import onnx
import pytest
from onnx import TensorProto, helper
from safetensors.numpy import save

from quadpatch.errors import ModelError
from quadpatch.inpainters.model_file import SHIPPED_MODELS, SUFFIXES, load_model
from quadpatch.inpainters.onnx_network import AutoencoderInpainter
from quadpatch.inpainters.proof import prove_model
from quadpatch.patches.normalisation import NORMALISATION
from tests.quadpatch.inpainters.test_onnx_network import PAPER, RESIDUAL, N, write_network

SHAPE = ["batch", 1, N, N]


def write(
    path: Path,
    nodes: Sequence[onnx.NodeProto],
    weights: Sequence[onnx.TensorProto] = (),
    *,
    shapes: Sequence[Sequence[Any]] = (SHAPE, SHAPE),
    output_type: int = TensorProto.FLOAT,
    domain: str = "",
) -> Path:
    """Write a network of the recipe `paper`, with an input `patches` and an output `clean`."""
    values = [
        helper.make_tensor_value_info(name, form, shape)
        for name, form, shape in zip(("patches", "clean"), (TensorProto.FLOAT, output_type), shapes, strict=True)
    ]
    graph = helper.make_graph(list(nodes), "network", values[:1], values[1:], list(weights))
    opsets = [helper.make_opsetid("", 17), *([helper.make_opsetid(domain, 1)] if domain else [])]
    model = helper.make_model(graph, opset_imports=opsets, ir_version=8)
    helper.set_model_props(model, {"card": json.dumps(PAPER)})
    path.write_bytes(model.SerializeToString())
    return path


def node(operator: str, inputs: str = "patches", output: str = "clean", **attributes: Any) -> onnx.NodeProto:
    return helper.make_node(operator, inputs.split(), [output], **attributes)


def number(name: str, *values: float) -> onnx.TensorProto:
    return onnx.numpy_helper.from_array(np.array(values, np.float32), name)


def outside() -> onnx.TensorProto:
    tensor = number("weight", 1.0)
    tensor.ClearField("raw_data")
    tensor.data_location = TensorProto.EXTERNAL
    for key, value in {"location": "/etc/passwd", "length": "4"}.items():
        tensor.external_data.add(key=key, value=value)
    return tensor


def nested(inner: onnx.NodeProto, weights: Sequence[onnx.TensorProto] = ()) -> list[onnx.NodeProto]:
    """Hide a node in both branches of an `If`."""
    output = helper.make_tensor_value_info("clean_inside", TensorProto.FLOAT, None)
    branch = helper.make_graph([inner], "branch", [], [output], list(weights))
    condition = onnx.numpy_helper.from_array(np.array(True), "value")
    return [
        helper.make_node("Constant", [], ["condition"], value=condition),
        helper.make_node("If", ["condition"], ["clean"], then_branch=branch, else_branch=branch),
    ]


def wide(path: Path) -> Path:
    return write(path, [node("Concat", "patches patches", axis=1)], shapes=(SHAPE, ["batch", 2, N, N]))


BAD: dict[str, tuple[Callable[[Path], Path], str]] = {
    "operators of another vendor": (
        lambda path: write(path, [node("Gelu", domain="com.microsoft")], domain="com.microsoft"),
        "not ONNX's own",
    ),
    "operators of another vendor in a branch": (
        lambda path: write(
            path, nested(node("Gelu", output="clean_inside", domain="com.microsoft")), domain="com.microsoft"
        ),
        "not ONNX's own",
    ),
    "weights outside": (lambda path: write(path, [node("Mul", "patches weight")], [outside()]), "outside of its file"),
    "weights outside in a branch": (
        lambda path: write(path, nested(node("Mul", "patches weight", "clean_inside"), [outside()])),
        "outside of its file",
    ),
    "weights outside in a constant": (
        lambda path: write(path, [node("Constant", "", "weight", value=outside()), node("Mul", "patches weight")]),
        "outside of its file",
    ),
    "two channels out": (wide, "wanted is float"),
    "integers out": (
        lambda path: write(path, [node("Cast", to=TensorProto.INT64)], output_type=TensorProto.INT64),
        "wanted is float",
    ),
    "no such operator": (lambda path: write(path, [node("Quadpatch")]), "no network that onnxruntime can run"),
    "one patch for many": (
        lambda path: write(
            path,
            [
                node("ReduceMean", output="mean", axes=[0], keepdims=1),
                node("Identity", "mean"),
            ],
        ),
        "answers 64 patches by",
    ),
    "one patch only": (
        lambda path: write(path, [node("Identity")], shapes=([1, 1, N, N], [1, 1, N, N])),
        "can't answer 64 patches",
    ),
    "not finite": (lambda path: write(path, [node("Div", "patches zero")], [number("zero", 0.0)]), "not finite"),
    "not finite for some": (
        lambda path: write(path, [node("Log", "patches", "log"), node("Log", "log")]),
        "not finite",
    ),
    "another answer each time": (
        lambda path: write(path, [node("RandomNormalLike", output="noise"), node("Add", "patches noise")]),
        "two different answers",
    ),
}


@pytest.mark.parametrize("case", BAD)
def test_each_check_refuses_a_network_and_says_why(tmp_path: Path, case: str) -> None:
    make, message = BAD[case]
    with pytest.raises(ModelError, match=message):
        prove_model(make(tmp_path / "network.onnx"))


@pytest.mark.parametrize(("card", "channels"), [(PAPER, 1), (RESIDUAL, 2)])
def test_a_network_that_answers_is_proven_by_its_card(tmp_path: Path, card: dict[str, Any], channels: int) -> None:
    prove_model(write_network(tmp_path / "copy.onnx", card, channels))
    bare = write_network(tmp_path / "bare.onnx", None, channels)
    prove_model(bare, card)
    with pytest.raises(ModelError, match="no card"):
        prove_model(bare)
    with pytest.raises(ModelError, match="wanted is float"):
        prove_model(bare, {**card, "patch_resolution": 2 * N})


def test_a_network_may_leave_the_sides_of_its_output_open(tmp_path: Path) -> None:
    # What `Compress` keeps follows from values, so that no inference of shapes can tell the sides.
    keep = onnx.numpy_helper.from_array(np.ones(N, np.bool_), "keep")
    nodes = [node("Compress", "patches keep", "rows", axis=2), node("Compress", "rows keep", axis=3)]
    path = write(tmp_path / "open.onnx", nodes, [keep], shapes=(SHAPE, ["batch", "c", "h", "w"]))
    (output,) = AutoencoderInpainter.load(path).session.get_outputs()
    assert output.shape[2:] == ["h", "w"]
    prove_model(path)
    assert load_model(path).kind == "autoencoder"


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"normalisation": "none of ours"}, "normalisation"),
        ({"scale": 2.0}, "unit norm"),
        ({"scale": np.nan}, "unit norm"),
        ({"kind": "autoencoder"}, "not 'dictionary'"),
        ({"patch_resolution": 7}, "."),
    ],
)
def test_a_dictionary_of_other_atoms_than_its_card_says_is_refused(
    tmp_path: Path, change: dict[str, Any], message: str
) -> None:
    card: dict[str, str | float] = {"kind": "dictionary", "normalisation": NORMALISATION}
    card |= {"patch_resolution": 8, "n_nonzero": 3, "scale": 1.0}
    atoms = np.random.default_rng(1).normal(size=(64, 5))
    atoms /= np.linalg.norm(atoms, axis=0)
    path = tmp_path / "atoms.safetensors"
    path.write_bytes(save({"atoms": atoms.astype(np.float32)}, {"card": json.dumps(card)}))
    prove_model(path)
    card |= change
    scaled = (atoms * float(card["scale"])).astype(np.float32)
    text = json.dumps({**card, "scale": None})
    path.write_bytes(save({"atoms": scaled}, {"card": text}))
    with pytest.raises(ModelError, match=message):
        prove_model(path)


@pytest.mark.parametrize(
    "path", sorted(path for path in SHIPPED_MODELS.glob("*@*") if path.suffix in SUFFIXES), ids=lambda path: path.stem
)
def test_every_model_that_ships_is_proven(path: Path) -> None:
    """They are registered at each start without a proof: this is it."""
    prove_model(path)
    assert load_model(path).kind in ("dictionary", "autoencoder")

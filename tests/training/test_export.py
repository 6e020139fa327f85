import copy
import hashlib
import json
from pathlib import Path
from typing import Any

import numpy as np
import onnx
import pytest
import torch
from torch import Tensor, nn

from quadpatch.inpainters.onnx_network import AutoencoderInpainter
from training.architectures import ARCHITECTURES
from training.autoencoder import Autoencoder, Layer, Plan
from training.errors import ExportError
from training.export import PARITY, run_onnx, to_onnx, write_network
from training.int8 import to_int8

pytestmark = pytest.mark.slow

CARD = {"patch_resolution": 16, "recipe": "paper", "height_low": -0.1, "height_high": 0.1}


def tiny(seed: int = 0) -> nn.Sequential:
    """One layer of each sort, and odd sides on the way."""
    torch.manual_seed(seed)
    encoder = (Layer(3, 4), Layer(5, 6, 2), Layer(3, 4, 2), Layer(3, 4, 2))
    decoder = (Layer(3, 4), Layer(5, 4, 2), Layer(3, 4), Layer(5, 6, 2), Layer(3, 4), Layer(5, 1, 2))
    plan = Plan(20, encoder, decoder, n_dense=3, has_skips=False)
    network = nn.Sequential(Autoencoder(plan), nn.Sigmoid())
    for weight in network.parameters():
        weight.data += 0.1 * torch.rand(weight.shape)
    return network


@pytest.fixture(scope="module")
def exported() -> tuple[nn.Sequential, Any]:
    """A network and what it is exported to; an export takes seconds."""
    network = tiny()
    return network, to_onnx(network, 1, 20)


@pytest.fixture(scope="module")
def small() -> Any:
    """The smallest network of the paper, exported."""
    architecture = ARCHITECTURES["small_4x"]
    torch.manual_seed(0)
    return to_onnx(nn.Sequential(architecture.build(), architecture.output()), 1, 24)


class Noisy(nn.Module):
    """Answers otherwise once it is exported."""

    def forward(self, patches: Tensor) -> Tensor:
        return patches if torch.compiler.is_exporting() else patches + 2 * PARITY


def test_the_exported_network_gives_what_torch_gives_for_any_count_of_patches(
    exported: tuple[nn.Sequential, Any],
) -> None:
    network, model = exported
    for count in (1, 2, 7):
        patches = torch.rand(count, 1, 20, 20)
        with torch.inference_mode():
            expected = network(patches).numpy()
        np.testing.assert_allclose(run_onnx(model, patches.numpy()), expected, rtol=0.0, atol=PARITY)
    assert "ConvTranspose" not in {node.op_type for node in model.graph.node}


def test_the_same_weights_give_the_same_bytes_and_nothing_of_this_machine(
    exported: tuple[nn.Sequential, Any], tmp_path: Path
) -> None:
    digests = set()
    for folder, model in (("one", copy.deepcopy(exported[1])), ("other", to_onnx(tiny(), 1, 20))):
        (tmp_path / folder).mkdir()
        write_network(tmp_path / folder / "network.onnx", model, CARD)
        data = (tmp_path / folder / "network.onnx").read_bytes()
        digests.add(hashlib.sha256(data).digest())
    assert len(digests) == 1
    for word in (str(Path.home()), "site-packages", "torch", ".py", str(tmp_path)):
        assert word.encode() not in data


def test_the_card_is_the_only_metadata(exported: tuple[nn.Sequential, Any], tmp_path: Path) -> None:
    model = copy.deepcopy(exported[1])
    write_network(tmp_path / "network.onnx", model, {"name": "old"})
    write_network(tmp_path / "network.onnx", model, CARD)
    (entry,) = onnx.load(tmp_path / "network.onnx").metadata_props
    assert (entry.key, json.loads(entry.value)) == ("card", {**CARD, "kind": "autoencoder"})


def test_a_network_that_changes_on_export_is_refused() -> None:
    with pytest.raises(ExportError, match="differ by 2e-05"):
        to_onnx(Noisy(), 1, 20)


def test_numbers_that_are_none_are_refused() -> None:
    network = tiny()
    next(network.parameters()).data.fill_(torch.nan)
    with pytest.raises(ExportError, match="nan"):
        to_onnx(network, 1, 20)


@pytest.mark.parametrize("name", ["small_4x", "long_12x_SC"])
def test_networks_of_the_paper_are_read_by_the_code_of_repairs(small: Any, tmp_path: Path, name: str) -> None:
    architecture = ARCHITECTURES[name]
    module = nn.Sequential(architecture.build(), architecture.output())
    is_small = name == "small_4x"
    model = copy.deepcopy(small) if is_small else to_onnx(module, architecture.channels, architecture.resolution)
    path = tmp_path / "network.onnx"
    write_network(path, model, {**CARD, "patch_resolution": architecture.resolution})
    inpainter = AutoencoderInpainter.load(path)
    assert (inpainter.resolution, inpainter.recipe) == (architecture.resolution, "paper")


def test_whole_numbers_take_a_third_of_the_room_and_cost_little_accuracy(small: Any) -> None:
    model = copy.deepcopy(small)
    patches = np.random.default_rng(0).random((100, 1, 24, 24), dtype=np.float32)
    rounded_model = to_int8(model, patches)
    assert rounded_model.ByteSize() < model.ByteSize() / 3
    exact, rounded = run_onnx(model, patches), run_onnx(rounded_model, patches)
    assert np.abs(rounded - exact).max() < 0.1
    assert np.corrcoef(rounded.ravel(), exact.ravel())[0, 1] > 0.99
    one, again = (model.SerializeToString(deterministic=True) for model in (rounded_model, to_int8(model, patches)))
    assert one == again

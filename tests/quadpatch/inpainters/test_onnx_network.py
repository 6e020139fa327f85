"""Networks, built here node by node, so that what they must answer is known exactly."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import onnx
import pytest
from onnx import TensorProto, helper

from quadpatch.errors import ModelError
from quadpatch.inpainters.onnx_network import BATCH, AutoencoderInpainter
from quadpatch.types import Patches

N = 16
PAPER = {"kind": "autoencoder", "patch_resolution": N, "recipe": "paper", "height_low": -0.5, "height_high": 0.5}
RESIDUAL = {"kind": "autoencoder", "patch_resolution": N, "recipe": "residual"}


def write_network(path: Path, card: dict[str, Any] | None, channels: int, *, gain: float = 1.0) -> Path:
    """Write a network that gives its first channel back, times a gain."""
    weight = np.zeros((1, channels, 1, 1), np.float32)
    weight[0, 0] = gain
    graph = helper.make_graph(
        [helper.make_node("Conv", ["patches", "weight"], ["clean"])],
        "network",
        [helper.make_tensor_value_info("patches", TensorProto.FLOAT, ["batch", channels, N, N])],
        [helper.make_tensor_value_info("clean", TensorProto.FLOAT, ["batch", 1, N, N])],
        [onnx.numpy_helper.from_array(weight, "weight")],
    )
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 17)], ir_version=8)
    if card is not None:
        helper.set_model_props(model, {"card": json.dumps(card)})
    path.write_bytes(model.SerializeToString())
    return path


def waves(n_patches: int) -> Patches:
    rng = np.random.default_rng(3)
    heights = 0.1 * np.sin(rng.normal(size=(n_patches, N, N)))
    known = rng.random((n_patches, N, N)) > 0.3
    zeros = np.zeros((n_patches, 3))
    frames = np.tile(np.eye(3), (n_patches, 1, 1))
    return Patches(zeros, frames, 1.0, heights, known, np.ones_like(known), np.zeros(known.shape, np.int64))


def test_paper_network_that_copies_gives_known_heights_back(tmp_path: Path) -> None:
    inpainter = AutoencoderInpainter.load(write_network(tmp_path / "copy.onnx", PAPER, 1))
    patches = waves(5)
    predicted = inpainter.predict(patches, np.zeros_like(patches.heights))
    np.testing.assert_allclose(predicted[patches.known], patches.heights[patches.known], atol=1e-6)


def test_paper_network_sees_one_in_every_unknown_bin(tmp_path: Path) -> None:
    inpainter = AutoencoderInpainter.load(write_network(tmp_path / "copy.onnx", PAPER, 1))
    patches = waves(2)
    predicted = inpainter.predict(patches, np.zeros_like(patches.heights))
    mean = np.array([h[k].mean() for h, k in zip(patches.heights, patches.known, strict=True)])
    unknown = np.where(patches.known, np.nan, predicted - mean[:, None, None])
    np.testing.assert_allclose(unknown[~patches.known], -0.5 + 1 / 0.83, atol=1e-6)


def test_raw_heights_go_into_a_network_as_they_are(tmp_path: Path) -> None:
    raw = {**PAPER, "normalisation": "heights-range"}
    inpainter = AutoencoderInpainter.load(write_network(tmp_path / "copy.onnx", raw, 1))
    patches = waves(4)
    predicted = inpainter.predict(patches, np.zeros_like(patches.heights))
    np.testing.assert_allclose(predicted[patches.known], patches.heights[patches.known], atol=1e-6)
    np.testing.assert_allclose(predicted[~patches.known], -0.5 + 1 / 0.83, atol=1e-6)


def test_raw_heights_are_over_the_smoothed_surface_at_the_centre_of_the_patch(tmp_path: Path) -> None:
    raw = {**PAPER, "normalisation": "heights-range"}
    inpainter = AutoencoderInpainter.load(write_network(tmp_path / "copy.onnx", raw, 1))
    patches = waves(4)
    low = replace(patches, heights=patches.heights - 7.0)
    predicted = inpainter.predict(low, np.full_like(patches.heights, -7.0))
    base = inpainter.predict(patches, np.zeros_like(patches.heights))
    np.testing.assert_allclose(predicted, base - 7.0, atol=1e-6)


def test_residual_network_of_zeros_changes_nothing(tmp_path: Path) -> None:
    inpainter = AutoencoderInpainter.load(write_network(tmp_path / "zero.onnx", RESIDUAL, 2, gain=0.0))
    patches = waves(3)
    base_heights = 0.5 * patches.heights
    np.testing.assert_allclose(inpainter.predict(patches, base_heights), patches.heights, atol=1e-12)


def test_batches_of_any_count_give_the_same_numbers(tmp_path: Path) -> None:
    inpainter = AutoencoderInpainter.load(write_network(tmp_path / "copy.onnx", PAPER, 1))
    patches = waves(BATCH + 3)
    together = inpainter.predict(patches, np.zeros_like(patches.heights))
    assert together.shape == patches.heights.shape
    np.testing.assert_array_equal(together, inpainter.predict(patches, np.zeros_like(patches.heights)))


@pytest.mark.parametrize(
    ("card", "channels", "message"),
    [
        (None, 1, "no card"),
        ({**PAPER, "kind": "dictionary"}, 1, "not that of an autoencoder"),
        ({**PAPER, "recipe": "magic"}, 1, "recipe 'magic'"),
        ({**PAPER, "patch_resolution": 4}, 1, "patch_resolution"),
        ({**PAPER, "height_low": 2.0}, 1, "no range"),
        (RESIDUAL, 1, "takes"),
    ],
)
def test_networks_that_do_not_fit_are_refused(
    tmp_path: Path, card: dict[str, Any] | None, channels: int, message: str
) -> None:
    with pytest.raises(ModelError, match=message):
        AutoencoderInpainter.load(write_network(tmp_path / "bad.onnx", card, channels))


def test_a_file_that_is_no_network_is_refused(tmp_path: Path) -> None:
    (tmp_path / "junk.onnx").write_bytes(b"junk")
    with pytest.raises(ModelError, match="no network"):
        AutoencoderInpainter.load(tmp_path / "junk.onnx")

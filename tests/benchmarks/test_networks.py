import numpy as np
import pytest
import torch

from benchmarks.networks import count_flop
from training.autoencoder import build
from training.export import to_onnx

# Weights of every layer times the places where they are put to use: two operations each.
FLOP = {
    "small_4x": 2 * 9 * (32 * 576 + 1024 * (144 + 144 + 36 + 36 + 36 + 144 + 144) + 32 * 576),
    "long_12x": 2
    * 25
    * (64 * 10_000 + 4096 * (2500 + 2500 + 625 + 625 + 169 + 169 + 169 + 625 + 625 + 2500) + 64 * 2500),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", FLOP)
def test_operations_are_those_of_the_layers_however_they_are_written(name: str) -> None:
    """The zeros with which a transposed convolution is padded, once it is written as a convolution, do not count."""
    torch.manual_seed(0)
    network = build(name)
    side = network.plan.resolution
    patches = np.zeros((2, 1, side, side), np.float32)
    assert count_flop(to_onnx(network, 1, side), patches) == FLOP[name]

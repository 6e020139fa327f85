from typing import Any

import pytest
import torch
from torch import Tensor, nn, relu

from training.autoencoder import PLANS, Autoencoder, Plan, build

# Sides of the grid after every convolution, encoder and decoder.
SIDES = {
    "small_4x": ([24, 12, 12, 6], [6, 12, 12, 24, 24]),
    "multi_6x": ([100, 50, 50, 25, 25, 13], [13, 25, 25, 50, 50, 100, 100]),
    "6x_128": ([50, 25, 13], [25, 50, 100, 100]),
    "long_12x": ([100, 50, 50, 25, 25, 13], [13, 25, 25, 50, 50, 100]),
    "long_12x_SC": ([100, 50, 50, 25, 25, 13], [13, 25, 25, 50, 50, 100]),
}
PARAMETERS = {
    "small_4x": 9 * 32 + 7 * 9 * 32 * 32 + 9 * 32 + 8 * 32 + 1,
    "multi_6x": 9 * 32 + 11 * 9 * 32 * 32 + 9 * 32 + 12 * 32 + 1,
    "6x_128": 25 * (32 + 32 * 64 + 64 * 128 + 128 * 128 + 128 * 64 + 64 * 32 + 32) + 2 * (32 + 64 + 128) + 1,
    "long_12x": 25 * (64 + 10 * 64 * 64 + 64) + 11 * 64 + 1,
}
PARAMETERS["long_12x_SC"] = PARAMETERS["long_12x"]
BOTTLENECK = 128 * 13 * 13
PARAMETERS["6x_128_FC"] = PARAMETERS["6x_128"] + 2 * 4096 * BOTTLENECK + 4096 + BOTTLENECK


def run(network: nn.Module, resolution: int, seed: int = 0) -> Tensor:
    with torch.inference_mode():
        answer: Tensor = network(
            torch.rand(2, 1, resolution, resolution, generator=torch.Generator().manual_seed(seed))
        )
    return answer


@pytest.mark.parametrize("name", PLANS)
def test_networks_have_the_parameters_of_their_kernels_and_filters(name: str) -> None:
    with torch.device("meta"):
        network = build(name)
    assert sum(weight.numel() for weight in network.parameters()) == PARAMETERS[name]


@pytest.mark.parametrize("name", SIDES)
def test_strides_halve_the_grid_and_their_mirrors_double_it_back(name: str) -> None:
    network, seen = build(name), []
    for layer in (*network.encoder, *network.decoder):
        layer.register_forward_hook(lambda module, inputs, output: seen.append(output.shape[-1]))
    answer = run(network, PLANS[name].resolution)
    assert (seen[: len(network.encoder)], seen[len(network.encoder) :]) == SIDES[name]
    assert answer.shape == (2, 1, PLANS[name].resolution, PLANS[name].resolution)


def test_the_dense_layer_stands_between_encoder_and_decoder() -> None:
    plan = PLANS["6x_128_FC"]
    network = Autoencoder(Plan(16, plan.encoder, plan.decoder, n_dense=5))
    assert run(network, 16).shape == (2, 1, 16, 16)
    middle: Any = network.dense
    middle[1].weight.data.zero_()
    middle[1].bias.data.fill_(-1.0)
    # Nothing gets past it.
    assert torch.equal(run(network, 16, 1), run(network, 16, 2))


def test_skips_carry_what_the_middle_of_the_network_loses() -> None:
    for name, passes in (("long_12x", False), ("long_12x_SC", True)):
        network = build(name)
        next(network.encoder[-1].parameters()).data.zero_()
        assert torch.equal(run(network, 100, 1), run(network, 100, 2)) is not passes


def test_two_skips_add_the_maps_of_50_and_25_bins_to_those_of_the_same_size_before_the_activation() -> None:
    network = build("long_12x_SC")

    def written_out(patches: Tensor) -> Tensor:
        a1, a2, a3, a4, a5, a6 = network.encoder
        b1, b2, b3, b4, b5, b6 = network.decoder
        at_50 = relu(a2(relu(a1(patches))))
        at_25 = relu(a4(relu(a3(at_50))))
        at_13 = relu(a6(relu(a5(at_25))))
        values = relu(b2(relu(b1(at_13))) + at_25)
        values = relu(b4(relu(b3(values))) + at_50)
        answer: Tensor = b6(relu(b5(values)))
        return answer

    patches = torch.rand(2, 1, 100, 100)
    with torch.inference_mode():
        assert torch.equal(network(patches), written_out(patches))


@pytest.mark.parametrize("name", ["small_4x", "long_12x"])
def test_fresh_layers_neither_blow_up_nor_fade_out(name: str) -> None:
    torch.manual_seed(0)
    assert 0.1 < float(run(build(name), PLANS[name].resolution).std()) < 10.0

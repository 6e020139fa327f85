"""Networks that several tests make, and their files as training writes them."""

from pathlib import Path

import torch
from torch import Tensor, nn

from quadpatch.networks.residual import Residual
from quadpatch.patches.residual_input import CHANNELS, RESOLUTION
from training.export import to_onnx, write_network


def random_tensor(seed: int, *shape: int) -> Tensor:
    return torch.randn(shape, generator=torch.Generator().manual_seed(seed))


def stirred(network: Residual, by: float = 0.1) -> Residual:
    """Away from its start, where the last layer answers zero whatever the others do."""
    with torch.no_grad():
        for parameter in network.last.parameters():
            parameter.copy_(by * random_tensor(0, *parameter.shape))
    return network


def write_residual(path: Path, network: nn.Module, resolution: int = RESOLUTION) -> Path:
    """Write a network of the recipe `residual`."""
    model = to_onnx(nn.Sequential(network, nn.Identity()), CHANNELS, resolution)
    card = {"name": path.stem.partition("@")[0], "patch_resolution": resolution, "recipe": "residual"}
    write_network(path, model, card)
    return path

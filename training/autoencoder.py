"""The six convolutional denoising autoencoders of the paper (its section 5), as one table.

K. Sarkar, K. Varanasi, D. Stricker, "Learning Quadrangulated Patches For 3D Shape Processing", 2019. Strided
convolutions in place of pooling; ReLU after every layer but the last. A network gives logits: their sigmoid is the
clean patch, in the scale of its input. A transposed convolution of stride 1 is a convolution with mirrored kernels, so
it is written as one: the same functions, the same count of parameters, one kind of layer less.
"""

from dataclasses import dataclass

import torch
from torch import Tensor, nn


@dataclass(frozen=True)
class Layer:
    """Kernel side in bins, filters, and stride: 2 halves the side of the grid, or doubles it in a decoder."""

    kernel: int
    filters: int
    stride: int = 1


@dataclass(frozen=True)
class Plan:
    """One row of the table.

    Attributes
    ----------
    resolution : int
        Bins along one side of a patch.
    encoder, decoder : tuple of Layer
        Every strided layer of the decoder undoes the last strided one of the encoder that is not undone yet.
    n_dense : int
        Units of a dense layer in the middle; 0: none.
    has_skips : bool
        Whether what a strided convolution gives, the last one aside, is added to what the strided layer of the decoder
        gives that has the same size.
    """

    resolution: int
    encoder: tuple[Layer, ...]
    decoder: tuple[Layer, ...]
    n_dense: int = 0
    has_skips: bool = False


_SMALL = (Layer(3, 32), Layer(3, 32, 2))
_LONG = (Layer(5, 64), Layer(5, 64, 2))
_WIDENING = (Layer(5, 32, 2), Layer(5, 64, 2), Layer(5, 128, 2))
_LONG_DECODER = (*_LONG, *_LONG, Layer(5, 64), Layer(5, 1, 2))

PLANS = {
    "small_4x": Plan(24, _SMALL * 2, (*_SMALL * 2, Layer(3, 1))),
    "multi_6x": Plan(100, _SMALL * 3, (*_SMALL * 3, Layer(3, 1))),
    "6x_128": Plan(100, _WIDENING, (*_WIDENING[::-1], Layer(5, 1))),
    "6x_128_FC": Plan(100, _WIDENING, (*_WIDENING[::-1], Layer(5, 1)), n_dense=4096),
    "long_12x": Plan(100, _LONG * 3, _LONG_DECODER),
    "long_12x_SC": Plan(100, _LONG * 3, _LONG_DECODER, has_skips=True),
}


class Autoencoder(nn.Module):
    """A network built from one row of the table.

    Parameters
    ----------
    plan : Plan
    """

    def __init__(self, plan: Plan) -> None:
        super().__init__()
        encoder: list[nn.Module] = []
        channels, side, halved = 1, plan.resolution, []
        for layer in plan.encoder:
            encoder.append(nn.Conv2d(channels, layer.filters, layer.kernel, layer.stride, layer.kernel // 2))
            channels = layer.filters
            if layer.stride == 2:
                halved.append(side)
                side = (side + 1) // 2
        self.encoder = nn.ModuleList(encoder)
        self.dense = _dense(channels, side, plan.n_dense) if plan.n_dense else nn.Identity()
        decoder: list[nn.Module] = []
        for layer in plan.decoder:
            if layer.stride == 2:
                decoder.append(_doubling(channels, layer, halved.pop()))
            else:
                decoder.append(nn.Conv2d(channels, layer.filters, layer.kernel, padding=layer.kernel // 2))
            channels = layer.filters
        self.decoder = nn.ModuleList(decoder)
        self.plan = plan
        for module in self.modules():
            if isinstance(module, nn.Conv2d | nn.ConvTranspose2d | nn.Linear):
                _initialise(module)

    def forward(self, patches: Tensor) -> Tensor:
        """Turn scaled patches (n, 1, N, N) float into logits (n, 1, N, N) of the clean ones."""
        values, carried = patches, []
        for layer, convolution in zip(self.plan.encoder, self.encoder, strict=True):
            values = torch.relu(convolution(values))
            if self.plan.has_skips and layer.stride == 2:
                carried.append(values)
        values, carried = self.dense(values), carried[:-1]
        for layer, convolution in zip(self.plan.decoder[:-1], self.decoder[:-1], strict=True):
            values = convolution(values)
            if carried and layer.stride == 2:
                values = values + carried.pop()
            values = torch.relu(values)
        logits: Tensor = self.decoder[-1](values)
        return logits


def build(name: str) -> Autoencoder:
    """Build one of the six networks; the weights follow from torch's generator.

    Raises
    ------
    KeyError
        If it is none of `PLANS`.
    """
    return Autoencoder(PLANS[name])


def _dense(channels: int, side: int, n_units: int) -> nn.Sequential:
    n_values = channels * side * side
    return nn.Sequential(
        nn.Flatten(),
        nn.Linear(n_values, n_units),
        nn.ReLU(),
        nn.Linear(n_units, n_values),
        nn.ReLU(),
        nn.Unflatten(1, (channels, side, side)),
    )


def _doubling(channels: int, layer: Layer, side: int) -> nn.ConvTranspose2d:
    """Build a transposed convolution whose output has that side, 2 n or 2 n - 1 of n bins."""
    padding = layer.kernel // 2
    return nn.ConvTranspose2d(channels, layer.filters, layer.kernel, 2, padding, output_padding=1 - side % 2)


def _initialise(module: nn.Conv2d | nn.ConvTranspose2d | nn.Linear) -> None:
    """Draw weights so that ReLU layers keep the spread of their input (He et al. 2015)."""
    weight = module.weight
    fan_in = weight[0].numel()
    if isinstance(module, nn.ConvTranspose2d):
        # Its weight is (in, out, k, k), and every output bin is reached by one in four of the kernel's taps.
        fan_in = weight[:, 0].numel() // 4
    nn.init.normal_(weight, std=(2.0 / fan_in) ** 0.5)
    assert module.bias is not None
    nn.init.zeros_(module.bias)

"""The network `residual`: sees the fill and the mask, and answers what the fill got wrong.

A U-Net (O. Ronneberger, P. Fischer, T. Brox, "U-Net: Convolutional Networks for Biomedical Image Segmentation", 2015)
with strided convolutions in place of pooling, pixel shuffle in place of transposed convolutions and added skips. Its
last layer starts at zero, so an untrained network leaves every fill as it is.
"""

from dataclasses import dataclass
from itertools import pairwise

import torch
from torch import Tensor, nn
from torch.nn import functional

from quadpatch.inpainters.corrections import CHANNELS

RESOLUTION = 32
# Multiples of 16: processors compute as many channels at once.
WIDTHS = (32, 64, 96)

# Weight of the error's slopes beside the error itself. The error is zero on measured bins, so its slopes also tell how
# well the rim is met.
SLOPES = 0.5


class Residual(nn.Module):
    """(n, 2, N, N) to (n, 1, N, N), N a multiple of 4."""

    def __init__(self, widths: tuple[int, ...] = WIDTHS) -> None:
        super().__init__()
        steps = list(pairwise(widths))
        self.first = _two(CHANNELS, widths[0])
        self.down = nn.ModuleList(_down(fine, coarse) for fine, coarse in steps)
        self.up = nn.ModuleList(_up(coarse, fine) for fine, coarse in reversed(steps))
        self.joined = nn.ModuleList(_two(fine, fine) for fine, _ in reversed(steps))
        self.last = nn.Conv2d(widths[0], 1, 1)
        nn.init.zeros_(self.last.weight)
        nn.init.zeros_(self.last.bias)  # type: ignore[arg-type]  # a convolution without bias has None there

    def forward(self, channels: Tensor) -> Tensor:
        """Answer corrections, in spreads."""
        levels = [self.first(channels)]
        for down in self.down:
            levels.append(down(levels[-1]))
        answer = levels.pop()
        for up, joined in zip(self.up, self.joined, strict=True):
            answer = joined(functional.relu(up(answer) + levels.pop()))
        corrections: Tensor = self.last(answer)
        return corrections


def _two(inputs: int, outputs: int) -> nn.Sequential:
    return nn.Sequential(
        nn.Conv2d(inputs, outputs, 3, padding=1), nn.ReLU(), nn.Conv2d(outputs, outputs, 3, padding=1), nn.ReLU()
    )


def _down(fine: int, coarse: int) -> nn.Sequential:
    return nn.Sequential(nn.Conv2d(fine, coarse, 3, stride=2, padding=1), nn.ReLU(), _two(coarse, coarse))


def _up(coarse: int, fine: int) -> nn.Sequential:
    return nn.Sequential(nn.Conv2d(coarse, 4 * fine, 1), nn.PixelShuffle(2))


@dataclass(frozen=True)
class Errors:
    """Errors of one batch, in spreads, over the bins that were asked for.

    Attributes
    ----------
    network, fill : Tensor
        Mean absolute error with the network's corrections, and without.
    loss : Tensor
        What training makes small.
    """

    network: Tensor
    fill: Tensor
    loss: Tensor


def errors(answer: Tensor, correction: Tensor, asked: Tensor) -> Errors:
    """Compare answers (n, 1, N, N) with true corrections (n, 1, N, N) in the bins asked for."""
    count = asked.sum().clamp(min=1.0)
    wrong = (answer - correction) * asked
    across = (wrong[..., 1:] - wrong[..., :-1]).abs().sum()
    along = (wrong[..., 1:, :] - wrong[..., :-1, :]).abs().sum()
    network = wrong.abs().sum() / count
    return Errors(network, (correction * asked).abs().sum() / count, network + SLOPES * (across + along) / count)


def turned(tensors: tuple[Tensor, ...], turns: int, *, mirrored: bool) -> tuple[Tensor, ...]:
    """Turn tensors (..., N, N) by quarter turns, and mirror them or not: the frame of a patch may point anywhere."""
    rotated = (torch.rot90(tensor, turns, (-2, -1)) for tensor in tensors)
    return tuple(tensor.transpose(-2, -1) if mirrored else tensor for tensor in rotated)

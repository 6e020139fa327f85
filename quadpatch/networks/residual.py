"""The network `residual`: sees the fill and the mask, and answers what the fill got wrong.

A U-Net (O. Ronneberger, P. Fischer, T. Brox, "U-Net: Convolutional Networks for Biomedical Image Segmentation", 2015)
with strided convolutions in place of pooling, pixel shuffle in place of transposed convolutions, added skips, and a
first convolution that halves the resolution: full resolution took most of the time and gained nothing. The last layer
starts at zero, so an untrained network leaves every fill as it is.
"""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import torch
from torch import Tensor, nn
from torch.nn import functional

from quadpatch.patches.residual_input import CHANNELS

# Multiples of 16: processors compute as many channels at once.
WIDTHS = (32, 64, 96)

# Weight of the error's slopes beside the error itself. The error is zero on measured bins, so its slopes also tell how
# well the rim is met.
SLOPES = 0.5
# Added to the fill's error, in standard deviations, before a loss is divided by it.
LEAST_ERROR = 0.3
# Errors up to about this, in standard deviations, count by their square, larger ones by their size.
ROUNDING = 0.3

# Dimensions of one patch in (n, 1, N, N).
_PATCH = (1, 2, 3)

# Slope of the units below zero. With none at all, as in the paper's networks, the first steps from an answer of zero
# can switch every unit of the last level off, and nothing ever moves them again.
_LEAK = 0.1


class Residual(nn.Module):
    """(n, 2, N, N) to (n, 1, N, N), N a multiple of 8."""

    def __init__(self, widths: tuple[int, ...] = WIDTHS) -> None:
        super().__init__()
        steps = list(pairwise(widths))
        self.stem = nn.Sequential(
            nn.Conv2d(CHANNELS, widths[0], 6, stride=2, padding=2), nn.LeakyReLU(_LEAK), _Block(widths[0])
        )
        self.down = nn.ModuleList(_down(fine, coarse) for fine, coarse in steps)
        self.up = nn.ModuleList(_up(coarse, fine) for fine, coarse in reversed(steps))
        self.joined = nn.ModuleList(_Block(fine) for fine, _ in reversed(steps))
        last = nn.Conv2d(widths[0], 4, 1)
        nn.init.zeros_(last.weight)
        nn.init.zeros_(last.bias)  # type: ignore[arg-type]  # a convolution without bias has None there
        self.last = nn.Sequential(last, nn.PixelShuffle(2))

    def forward(self, channels: Tensor) -> Tensor:
        """Answer corrections, in standard deviations."""
        levels = [self.stem(channels)]
        for down in self.down:
            levels.append(down(levels[-1]))
        answer = levels.pop()
        for up, joined in zip(self.up, self.joined, strict=True):
            answer = joined(_bent(up(answer) + levels.pop()))
        corrections: Tensor = self.last(answer)
        return corrections


class _Block(nn.Module):
    """Two convolutions around which their input goes by (K. He et al., "Deep Residual Learning", 2016)."""

    def __init__(self, width: int) -> None:
        super().__init__()
        self.first, self.second = (nn.Conv2d(width, width, 3, padding=1) for _ in range(2))

    def forward(self, values: Tensor) -> Tensor:
        """Keep the shape."""
        return _bent(values + self.second(_bent(self.first(values))))


def _bent(values: Tensor) -> Tensor:
    return functional.leaky_relu(values, _LEAK)


def _down(fine: int, coarse: int) -> nn.Sequential:
    return nn.Sequential(nn.Conv2d(fine, coarse, 4, stride=2, padding=1), nn.LeakyReLU(_LEAK), _Block(coarse))


def _up(coarse: int, fine: int) -> nn.Sequential:
    return nn.Sequential(nn.Conv2d(coarse, 4 * fine, 1), nn.PixelShuffle(2))


@dataclass(frozen=True)
class Errors:
    """Errors of one batch over the bins that were asked for.

    Attributes
    ----------
    network, fill : Tensor
        Mean absolute error with the network's corrections, and without, in standard deviations.
    loss : Tensor
        Errors and their slopes, in standard deviations: to be made small on one mesh.
    relative_loss : Tensor
        The same with large errors in charge, and divided by the fill's error, patch by patch, so that a smooth mesh
        among many counts for something. Plain shares would not do: errors of smooth surfaces are next to unpredictable,
        and a network that is paid for those alone learns to answer nothing at all.
    """

    network: Tensor
    fill: Tensor
    loss: Tensor
    relative_loss: Tensor


def errors(answer: Tensor, correction: Tensor, loss_mask: Tensor) -> Errors:
    """Compare answers (n, 1, N, N) with true corrections (n, 1, N, N) in the bins asked for."""
    count = loss_mask.sum(dim=_PATCH).clamp(min=1.0)
    wrong = (answer - correction) * loss_mask
    network, fill = wrong.abs().sum(dim=_PATCH) / count, (correction * loss_mask).abs().sum(dim=_PATCH) / count
    plain = _with_slopes(wrong, torch.abs) / count
    rounded = _with_slopes(wrong, _rounded) / count
    return Errors(network.mean(), fill.mean(), plain.mean(), (rounded / (fill + LEAST_ERROR)).mean())


def _with_slopes(wrong: Tensor, size: Callable[[Tensor], Tensor]) -> Tensor:
    across, along = wrong[..., 1:] - wrong[..., :-1], wrong[..., 1:, :] - wrong[..., :-1, :]
    slopes = size(across).sum(dim=_PATCH) + size(along).sum(dim=_PATCH)
    return size(wrong).sum(dim=_PATCH) + SLOPES * slopes


def _rounded(values: Tensor) -> Tensor:
    return torch.sqrt(values**2 + ROUNDING**2) - ROUNDING


def rotated(tensors: tuple[Tensor, ...], turns: int, *, mirrored: bool) -> tuple[Tensor, ...]:
    """Turn tensors (..., N, N) by quarter turns, and mirror them or not: the frame of a patch may point anywhere."""
    rotated = (torch.rot90(tensor, turns, (-2, -1)) for tensor in tensors)
    return tuple(tensor.transpose(-2, -1) if mirrored else tensor for tensor in rotated)

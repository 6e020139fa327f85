"""Holes and turns for training patches, made anew for every batch.

The numbers are drawn with numpy on the CPU, so they are the same on every device; the grids are made with torch where
the network is.
"""

from dataclasses import dataclass

import numpy as np
import torch
from torch import Tensor

from quadpatch.types import BoolArray, FloatArray, IntArray

# Of the patch length, as in the paper.
LARGEST = 0.8
N_TURNS = 8


@dataclass(frozen=True)
class Holes:
    """One hole for each patch.

    Attributes
    ----------
    centre : (n, 2) float64
        Row and column, in patch lengths, anywhere in the patch.
    width : (n,) float64
        Side of a square or diameter of a circle, in patch lengths.
    is_square : (n,) bool
    """

    centre: FloatArray
    width: FloatArray
    is_square: BoolArray

    def cut(self, resolution: int, device: torch.device) -> Tensor:
        """Tell which bins lie outside of the holes: (n, N, N) bool."""
        ticks = (torch.arange(resolution, device=device) + 0.5) / resolution
        centre = torch.from_numpy(self.centre).to(device, torch.float32)
        half = torch.from_numpy(0.5 * self.width).to(device, torch.float32)[:, None, None]
        is_square = torch.from_numpy(self.is_square).to(device)[:, None, None]
        down = (ticks[None, :, None] - centre[:, 0, None, None]).abs()
        across = (ticks[None, None, :] - centre[:, 1, None, None]).abs()
        inside_square = (down < half) & (across < half)
        inside_circle = down**2 + across**2 < half**2
        return ~torch.where(is_square, inside_square, inside_circle)


def draw_holes(n: int, rng: np.random.Generator) -> Holes:
    """Draw squares and circles as often, of 0 to 0.8 of the patch length, at random places (section 5 of the paper)."""
    return Holes(rng.random((n, 2)), rng.uniform(0.0, LARGEST, n), rng.random(n) < 0.5)


def turn(patches: Tensor, turns: IntArray) -> Tensor:
    """Turn and mirror patches.

    The frame of a quad may point along any of its sides, so a network must know its patterns in all eight ways.

    Parameters
    ----------
    patches : (n, N, N) tensor
    turns : (n,) int64
        0 to 7: quarter turns, and from 4 on mirrored before.
    """
    rotated = patches.clone()
    for way in range(1, N_TURNS):
        # Without a wait for the device: the rows are known here.
        rows = torch.from_numpy(np.flatnonzero(turns == way)).to(patches.device)
        if len(rows):
            chosen = patches[rows].transpose(1, 2) if way >= 4 else patches[rows]
            rotated[rows] = torch.rot90(chosen, way % 4, (1, 2))
    return rotated

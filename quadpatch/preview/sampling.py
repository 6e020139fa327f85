"""Pictures from the colours at places in them: one place in each pixel, more where colours change.

Tested in `tests/quadpatch/preview/test_shading.py`.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quadpatch.mesh.raycast import Places
from quadpatch.types import BoolArray

# Red, green, blue, 0..1. Float32 is exact to far less than a step of a byte.
Colours = NDArray[np.float32]

# Pixels that differ from a neighbour by more than this (of 1) get more places.
_EDGE = 0.04
# Places within such a pixel: a rotated square, which has no two on one row or column.
_SUBPIXELS = ((0.375, 0.125), (0.875, 0.375), (0.125, 0.625), (0.625, 0.875))
# Places that are drawn together: it bounds the memory, and their numbers fit into the processor's cache.
_CHUNK = 1 << 16


def sampled(colours_at: Callable[[Places], Colours], size: tuple[int, int]) -> Colours:
    """Make pictures of one thing, or of several that are drawn together.

    Parameters
    ----------
    colours_at : callable
        Gives the colours (n_pictures, 3, n) at places (2, n): those in the middle of each pixel, and then four in each
        pixel that differs from a neighbour in any picture.
    size : (int, int)
        Columns and rows, in pixels.

    Returns
    -------
    (n_pictures, rows, columns, 3) float32
    """
    pixels = np.indices((size[1], size[0]), dtype=np.float32)[::-1].reshape(2, -1)
    colours = np.concatenate([colours_at(chunk + np.float32(0.5)) for chunk in _chunks(pixels, _CHUNK)], axis=2)
    edge = np.flatnonzero(_differs_from_neighbours(colours.reshape(-1, size[1], size[0])))
    within = np.array(_SUBPIXELS, dtype=np.float32).T[:, :, None]
    for chunk in _chunks(edge, _CHUNK // len(_SUBPIXELS)):
        samples = colours_at((pixels[:, None, chunk] + within).reshape(2, -1))
        colours[:, :, chunk] = samples.reshape(*colours.shape[:2], len(_SUBPIXELS), -1).mean(axis=2)
    return np.moveaxis(colours, 1, 2).reshape(len(colours), size[1], size[0], 3)


def _chunks(array: NDArray[Any], size: int) -> list[NDArray[Any]]:
    """Split along the last axis."""
    return [array[..., start : start + size] for start in range(0, array.shape[-1], size)]


def _differs_from_neighbours(channels: Colours) -> BoolArray:
    """Tell pixels (rows, columns) that differ from the next one in the row or column in any channel."""
    differs = np.zeros(channels.shape[1:], dtype=bool)
    for channel in channels:
        across = np.abs(np.diff(channel, axis=1)) > _EDGE
        along = np.abs(np.diff(channel, axis=0)) > _EDGE
        differs[:, 1:] |= across
        differs[:, :-1] |= across
        differs[1:] |= along
        differs[:-1] |= along
    return differs

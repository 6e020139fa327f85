"""Shift and scale of patches, so that a model sees all of them at the same size."""

from dataclasses import dataclass

import numpy as np

from quadpatch.types import BoolArray, FloatArray

# Fewer known bins than this say nothing about the size of a patch's detail.
_FEWEST_KNOWN = 3
# A spread below this part of the largest height is rounding noise of a constant patch.
_LEAST_SPREAD = 1e-12
# Mean absolute deviation of a normal distribution to its standard deviation.
_TO_STANDARD_DEVIATION = np.sqrt(np.pi / 2)


@dataclass(frozen=True)
class Normalisation:
    """What was taken off each patch: ``height = value * scale + shift``.

    Attributes
    ----------
    shift, scale : (n_patches,) float64
        In mesh units; scales are positive.
    """

    shift: FloatArray
    scale: FloatArray

    def apply(self, heights: FloatArray) -> FloatArray:
        """Heights (n_patches, N, N) in mesh units to values around 0 of size about 1."""
        return (heights - self.shift[:, None, None]) / self.scale[:, None, None]

    def undo(self, values: FloatArray) -> FloatArray:
        """Values (n_patches, N, N) back to heights in mesh units."""
        return values * self.scale[:, None, None] + self.shift[:, None, None]


def normalisation(heights: FloatArray, known: BoolArray) -> Normalisation:
    """Measure mean and spread of the known bins of each patch.

    The spread is the mean absolute deviation, scaled to equal the standard deviation of normal noise: one spike
    weighs less in it, and it is zero for nothing but a constant patch.

    Parameters
    ----------
    heights : (n_patches, N, N) float64
        In mesh units.
    known : (n_patches, N, N) bool

    Returns
    -------
    Normalisation
        A patch with fewer than three known bins takes the median scale of the others, one without any the shift 0;
        a constant patch has scale 1.
    """
    count = known.sum(axis=(1, 2))
    safe_count = np.maximum(count, 1)
    shift = np.where(known, heights, 0.0).sum(axis=(1, 2)) / safe_count
    deviation = np.where(known, np.abs(heights - shift[:, None, None]), 0.0).sum(axis=(1, 2)) / safe_count
    spread = _TO_STANDARD_DEVIATION * deviation
    largest = np.where(known, np.abs(heights), 0.0).max(axis=(1, 2), initial=0.0)
    has_spread = (count >= _FEWEST_KNOWN) & (spread > _LEAST_SPREAD * largest)
    usual = float(np.median(spread[has_spread])) if has_spread.any() else 1.0
    return Normalisation(shift, np.where(has_spread, spread, np.where(count < _FEWEST_KNOWN, usual, 1.0)))

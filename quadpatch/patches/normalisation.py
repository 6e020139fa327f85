"""From the heights of a patch to the signals that a dictionary codes, and back.

A signal is the detail of a patch (its heights over a smooth surface) shifted by the mean of its known bins and
divided by their standard deviation, so that a shallow and a deep relief of the same shape give the same signal.
Training and inpainting both call this module: a dictionary only fits signals made the way its own were.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from quadpatch.types import BoolArray, FloatArray

# What model cards call this normalisation; a model made with another one can't be used here.
NORMALISATION = "detail-mean-spread"

# The same for dictionaries of the paper's own recipe: heights over the plane of the patch, as they are.
HEIGHTS = "heights"

# A standard deviation this small against the heights themselves is rounding, not relief.
FLAT = 1e-9


@dataclass(frozen=True)
class Scaling:
    """What was taken out of every patch: ``detail = mean + deviation * signal``.

    Attributes
    ----------
    mean : (n_patches,) float64
        Mean detail of the known bins, in mesh units; 0 where none is known.
    deviation : (n_patches,) float64
        Standard deviation of the known bins' detail, in mesh units; 0 where the patch is flat or has no known bin.
    """

    mean: FloatArray
    deviation: FloatArray


def to_signals(detail: FloatArray, known: BoolArray, least_deviation: float = 0.0) -> tuple[FloatArray, Scaling]:
    """Bring patches to mean 0 and standard deviation 1 over their known bins.

    Parameters
    ----------
    detail : (n_patches, N, N) float64
        Height over the smooth surface, in mesh units; unknown bins may hold anything.
    known : (n_patches, N, N) bool
        True = measured bin.
    least_deviation : float
        In mesh units. Patches that vary less are divided by this instead, so that noise stays small.

    Returns
    -------
    signals : (n_patches, N * N) float64
        0 in unknown bins, and everywhere in flat patches.
    scaling : Scaling
        For `from_signals`.
    """
    # Written out, because -1 has no meaning for no patch at all.
    shape = len(detail), detail.shape[1] * detail.shape[2]
    flat_known = known.reshape(shape)
    values = np.where(flat_known, detail.reshape(shape), 0.0)
    count = np.maximum(flat_known.sum(axis=1), 1)
    mean = values.sum(axis=1) / count
    centred = np.where(flat_known, values - mean[:, None], 0.0)
    deviation = np.sqrt((centred**2).sum(axis=1) / count)
    deviation = np.where(deviation > FLAT * np.abs(values).max(axis=1, initial=0.0), deviation, 0.0)
    deviation = np.where(deviation > 0.0, np.maximum(deviation, least_deviation), 0.0)
    signals = np.divide(centred, deviation[:, None], out=np.zeros_like(centred), where=deviation[:, None] > 0.0)
    return signals, Scaling(mean, deviation)


def from_signals(signals: FloatArray, scaling: Scaling) -> FloatArray:
    """Undo `to_signals` or `raw_heights`.

    Parameters
    ----------
    signals : (n_patches, N * N) float64
        Completed signals, ``codes @ atoms.T``.
    scaling : Scaling
        As they gave it.

    Returns
    -------
    (n_patches, N, N) float64
        Detail, in mesh units.
    """
    n_patches, n_bins = signals.shape
    resolution = int(np.sqrt(n_bins))
    detail = scaling.mean[:, None] + scaling.deviation[:, None] * signals
    return detail.reshape(n_patches, resolution, resolution)


def raw_heights(heights: FloatArray, known: BoolArray) -> tuple[FloatArray, Scaling]:
    """Leave the heights of patches as they are: the signals of the paper's own recipe.

    Less the mean of the known bins, no atom could carry a level, and the level inside a hole would be that of its rim.

    Parameters
    ----------
    heights : (n_patches, N, N) float64
        Over the plane of the patch, in mesh units; unknown bins may hold anything.
    known : (n_patches, N, N) bool
        True = measured bin.

    Returns
    -------
    signals : (n_patches, N * N) float64
        In mesh units; 0 in unknown bins.
    scaling : Scaling
        For `from_signals`; its mean is 0 and its deviation 1, a pure number.
    """
    # Written out, because -1 has no meaning for no patch at all.
    shape = len(heights), heights.shape[1] * heights.shape[2]
    signals = np.where(known.reshape(shape), heights.reshape(shape), 0.0)
    return signals, Scaling(np.zeros(len(heights)), np.ones(len(heights)))


# How signals are made, by what model cards call it. `from_signals` undoes them all.
NORMALISATIONS: dict[str, Callable[[FloatArray, BoolArray], tuple[FloatArray, Scaling]]] = {
    NORMALISATION: to_signals,
    HEIGHTS: raw_heights,
}

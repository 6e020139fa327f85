"""What a network of the recipe `residual` sees of a patch, and what its answer means.

It sees the detail of the filled surface over the base surface, in standard deviations of the known bins, and which bins
are known. It answers how much higher the true surface lies in the bins that were invented: zero means the fill as it
is.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from quadpatch.patches.normalisation import FLAT, to_signals
from quadpatch.types import FloatArray, Patches

CHANNELS = 2
RESOLUTION = 32

# Single bins may stand out (a spike at a fold), and must not drown the others.
LARGEST = 10.0


@dataclass(frozen=True)
class NetworkInput:
    """Patches as the network sees them.

    Attributes
    ----------
    channels : (n, 2, N, N) float32
        Detail in standard deviations, and 1 for known bins.
    deviation : (n,) float64
        Standard deviation of the known detail, in mesh units; 0 where there is none.
    """

    channels: NDArray[np.float32]
    deviation: FloatArray


def network_input(patches: Patches, base_heights: FloatArray) -> NetworkInput:
    """Prepare patches for a network.

    Parameters
    ----------
    patches : Patches
        Heights in unknown bins are those of the fill.
    base_heights : (n, N, N) float64
    """
    detail = patches.heights - base_heights
    _, scaling = to_signals(detail, patches.known)
    centred = np.where(patches.seen, detail - scaling.mean[:, None, None], 0.0)
    # A detail this small is what rounding left between a flat surface and its base surface.
    deviation = np.where(scaling.deviation > FLAT * patches.length, scaling.deviation, 0.0)
    signals = standardise(centred, deviation)
    return NetworkInput(np.stack([signals, patches.known], axis=1, dtype=np.float32), deviation)


def standardise(lengths: FloatArray, deviation: FloatArray) -> FloatArray:
    """Divide lengths (n, N, N) by the standard deviation (n,) of their patch; 0 for flat patches."""
    wide = np.broadcast_to(deviation[:, None, None], lengths.shape)
    signals = np.divide(lengths, wide, out=np.zeros_like(lengths), where=wide > 0.0)
    return np.asarray(np.clip(signals, -LARGEST, LARGEST))


def corrected(patches: Patches, deviation: FloatArray, corrections: FloatArray) -> FloatArray:
    """Heights (n, N, N), in mesh units: those of the fill, corrected in invented bins by (n, N, N) deviations."""
    return np.asarray(patches.heights + np.where(patches.known, 0.0, corrections * deviation[:, None, None]))

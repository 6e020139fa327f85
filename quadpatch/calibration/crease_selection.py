"""Whether fills of a surface are to have creases: tried on calibration holes."""

from dataclasses import dataclass

from quadpatch.calibration.calibration_set import CalibrationSet, choose_blend_factor, may_gain
from quadpatch.calibration.energy_selection import EnergyBlend
from quadpatch.filling.creases import crease_displacement, crease_share
from quadpatch.filling.filled_mesh import FilledMesh

# Where creases are rarer among the edges that calibration holes took, there is nothing to gain.
_LEAST_CREASE_SHARE = 0.002


@dataclass(frozen=True)
class CreaseCalibration:
    """What calibration says of creases.

    Attributes
    ----------
    share : float
        Of the displacement that `crease_displacement` finds; 0 for faired fills.
    filled : FilledMesh or None
        The calibration holes, filled as densely as real ones and with creases; None with a share of 0.
    """

    share: float = 0.0
    filled: FilledMesh | None = None


def calibrate_creases(holes: CalibrationSet, blend: EnergyBlend, filled: FilledMesh) -> CreaseCalibration:
    """Try creases on the calibration holes, of which `filled` is the faired fill."""
    if crease_share(holes.truth) < _LEAST_CREASE_SHARE:
        return CreaseCalibration()
    uniform = fill_uniformly(holes, blend, filled)
    # Where faces meet in creases, the first round gains already.
    if not may_gain(holes, uniform, crease_displacement(uniform, rounds=1)):
        return CreaseCalibration()
    displacement = crease_displacement(uniform)
    share = choose_blend_factor(holes, uniform, displacement)
    return CreaseCalibration(share, uniform.displaced(share * displacement)) if share else CreaseCalibration()


def fill_uniformly(holes: CalibrationSet, blend: EnergyBlend, filled: FilledMesh) -> FilledMesh:
    """Fill the calibration holes as densely as real ones: what is found on graded fills is another thing."""
    if filled.energy_weights is None or not holes.is_graded:
        return filled
    return blend.fill_weighted(holes.closed_uniformly(), filled.energy_weights)

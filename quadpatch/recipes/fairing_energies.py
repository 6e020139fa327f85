"""The energies that compete for a surface, and which of them may.

Tested in `tests/quadpatch/calibration/test_calibration_set.py`.
"""

from quadpatch.calibration.calibration_set import CalibrationSet
from quadpatch.calibration.energy_selection import AS_WIDE, EnergyBlend, learn_energy_blend
from quadpatch.filling.fairing import THIN_PLATE, Energy
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.processes import ProcessPool
from quadpatch.progress import Fraction, no_fraction

# From rough to smooth: a noisy surface is continued best by the first, a rough one by the second, a smooth one by the
# last.
FAIRING_ENERGIES = (
    Energy(membrane=0.3, plate=1.0),
    Energy(membrane=0.1, plate=1.0, slope=2.0),
    Energy(plate=1.0, variation=0.4),
    Energy(plate=1.0, variation=0.4, slope=1.5),
    Energy(plate=1.0, variation=2.0, slope=1.5),
    Energy(plate=1.0, variation=40.0),
)

# For surfaces on which calibration can't tell the energies apart.
DEFAULT_ENERGY = FAIRING_ENERGIES[2]
# For surfaces whose calibration holes are narrower than the real ones.
PLAIN_ENERGIES = (
    FAIRING_ENERGIES[0],
    THIN_PLATE,
    *(Energy(plate=1.0, variation=weight) for weight in (0.4, 2.0, 40.0)),
)
# For surfaces without room for calibration: they are coarse for their holes, and a rim of few edges shows no curvature
# to carry on.
PRIOR_ENERGY = THIN_PLATE
# All that a calibration may end with.
CALIBRATED_ENERGIES = tuple(dict.fromkeys((*FAIRING_ENERGIES, *PLAIN_ENERGIES, PRIOR_ENERGY)))


def suitable_blend(
    holes: CalibrationSet | None,
    diameter: float | None = None,
    reach: Fraction = no_fraction,
    pool: ProcessPool | None = None,
) -> tuple[EnergyBlend, FilledMesh | None]:
    """Learn how this surface is continued best, as far as calibration tells; also the calibration holes, filled.

    Energies with a slope take part where calibration holes are as wide as the real ones (mesh units) typically are.
    """
    if holes is None:
        return EnergyBlend.of_one(PRIOR_ENERGY), None
    is_narrow = diameter is not None and diameter > AS_WIDE * holes.diameter
    return learn_energy_blend(holes, PLAIN_ENERGIES if is_narrow else FAIRING_ENERGIES, DEFAULT_ENERGY, reach, pool)

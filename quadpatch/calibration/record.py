"""What calibration found out about a scan, small enough to be kept, and exact through JSON.

Calibration holes are cut at places that follow from scan, options and seed, so they need not be kept: what they were
filled by is enough to fill them again with the same bits.
"""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from quadpatch.calibration.calibration_set import CalibrationSet
from quadpatch.calibration.energy_selection import EnergyBlend
from quadpatch.calibration.error_model import ErrorModel
from quadpatch.filling.creases import crease_displacement
from quadpatch.filling.fairing import Energy
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.filling.parts import FillInParts
from quadpatch.processes import ProcessPool
from quadpatch.types import FloatArray


@dataclass(frozen=True)
class CalibrationRecord:
    """What calibration found out.

    Attributes
    ----------
    blend : EnergyBlend
        What holes are faired by.
    error_model : ErrorModel
        How large an error of that to expect.
    crease_share : float
        See `quadpatch.calibration.crease_selection.CreaseCalibration`.
    is_graded : bool
        Whether the calibration holes are large for their edges; they are filled as densely as real ones all the same.
    weights : (n_holes, n_energies) float64 or None
        Of the energies of the blend, in the fill of every calibration hole; rows sum to 1. None where the surface has
        no room for calibration holes.
    seconds : float
        That calibration took.
    """

    blend: EnergyBlend
    error_model: ErrorModel
    crease_share: float = 0.0
    is_graded: bool = False
    weights: FloatArray | None = None
    seconds: float = 0.0

    @property
    def n_holes(self) -> int:
        """How many calibration holes there were."""
        return 0 if self.weights is None else len(self.weights)

    def fill(self, holes: CalibrationSet) -> FilledMesh:
        """Fill the calibration holes, of which there are some, like real ones."""
        weights = np.zeros((0, 0)) if self.weights is None else self.weights
        if self.is_graded:
            filled = self.blend.fill_weighted(holes.closed_uniformly(), weights)
        else:
            filled = self.blend.fair(holes.closed, weights)
        return self._with_creases(filled)

    def fill_others(self, holes: CalibrationSet, pool: ProcessPool) -> FilledMesh:
        """Fill calibration holes like real ones, of which it is not known by which weights; a pool shares the work."""
        filling = FillInParts(holes.opened, holes.loops, pool)
        filling.begin(self.blend.fill_closed)
        return self._with_creases(filling.finish())

    def _with_creases(self, filled: FilledMesh) -> FilledMesh:
        return filled.displaced(self.crease_share * crease_displacement(filled)) if self.crease_share else filled

    def plain(self) -> dict[str, Any]:
        """Give the record as JSON takes it; `record_of` reads that back with the same bits."""
        blend = self.blend
        return {
            "energies": [asdict(energy) for energy in blend.energies],
            "log_error": blend.log_error.tolist(),
            "log_miss": blend.log_miss.tolist(),
            "best": blend.best,
            "belief": blend.belief,
            "widest": blend.widest,
            "error_model": asdict(self.error_model),
            "crease_share": self.crease_share,
            "is_graded": self.is_graded,
            "weights": None if self.weights is None else self.weights.tolist(),
            "seconds": self.seconds,
        }


def record_of(fields: Mapping[str, Any]) -> CalibrationRecord:
    """Turn what `CalibrationRecord.plain` gave and `quadpatch_rules.calibration_records` checked into a record."""
    return CalibrationRecord(
        EnergyBlend(
            [Energy(**weights) for weights in fields["energies"]],
            np.array(fields["log_error"]),
            np.array(fields["log_miss"]),
            fields["best"],
            fields["belief"],
            fields["widest"],
        ),
        ErrorModel(**fields["error_model"]),
        fields["crease_share"],
        fields["is_graded"],
        None if fields["weights"] is None else np.array(fields["weights"]),
        fields["seconds"],
    )

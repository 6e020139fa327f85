"""How large an error to expect of a fill, learned from calibration holes, whose true error is known.

Two signs tell uncertain holes from sure ones, both without unit: the gap between two sensible fills as a share of the
hole's width, and how much the surface turns along the rim. Their geometric mean is the uncertainty u of the hole. The
mean error, as a share of the width, is taken for a power of it, ``factor * u ** slope``. Where u says nothing about the
calibration holes (a relief that is as deep everywhere) the slope comes out as 0: all holes are taken for equally wrong.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.types import FloatArray

# Logarithms need more than nothing: what is smaller counts as this.
_LEAST = 1e-9

# The slope on 22 scans and reliefs outside the benchmark, and what it weighs against calibration holes whose ln u
# scatter by as large a sum of squares: the variance of errors around their power law over that of the slope between
# meshes.
PRIOR_SLOPE = 0.9
WEIGHT = 1.6


@dataclass(frozen=True)
class ErrorModel:
    """Mean error of a fill, as a share of the hole's width, by its uncertainty u: ``factor * u ** slope``."""

    factor: float
    slope: float

    def errors(self, filled: FilledMesh, diameters: Sequence[float] | FloatArray) -> FloatArray:
        """Give the expected mean distance (n_holes,) of every fill to the true surface, in mesh units.

        Parameters
        ----------
        filled : FilledMesh
        diameters : (n_holes,) float64
            Of the filled holes, in mesh units.
        """
        widths = np.asarray(diameters, np.float64)
        expected: FloatArray = self.factor * widths * _uncertainty(filled, widths) ** self.slope
        return expected


# For surfaces that have no room for calibration; on scans the factor came out as 0.24 to 0.88.
PRIOR = ErrorModel(0.45, PRIOR_SLOPE)


def fit_error_model(filled: FilledMesh, diameters: FloatArray, errors: FloatArray) -> ErrorModel:
    """Fit the power law to holes whose error is known: the slope to the logarithms, the factor to the mean error.

    Parameters
    ----------
    filled : FilledMesh
    diameters, errors : (n_holes,) float64
        In mesh units.
    """
    # Holes so small that they got no vertex have no disagreement: as outliers they would weigh most.
    telling = filled.disagreement > 0
    log_u = np.log(_uncertainty(filled, diameters))[telling]
    log_error = np.log(np.maximum(errors / diameters, _LEAST))[telling]
    scatter = log_u - log_u.sum() / max(len(log_u), 1)
    slope = (scatter @ log_error + WEIGHT * PRIOR_SLOPE) / (scatter @ scatter + WEIGHT)
    shape = ErrorModel(1.0, float(np.clip(slope, 0.0, 1.0)))
    return ErrorModel(float(errors.sum() / shape.errors(filled, diameters).sum()), shape.slope)


def _uncertainty(filled: FilledMesh, diameters: FloatArray) -> FloatArray:
    share = filled.disagreement / np.maximum(diameters, np.finfo(np.float64).tiny)
    return np.asarray(np.maximum(np.sqrt(share * filled.rim_variation), _LEAST))

"""How wrong a restored vertex is expected to be: learned from hidden vertices.

Two sensible ways to place a vertex, a smooth one and one that keeps edges, differ the more the less its surroundings
say. Their distance is the sign by which unsure vertices are told from sure ones; what it amounts to is read off the
errors of hidden vertices, in classes of equal count, and never falls as the sign grows.
"""

from dataclasses import dataclass

import numpy as np

from quadpatch.types import FloatArray

# Hidden vertices are put into at most so many classes.
_CLASSES = 12
_FEWEST_IN_CLASS = 10


@dataclass(frozen=True)
class ErrorCurve:
    """Expected error over the distance between two placements; both in mesh units.

    Attributes
    ----------
    sign : (k,) float64
        Ascending.
    error : (k,) float64
        Not descending.
    """

    sign: FloatArray
    error: FloatArray

    def expected(self, sign: FloatArray) -> FloatArray:
        """Give expected errors (n,): between classes by interpolation, beyond the last in proportion."""
        inside = np.interp(sign, self.sign, self.error)
        beyond = np.maximum(sign / max(float(self.sign[-1]), 1e-300), 1.0)
        return np.asarray(inside * beyond)


def learn_error_curve(sign: FloatArray, error: FloatArray, weight: FloatArray) -> ErrorCurve:
    """Learn the curve from hidden vertices.

    Parameters
    ----------
    sign, error, weight : (h,) float64
        Distances between the placements and to the true surface, in mesh units, and weights that sum to 1.

    Returns
    -------
    ErrorCurve
        Its root mean square over the hidden vertices is that of their errors.
    """
    order = np.argsort(sign, kind="stable")
    n_classes = max(1, min(_CLASSES, len(order) // _FEWEST_IN_CLASS))
    signs, errors = np.zeros(n_classes), np.zeros(n_classes)
    for k, members in enumerate(np.array_split(order, n_classes)):
        mass = np.maximum(weight[members], 1e-12)
        signs[k] = np.average(sign[members], weights=mass)
        errors[k] = np.sqrt(np.average(error[members] ** 2, weights=mass))
    curve = ErrorCurve(signs, np.maximum.accumulate(errors))
    stated = np.sqrt(np.average(curve.expected(sign) ** 2, weights=weight))
    true = np.sqrt(np.average(error**2, weights=weight))
    return ErrorCurve(signs, curve.error * (true / stated if stated > 0 else 1.0))

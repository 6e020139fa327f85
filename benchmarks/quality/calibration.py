"""Does confidence mean something: expected against true errors of single holes."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from scipy.stats import rankdata, spearmanr

from quadpatch.types import FloatArray

LEAST_CONFIDENT = 0.1


@dataclass(frozen=True)
class Calibration:
    """How well expected errors and confidences rank fills.

    Attributes
    ----------
    n_holes : int
    rank_correlation : float
        Spearman's, between expected and true error.
    tenth_ratio : float
        Mean true error of the tenth of the holes with the least confidence, over that of the rest.
    true_per_expected : float
        Mean true over mean expected error: 1 is unbiased.
    """

    n_holes: int
    rank_correlation: float
    tenth_ratio: float
    true_per_expected: float

    def facts(self) -> dict[str, Any]:
        """As JSON."""
        return asdict(self)


def calibrate(holes: Sequence[dict[str, Any]]) -> Calibration | None:
    """Compare `expected_error`, `confidence` and `true_error` of many holes.

    Of holes of equal confidence across the border of the last tenth each counts in part.

    Returns
    -------
    Calibration or None
        None for fewer than ten holes with an expected error (the paper's recipe gives none), or where these are all
        the same: there is nothing to rank.
    """
    rated = [hole for hole in holes if hole["expected_error"] is not None]
    true, expected, confidence = (
        np.array([float(hole[name]) for hole in rated]) for name in ("true_error", "expected_error", "confidence")
    )
    if len(rated) < round(1 / LEAST_CONFIDENT) or not np.ptp(expected) or not np.ptp(true):
        return None
    rank = float(spearmanr(expected, true).statistic)
    return Calibration(len(rated), rank, _tenth_ratio(true, confidence), float(true.mean() / expected.mean()))


def _tenth_ratio(true: FloatArray, confidence: FloatArray) -> float:
    tenth = max(1, int(LEAST_CONFIDENT * len(true)))
    lowest = rankdata(confidence, method="min") - 1
    share = np.zeros(len(true))
    # Holes from rank r on that tie share what is left of the tenth.
    for rank in np.unique(lowest):
        tied = lowest == rank
        share[tied] = np.clip((tenth - rank) / tied.sum(), 0.0, 1.0)
    least_confident, others = (float((true * weight).sum() / weight.sum()) for weight in (share, 1 - share))
    return least_confident / others

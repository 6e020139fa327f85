"""Two repairs of the same holes, compared by what calibration says of them."""

import math
from collections.abc import Mapping
from typing import Any


def expected_errors(report: Mapping[str, Any]) -> dict[int, float]:
    """Return the expected error of every filled hole of a report by its id, in mesh units.

    It is empty where the scan had no room for calibration holes: then errors are guesses that say nothing of a model.
    """
    if not (report.get("calibration") or {}).get("holes"):
        return {}
    errors = {hole["id"]: hole["expected_error"] for hole in report["holes"]}
    return {number: float(error) for number, error in errors.items() if error is not None and error > 0}


def error_ratio(candidate: Mapping[str, Any], baseline: Mapping[str, Any]) -> tuple[int, float] | None:
    """Return how many holes both reports have an error of, and the geometric mean of its ratio.

    Parameters
    ----------
    candidate, baseline : mapping
        Reports of the same mesh, filled with the same options by two models; below 1 the first one is better.

    Returns
    -------
    int, float or None
        None where there is no such hole.
    """
    errors, others = expected_errors(candidate), expected_errors(baseline)
    logs = [math.log(errors[number] / others[number]) for number in sorted(errors.keys() & others.keys())]
    return (len(logs), math.exp(sum(logs) / len(logs))) if logs else None

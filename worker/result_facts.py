"""The facts of a result that clients see, read out of an engine's report.

Tested in `tests/worker/test_results.py`.
"""

from collections.abc import Mapping
from typing import Any

from quadpatch_client.schema import HoleCounts
from quadpatch_rules.coded_warnings import add_warning, warning


def facts_of_fill(report: Mapping[str, Any]) -> dict[str, Any]:
    """Return the fields of `JobResult` that the report of a repair tells: verdicts, what was added, warnings."""
    counts = HoleCounts.model_validate(report["counts"])
    return {
        "holes": counts,
        "new_vertices": sum(hole.get("new_vertices", 0) for hole in report["holes"]),
        "new_triangles": sum(hole.get("new_triangles", 0) for hole in report["holes"]),
        **_warnings(report, counts),
        "acceptance": report.get("acceptance"),
    }


def facts_of_task(report: Mapping[str, Any]) -> dict[str, Any]:
    """Return the same of a report of another task: what it counts and measures, lengths in mesh units."""
    return {
        "restored_vertices": report.get("vertices", {}).get("restored"),
        "moved_vertices": report.get("moved_vertices"),
        "shift_95": report.get("shift_95"),
        "max_error": _largest_error(report),
        **_warnings(report),
    }


def facts_of_training(report: Mapping[str, Any], model: str, sha256: str) -> dict[str, Any]:
    """Return the same of a training, before its version has a number."""
    names = ("kind", "learned_from", "patches", "judged", "is_better", "verdict")
    unnumbered = {"model": model, "version": 1, "is_new": True, "sha256": sha256}
    learned = {**unnumbered, **{name: report[name] for name in names}}
    return {"training": learned, **_warnings(report)}


def _largest_error(report: Mapping[str, Any]) -> float | None:
    """Return the error of an encoded surface: the larger of both directions, or what the file promises."""
    error = report.get("max_error")
    if isinstance(error, Mapping):
        return max(float(error["true_to_decoded"]), float(error["decoded_to_true"]))
    return error


def _warnings(report: Mapping[str, Any], counts: HoleCounts | None = None) -> dict[str, Any]:
    """Collect the report's warnings; a refused hole is one, whether or not the report says so in words."""
    found = {name: list(report.get(name, [])) for name in ("warnings", "warning_details")}
    refused = 0 if counts is None else counts.refused
    if refused and not found["warnings"]:
        add_warning(found, warning("hole_refused") if refused == 1 else warning("holes_refused", refused=refused))
    return found

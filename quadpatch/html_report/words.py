"""What stands in a report as codes and numbers, in words.

Tested in `tests/quadpatch/html_report/test_page.py`.
"""

import json
from collections.abc import Iterator, Mapping
from typing import Any

VERDICTS = {
    "filled": "filled, with detail from a model",
    "filled_smooth": "filled by geometry alone",
    "skipped": "left open by rule",
    "refused": "left open: no sound fill was found",
}
KINDS = {"hole": "hole", "slit": "slit", "border": "outer border", "open_end": "open end"}
FILLS = {
    "energies": "fairing energies",
    "creases": "fairing energies with creases",
    "flat": "plane patch",
    "thin_plate": "thin plate",
    "constrained": "constrained fairing",
}
FAULTS = {
    "refused": "it stays open",
    "unknown": "it has no figure that a limit asks for",
    "expected_error": "the expected error is over the limit",
    "error_share": "the expected error is over the limit for a hole of its diameter",
    "confidence": "the confidence is below the limit",
}
NONE = "–"
# Names of models that stand for none where no shares are given: what competed has lost, or nothing was to compete.
_WITHOUT_MODEL = ("auto", "smooth")
WEIGHTS = ("membrane", "plate", "variation", "slope")
# From here on numbers are written without decimals, and with thousands separated.
_LARGE, _HUGE = 1e4, 1e15


def figure(value: float | None) -> str:
    """Write a number for people: whole ones with separators, others with four digits; a dash for none."""
    if value is None:
        return NONE
    if isinstance(value, int):
        return f"{value:,}"
    return f"{value:,.0f}" if _LARGE <= abs(value) < _HUGE else f"{value:.4g}"


def percent(share: float) -> str:
    """Write a share of 0..1, such as `12.5 %`, on one line."""
    return f"{100 * share:.3g}\u00a0%"


def energy_names(report: Mapping[str, Any]) -> dict[tuple[float, ...], str]:
    """Give each energy of a report a short name, by its `WEIGHTS`: E1 is the first that a hole has."""
    found = dict.fromkeys(_weights(part) for row in report["holes"] for part in row["energies"] or [])
    return {weights: f"E{i}" for i, weights in enumerate(found, 1)}


def geometric_fill(row: Mapping[str, Any], names: Mapping[tuple[float, ...], str]) -> str:
    """Name the geometric fill of a hole, and of which energies it is the minimum."""
    if row["fill"] is None:
        return NONE
    largest_first = sorted(row["energies"] or [], key=lambda part: -part["share"])
    parts = [f"{names[_weights(part)]}\u00a0{percent(part['share'])}" for part in largest_first]
    return FILLS.get(row["fill"], str(row["fill"])) + (f": {', '.join(parts)}" if parts else "")


def _weights(part: Mapping[str, float]) -> tuple[float, ...]:
    return tuple(part[name] for name in WEIGHTS)


def model(report: Mapping[str, Any]) -> str:
    """Name the models whose detail holes got."""
    facts = report["model"]
    shares = facts.get("shares", {})
    if shares:
        return ", ".join(f"{name} {percent(share)}" for name, share in shares.items())
    if facts["name"] in _WITHOUT_MODEL:
        return "none: geometry alone"
    number = facts.get("version")
    return f"{facts['name']}@{number}" if number is not None else str(facts["name"])


def model_of_hole(row: Mapping[str, Any], report: Mapping[str, Any]) -> str:
    """Say which model a fill has its detail from."""
    return {"filled": model(report), "filled_smooth": "none"}.get(row["verdict"], NONE)


def flattened(values: Mapping[str, Any], path: str = "") -> Iterator[tuple[str, str]]:
    """List nested values as pairs of a dotted name and its JSON text."""
    for name, value in values.items():
        if isinstance(value, Mapping) and value:
            yield from flattened(value, f"{path}{name}.")
        else:
            yield f"{path}{name}", value if isinstance(value, str) else json.dumps(value, ensure_ascii=False)

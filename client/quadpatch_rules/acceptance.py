"""Whether the holes of a repair meet limits, judged by the rows of its report."""

from collections.abc import Mapping, Sequence
from typing import Any

# Holes that a sentence names; the judgement lists all of them.
_MOST_NAMED = 20
# Holes of which a sentence says why.
_MOST_EXPLAINED = 3


def judge(holes: Sequence[Mapping[str, Any]], limits: Mapping[str, Any]) -> dict[str, Any]:
    """Hold limits against the holes of a report; what was skipped was not chosen.

    Parameters
    ----------
    holes : sequence of mapping
    limits : mapping
        `max_expected_error` in mesh units, `max_error_share` of the hole's diameter, `min_confidence`; None, or not
        there, where there is no such limit.

    Returns
    -------
    dict
        `is_met`; `holes`, how many were chosen; and `unmet`, those that do not meet the limits, by id, each with its
        `faults`: `refused`, `unknown` where it has no figure that a limit asks for, else the limits.
    """
    chosen = [hole for hole in holes if hole["verdict"] != "skipped"]
    unmet = [
        {"id": hole["id"], "faults": faults, "expected_error": hole["expected_error"], "confidence": hole["confidence"]}
        for hole in sorted(chosen, key=lambda hole: int(hole["id"]))
        if (faults := _faults(hole, limits))
    ]
    return {"is_met": not unmet, "holes": len(chosen), "unmet": unmet}


def unmet_in_words(judged: Mapping[str, Any], rule: str | None, limits: Mapping[str, Any]) -> str:
    """Say which holes miss the limits, of a rule where it has a name; of a few also by which figure.

    Parameters
    ----------
    judged : mapping
        As `judge` returns it.
    rule : str, optional
    limits : mapping
        As for `judge`.
    """
    unmet = judged["unmet"]
    chosen = f"{judged['holes']} chosen {'hole' if judged['holes'] == 1 else 'holes'}"
    of_rule = "" if rule is None else f" of {rule}"
    if len(unmet) <= _MOST_EXPLAINED:
        named = ", ".join(f"hole {hole['id']} ({_why(hole, limits)})" for hole in unmet)
    else:
        named = "holes " + ", ".join(str(hole["id"]) for hole in unmet[:_MOST_NAMED])
        named += ", …" if len(unmet) > _MOST_NAMED else ""
    return f"{len(unmet)} of {chosen} {'misses' if len(unmet) == 1 else 'miss'} the limits{of_rule}: {named}"


def _why(hole: Mapping[str, Any], limits: Mapping[str, Any]) -> str:
    return "; ".join(_fault_in_words(fault, hole, limits) for fault in hole["faults"])


def _fault_in_words(fault: str, hole: Mapping[str, Any], limits: Mapping[str, Any]) -> str:
    if fault == "expected_error":
        return f"expected error {hole['expected_error']:.3g}, at most {limits['max_expected_error']:g}"
    if fault == "error_share":
        return f"expected error {hole['expected_error']:.3g}, at most {limits['max_error_share']:g} of its diameter"
    if fault == "confidence":
        return f"confidence {hole['confidence']:.3g}, at least {limits['min_confidence']:g}"
    return "it has no such figure" if fault == "unknown" else "refused"


def _faults(hole: Mapping[str, Any], limits: Mapping[str, Any]) -> list[str]:
    if hole["verdict"] == "refused":
        return ["refused"]
    error, confidence = hole["expected_error"], hole["confidence"]
    largest, share, least = (limits.get(name) for name in ("max_expected_error", "max_error_share", "min_confidence"))
    wants_error = largest is not None or share is not None
    if (wants_error and error is None) or (least is not None and confidence is None):
        return ["unknown"]
    held = [
        ("expected_error", largest is not None and error > largest),
        ("error_share", share is not None and error > share * hole["diameter"]),
        ("confidence", least is not None and confidence < least),
    ]
    return [fault for fault, is_over in held if is_over]

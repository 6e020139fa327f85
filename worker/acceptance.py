"""Whether the holes of a repair meet the limits of its spec, judged by the report."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from quadpatch.formats.output_files import write_whole
from quadpatch_client.schema import Acceptance, Accepted, HoleFault, JobSpec, UnmetHole
from worker.engine.request import REPORT_NAME
from worker.failures import EngineFailedError, Failure

# Holes that a sentence names; a result lists all of them.
_MOST_NAMED = 20


def check_acceptance(folder: Path, spec: JobSpec) -> None:
    """Write into the report in a request's folder what comes of the spec's limits; nothing where it has none.

    Raises
    ------
    EngineFailedError
        `acceptance_not_met`, if a hole does not meet them and the spec says that the job fails then.
    """
    if spec.acceptance is None:
        return
    path = folder / REPORT_NAME
    report: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    accepted = judge(report["holes"], spec.acceptance)
    if not accepted.is_met:
        message = _sentence(accepted, spec.rule)
        if spec.acceptance.otherwise == "fail":
            raise EngineFailedError(Failure("acceptance_not_met", message, "judge"))
        report["warnings"].append(message)
    report["acceptance"] = accepted.model_dump(mode="json")
    write_whole(path, json.dumps(report).encode())


def judge(holes: list[Mapping[str, Any]], acceptance: Acceptance) -> Accepted:
    """Hold the limits against the holes of a report; what was skipped was not chosen."""
    chosen = [hole for hole in holes if hole["verdict"] != "skipped"]
    found = [(hole, faults) for hole in chosen if (faults := _faults(hole, acceptance))]
    unmet = [
        UnmetHole(id=hole["id"], faults=faults, expected_error=hole["expected_error"], confidence=hole["confidence"])
        for hole, faults in sorted(found, key=lambda one: int(one[0]["id"]))
    ]
    return Accepted(is_met=not unmet, holes=len(chosen), unmet=unmet)


def _faults(hole: Mapping[str, Any], acceptance: Acceptance) -> list[HoleFault]:
    if hole["verdict"] == "refused":
        return ["refused"]
    error, confidence = hole["expected_error"], hole["confidence"]
    wants_error = acceptance.max_expected_error is not None or acceptance.max_error_share is not None
    if (wants_error and error is None) or (acceptance.min_confidence is not None and confidence is None):
        return ["unknown"]
    held: list[tuple[HoleFault, bool]] = [
        ("expected_error", _is_over(error, acceptance.max_expected_error)),
        ("error_share", _is_over(error, acceptance.max_error_share, hole["diameter"])),
        ("confidence", acceptance.min_confidence is not None and confidence < acceptance.min_confidence),
    ]
    return [fault for fault, is_over in held if is_over]


def _is_over(value: float | None, limit: float | None, unit: float = 1.0) -> bool:
    return limit is not None and value is not None and value > limit * unit


def _sentence(accepted: Accepted, rule: str | None) -> str:
    ids = [str(hole.id) for hole in accepted.unmet]
    named = ", ".join(ids[:_MOST_NAMED]) + (", …" if len(ids) > _MOST_NAMED else "")
    limits = "the limits" if rule is None else f"the rule {rule}"
    verb = "does" if len(ids) == 1 else "do"
    return f"{len(ids)} of {accepted.holes} holes {verb} not meet {limits}: {named}"

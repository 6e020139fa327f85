"""A finished job in sentences."""

from collections.abc import Iterable, Mapping
from typing import Any

from quadpatch_client.schema import HoleCounts, Job, JobResult
from quadpatch_client.task_summary import counted, task_sentence
from quadpatch_rules.competition import outcome

_LONGEST_LIST = 6


def verdicts(counts: HoleCounts) -> str:
    """Say what became of the holes, without verdicts that no hole got."""
    parts = [
        f"{counts.filled} filled with the model" if counts.filled else "",
        f"{counts.filled_smooth} filled smoothly" if counts.filled_smooth else "",
        f"{counts.skipped} left open by rule" if counts.skipped else "",
        f"{counts.refused} refused" if counts.refused else "",
    ]
    return ", ".join(part for part in parts if part) or "nothing to do"


def open_holes(report: Mapping[str, Any]) -> str:
    """Say which holes stay open and why, the commonest reason first; empty if none does."""
    reasons: dict[str, list[str]] = {}
    for hole in report["holes"]:
        if hole["verdict"] in ("skipped", "refused"):
            reason = str(hole.get("reason") or "no reason was given")
            reasons.setdefault(str(hole.get("code") or reason), []).append(f"hole {hole['id']}: {reason}")
    return _by_reason(reasons)


def geometry_only(report: Mapping[str, Any]) -> str:
    """Say why geometry alone filled holes, the commonest reason first; empty if it filled none."""
    reasons: dict[str, int] = {}
    for hole in report["holes"]:
        if hole["verdict"] == "filled_smooth" and hole.get("reason"):
            reasons[hole["reason"]] = reasons.get(hole["reason"], 0) + 1
    commonest = sorted(reasons.items(), key=lambda item: -item[1])
    return "; ".join(f"{count} × {reason}" for reason, count in commonest)


def _by_reason(reasons: Mapping[str, list[str]]) -> str:
    commonest = sorted(reasons.items(), key=lambda item: -len(item[1]))[:_LONGEST_LIST]
    return "; ".join(_reason_in_words(code, examples) for code, examples in commonest)


def stage_seconds(report: Mapping[str, Any]) -> str:
    """Say how long every stage took."""
    return ", ".join(f"{stage['name']} {stage['seconds']:.1f} s" for stage in report["stages"])


def paragraph(name: str, job: Job, report: Mapping[str, Any]) -> str:
    """Tell a whole job in one paragraph.

    Parameters
    ----------
    name : str
        Of the mesh, for people.
    job : Job
        One that has succeeded.
    report : mapping
        The job's report.
    """
    if job.result is None:
        raise ValueError(f"job {job.id} has no result")
    if job.spec.task != "fill":
        sentences = [task_sentence(name, job.spec.task, job.result, str(report.get("length_unit", "mesh units")))]
        sentences.append(f"The work took {job.result.seconds:.1f} s ({stage_seconds(report)}).")
        return " ".join([*sentences, *_warnings(job.result.warnings)])
    counts = job.result.holes
    sentences = [
        f"{name} has {counted(counts.found, 'hole')}: {verdicts(counts)}.",
        _added(job.result),
    ]
    competition = outcome(report.get("model", {}))
    if competition:
        sentences.append(competition)
    smooth = geometry_only(report)
    if smooth:
        sentences.append(f"By geometry alone: {smooth}.")
    left_open = open_holes(report)
    if left_open:
        sentences.append(f"Left open: {left_open}.")
    # A service of an earlier version says nothing of colours.
    if report.get("colours"):
        sentences.append(f"Colours of new vertices: {report['colours']['method']}.")
    sentences.append(f"The repair took {job.result.seconds:.1f} s ({stage_seconds(report)}).")
    return " ".join([*sentences, *_warnings(job.result.warnings)])


def _added(result: JobResult) -> str:
    if not result.new_triangles:
        return "Nothing was added."
    added = f"{counted(result.new_vertices, 'vertex')} and {counted(result.new_triangles, 'triangle')}"
    return f"{added} were added; every measured vertex kept its bits."


def _warnings(warnings: Iterable[str]) -> list[str]:
    return [f"Warning: {warning}." for warning in warnings]


def _reason_in_words(code: str, examples: list[str]) -> str:
    if len(examples) == 1:
        return examples[0]
    return f"{len(examples)} × {code.replace('_', ' ')} ({examples[0]})"

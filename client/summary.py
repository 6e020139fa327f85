"""A finished repair in sentences."""

from collections import Counter
from collections.abc import Iterable, Mapping
from typing import Any

from jobkit.schema import HoleCounts, Job

_LONGEST_LIST = 6


def verdicts(counts: HoleCounts) -> str:
    """Say what became of the holes, without those verdicts that nobody got."""
    parts = [
        f"{counts.filled} filled with the model" if counts.filled else "",
        f"{counts.filled_smooth} filled smoothly" if counts.filled_smooth else "",
        f"{counts.skipped} left open by rule" if counts.skipped else "",
        f"{counts.refused} refused" if counts.refused else "",
    ]
    return ", ".join(part for part in parts if part) or "nothing to do"


def open_holes(report: Mapping[str, Any]) -> str:
    """Say which holes stay open and why, the commonest reason first; empty if none does."""
    reasons = Counter(
        str(hole.get("reason") or hole.get("code") or "no reason given")
        for hole in report["holes"]
        if hole["verdict"] in ("skipped", "refused")
    )
    return "; ".join(f"{count} × {reason}" for reason, count in reasons.most_common(_LONGEST_LIST))


def stage_seconds(report: Mapping[str, Any]) -> str:
    """Say how long every stage took."""
    return ", ".join(f"{stage['name']} {stage['seconds']:.1f} s" for stage in report["stages"])


def paragraph(name: str, job: Job, report: Mapping[str, Any]) -> str:
    """Tell a whole repair in one paragraph.

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
    counts = job.result.holes
    sentences = [
        f"{name} has {_counted(counts.found, 'hole')}: {verdicts(counts)}.",
        f"{job.result.new_vertices:,} vertices and {job.result.new_triangles:,} triangles were added; "
        "every measured vertex kept its bits.",
    ]
    left_open = open_holes(report)
    if left_open:
        sentences.append(f"Left open: {left_open}.")
    sentences.append(f"The repair took {job.result.seconds:.1f} s ({stage_seconds(report)}).")
    return " ".join([*sentences, *_warnings(job.result.warnings)])


def _warnings(warnings: Iterable[str]) -> list[str]:
    return [f"Warning: {warning}." for warning in warnings]


def _counted(number: int, noun: str) -> str:
    return f"{number:,} {noun}" if number == 1 else f"{number:,} {noun}s"

"""The first lines of a page: what was measured, what was invented, how sure that is, and what to do next.

They are for people who know the object and not the method, and hold no figure that the report does not have.

Tested in `tests/quadpatch/html_report/test_in_short.py`.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from statistics import median
from typing import Any

from quadpatch.html_report import words

# Holes that a line names; the table has all of them.
_MOST_NAMED = 5
_OUTER = ("border", "open_end", "largest")
QUESTIONS = ("What was measured?", "What was invented?", "How sure is it?", "What to do next?")


@dataclass(frozen=True)
class Answer:
    """A sentence, and the hole that it leads to, if any."""

    text: str
    hole: int | None = None


def in_short(report: Mapping[str, Any]) -> list[tuple[str, list[Answer]]]:
    """Answer the four questions from the report of a repair that has a `provenance`.

    Returns
    -------
    list of (str, list of Answer)
        The questions in order, each with its sentences.
    """
    answers = (_measured(report), _invented(report), _sure(report), _next(report))
    return list(zip(QUESTIONS, answers, strict=True))


def outer_loops(holes: Sequence[Mapping[str, Any]]) -> list[Mapping[str, Any]]:
    """Return the loops that are no damage and stay open: outer borders, and open ends."""
    return [row for row in holes if row["verdict"] == "skipped" and (row["kind"] == "border" or row["code"] in _OUTER)]


def counted(n: int, noun: str, plural: str = "") -> str:
    """Write a number of things."""
    return f"{n:,} {noun if n == 1 else plural or noun + 's'}"


def _filled(report: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    return [row for row in report["holes"] if row["verdict"] in {"filled", "filled_smooth"}]


def _measured(report: Mapping[str, Any]) -> list[Answer]:
    source = report["source"]
    size = f"{counted(source['vertices'], 'vertex', 'vertices')} and {counted(source['triangles'], 'triangle')}"
    return [Answer(f"The scan: {size}. They stand in the repaired file as they came; none was moved.")]


def _invented(report: Mapping[str, Any]) -> list[Answer]:
    filled, outer = _filled(report), outer_loops(report["holes"])
    n_holes = len(report["holes"]) - len(outer)
    if not filled:
        return [Answer("Nothing: no hole was filled.")]
    new = sum(row["new_triangles"] for row in filled)
    share = invented_area(report["provenance"])
    of_area = "" if share is None else f", {words.percent(share)} of the area"
    said = f"The fills of {len(filled):,} of {counted(n_holes, 'hole')}: {counted(new, 'triangle')}{of_area}."
    return [Answer(f"{said} A fill continues the surface around it; it is no evidence of what was there.")]


def _sure(report: Mapping[str, Any]) -> list[Answer]:
    filled = _filled(report)
    known = [row for row in filled if row["confidence"] is not None and row["expected_error"] is not None]
    if not filled:
        return []
    if not known:
        return [Answer("There is no measure of it for these fills: take them for guesses.")]
    middle, least = median(row["confidence"] for row in known), _least_sure(known)
    unit = report["length_unit"]
    said = (
        f"Confidence goes from 0, a mere guess, to 1. Half of the fills have {words.figure(middle)} or more, the least "
        f"sure one {words.figure(least['confidence'])}: it is expected to be off by "
        f"{words.figure(least['expected_error'])} {unit} in the mean, "
        f"{words.percent(least['expected_error'] / least['diameter'])} of its width."
    )
    unknown = len(filled) - len(known)
    rest = f"Of {counted(unknown, 'fill')} there is no measure." if unknown else ""
    return [Answer(text) for text in (said, rest) if text]


def _next(report: Mapping[str, Any]) -> list[Answer]:
    holes, unit = report["holes"], report["length_unit"]
    refused = [row for row in holes if row["verdict"] == "refused"]
    outer = outer_loops(holes)
    skipped = [row for row in holes if row["verdict"] == "skipped" and row not in outer]
    known = [row for row in _filled(report) if row["confidence"] is not None and row["expected_error"] is not None]
    todo: list[Answer] = []
    unmet = (report.get("acceptance") or {}).get("unmet") or []
    if unmet:
        missing = f"{_named(unmet)} {_verb(unmet, 'misses', 'miss')} the limits that the result has to meet: see below."
        todo.append(Answer(missing, unmet[0]["id"]))
    if len(known) > 1:
        worst = _least_sure(known)
        figures = f"confidence {words.figure(worst['confidence'])}, diameter {words.figure(worst['diameter'])} {unit}"
        todo.append(Answer(f"Look at hole {worst['id']}: it is the least sure ({figures}).", worst["id"]))
    elif known:
        todo.append(Answer(f"Look at hole {known[0]['id']}, and judge by what you know of the object.", known[0]["id"]))
    if refused:
        said = f"{_named(refused)} {_verb(refused, 'stays', 'stay')} open: no sound fill was found. "
        rims = _verb(refused, "the rim, or have it", "their rims, or have them")
        todo.append(Answer(f"{said}Look at {rims} closed flat.", refused[0]["id"]))
    if skipped:
        said = f"{_named(skipped)} {_verb(skipped, 'was', 'were')} left open by rule ({_reasons(skipped)})."
        chosen = _verb(skipped, "it is damage, choose it", "they are damage, choose them")
        todo.append(Answer(f"{said} If {chosen} and repair again.", skipped[0]["id"]))
    if outer:
        kinds = _counted_kinds(outer)
        todo.append(Answer(f"{kinds} {_verb(outer, 'stays', 'stay')} open, as on every scan that is not closed."))
    if report["warnings"]:
        todo.append(Answer(f"Read the {counted(len(report['warnings']), 'warning')} below."))
    return todo or [Answer("Nothing: there was no hole.")]


def _least_sure(rows: Sequence[Mapping[str, Any]]) -> Mapping[str, Any]:
    return min(rows, key=lambda row: (row["confidence"], -row["expected_error"], row["id"]))


def _named(rows: Sequence[Mapping[str, Any]]) -> str:
    ids = [str(row["id"]) for row in rows[:_MOST_NAMED]]
    if len(rows) > _MOST_NAMED:
        return f"{len(rows):,} holes ({', '.join(ids)} …)"
    return f"Hole {ids[0]}" if len(ids) == 1 else f"Holes {', '.join(ids[:-1])} and {ids[-1]}"


def _verb(rows: Sequence[Any], singular: str, plural: str) -> str:
    return singular if len(rows) == 1 else plural


def _reasons(rows: Iterable[Mapping[str, Any]]) -> str:
    said = dict.fromkeys(str(row["code"] or "").replace("_", " ") for row in rows)
    return ", ".join(said)


def _counted_kinds(rows: Iterable[Mapping[str, Any]]) -> str:
    counts: dict[str, int] = {}
    for row in rows:
        kind = words.KINDS.get(row["kind"], row["kind"])
        counts[kind] = counts.get(kind, 0) + 1
    return " and ".join(counted(n, kind) for kind, n in counts.items())


def invented_area(facts: Mapping[str, Any]) -> float | None:
    """Return the share of the repaired surface that is invented, None where it is not known."""
    before, after = facts["before"]["area"], facts["after"]["area"]
    return None if before is None or not after else max(0.0, 1 - before / after)

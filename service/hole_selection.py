"""Which holes a job would fill, and how: the selection rule on the hole list that a worker found.

The rule is that of `quadpatch.mesh.holes.select_holes`, which this package may not import; a test holds the two
together.
"""

import math
from dataclasses import dataclass

from jobkit.schema import Hole, HoleAction, HoleRule, HoleSelection

AUTO_DIAMETER_SHARE = 0.25
MAX_NEW_VERTICES = 200_000


@dataclass(frozen=True)
class Choice:
    """What would become of one hole: the code of the reason why it stays open, or how it is closed.

    `joined_to` is the id of the hole that it lies in, where it is the border of an island.
    """

    reason: str | None
    action: HoleAction | None
    joined_to: int | None = None


def choose_holes(holes: list[Hole], selection: HoleSelection, diagonal: float) -> list[Choice]:
    """Apply a job's selection to every hole of a mesh.

    Parameters
    ----------
    holes : list of Hole
    selection : HoleSelection
    diagonal : float
        Of the mesh's bounding box, in mesh units.
    """
    chosen_ids = _id_set(selection.ids)
    rules = [(rule, _id_set(rule.ids)) for rule in selection.rules]
    choices = []
    for hole in holes:
        rule = next((rule for rule, ids in rules if _meets(hole, rule, ids, selection)), None)
        is_listed = chosen_ids is None or hole.id in chosen_ids
        reason = _reason_to_skip(hole, selection, rule, diagonal) if is_listed else _reason_if_unlisted(hole)
        choices.append(Choice(reason, None if reason else _action(hole, selection, rule)))
    return choices


def join_islands(holes: list[Hole], choices: list[Choice]) -> list[Choice]:
    """Join each island to the narrowest hole around it that is filled, as `quadpatch.filling.islands` does.

    Parameters
    ----------
    holes : list of Hole
    choices : list of Choice
        One for each hole, by its own selection.
    """
    actions = {hole.id: choice.action for hole, choice in zip(holes, choices, strict=True) if choice.reason is None}
    hosts = [next((i for i in hole.lies_in if i in actions), None) for hole in holes]
    return [
        choice if host is None else Choice(None, actions[host], host)
        for host, choice in zip(hosts, choices, strict=True)
    ]


def _id_set(ids: list[int] | None) -> frozenset[int] | None:
    """Make a set of a list: a look-up in a long list, once for every hole, takes minutes."""
    return None if ids is None else frozenset(ids)


def _meets(hole: Hole, rule: HoleRule, ids: frozenset[int] | None, selection: HoleSelection) -> bool:
    by_name = rule.ids is not None or rule.kind is not None
    return (
        (by_name or _is_asked_for(hole, selection))
        and (ids is None or hole.id in ids)
        and rule.kind in (None, hole.kind)
        and (rule.min_diameter is None or hole.diameter >= rule.min_diameter)
        and (rule.max_diameter is None or hole.diameter <= rule.max_diameter)
        and (rule.max_perimeter is None or hole.perimeter <= rule.max_perimeter)
    )


def _is_asked_for(hole: Hole, selection: HoleSelection) -> bool:
    if hole.kind == "border":
        return selection.include_borders or selection.ids is not None
    if hole.kind == "open_end":
        return selection.cap is not None or selection.ids is not None
    return True


def _action(hole: Hole, selection: HoleSelection, rule: HoleRule | None) -> HoleAction:
    if rule is not None and rule.action != "skip":
        return rule.action
    return "flat" if hole.kind == "open_end" and selection.cap == "flat" else "model"


def _reason_to_skip(hole: Hole, selection: HoleSelection, rule: HoleRule | None, diagonal: float) -> str | None:
    is_left_out = rule is None and not _is_asked_for(hole, selection)
    max_diameter = selection.max_diameter
    if _has_automatic_limit(hole, selection, rule):
        max_diameter = AUTO_DIAMETER_SHARE * diagonal
    reasons = (
        (not hole.is_manifold, "non_manifold_rim"),
        (selection.all_but_largest and hole.id == 0, "largest"),
        (rule is not None and rule.action == "skip", "rule"),
        (is_left_out and hole.kind == "border", "border"),
        (is_left_out, "open_end"),
        (_expected_vertices(hole) > MAX_NEW_VERTICES, "too_many_vertices"),
        (max_diameter is not None and hole.diameter > max_diameter, "too_wide"),
        (selection.max_perimeter is not None and hole.perimeter > selection.max_perimeter, "too_long"),
    )
    return next((code for applies, code in reasons if applies), None)


def _reason_if_unlisted(hole: Hole) -> str:
    return "not_chosen" if hole.is_manifold else "non_manifold_rim"


def _has_automatic_limit(hole: Hole, selection: HoleSelection, rule: HoleRule | None) -> bool:
    if hole.kind not in ("hole", "border") or selection.all_but_largest:
        return False
    sources = (selection,) if rule is None else (selection, rule)
    return all(s.max_diameter is None and s.max_perimeter is None and s.ids is None for s in sources)


def _expected_vertices(hole: Hole) -> int:
    edge = hole.perimeter / max(hole.edges, 1)
    return round(hole.area / (math.sqrt(0.75) * edge**2)) if edge > 0 else 0

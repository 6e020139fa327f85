"""Which holes a repair fills, and how: the rules of the user, or the automatic one.

The service plans by it, on the hole list of an analysis; a repair chooses by it, on the holes of its mesh.
"""

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import inf, sqrt
from typing import Literal, Protocol

HoleKind = Literal["hole", "slit", "open_end", "border"]
# How a hole is closed: by the model of the repair, by geometry alone, or by a plane patch.
HoleAction = Literal["model", "smooth", "flat"]
RuleAction = Literal["skip", "model", "smooth", "flat"]
Cap = Literal["flat"]

# An open scan has an outer border that is not to be closed: without a limit from the user, loops wider than this share
# of the bounding box's diagonal stay open.
AUTO_DIAMETER_SHARE = 0.25

# Vertices grow with the square of the rim; such a fill would take minutes and gigabytes.
MAX_NEW_VERTICES = 200_000

MODEL_FILLS_ONLY = (
    "holes.cap, holes.bridges and the actions smooth and flat of holes.rules go with the recipe default only"
)


_NOT_MANIFOLD = "non_manifold_rim", "its rim touches faces of opposite direction, or three at one edge"
_OTHER_NOT_MANIFOLD = (
    "non_manifold_rim",
    "the rim at the other end of its bridge touches such faces, or three at one edge",
)


class Hole(Protocol):
    """A boundary loop; lengths in mesh units, the area in square mesh units."""

    @property
    def id(self) -> int: ...
    @property
    def n_edges(self) -> int: ...
    @property
    def perimeter(self) -> float: ...
    @property
    def diameter(self) -> float: ...
    @property
    def area(self) -> float: ...
    @property
    def kind(self) -> HoleKind: ...
    @property
    def is_manifold(self) -> bool: ...


class HoleRule(Protocol):
    """What to do with the holes that meet all of some conditions."""

    @property
    def action(self) -> RuleAction: ...
    @property
    def ids(self) -> Sequence[int] | None: ...
    @property
    def kind(self) -> HoleKind | None: ...
    @property
    def min_diameter(self) -> float | None: ...
    @property
    def max_diameter(self) -> float | None: ...
    @property
    def max_perimeter(self) -> float | None: ...


class HoleSelection(Protocol):
    """Which holes to fill, and how."""

    @property
    def max_diameter(self) -> float | None: ...
    @property
    def max_perimeter(self) -> float | None: ...
    @property
    def all_but_largest(self) -> bool: ...
    @property
    def ids(self) -> Sequence[int] | None: ...
    @property
    def include_borders(self) -> bool: ...
    @property
    def cap(self) -> Cap | None: ...
    @property
    def rules(self) -> Sequence[HoleRule]: ...
    @property
    def bridges(self) -> Sequence[Sequence[int]]: ...


@dataclass(frozen=True, slots=True)
class Choice:
    """What becomes of one hole.

    Attributes
    ----------
    action : str or None
        How it is closed; None where it stays open.
    code, reason : str or None
        Why it stays open: a stable code, and a sentence for people.
    joined_to : int or None
        Id of the hole that it lies in, where it is the border of an island that is filled with that hole.
    bridged_to: int or None
        Id of the loop that a bridge joins it to.
    """

    action: HoleAction | None
    code: str | None = None
    reason: str | None = None
    joined_to: int | None = None
    bridged_to: int | None = None


def choose_holes(holes: Sequence[Hole], selection: HoleSelection, diagonal: float) -> list[Choice]:
    """Apply a selection to every hole of a mesh.

    Parameters
    ----------
    holes : sequence of Hole
    selection : HoleSelection
    diagonal : float
        Of the mesh's bounding box, in mesh units; the automatic rule is relative to it.
    """
    # A look-up in a long list, once for every hole, takes minutes.
    chosen_ids = _id_set(selection.ids)
    rules = [(number, rule, _id_set(rule.ids)) for number, rule in enumerate(selection.rules, 1)]
    bridged = _bridged(holes, selection)
    choices = []
    for hole in holes:
        if hole.id in bridged:
            choices.append(bridged[hole.id])
            continue
        number, rule = next(((n, rule) for n, rule, ids in rules if _meets(hole, rule, ids, selection)), (0, None))
        is_listed = chosen_ids is None or hole.id in chosen_ids
        skipped = next(_reasons_to_skip(hole, selection, rule, number, is_listed), None)
        skipped = skipped or next(_limits(hole, selection, rule, diagonal), None)
        choices.append(Choice(None, *skipped) if skipped else Choice(_action(hole, selection, rule)))
    return choices


def _bridged(holes: Sequence[Hole], selection: HoleSelection) -> dict[int, Choice]:
    """Say of the loops of all bridges what becomes of them, by id: no other option is about these."""
    if not selection.bridges:
        return {}
    by_id, found = {hole.id: hole for hole in holes}, {}
    for pair in selection.bridges:
        is_possible = all(by_id[i].is_manifold for i in pair)
        for hole_id, other_id in (pair, pair[::-1]):
            bad = _NOT_MANIFOLD if not by_id[hole_id].is_manifold else _OTHER_NOT_MANIFOLD
            found[hole_id] = Choice("model", bridged_to=other_id) if is_possible else Choice(None, *bad)
    return found


def join_islands(hosts: Sequence[Sequence[int]], choices: Sequence[Choice]) -> list[Choice]:
    """Join each island to the narrowest hole around it that is filled; loops of bridges take no part.

    Parameters
    ----------
    hosts : sequence of sequences of int
        For each hole, the ids of those that it lies in as the border of an island, the narrowest first.
    choices : sequence of Choice
        One for each hole, by its own selection; their position is the id.
    """
    actions = {i: c.action for i, c in enumerate(choices) if c.action is not None and c.bridged_to is None}
    narrowest = [next((i for i in ids if i in actions), None) for ids in hosts]
    return [
        choice if host is None or choice.bridged_to is not None else Choice(actions[host], joined_to=host)
        for host, choice in zip(narrowest, choices, strict=True)
    ]


def unknown_hole(holes: Sequence[Hole], selection: HoleSelection) -> str | None:
    """Say in a sentence which explicit id names no hole; None where all do."""
    lists = (selection.ids, *(rule.ids for rule in selection.rules), *selection.bridges)
    named = {i for ids in lists for i in ids or ()}
    unknown = sorted(named - {hole.id for hole in holes})
    return f"no hole has the id {unknown[0]}; this mesh has {len(holes)} holes, counted from 0" if unknown else None


def repeated_loop(bridges: Sequence[Sequence[int]]) -> str | None:
    """Say in a sentence which loop several ends of bridges name; None where each names another."""
    counts = Counter(i for pair in bridges for i in pair)
    repeated = min((i for i, count in counts.items() if count > 1), default=None)
    rule = "a bridge joins two loops, and a loop has one bridge at most"
    return None if repeated is None else f"{rule}: loop {repeated} is named twice"


def names_fills(selection: HoleSelection) -> bool:
    """Whether some holes are to be closed in another way than by the model; see `MODEL_FILLS_ONLY`."""
    is_other = any(rule.action in ("smooth", "flat") for rule in selection.rules)
    return selection.cap is not None or bool(selection.bridges) or is_other


def expected_vertices(hole: Hole) -> int:
    """Estimate the new vertices that a fill will have: equilateral triangles as large as the rim's edges."""
    edge = hole.perimeter / max(hole.n_edges, 1)
    return round(hole.area / (sqrt(0.75) * edge**2)) if edge > 0 else 0


def _id_set(ids: Sequence[int] | None) -> frozenset[int] | None:
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
    """Whether loops of this kind are closed: holes and slits always, others where an option asks for them."""
    if hole.kind == "border":
        return selection.include_borders or selection.ids is not None
    if hole.kind == "open_end":
        return selection.cap is not None or selection.ids is not None
    return True


def _action(hole: Hole, selection: HoleSelection, rule: HoleRule | None) -> HoleAction:
    if rule is not None and rule.action != "skip":
        return rule.action
    return "flat" if hole.kind == "open_end" and selection.cap == "flat" else "model"


def _reasons_to_skip(
    hole: Hole, selection: HoleSelection, rule: HoleRule | None, number: int, is_listed: bool
) -> Iterator[tuple[str, str]]:
    """Yield what keeps a hole open, each with its code and a sentence: the first one counts."""
    is_left_out = rule is None and not _is_asked_for(hole, selection)
    if not hole.is_manifold:
        yield _NOT_MANIFOLD
    if not is_listed:
        yield "not_chosen", "not among the chosen ids"
    if selection.all_but_largest and hole.id == 0:
        yield "largest", "the largest loop is taken for the border of the scan"
    if rule is not None and rule.action == "skip":
        yield "rule", f"rule {number} leaves it open"
    if is_left_out and hole.kind == "border":
        yield "border", "outer border of a piece of the scan"
    if is_left_out:
        yield "open_end", "open end of a piece of the scan, like that of a tube"
    n_vertices = expected_vertices(hole)
    if n_vertices > MAX_NEW_VERTICES:
        dense = f"a fill as dense as its rim takes about {n_vertices} new vertices"
        yield "too_many_vertices", f"{dense}, over {MAX_NEW_VERTICES}"


def _limits(hole: Hole, selection: HoleSelection, rule: HoleRule | None, diagonal: float) -> Iterator[tuple[str, str]]:
    """Compare a hole's sizes with the limits of the user, or its diameter with the automatic one."""
    widest, longest = selection.max_diameter or inf, selection.max_perimeter or inf
    said_by = "the given maximum"
    if _has_automatic_limit(hole, selection, rule):
        widest, said_by = AUTO_DIAMETER_SHARE * diagonal, "a quarter of the scan's diagonal"
    if hole.diameter > widest:
        yield "too_wide", f"diameter {hole.diameter:.6g} is over {widest:.6g}, {said_by}"
    if hole.perimeter > longest:
        yield "too_long", f"perimeter {hole.perimeter:.6g} is over {longest:.6g}, {said_by}"


def _has_automatic_limit(hole: Hole, selection: HoleSelection, rule: HoleRule | None) -> bool:
    """Whether the user left its size open. Slits may be as long as the object, and open ends are asked for by kind."""
    if hole.kind not in ("hole", "border") or selection.all_but_largest:
        return False
    sources = (selection,) if rule is None else (selection, rule)
    return all(s.max_diameter is None and s.max_perimeter is None and s.ids is None for s in sources)

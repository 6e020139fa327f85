"""Which holes to fill: the rules of the user, or the automatic one, applied to the holes of a mesh.

Measuring stands in `quadpatch.mesh.hole_measures`.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from quadpatch.errors import OptionError
from quadpatch.mesh.hole_measures import Hole, find_holes
from quadpatch.options import HoleAction, HoleOptions, HoleRule

__all__ = ["AUTO_DIAMETER_SHARE", "MAX_NEW_VERTICES", "Hole", "Selection", "find_holes", "select_holes"]

# An open scan has an outer border that is not to be closed: without a limit from the user, loops wider than this share
# of the bounding box's diagonal stay open.
AUTO_DIAMETER_SHARE = 0.25

# Vertices grow with the square of the rim; such a fill would take minutes and gigabytes.
MAX_NEW_VERTICES = 200_000


@dataclass(frozen=True)
class Selection:
    """What to do with every hole.

    Attributes
    ----------
    chosen : list of Hole
    skipped : dict of int to (str, str)
        Hole id to a stable code and a sentence for people.
    actions : dict of int to str
        Id of each chosen hole to `model`, `smooth` or `flat`.
    """

    chosen: list[Hole]
    skipped: dict[int, tuple[str, str]]
    actions: dict[int, HoleAction] = field(default_factory=dict)


def select_holes(holes: list[Hole], options: HoleOptions, diagonal: float) -> Selection:
    """Apply the user's rules, or the automatic one, to every hole.

    Parameters
    ----------
    holes : list of Hole
    options : HoleOptions
    diagonal : float
        Of the mesh's bounding box, in mesh units; the automatic rule is relative to it.

    Raises
    ------
    OptionError
        If an explicit id names no hole.
    """
    _check_ids(holes, options)
    chosen: list[Hole] = []
    skipped: dict[int, tuple[str, str]] = {}
    actions: dict[int, HoleAction] = {}
    for hole in holes:
        found = _first_rule(hole, options)
        reason = _reason_to_skip(hole, options, found, diagonal)
        if reason is None:
            chosen.append(hole)
            actions[hole.id] = _action(hole, options, found[1] if found else None)
        else:
            skipped[hole.id] = reason
    return Selection(chosen, skipped, actions)


def _check_ids(holes: list[Hole], options: HoleOptions) -> None:
    named = {i for ids in (options.ids, *(rule.ids for rule in options.rules)) for i in ids or ()}
    unknown = sorted(named - {hole.id for hole in holes})
    if unknown:
        raise OptionError(f"no hole has the id {unknown[0]}; this mesh has {len(holes)} holes, counted from 0")


def _first_rule(hole: Hole, options: HoleOptions) -> tuple[int, HoleRule] | None:
    """Return the first rule whose conditions a hole meets, with its number, counted from 1."""
    return next(((i, rule) for i, rule in enumerate(options.rules, 1) if _meets(hole, rule, options)), None)


def _meets(hole: Hole, rule: HoleRule, options: HoleOptions) -> bool:
    by_name = rule.ids is not None or rule.kind is not None
    return (
        (by_name or _is_asked_for(hole, options))
        and (rule.id_set is None or hole.id in rule.id_set)
        and rule.kind in (None, hole.kind)
        and (rule.min_diameter is None or hole.diameter >= rule.min_diameter)
        and (rule.max_diameter is None or hole.diameter <= rule.max_diameter)
        and (rule.max_perimeter is None or hole.perimeter <= rule.max_perimeter)
    )


def _is_asked_for(hole: Hole, options: HoleOptions) -> bool:
    """Whether loops of this kind are closed: holes and slits always, others where an option asks for them."""
    if hole.kind == "border":
        return options.include_borders or options.ids is not None
    if hole.kind == "open_end":
        return options.cap is not None or options.ids is not None
    return True


def _action(hole: Hole, options: HoleOptions, rule: HoleRule | None) -> HoleAction:
    if rule is not None and rule.action != "skip":
        return rule.action
    return "flat" if hole.kind == "open_end" and options.cap == "flat" else "model"


def _reason_to_skip(
    hole: Hole, options: HoleOptions, found: tuple[int, HoleRule] | None, diagonal: float
) -> tuple[str, str] | None:
    """Apply what keeps holes open in order; the first that holds is the reason."""
    number, rule = found or (0, None)
    is_left_out = rule is None and not _is_asked_for(hole, options)
    reasons = (
        (not hole.is_manifold, "non_manifold_rim", "its rim touches faces of opposite direction, or three at one edge"),
        (options.id_set is not None and hole.id not in options.id_set, "not_chosen", "not among the chosen ids"),
        (options.all_but_largest and hole.id == 0, "largest", "the largest loop is taken for the border of the scan"),
        (rule is not None and rule.action == "skip", "rule", f"rule {number} leaves it open"),
        (is_left_out and hole.is_border, "border", "outer border of a piece of the scan"),
        (is_left_out, "open_end", "open end of a piece of the scan, like that of a tube"),
        (hole.n_expected_vertices > MAX_NEW_VERTICES, "too_many_vertices", _too_many(hole)),
        *_limits(hole, options, rule, diagonal),
    )
    return next(((code, text) for applies, code, text in reasons if applies), None)


def _limits(
    hole: Hole, options: HoleOptions, rule: HoleRule | None, diagonal: float
) -> Iterator[tuple[bool, str, str]]:
    """Compare a hole's sizes with the limits of the user, or its diameter with the automatic one."""
    widest, longest = options.max_diameter or np.inf, options.max_perimeter or np.inf
    said_by = "the given maximum"
    if _has_automatic_limit(hole, options, rule):
        widest, said_by = AUTO_DIAMETER_SHARE * diagonal, "a quarter of the scan's diagonal"
    yield hole.diameter > widest, "too_wide", f"diameter {hole.diameter:.6g} is over {widest:.6g}, {said_by}"
    yield hole.perimeter > longest, "too_long", f"perimeter {hole.perimeter:.6g} is over {longest:.6g}, {said_by}"


def _has_automatic_limit(hole: Hole, options: HoleOptions, rule: HoleRule | None) -> bool:
    """Whether the user left its size open. Slits may be as long as the object, and open ends are asked for by kind."""
    return options.is_automatic and hole.kind in ("hole", "border") and (rule is None or not rule.limits_size)


def _too_many(hole: Hole) -> str:
    return f"a fill as dense as its rim takes about {hole.n_expected_vertices} new vertices, over {MAX_NEW_VERTICES}"

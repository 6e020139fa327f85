"""Which holes to fill: the rules of `quadpatch_rules.hole_selection`, applied to the holes of a mesh.

Measuring stands in `quadpatch.mesh.hole_measures`.
"""

from dataclasses import dataclass, field

from quadpatch.errors import OptionError
from quadpatch.mesh.hole_measures import Hole, find_holes
from quadpatch.options import HoleOptions
from quadpatch_rules.hole_selection import HoleAction, choose_holes, unknown_hole

__all__ = ["Hole", "Selection", "find_holes", "select_holes"]


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
    bridges : list of (int, int)
        Ids of loops that are to be joined, which are not among the chosen ones.
    bridge_widths : dict of int to float
        Widths of bridges, in mesh units, by the id of the chosen loop that each starts from.
    """

    chosen: list[Hole]
    skipped: dict[int, tuple[str, str]]
    actions: dict[int, HoleAction] = field(default_factory=dict)
    bridges: list[tuple[int, int]] = field(default_factory=list)
    bridge_widths: dict[int, float] = field(default_factory=dict)

    @property
    def widths(self) -> list[float]:
        """Widths of the chosen ones, in mesh units: diameters of holes, or those of bridges."""
        return [self.bridge_widths.get(hole.id, hole.diameter) for hole in self.chosen]


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
    message = unknown_hole(holes, options)
    if message is not None:
        raise OptionError(message)
    choices = list(zip(holes, choose_holes(holes, options, diagonal), strict=True))
    return Selection(
        [hole for hole, choice in choices if choice.action and choice.bridged_to is None],
        {hole.id: (choice.code, choice.reason) for hole, choice in choices if choice.code and choice.reason},
        {hole.id: choice.action for hole, choice in choices if choice.action},
        [(first, second) for first, second in options.bridges if choices[first][1].action],
    )

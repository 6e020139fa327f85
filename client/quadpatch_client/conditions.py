"""`--where`: which files of a folder are repaired, by what they are: `holes>0`, `triangles<=5000000`, `name=*.stl`.

Tested in `tests/quadpatch_client/test_conditions.py`.
"""

import operator
import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from fnmatch import fnmatchcase
from types import MappingProxyType
from typing import TYPE_CHECKING

from quadpatch_client.errors import UsageError

if TYPE_CHECKING:
    from quadpatch_client.schema import MeshFacts

# What can be asked, and what it means; the first two are known before a file is sent.
QUANTITIES: Mapping[str, str] = MappingProxyType(
    {
        "name": "name of the file, * for any characters",
        "size_mb": "size of the file, in MB",
        "vertices": "vertices",
        "triangles": "triangles",
        "holes": "boundary loops, outer borders among them",
        "widest": "diameter of the widest loop, in mesh units",
        "diagonal": "diagonal of the bounding box, in mesh units",
    }
)
_OF_THE_FILE = ("name", "size_mb")
_COMPARISONS: Mapping[str, Callable[[float, float], bool]] = MappingProxyType(
    {">=": operator.ge, "<=": operator.le, "!=": operator.ne, "=": operator.eq, ">": operator.gt, "<": operator.lt}
)
_FORM = re.compile(r"\s*(?P<quantity>\w+)\s*(?P<comparison>>=|<=|!=|==|=|>|<)\s*(?P<value>.+?)\s*")


@dataclass(frozen=True)
class Condition:
    """What one quantity of a file has to be."""

    quantity: str
    comparison: str
    value: str

    @property
    def is_of_the_file(self) -> bool:
        """Whether it can be told without sending the file."""
        return self.quantity in _OF_THE_FILE

    def fault(self, actual: str | float | None) -> str | None:
        """Say why a file is passed over; None where the condition is met."""
        if self.quantity == "name":
            is_met = fnmatchcase(str(actual), self.value) == (self.comparison == "=")
        else:
            is_met = actual is not None and _COMPARISONS[self.comparison](float(actual), float(self.value))
        shown = f"{actual:g}" if isinstance(actual, float) else actual
        return None if is_met else f"{self.quantity} is {shown}, not {self.comparison} {self.value}"


def read_condition(text: str) -> Condition:
    """Read a condition as it was typed.

    Raises
    ------
    UsageError
    """
    match = _FORM.fullmatch(text)
    if match is None:
        raise UsageError(f"--where {text}: say a quantity, a comparison and a value, such as holes>0 or name=*.stl")
    quantity, value = match["quantity"], match["value"]
    comparison = "=" if match["comparison"] == "==" else match["comparison"]
    if quantity not in QUANTITIES:
        close = get_close_matches(quantity, QUANTITIES, 1)
        hint = f"did you mean {close[0]}?" if close else f"there are {', '.join(QUANTITIES)}"
        raise UsageError(f"--where {text}: there is no quantity {quantity!r}; {hint}")
    if quantity == "name":
        if comparison not in ("=", "!="):
            raise UsageError(f"--where {text}: a name is compared by = or !=")
    elif not _is_number(value):
        raise UsageError(f"--where {text}: {value!r} is no number")
    return Condition(quantity, comparison, value)


def first_fault(conditions: Iterable[Condition], actual: Mapping[str, str | float | None]) -> str | None:
    """Say why a file is passed over, by those conditions whose quantity is known."""
    faults = (c.fault(actual[c.quantity]) for c in conditions if c.quantity in actual)
    return next((fault for fault in faults if fault), None)


def quantities_of(facts: "MeshFacts") -> dict[str, str | float | None]:
    """Return what the analysis of a mesh says for conditions."""
    widest = max((hole.diameter for hole in facts.holes), default=0.0)
    counts = {"vertices": facts.vertices, "triangles": facts.triangles, "holes": len(facts.holes)}
    return {**counts, "widest": widest, "diagonal": facts.diagonal}


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True

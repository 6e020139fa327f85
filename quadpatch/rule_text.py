"""Rules for holes as text: `max_diameter=5:flat`, `kind=open_end,max_diameter=30:flat`, `id=3,id=4:skip`, `smooth`."""

from typing import Any

from quadpatch.errors import OptionError
from quadpatch.options import HoleRule

_LENGTHS = ("min_diameter", "max_diameter", "max_perimeter")


def read_rule(text: str) -> HoleRule:
    """Read one rule: conditions, separated by commas, a colon, and the action; or the action alone.

    The conditions are `min_diameter=`, `max_diameter=`, `max_perimeter=` and `kind=`, and `id=`, which may be repeated.

    Raises
    ------
    OptionError
        If it can't be read.
    """
    conditions, _, action = text.rpartition(":")
    values: dict[str, Any] = {"action": action.strip()}
    for condition in conditions.split(",") if conditions.strip() else ():
        name, _, value = (part.strip() for part in condition.partition("="))
        try:
            _add(values, name, value)
        except (KeyError, ValueError) as error:
            raise OptionError(
                f"{condition.strip()!r} is no condition of a rule; write it like max_diameter=5 or kind=slit or id=3"
            ) from error
    ids = values.pop("ids", None)
    return HoleRule(**values, ids=None if ids is None else tuple(ids))


def _add(values: dict[str, Any], name: str, value: str) -> None:
    if name == "id":
        values.setdefault("ids", []).append(int(value))
    elif name == "kind":
        values["kind"] = value
    elif name in _LENGTHS:
        values[name] = float(value)
    else:
        raise KeyError(name)

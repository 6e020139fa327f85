"""Rules for holes as text: `max_diameter=5:flat`, `kind=open_end,max_diameter=30:flat`, `id=3,id=4:skip`, `smooth`.

Bridges as text: `3:17`.
"""

from typing import Any

_LENGTHS = ("min_diameter", "max_diameter", "max_perimeter")


class RuleTextError(ValueError):
    """The text is no rule; the message says how one is written."""


def read_rule(text: str) -> dict[str, Any]:
    """Read one rule: conditions, separated by commas, a colon, and the action; or the action alone.

    The conditions are `min_diameter=`, `max_diameter=`, `max_perimeter=` and `kind=`, and `id=`, which may be repeated.

    Returns
    -------
    dict
        `action`, and the conditions that are given; `ids` as a list.

    Raises
    ------
    RuleTextError
        If a condition can't be read.
    """
    conditions, _, action = text.rpartition(":")
    values: dict[str, Any] = {"action": action.strip()}
    for condition in conditions.split(",") if conditions.strip() else ():
        name, _, value = (part.strip() for part in condition.partition("="))
        try:
            _add(values, name, value)
        except (KeyError, ValueError) as error:
            raise RuleTextError(
                f"{condition.strip()!r} is no condition of a rule; write it like max_diameter=5 or kind=slit or id=3"
            ) from error
    return values


def read_bridge(text: str) -> tuple[int, int]:
    """Read the ids of two loops with a colon between them.

    Raises
    ------
    RuleTextError
        If the text is anything else.
    """
    ids = [part.strip() for part in text.split(":")]
    if len(ids) != 2 or not all(part.isascii() and part.isdigit() for part in ids):
        raise RuleTextError(f"{text!r} is no bridge; write the ids of two loops, like 3:17")
    return int(ids[0]), int(ids[1])


def _add(values: dict[str, Any], name: str, value: str) -> None:
    if name == "id":
        values.setdefault("ids", []).append(int(value))
    elif name == "kind":
        values["kind"] = value
    elif name in _LENGTHS:
        values[name] = float(value)
    else:
        raise KeyError(name)

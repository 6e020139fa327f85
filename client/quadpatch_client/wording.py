"""Errors in the words of the command line: names of options, and what was meant, instead of a validator's terms.

Tested in `tests/quadpatch_client/test_wording.py`.
"""

from collections.abc import Iterable, Mapping
from difflib import get_close_matches
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from pydantic import ValidationError
    from pydantic_core import ErrorDetails

# Fields of a job spec whose option has another name.
_OPTIONS: Mapping[str, str] = MappingProxyType(
    {
        "ids": "--hole",
        "rules": "--rule",
        "bridges": "--bridge",
        "rule": "--saved-rule",
        "length": "--patch-length",
        "steps": "--fit-steps",
        "seconds": "--fit-seconds",
    }
)
_SAID: Mapping[str, str] = MappingProxyType(
    {
        "greater_than": "has to be greater than {gt}",
        "greater_than_equal": "has to be at least {ge}",
        "less_than": "has to be less than {lt}",
        "less_than_equal": "has to be at most {le}",
        "finite_number": "has to be a finite number",
        "int_parsing": "has to be a whole number",
        "int_type": "has to be a whole number",
        "int_from_float": "has to be a whole number",
        "float_parsing": "has to be a number",
        "float_type": "has to be a number",
        "literal_error": "has to be {expected}",
        "enum": "has to be {expected}",
        "string_too_long": "has to have at most {max_length} characters",
        "string_too_short": "has to have at least {min_length} characters",
        "too_long": "may be given at most {max_length} times",
    }
)
_FORMS: Mapping[str, str] = MappingProxyType(
    {
        "model": "has to be name, name@version or 'self'",
        "rule": "has to be name or name@version",
        "label": "has to be text without control characters",
    }
)

_LONGEST = 40


def said(error: "ValidationError") -> str:
    """Say in words what is wrong with the options of a command."""
    # Of a value that may have several forms each form has its own complaint: the first one is enough.
    by_option = {option_of(detail["loc"]): detail for detail in reversed(error.errors(include_url=False))}
    return "; ".join(_sentence(option, detail) for option, detail in reversed(by_option.items()))


def option_of(location: tuple[int | str, ...]) -> str:
    """Return the option that a field of the job spec was given by."""
    names = [step for step in location if isinstance(step, str) and step.replace("_", "").isalpha()]
    within_rules = "rules" in names
    name = "rules" if within_rules else next((n for n in reversed(names) if n.islower()), "")
    return _OPTIONS.get(name, f"--{name.replace('_', '-')}")


def suggestion(word: str, known: Iterable[str]) -> str:
    """Return a question after what was meant, to be put behind a message; empty where nothing is alike."""
    close = get_close_matches(word, sorted(set(known)), 1)
    return f"; did you mean {close[0]!r}?" if close else ""


def _sentence(option: str, detail: "ErrorDetails") -> str:
    context = {name: _shown(value) for name, value in detail.get("ctx", {}).items()}
    name = str(detail["loc"][-1]) if detail["loc"] else ""
    given = detail["input"]
    if detail["type"] == "value_error":
        return context.get("error", detail["msg"])
    words = _FORMS.get(name) if detail["type"] == "string_pattern_mismatch" else None
    words = words or (_SAID[detail["type"]].format(**context) if detail["type"] in _SAID else "can't be this")
    shown = f", not {_shown(given, quoted=True)}" if isinstance(given, int | float | str) else ""
    return f"{option} {words}{shown}"


def _shown(value: Any, *, quoted: bool = False) -> str:
    if isinstance(value, float):
        return f"{value:g}"
    text = str(value)
    return repr(text[:_LONGEST]) if quoted and isinstance(value, str) else text

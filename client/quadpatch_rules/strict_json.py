"""Strict reading of untrusted JSON: what could not be written again is refused when it is read.

Python's reader takes NaN, numbers that overflow to infinity, lone surrogates, repeated names and nesting as deep as its
stack: each of them would fail later, where no client can be told.

Tested in `tests/attacks/test_a_text_is_data.py`.
"""

import json
import math
from itertools import chain
from typing import Any, NoReturn

from quadpatch_rules.text import has_surrogate, printable

MOST_LEVELS = 32


class StrictJsonError(ValueError):
    """The bytes are no JSON, or JSON that is not taken; the message says why, in one line."""

    def __init__(self, message: str) -> None:
        super().__init__(printable(message))


def read_json(data: bytes | str) -> Any:
    """Read a JSON text.

    Parameters
    ----------
    data : bytes or str
        Bytes are UTF-8.

    Returns
    -------
    Any
        Dicts, lists, encodable strings, finite numbers, booleans and None, in at most `MOST_LEVELS` levels.

    Raises
    ------
    StrictJsonError
        If it is not JSON, or holds a lone surrogate, a number that is not finite, a name twice in one object, or more
        levels.
    """
    try:
        text = data.decode("utf-8") if isinstance(data, bytes) else data
        value = json.loads(text, parse_constant=_refuse_constant, object_pairs_hook=_without_repeats)
    except StrictJsonError:
        raise
    except RecursionError as error:
        raise _too_deep() from error
    except UnicodeDecodeError as error:
        raise StrictJsonError(f"byte {error.start} is not UTF-8") from error
    except ValueError as error:
        raise StrictJsonError(str(error)) from error
    _check(value, 0)
    return value


def _check(value: Any, level: int) -> None:
    if isinstance(value, str) and has_surrogate(value):
        raise StrictJsonError("a string holds half of a surrogate pair")
    if isinstance(value, float) and not math.isfinite(value):
        raise StrictJsonError("a number is too large")
    if isinstance(value, dict | list):
        if level == MOST_LEVELS:
            raise _too_deep()
        items = chain(value, value.values()) if isinstance(value, dict) else value
        for item in items:
            _check(item, level + 1)


def _without_repeats(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    values = dict(pairs)
    if len(values) < len(pairs):
        names = [name for name, _ in pairs]
        raise StrictJsonError(f"the name {next(name for name in names if names.count(name) > 1)!r} comes twice")
    return values


def _refuse_constant(name: str) -> NoReturn:
    raise StrictJsonError(f"{name} is no number of JSON")


def _too_deep() -> StrictJsonError:
    return StrictJsonError(f"it is nested deeper than {MOST_LEVELS} levels")

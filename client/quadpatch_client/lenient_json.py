"""Lenient reading of answers: a newer service may send what this client does not know.

What a client sends is checked strictly. What it reads may hold options, states and words that came later: an unknown
option is left out, an unknown word stays as it is, and an unknown state is replaced by the one that fits the rest of
the answer.

Tested in `tests/attacks/test_j_client.py`.
"""

import json
import re
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

M = TypeVar("M", bound=BaseModel)

_Location = tuple[int | str, ...]
# Each round handles one level of nesting; answers have fewer levels.
_MOST_ROUNDS = 16
_UNKNOWN_WORDS = ("enum", "literal_error")


def read_leniently(model: type[M], content: bytes) -> M:
    """Read an answer as a model.

    Parameters
    ----------
    model : type
    content : bytes
        JSON.

    Raises
    ------
    ValueError
        If something is missing or wrong that has no default; pydantic's ValidationError is one.
    """
    try:
        return model.model_validate_json(content)
    except ValidationError as error:
        first_error = error
    try:
        data = json.loads(content)
    except (ValueError, RecursionError):
        raise first_error from None
    unknown_words: list[tuple[_Location, str]] = []
    for _ in range(_MOST_ROUNDS):
        try:
            value = model.model_validate_json(json.dumps(data))
        except ValidationError as error:
            # Of several errors at one place, as of the variants of a union, the first one is used.
            details = {
                _location_in_answer(data, detail["loc"]): detail for detail in reversed(error.errors(include_url=False))
            }
            for location, detail in details.items():
                _replace_unknown(data, location, detail, unknown_words, first_error)
        else:
            _restore_words(value, unknown_words)
            return value
    raise first_error


def _replace_unknown(
    data: Any, location: _Location, detail: ErrorDetails, unknown_words: list[Any], first_error: ValidationError
) -> None:
    """Remove from the answer what could not be read, or put a known word in its place until the end."""
    if not location or detail["type"] == "missing":
        raise first_error
    owner = data
    for step in location[:-1]:
        owner = owner[step]
    key = location[-1]
    if detail["type"] in _UNKNOWN_WORDS and isinstance(owner[key], str):
        if key == "state":
            owner[key] = _state_of(owner)
        else:
            unknown_words.append((location, owner[key]))
            owner[key] = _first_known(detail)
    elif detail["type"] == "extra_forbidden" or "spec" in location[:-1]:
        del owner[key]
    else:
        raise first_error


def _location_in_answer(data: Any, location: _Location) -> _Location:
    """Return a location without the steps that name a variant of a union and not a place in the answer."""
    steps: list[int | str] = []
    for step in location:
        is_there = isinstance(data, dict) and step in data
        if is_there or (isinstance(data, list) and isinstance(step, int) and step < len(data)):
            steps.append(step)
            data = data[step]
    return tuple(steps)


def _state_of(answer: dict[str, Any]) -> str:
    """Return the known state that fits the rest of a job, or of a mesh."""
    if "mesh_id" in answer:
        if answer.get("finished_at") is None:
            return "running"
        return "succeeded" if answer.get("result") else "failed"
    if answer.get("facts"):
        return "ready"
    return "rejected" if answer.get("problem") else "analysing"


def _first_known(detail: ErrorDetails) -> str:
    match = re.search(r"'([^']*)'", str(detail.get("ctx", {}).get("expected", "")))
    return match[1] if match else ""


def _restore_words(value: Any, unknown_words: list[Any]) -> None:
    for location, text in unknown_words:
        owner = value
        for step in location[:-1]:
            owner = owner[step] if isinstance(step, int) or isinstance(owner, dict) else getattr(owner, step)
        if isinstance(owner, BaseModel):
            setattr(owner, str(location[-1]), text)

"""What a report says of the models that competed on a mesh, in words for people."""

from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import Any

_IN_WORDS: Mapping[str, str] = MappingProxyType(
    {"self": "a dictionary of this mesh", "self-network": "a network fitted to this mesh"}
)


def outcome(model: Mapping[str, Any]) -> str:
    """Say what left the least error on calibration holes, and which models were not tried.

    Parameters
    ----------
    model : mapping
        `model` of a report.

    Returns
    -------
    str
        Sentences; empty where nothing competed.
    """
    sentences = []
    if model.get("trials"):
        sentences.append(f"Least error on calibration holes: {_winner(model['shares'], model['trials'])}.")
    not_tried: Mapping[str, str] = model.get("not_tried") or {}
    if not_tried:
        sentences.append(f"Not tried: {'; '.join(f'{_words(name)} ({why})' for name, why in not_tried.items())}.")
    return " ".join(sentences)


def _winner(shares: Iterable[str], trials: list[Mapping[str, Any]]) -> str:
    """Name the models that have a share, and say how much they gain over the first trial, that of geometry alone."""
    names = [_words(name) for name in shares]
    if not names:
        return "geometry alone"
    models = names[0] if len(names) == 1 else f"the mean of {', '.join(names[:-1])} and {names[-1]}"
    gain = 1.0 - min(trial["error"] for trial in trials) / trials[0]["error"]
    return f"{models}, {100.0 * gain:.0f} % less than geometry alone"


def _words(name: str) -> str:
    return _IN_WORDS.get(name, name)

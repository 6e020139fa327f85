"""What a report says of the models that competed on a mesh, and of fitting one to it, in words for people."""

from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import Any

_IN_WORDS: Mapping[str, str] = MappingProxyType(
    {"self": "a dictionary of this mesh", "self-network": "a network fitted to this mesh"}
)

_WHY_FITTING_ENDED: Mapping[str, str] = MappingProxyType(
    {
        "steps": "all that were asked for",
        "settled": "calibration holes gained nothing more",
        "no_gain": "calibration holes gained nothing, so the network stays as it was",
        "seconds": "the time for it was over, and another run may end elsewhere",
        "no_room": "the surface has no room for training pairs, so the network stays as it was",
        "no_calibration": "there are no calibration holes to judge it by",
    }
)


def outcome(model: Mapping[str, Any]) -> str:
    """Say what left the least error on calibration holes, how a network was fitted, and what was not tried.

    Parameters
    ----------
    model : mapping
        `model` of a report.

    Returns
    -------
    str
        Sentences; empty where nothing competed, and nothing was fitted.
    """
    sentences = []
    if model.get("trials"):
        sentences.append(f"Least error on calibration holes: {_winner(model['shares'], model['trials'])}.")
    fitting = model.get("fitting")
    if fitting:
        steps, why = f"{fitting['steps']} of {fitting['steps_asked']} steps", _WHY_FITTING_ENDED[fitting["end"]]
        sentences.append(f"Fitting took {steps}: {why}.")
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

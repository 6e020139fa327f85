from typing import Any, get_args

import pytest

from quadpatch.inpainters.inpainter import FittingEnd
from quadpatch_rules.competition import outcome

GEOMETRY: dict[str, Any] = {"models": {}, "believed_share": 0.0, "error": 0.5}
HALVES = {"self": 0.5, "general-residual": 0.5}


def trial(shares: dict[str, float], error: float) -> dict[str, Any]:
    return {"models": shares, "believed_share": 1.0, "error": error}


@pytest.mark.parametrize(
    ("shares", "winner"),
    [
        ({"self": 1.0}, "a dictionary of this mesh"),
        ({"general-residual": 1.0}, "general-residual"),
        (HALVES, "the mean of a dictionary of this mesh and general-residual"),
        (
            dict.fromkeys(["self", "general-residual", "self-network"], 1 / 3),
            "the mean of a dictionary of this mesh, general-residual and a network fitted to this mesh",
        ),
    ],
)
def test_the_models_that_won_are_named_with_what_they_gain(shares: dict[str, float], winner: str) -> None:
    model = {"name": "auto", "shares": shares, "trials": [GEOMETRY, trial({"other": 1.0}, 0.49), trial(shares, 0.44)]}
    assert outcome(model) == f"Least error on calibration holes: {winner}, 12 % less than geometry alone."


def test_geometry_wins_where_no_model_has_a_share() -> None:
    unbelieved = {"models": HALVES, "believed_share": 0.0, "error": 0.5}
    model = {"name": "auto", "shares": {}, "trials": [GEOMETRY, unbelieved]}
    assert outcome(model) == "Least error on calibration holes: geometry alone."


def test_models_that_were_not_tried_are_named_with_the_reason() -> None:
    not_tried = {"general-residual": "too fine", "self-network": "no torch"}
    sentence = "Not tried: general-residual (too fine); a network fitted to this mesh (no torch)."
    assert outcome({"name": "auto", "not_tried": not_tried}) == sentence
    both = {"name": "auto", "not_tried": not_tried, "shares": {}, "trials": [GEOMETRY]}
    assert outcome(both) == f"Least error on calibration holes: geometry alone. {sentence}"


def fitting(end: str, steps: int) -> dict[str, Any]:
    return {"steps_asked": 400, "steps": steps, "end": end}


def test_a_fitting_that_time_ended_is_named_with_its_steps_and_the_reason() -> None:
    sentence = "Fitting took 0 of 400 steps: the time for it was over, and another run may end elsewhere."
    assert outcome({"name": "self-network", "fitting": fitting("seconds", 0)}) == sentence
    both = {"name": "auto", "shares": {}, "trials": [GEOMETRY], "fitting": fitting("seconds", 0)}
    assert outcome(both) == f"Least error on calibration holes: geometry alone. {sentence}"


def test_every_end_of_a_fitting_has_words() -> None:
    ends = get_args(FittingEnd)
    sentences = {outcome({"fitting": fitting(end, 50)}) for end in ends}
    assert len(sentences) == len(ends)
    assert all(sentence.startswith("Fitting took 50 of 400 steps: ") for sentence in sentences)


@pytest.mark.parametrize("model", [{}, {"name": "smooth"}, {"name": "auto", "effort": "fast"}])
def test_where_nothing_competed_there_is_nothing_to_say(model: dict[str, Any]) -> None:
    assert outcome(model) == ""

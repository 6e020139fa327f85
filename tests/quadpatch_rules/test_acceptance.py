from typing import Any

import pytest

from quadpatch_rules.acceptance import judge, unmet_in_words
from tests.worker.test_acceptance import HOLES, hole


@pytest.mark.parametrize(
    ("limits", "faults"),
    [
        ({}, {2: ["refused"]}),
        ({"max_expected_error": 0.1}, {2: ["refused"], 4: ["expected_error"]}),
        ({"max_expected_error": 0.3}, {2: ["refused"]}),
        ({"max_error_share": 0.1}, {2: ["refused"], 4: ["error_share"]}),
        ({"max_error_share": 0.15}, {2: ["refused"]}),
        ({"min_confidence": 0.8}, {2: ["refused"], 3: ["confidence"]}),
        (
            {"min_confidence": 0.9, "max_expected_error": 0.2, "max_error_share": 0.04},
            {
                0: ["error_share", "confidence"],
                2: ["refused"],
                3: ["error_share", "confidence"],
                4: ["expected_error", "error_share", "confidence"],
            },
        ),
    ],
)
def test_every_chosen_hole_is_held_to_every_limit(limits: dict[str, float], faults: dict[int, list[str]]) -> None:
    accepted = judge(HOLES, limits)
    assert {unmet["id"]: unmet["faults"] for unmet in accepted["unmet"]} == faults
    assert [unmet["id"] for unmet in accepted["unmet"]] == sorted(faults)
    assert (accepted["is_met"], accepted["holes"]) == (False, 4)


@pytest.mark.parametrize("limits", [{"max_expected_error": 1.0}, {"max_error_share": 1.0}, {"min_confidence": 0.1}])
def test_a_hole_without_the_figure_does_not_meet_its_limit(limits: dict[str, float]) -> None:
    (unmet,) = judge([hole(0, None, None)], limits)["unmet"]
    assert unmet["faults"] == ["unknown"]


@pytest.mark.parametrize(
    ("holes", "limits", "rule", "sentence"),
    [
        (
            HOLES,
            {"max_expected_error": 0.1},
            None,
            "2 of 4 chosen holes miss the limits: hole 2 (refused), hole 4 (expected error 0.3, at most 0.1)",
        ),
        (
            [hole(7, 0.25)],
            {"max_error_share": 0.1, "min_confidence": 0.9},
            "castings@3",
            "1 of 1 chosen hole misses the limits of castings@3: "
            "hole 7 (expected error 0.25, at most 0.1 of its diameter; confidence 0.8, at least 0.9)",
        ),
        (
            [hole(0), hole(1, None)],
            {"max_expected_error": 0.1},
            "castings@3",
            "1 of 2 chosen holes misses the limits of castings@3: hole 1 (it has no such figure)",
        ),
        (
            [hole(i, 0.2) for i in range(4)],
            {"max_expected_error": 0.1},
            "castings@3",
            "4 of 4 chosen holes miss the limits of castings@3: holes 0, 1, 2, 3",
        ),
    ],
)
def test_holes_that_miss_the_limits_are_named(
    holes: list[Any], limits: dict[str, float], rule: str | None, sentence: str
) -> None:
    assert unmet_in_words(judge(holes, limits), rule, limits) == sentence

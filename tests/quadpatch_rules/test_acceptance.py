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


def test_holes_that_do_not_meet_the_limits_are_named() -> None:
    judged = judge(HOLES, {"max_expected_error": 0.1})
    assert unmet_in_words(judged, None) == "2 of 4 holes do not meet the limits: 2, 4"
    assert unmet_in_words(judge([hole(7, 0.2)], {"max_expected_error": 0.1}), "castings@3") == (
        "1 of 1 holes does not meet the rule castings@3: 7"
    )

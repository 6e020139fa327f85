from typing import Any

import pytest

from jobkit.shadows.comparison import error_ratio, expected_errors


def report(errors: dict[int, float | None], calibration_holes: int = 24) -> dict[str, Any]:
    holes = [{"id": number, "expected_error": error} for number, error in errors.items()]
    return {"calibration": {"holes": calibration_holes}, "holes": holes}


def test_errors_are_compared_hole_by_hole() -> None:
    n_holes, ratio = error_ratio(report({0: 0.1, 1: 0.4}), report({0: 0.2, 1: 0.1})) or (0, 0.0)
    assert n_holes == 2
    assert ratio == pytest.approx(2**0.5)


def test_holes_that_only_one_report_has_an_error_of_are_left_out() -> None:
    candidate, baseline = report({0: 0.1, 1: None, 3: 0.7}), report({0: 0.2, 1: 0.3, 2: 0.1})
    assert error_ratio(candidate, baseline) == pytest.approx((1, 0.5))
    assert error_ratio(report({1: None}), baseline) is None


@pytest.mark.parametrize("calibration", [None, {"holes": 0}])
def test_without_calibration_holes_there_is_nothing_to_compare(calibration: dict[str, int] | None) -> None:
    guessed = report({0: 0.1}) | {"calibration": calibration}
    assert expected_errors(guessed) == {}
    assert error_ratio(guessed, report({0: 0.1})) is None

from typing import Any

import numpy as np
import pytest

from benchmarks.quality.calibration import calibrate


def _holes(true: list[float], expected: list[float]) -> list[dict[str, Any]]:
    return [
        {"true_error": t, "expected_error": e, "confidence": float(np.exp(-e))}
        for t, e in zip(true, expected, strict=True)
    ]


def test_expectations_that_are_true_are_perfect() -> None:
    errors = [float(i) for i in range(1, 21)]
    found = calibrate(_holes(errors, errors))
    assert found is not None
    assert found.n_holes == 20
    assert found.rank_correlation == pytest.approx(1.0)
    assert found.true_per_expected == pytest.approx(1.0)
    assert found.tenth_ratio == pytest.approx(19.5 / np.mean(errors[:18]))


def test_expectations_the_wrong_way_round_have_rank_minus_one() -> None:
    errors = [float(i) for i in range(1, 21)]
    found = calibrate(_holes(errors, errors[::-1]))
    assert found is not None
    assert found.rank_correlation == pytest.approx(-1.0)
    assert found.tenth_ratio < 1


def test_the_least_confident_tenth_takes_its_part_of_a_tie_in_any_order() -> None:
    holes = _holes([1.0] * 10 + [3.0] * 10, [1.0] * 10 + [2.0] * 10)
    forward, backward = calibrate(holes), calibrate(holes[::-1])
    assert forward is not None
    assert backward is not None
    assert forward.tenth_ratio == pytest.approx(backward.tenth_ratio)
    # Two of the ten that tie at the bottom are worth 3.0 each; eight of them and the others make the rest.
    assert forward.tenth_ratio == pytest.approx(3.0 / ((10 * 1.0 + 8 * 3.0) / 18))


def test_holes_without_an_expectation_do_not_count() -> None:
    errors = [float(i) for i in range(1, 11)]
    silent = {"true_error": 9.0, "expected_error": None, "confidence": None}
    assert calibrate([*_holes(errors, errors), silent]) == calibrate(_holes(errors, errors))


def test_there_is_nothing_to_say_about_few_or_equal_holes() -> None:
    assert calibrate(_holes([1.0] * 9, [float(i) for i in range(9)])) is None
    assert calibrate(_holes([float(i) for i in range(20)], [1.0] * 20)) is None

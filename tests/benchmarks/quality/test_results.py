from pathlib import Path

import pytest

from benchmarks.quality.results import Results

KEY = {"mesh": "igea", "radius": "0.025", "method": "a/b c"}


def test_a_result_is_computed_once_and_kept_between_runs(tmp_path: Path) -> None:
    assert Results(tmp_path).get("repairs", KEY, lambda: {"error": 0.5}) == {"error": 0.5}
    assert Results(tmp_path).get("repairs", KEY, lambda: {"error": 9.0}) == {"error": 0.5}


def test_another_key_or_kind_is_another_result(tmp_path: Path) -> None:
    results = Results(tmp_path)
    results.get("repairs", KEY, lambda: {"error": 0.5})
    assert results.get("repairs", {**KEY, "sha256": "other"}, lambda: {"error": 0.6}) == {"error": 0.6}
    assert results.get("peers", KEY, lambda: {"error": 0.7}) == {"error": 0.7}


def test_a_fresh_run_computes_again_but_just_once(tmp_path: Path) -> None:
    Results(tmp_path).get("repairs", KEY, lambda: {"error": 0.5})
    fresh = Results(tmp_path, fresh=["repairs"])
    assert fresh.get("repairs", KEY, lambda: {"error": 0.6}) == {"error": 0.6}
    assert fresh.get("repairs", KEY, lambda: {"error": 0.7}) == {"error": 0.6}


def test_only_the_kinds_that_are_named_are_fresh(tmp_path: Path) -> None:
    Results(tmp_path).get("peers", KEY, lambda: {"error": 0.5})
    fresh = Results(tmp_path, fresh=["repairs"])
    assert fresh.get("peers", KEY, lambda: {"error": 0.6}) == {"error": 0.5}


def test_a_computation_that_fails_leaves_nothing_behind(tmp_path: Path) -> None:
    results = Results(tmp_path)

    def fail() -> dict[str, float]:
        raise ValueError("no")

    with pytest.raises(ValueError, match="no"):
        results.get("repairs", KEY, fail)
    assert results.get("repairs", KEY, lambda: {"error": 0.5}) == {"error": 0.5}

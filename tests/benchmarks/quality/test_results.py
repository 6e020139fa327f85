from pathlib import Path

import pytest

from benchmarks.quality.code_version import code_sha256
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


def test_results_of_other_code_are_measured_again_but_not_those_of_the_peers(tmp_path: Path) -> None:
    for kind in ("repairs", "peers"):
        Results(tmp_path, code="old").get(kind, KEY, lambda: {"error": 0.5})
    newer = Results(tmp_path, code="new")
    assert newer.get("repairs", KEY, lambda: {"error": 0.6}) == {"error": 0.6}
    assert newer.get("peers", KEY, lambda: {"error": 0.6}) == {"error": 0.5}


def test_comments_and_docstrings_are_no_other_code(tmp_path: Path) -> None:
    file = tmp_path / "rule.py"

    def version(text: str) -> str:
        file.write_text(text)
        return code_sha256([file])

    first = version('"""One."""\n\n\ndef rule() -> int:\n    """Say one."""\n    return 1\n')
    assert version('"""Two."""\n\n\ndef rule() -> int:\n    # why\n    return 1\n') == first
    assert version("def rule() -> int:\n    return 2\n") != first

"""Also tests `quadpatch_client.schema.acceptance`."""

import json
from pathlib import Path
from typing import Any

import pytest

from quadpatch_client.schema import JobSpec
from worker.acceptance import check_acceptance
from worker.engine.request import REPORT_NAME
from worker.failures import EngineFailedError


def hole(number: int, error: float | None = 0.1, confidence: float | None = 0.8, verdict: str = "filled") -> Any:
    return {"id": number, "verdict": verdict, "expected_error": error, "confidence": confidence, "diameter": 2.0}


HOLES = [
    hole(4, error=0.3),
    hole(3, confidence=0.2, verdict="filled_smooth"),
    hole(2, error=None, confidence=None, verdict="refused"),
    hole(1, error=None, confidence=None, verdict="skipped"),
    hole(0),
]


def spec(**acceptance: Any) -> JobSpec:
    return JobSpec.model_validate({"mesh_id": "a" * 64, "acceptance": acceptance, "rule": "castings@3"})


def written(folder: Path, holes: list[Any]) -> Path:
    path = folder / REPORT_NAME
    path.write_text(json.dumps({"holes": holes, "warnings": ["unit unknown"]}))
    return path


def test_what_is_not_met_is_a_warning_that_names_the_holes(tmp_path: Path) -> None:
    path = written(tmp_path, HOLES)
    check_acceptance(tmp_path, spec(max_expected_error=0.1))
    report = json.loads(path.read_text())
    sentence = (
        "2 of 4 chosen holes miss the limits of castings@3: hole 2 (refused), hole 4 (expected error 0.3, at most 0.1)"
    )
    assert report["warnings"] == ["unit unknown", sentence]
    assert report["acceptance"]["is_met"] is False
    assert [hole["id"] for hole in report["acceptance"]["unmet"]] == [2, 4]


def test_what_is_met_is_no_warning(tmp_path: Path) -> None:
    path = written(tmp_path, [hole(0)])
    check_acceptance(tmp_path, spec(max_expected_error=0.1, otherwise="fail"))
    report = json.loads(path.read_text())
    assert report["warnings"] == ["unit unknown"]
    assert report["acceptance"] == {"is_met": True, "holes": 1, "unmet": []}


def test_a_job_fails_where_its_rule_says_so(tmp_path: Path) -> None:
    written(tmp_path, [hole(i, error=1.0) for i in range(25)])
    with pytest.raises(EngineFailedError) as caught:
        check_acceptance(tmp_path, spec(max_expected_error=0.1, otherwise="fail"))
    failure = caught.value.failure
    assert (failure.code, failure.retryable, failure.stage) == ("acceptance_not_met", False, "judge")
    assert failure.message == (
        "25 of 25 chosen holes miss the limits of castings@3: holes " + ", ".join(map(str, range(20))) + ", …"
    )


def test_without_limits_the_report_stays_as_it_is(tmp_path: Path) -> None:
    path = written(tmp_path, HOLES)
    before = path.read_bytes()
    check_acceptance(tmp_path, JobSpec(mesh_id="a" * 64))
    assert path.read_bytes() == before

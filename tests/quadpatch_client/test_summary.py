from datetime import UTC, datetime
from typing import Any

import pytest

from quadpatch_client.schema import HoleCounts, Job
from quadpatch_client.summary import geometry_only, open_holes, paragraph, verdicts


def hole(number: int, verdict: str, code: str | None = None, reason: str | None = None) -> dict[str, Any]:
    return {"id": number, "verdict": verdict, "code": code, "reason": reason}


def finished_job(**result: Any) -> Job:
    return Job.model_validate(
        {
            "id": "job_01jd7z3v5qk8m2x4c6b8n0a9de",
            "state": "succeeded",
            "attempt": 1,
            "max_attempts": 3,
            "percent": 100.0,
            "created_at": datetime(2026, 11, 22, tzinfo=UTC),
            "mesh_id": "0" * 64,
            "model": {"requested": "default", "kind": "none"},
            "spec": {"mesh_id": "0" * 64},
            "revision": 3,
            "links": {"self": "/", "events": "/", "mesh": "/", "rerun": "/"},
            "result": {"format": "ply", **result},
        }
    )


def test_verdicts_leave_out_what_did_not_happen() -> None:
    assert verdicts(HoleCounts(found=3, filled=2, refused=1)) == "2 filled with the model, 1 refused"
    assert verdicts(HoleCounts()) == "nothing to do"


def test_open_holes_are_told_by_reason_the_commonest_first() -> None:
    holes = [
        hole(0, "skipped", "largest", "it is the border"),
        hole(1, "refused", "too_wide", "10 is over 5"),
        hole(2, "filled"),
        hole(3, "refused", "too_wide", "11 is over 5"),
    ]
    assert open_holes({"holes": holes}) == "2 × too wide (hole 1: 10 is over 5); hole 0: it is the border"
    assert open_holes({"holes": [hole(0, "filled")]}) == ""


def test_holes_filled_by_geometry_say_why() -> None:
    holes = [hole(0, "filled_smooth", "no_gain", "no gain"), hole(1, "filled_smooth", "no_gain", "no gain")]
    assert geometry_only({"holes": [*holes, hole(2, "filled")]}) == "2 × no gain"


def test_a_paragraph_tells_counts_reasons_and_seconds() -> None:
    job = finished_job(holes={"found": 1, "filled_smooth": 1}, new_vertices=1200, new_triangles=2400, seconds=1.25)
    report = {"holes": [hole(0, "filled_smooth")], "stages": [{"name": "read", "seconds": 0.26}]}
    assert paragraph("scan.ply", job, report) == (
        "scan.ply has 1 hole: 1 filled smoothly. 1,200 vertices and 2,400 triangles were added; "
        "every measured vertex kept its bits. The repair took 1.2 s (read 0.3 s)."
    )
    coloured = paragraph("scan.ply", job, {**report, "colours": {"method": "exemplars", "calibration": None}})
    assert " Colours of new vertices: exemplars. The repair took" in coloured


def test_a_paragraph_tells_which_model_was_best() -> None:
    job = finished_job(holes={"found": 1, "filled_smooth": 1}, new_vertices=1200, new_triangles=2400, seconds=1.25)
    model = {"shares": {}, "trials": [{"models": {}, "believed_share": 0.0, "error": 0.5}]}
    report = {"model": model, "holes": [hole(0, "filled_smooth")], "stages": []}
    assert "kept its bits. Least error on calibration holes: geometry alone. The repair" in paragraph("a", job, report)


def test_there_is_no_paragraph_without_a_result() -> None:
    job = finished_job().model_copy(update={"result": None})
    with pytest.raises(ValueError, match="has no result"):
        paragraph("scan.ply", job, {})

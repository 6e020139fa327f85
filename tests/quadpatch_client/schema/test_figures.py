"""One table for the batch of a service and the folder of a client."""

from pathlib import Path
from typing import Any

import pytest

from quadpatch_client.batch_summary import figures
from quadpatch_client.errors import JobFailedError
from quadpatch_client.file_repair import FilePlan, Row, failure, row_of
from quadpatch_client.schema import FIGURES, Job, figures_of, spreadsheet_cell
from tests.quadpatch_client.wire_jobs import JOB_ID, body

PLAN = FilePlan("deep/scan.gltf", Path("in/deep/scan.gltf"), Path("out/deep/scan.glb"), Path("out/deep/scan.json"))


def job_in(state: str, **more: Any) -> Job:
    return Job.model_validate_json(body(state, 3, **more))


def test_a_row_of_the_client_says_what_that_of_the_service_says() -> None:
    counts = {"found": 3, "filled_smooth": 2, "skipped": 1}
    result = {"format": "glb", "holes": counts, "seconds": 1.5, "warnings": ["the unit"]}
    job = job_in("succeeded_with_warnings", result=result)
    of_service, of_client = figures_of(job, "scan-repaired.glb"), figures(row_of(PLAN, job, "the unit"))
    assert tuple(of_service) == tuple(of_client) == FIGURES
    assert of_client == {**of_service, "mesh_name": "deep/scan.gltf", "file": "deep/scan.glb"}
    assert of_client["reason"] == "the unit"
    assert (of_client["holes_filled_smooth"], of_client["work_seconds"], of_client["warnings"]) == (2, 1.5, 1)


def test_a_job_that_failed_has_its_code_and_reason() -> None:
    job = job_in("failed", error={"code": "out_of_memory", "message": "it took more than 2 GB"})
    row = figures(failure("scan.ply", JobFailedError(job)))
    assert (row["state"], row["error_code"], row["job_id"]) == ("failed", "out_of_memory", JOB_ID)
    assert "it took more than 2 GB" in row["reason"]
    unsent = figures(failure("scan.ply", OSError("it is gone")))
    assert (unsent["state"], unsent["job_id"], unsent["reason"]) == ("failed", None, "it is gone")


def test_an_entry_of_an_earlier_version_fills_the_columns_that_it_knows() -> None:
    row = figures(Row("scan.ply", "done", 3, 0, 2, 1, 0, 70, 1.0, "job_2"))
    assert row["holes_filled_smooth"] == 2
    assert (row["state"], row["new_triangles"], row["work_seconds"], row["job_id"]) == ("succeeded", 70, 1.0, "job_2")
    assert row["file_sha256"] is None


@pytest.mark.parametrize("text", ["=1+1", "+1", "-1", "@a", "\t=1"])
def test_no_cell_is_a_formula(text: str) -> None:
    assert spreadsheet_cell(text) == f"'{text}"
    assert spreadsheet_cell("a" + text) == "a" + text
    assert spreadsheet_cell(-1) == -1

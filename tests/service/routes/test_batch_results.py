"""Also tests `service/batch_files.py` and `service/routes/batch_results.py`."""

import csv
import io
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from starlette.testclient import TestClient

from jobkit.batches.progress import note_progress
from quadpatch_client.schema import Job, JobError
from service.batch_files import FileNames
from service.services import Services
from tests.jobkit.fixtures import damage

SMOOTH = {"method": "smooth"}
Finish = Callable[[str], Job]


@pytest.fixture
def ended(client: TestClient, services: Services, mesh_id: str, finish: Finish) -> str:
    """A batch that has ended: two results under one name, one under a hostile name, and a failure."""
    names = ["part 7.ply", "PART 7.stl", '=cmd|"C calc"!A0.ply', "@failed.ply"]
    jobs = [
        {"mesh_id": mesh_id, "method": SMOOTH, "seed": i, "mesh_name": name, "label": "=1+1"}
        for i, name in enumerate(names)
    ]
    batch_id: str = client.post("/v1/batches", json={"jobs": jobs}).json()["id"]
    ids = services.batches.job_ids(batch_id)
    for job_id in ids[:3]:
        finish(job_id)
    attempt = services.attempts.start(ids[3], "test", 30).attempt
    services.attempts.fail(attempt, JobError(code="no_quads", message="-2+3 has no quads"))
    note_progress(services.database)
    return batch_id


def table_of(data: bytes) -> list[dict[str, str]]:
    return list(csv.DictReader(io.StringIO(data.decode(), newline="")))


def test_the_archive_holds_every_result_under_a_name_of_its_own(client: TestClient, ended: str) -> None:
    answer = client.get(f"/v1/batches/{ended}/results.zip")
    assert (answer.status_code, answer.headers["Content-Type"]) == (200, "application/zip")
    assert "Content-Length" not in answer.headers
    archive = zipfile.ZipFile(io.BytesIO(answer.content))
    assert archive.testzip() is None
    table = table_of(archive.read("figures.csv"))
    files = [row["file"] for row in table if row["file"]]
    assert archive.namelist() == ["figures.csv", *(name.removeprefix("'") for name in files)]
    assert {archive.read(name) for name in archive.namelist()[1:]} == {b"ply, repaired"}
    assert files == [
        "part 7-repaired.ply",
        f"PART 7-repaired-{table[1]['job_id']}.ply",
        "'=cmd__C calc_!A0-repaired.ply",
    ]
    assert [row["file_bytes"] for row in table] == ["13", "13", "13", ""]
    assert table == table_of(client.get(f"/v1/batches/{ended}/figures.csv").content)


def test_other_files_come_where_they_are_asked_for(client: TestClient, ended: str) -> None:
    answer = client.get(f"/v1/batches/{ended}/results.zip?role=report&role=preview&role=report")
    names = zipfile.ZipFile(io.BytesIO(answer.content)).namelist()
    assert len(names) == len(set(names)) == 7
    assert names[1:3] == ["part 7-repaired.json", "part 7-repaired.png"]


def test_the_table_says_what_became_of_each_job(client: TestClient, ended: str) -> None:
    answer = client.get(f"/v1/batches/{ended}/figures.csv")
    assert answer.headers["Content-Type"] == "text/csv; charset=utf-8"
    assert f'filename="{ended}.csv"' in answer.headers["Content-Disposition"]
    rows = table_of(answer.content)
    jobs: list[dict[str, Any]] = client.get(f"/v1/jobs?batch_id={ended}&oldest_first=true").json()["items"]
    assert [row["job_id"] for row in rows] == [job["id"] for job in jobs]
    for row, job in zip(rows, jobs, strict=True):
        assert (row["state"], row["mesh_id"], row["created_at"]) == (job["state"], job["mesh_id"], job["created_at"])
        if job["result"] is not None:
            assert row["holes_found"] == str(job["result"]["holes"]["found"])
            assert row["work_seconds"] == str(job["result"]["seconds"])
    assert [name for name in rows[0] if name.endswith(("_bytes", "_mib", "_seconds", "_mesh_units"))]


def test_no_text_of_a_sender_becomes_a_formula(client: TestClient, ended: str) -> None:
    rows = table_of(client.get(f"/v1/batches/{ended}/figures.csv").content)
    assert rows[2]["mesh_name"].startswith("'=cmd")
    assert (rows[3]["mesh_name"], rows[3]["error_message"]) == ("'@failed.ply", "'-2+3 has no quads")
    assert {row["label"] for row in rows} == {"'=1+1"}


def test_results_come_once_the_batch_has_ended_and_figures_before(client: TestClient, mesh_id: str) -> None:
    made = client.post("/v1/batches", json={"mesh_ids": [mesh_id], "spec": {"method": SMOOTH}}).json()["id"]
    early = client.get(f"/v1/batches/{made}/results.zip")
    assert (early.status_code, early.json()["code"]) == (409, "batch_not_finished")
    (row,) = table_of(client.get(f"/v1/batches/{made}/figures.csv").content)
    assert (row["state"], row["file"]) == ("queued", "")


def test_a_lost_result_leaves_a_note_in_its_place(client: TestClient, services: Services, ended: str) -> None:
    _, keys = services.jobs.with_files(services.batches.job_ids(ended)[0])
    services.store.delete(keys["repaired.ply"])
    archive = zipfile.ZipFile(io.BytesIO(client.get(f"/v1/batches/{ended}/results.zip").content))
    assert archive.read("part 7-repaired.ply.missing.txt").startswith(b"object_not_found: ")
    assert len(archive.namelist()) == 4


def test_damage_that_shows_in_the_middle_breaks_the_archive_off(
    client: TestClient, services: Services, ended: str, tmp_path: Path
) -> None:
    _, keys = services.jobs.with_files(services.batches.job_ids(ended)[1])
    damage(services.store, keys["repaired.ply"], tmp_path)
    with pytest.raises(RuntimeError, match="already started"):
        client.get(f"/v1/batches/{ended}/results.zip")


def test_a_head_says_what_would_come(client: TestClient, ended: str) -> None:
    answer = client.head(f"/v1/batches/{ended}/results.zip")
    assert (answer.status_code, answer.content, answer.headers["Content-Type"]) == (200, b"", "application/zip")


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ("../../etc/passwd", "passwd-repaired.ply"),
        ("C:\\scans\\a.stl", "C__scans_a-repaired.ply"),
        ("-rf.ply", "rf-repaired.ply"),
        ("ü" * 250 + ".stl", "ü" * 100 + "-repaired.ply"),
        ("nul\x00<b>.ply", "nul__b_-repaired.ply"),
    ],
)
def test_names_are_safe_on_every_system(
    client: TestClient, services: Services, ended: str, given: str, expected: str
) -> None:
    job = services.jobs.get(services.batches.job_ids(ended)[0]).model_copy(update={"mesh_name": given})
    assert FileNames().name(job) == expected
    assert len(expected.encode()) <= 255

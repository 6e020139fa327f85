import json
from dataclasses import replace
from pathlib import Path
from typing import cast

import pytest

from quadpatch_client.errors import ClientError, UsageError
from quadpatch_client.options import HoleChoice, MethodChoice
from quadpatch_client.repairing import Task, check_outputs, format_of, repair
from quadpatch_client.schema import Job, JobSpec, Mesh
from quadpatch_client.screen import Screen
from quadpatch_client.sdk import Client
from tests.quadpatch_client.wire_jobs import body


def task(source: Path, output: Path, report: Path | None = None, *, may_overwrite: bool = False) -> Task:
    return Task(source, output, HoleChoice(), MethodChoice(), report=report, may_overwrite=may_overwrite)


def test_the_scan_is_overwritten_on_request_alone_whatever_name_it_has(tmp_path: Path) -> None:
    scan, mesh, report = tmp_path / "scan.ply", tmp_path / "mesh.ply", tmp_path / "report.json"
    scan.write_bytes(b"raw")
    link, hard = tmp_path / "link.ply", tmp_path / "hard.ply"
    link.symlink_to(scan)
    hard.hardlink_to(scan)
    (tmp_path / "folder").mkdir()
    for name in (scan, tmp_path / "folder" / ".." / "scan.ply", link, hard):
        with pytest.raises(UsageError, match="--overwrite"):
            check_outputs(task(scan, name, report))
        check_outputs(task(scan, name, report, may_overwrite=True))
        for may_overwrite in (False, True):
            with pytest.raises(UsageError, match="named twice"):
                check_outputs(task(scan, mesh, name, may_overwrite=may_overwrite))


def test_outputs_must_not_overwrite_each_other(tmp_path: Path) -> None:
    scan, mesh, report = tmp_path / "scan.ply", tmp_path / "mesh.ply", tmp_path / "report.json"
    check_outputs(task(scan, mesh, report))
    with pytest.raises(UsageError, match="named twice"):
        check_outputs(task(scan, mesh, mesh, may_overwrite=True))
    with pytest.raises(UsageError, match="named twice"):
        check_outputs(replace(task(scan, mesh, report), html=report))


def test_close_ups_must_not_overwrite_another_output(tmp_path: Path) -> None:
    folder = tmp_path / "holes"
    folder.mkdir()
    asked = replace(task(tmp_path / "scan.ply", tmp_path / "mesh.ply"), closeups=folder)
    check_outputs(replace(asked, preview=folder / "whole.png"))
    for clash in (
        replace(asked, preview=folder / "hole_0.png"),
        replace(asked, report=folder / "hole_12.png"),
        replace(asked, html=folder / "hole_3.png"),
    ):
        with pytest.raises(UsageError, match="name of a close-up"):
            check_outputs(clash)


def test_an_output_needs_a_folder_and_must_be_none(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="there is no folder"):
        check_outputs(task(tmp_path / "scan.ply", tmp_path / "none" / "mesh.ply"))
    with pytest.raises(UsageError, match="is a folder"):
        check_outputs(task(tmp_path / "scan.ply", tmp_path / "mesh.ply", tmp_path))


class Service:
    """A service that has repaired the mesh, and lost some of the files that come with it."""

    def __init__(self, lost: set[str]) -> None:
        self._lost = lost

    def upload(self, path: Path, progress: object) -> Mesh:
        links = {"self": "/v1/meshes/0", "content": "/v1/meshes/0/content"}
        facts = {"id": "0" * 64, "state": "ready", "size_bytes": 3, "created_at": "2026-11-22T09:15:02.250Z"}
        return Mesh.model_validate({**facts, "links": links})

    def create_job_once(self, spec: JobSpec) -> Job:
        return Job.model_validate_json(body("queued", 1, mesh_name=spec.mesh_name))

    def wait(self, *_: object) -> Job:
        return Job.model_validate_json(body("succeeded", 2, result={"format": "ply"}))

    def download(self, job: Job, role: str, target: Path, progress: object = None) -> None:
        if role in self._lost:
            raise ClientError(f"job {job.id} has no {role}")
        target.write_text(json.dumps({"holes": [], "warnings": [], "stages": []}))

    def download_closeups(self, job: Job, folder: Path) -> list[Path]:
        folder.mkdir()
        self.download(job, "closeups", folder / "hole_0.png")
        return [folder / "hole_0.png"]


@pytest.mark.parametrize(
    "lost", [set(), {"preview"}, {"report"}, {"closeups"}, {"html_report"}, {"preview", "report", "closeups"}]
)
def test_the_mesh_is_there_whatever_else_the_service_has_lost(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], lost: set[str]
) -> None:
    (tmp_path / "scan.ply").write_text("ply")
    output, preview, page = tmp_path / "out.ply", tmp_path / "out.png", tmp_path / "page.html"
    asked = replace(task(tmp_path / "scan.ply", output), preview=preview, closeups=tmp_path / "holes", html=page)
    job = repair(cast(Client, Service(lost)), Screen(), asked)
    assert job.state.has_result
    assert output.exists()
    assert preview.exists() == ("preview" not in lost)
    said = capsys.readouterr().err
    assert {role for role in ("preview", "report") if f"there is no {role}" in said} == lost & {"preview", "report"}
    assert page.exists() == ("html_report" not in lost) == ("there is no HTML report" not in said)
    assert ("there are no close-ups" in said) == ("closeups" in lost)
    assert ("hole_0.png" in said) == (tmp_path / "holes" / "hole_0.png").exists() == ("closeups" not in lost)


def test_a_report_that_was_asked_for_and_is_not_there_is_an_error_after_the_mesh(tmp_path: Path) -> None:
    (tmp_path / "scan.ply").write_text("ply")
    asked = task(tmp_path / "scan.ply", tmp_path / "out.ply", tmp_path / "out.json")
    with pytest.raises(ClientError, match="has no report"):
        repair(cast(Client, Service({"report"})), Screen(quiet=True), asked)
    assert (tmp_path / "out.ply").exists()


def test_the_suffix_says_the_format_in_any_case() -> None:
    assert format_of(Path("a/part.STL")) == "stl"
    for name in ("part", "part.xyz", "part.gltf"):
        with pytest.raises(UsageError, match="rename it or give --format"):
            format_of(Path(name))

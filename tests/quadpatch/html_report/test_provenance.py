import hashlib
from datetime import datetime
from importlib.metadata import version
from pathlib import Path

import pytest

from quadpatch.html_report.page import render_page
from quadpatch.html_report.provenance import note_start, provenance
from quadpatch.repair import repair_and_keep
from tests.quadpatch.html_report.pages import Page, ball
from tests.quadpatch.shapes import write_ply
from tests.quadpatch.test_repair_by_effort import SCAN


def test_it_names_the_bytes_that_came_in_and_those_that_were_written(tmp_path: Path) -> None:
    source, output = ball(tmp_path), tmp_path / "out.ply"
    start = note_start(source)
    repaired = repair_and_keep(source, output, "smooth")
    facts = provenance(start, repaired, output)
    for file, path in ((facts["source"], source), (facts["output"], output)):
        assert file == {
            "name": path.name,
            "size_bytes": path.stat().st_size,
            "sha256": hashlib.sha256(path.read_bytes()).hexdigest(),
        }
    assert (facts["software"], facts["software_version"]) == ("quadpatch", version("quadpatch"))
    started, finished = (datetime.fromisoformat(facts[name]) for name in ("started_at", "finished_at"))
    assert started <= finished
    assert facts["request"] is None


def test_the_surface_before_agrees_with_the_holes_of_the_report(tmp_path: Path) -> None:
    source, output = ball(tmp_path), tmp_path / "out.ply"
    repaired = repair_and_keep(source, output, "smooth")
    facts, holes = provenance(note_start(source), repaired, output), repaired.report["holes"]
    before, after = facts["before"], facts["after"]
    assert before["boundary_loops"] == repaired.report["counts"]["found"] == 2
    assert before["boundary_length"] == pytest.approx(sum(hole["perimeter"] for hole in holes))
    assert after["triangles"] - before["triangles"] == sum(hole["new_triangles"] for hole in holes)
    assert (after["boundary_loops"], after["is_watertight"], before["volume"]) == (0, True, None)
    assert after["volume"] == pytest.approx(4.1, abs=0.1)


def test_a_scan_that_is_overwritten_keeps_its_hash(tmp_path: Path) -> None:
    source = ball(tmp_path)
    sha256 = hashlib.sha256(source.read_bytes()).hexdigest()
    start = note_start(source)
    facts = provenance(start, repair_and_keep(source, source, "smooth"), source)
    assert facts["source"]["sha256"] == sha256
    assert facts["output"]["sha256"] == hashlib.sha256(source.read_bytes()).hexdigest() != sha256


def test_what_went_into_a_stream_has_no_hash(tmp_path: Path) -> None:
    source = ball(tmp_path)
    repaired = repair_and_keep(source, tmp_path / "out.ply", "smooth")
    assert provenance(note_start(source), repaired, Path("/dev/null"))["output"] is None
    assert note_start(tmp_path / "none.ply").source is None


def test_the_name_of_the_mesh_and_who_asked_come_from_the_request(tmp_path: Path) -> None:
    source, output = ball(tmp_path, "source.ply"), tmp_path / "out.ply"
    repaired = repair_and_keep(source, output, "smooth")
    asked = {"job_id": "job_1", "label": "a\nb", "mesh_name": "bust.ply"}
    facts = provenance(note_start(source), repaired, output, asked)
    assert facts["source"]["name"] == "bust.ply"
    assert facts["request"] == {"job_id": "job_1", "label": "a\\nb"}


def test_how_far_a_model_moved_new_vertices_is_counted(tmp_path: Path) -> None:
    source, output = write_ply(tmp_path / "in.ply", SCAN), tmp_path / "out.ply"
    repaired = repair_and_keep(source, output)
    facts = provenance(note_start(source), repaired, output)
    counted = facts["displacement"]
    by_model = [hole["new_vertices"] for hole in repaired.report["holes"] if hole["verdict"] == "filled"]
    assert sum(by_model) > 0
    assert sum(counted["counts"]) == sum(by_model)
    repaired.report["provenance"] = facts
    page = Page(render_page(repaired.report))
    assert [chart.text.split(",")[0] for chart in page.all("figcaption")] == [
        "Expected error of the filled holes",
        "How far the model moved new vertices off the geometric fill",
    ]
    assert len(page.all("svg")) == 2

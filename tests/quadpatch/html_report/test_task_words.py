"""Pages of the other tasks: their figures are those of the JSON, and nothing that a client wrote is more than text."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pydantic import BaseModel

from quadpatch.compression.encode import EncodeOptions
from quadpatch.html_report.in_short import QUESTIONS
from quadpatch.html_report.provenance import note_start
from quadpatch.html_report.task_words import FIGURES, task_in_short, value_at
from quadpatch.html_report.writing import PageOrder, add_task_report
from quadpatch.tasks.decode import decode_file
from quadpatch.tasks.denoise import denoise_file
from quadpatch.tasks.encode import encode_file
from quadpatch.tasks.restore import restore_file
from quadpatch.tasks.result import TaskResult
from quadpatch.types import TriangleMesh
from quadpatch_client.schema.task_reports import DecodeReport, DenoiseReport, EncodeReport, RestoreReport
from quadpatch_rules.coded_warnings import warning
from tests.quadpatch.html_report.pages import HOSTILE, Page
from tests.quadpatch.shapes import sphere, write_ply

ASKED = {
    "job_id": "job_01",
    "tenant": "default",
    "asked_by": "station 4",
    "request_id": None,
    "label": HOSTILE,
    "metadata": {"order": HOSTILE},
    "rule": None,
    "mesh_name": HOSTILE,
}
MODELS: dict[str, type[BaseModel]] = {
    "restore": RestoreReport,
    "denoise": DenoiseReport,
    "encode": EncodeReport,
    "decode": DecodeReport,
}


def scan(folder: Path) -> Path:
    ball = sphere(4)
    rough = ball.vertices * (1 + 0.003 * np.random.default_rng(2).standard_normal((len(ball.vertices), 1)))
    return write_ply(folder / "in.ply", TriangleMesh(rough, ball.triangles))


def restored(source: Path, output: Path) -> TaskResult:
    (source.parent / "missing.txt").write_text("3\n40\n41\n")
    return restore_file(source, output, source.parent / "missing.txt", "smooth")


def encoded(source: Path, output: Path) -> TaskResult:
    return encode_file(source, output, options=EncodeOptions(0.02))


def decoded(source: Path, output: Path) -> TaskResult:
    encoded(source, source.with_suffix(".qpz"))
    return decode_file(source.with_suffix(".qpz"), output)


TASKS: dict[str, tuple[Callable[[Path, Path], TaskResult], str]] = {
    "restore": (restored, "out.ply"),
    "denoise": (lambda source, output: denoise_file(source, output, "smooth"), "out.ply"),
    "encode": (encoded, "out.qpz"),
    "decode": (decoded, "out.ply"),
}


@pytest.fixture(scope="module", params=TASKS)
def written(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[dict[str, Any], str]:
    """Report and page of a task that was asked for with hostile names."""
    folder = tmp_path_factory.mktemp("task")
    do, name = TASKS[request.param]
    source, output = scan(folder), folder / name
    start = note_start(source)
    result = do(source, output)
    add_task_report(result, PageOrder(start, output, ASKED), folder / "report.html")
    return result.report, (folder / "report.html").read_text("utf-8")


def test_every_figure_is_that_of_the_json(written: tuple[dict[str, Any], str]) -> None:
    report, text = written
    page = Page(text)
    (inside,) = page.all("textarea")
    as_json = json.loads(inside.text)
    assert {**as_json, "stages": None} == {**report, "stages": None}
    shown = {cells[0].text: cells[1:] for cells in page.rows("table-of-figures")}
    for path, title in FIGURES[report["task"]].items():
        found, value = value_at(as_json, path)
        parts = value.items() if isinstance(value, dict) else [("", value)] if found else []
        for name, part in parts:
            cells = shown.pop(f"{title}: {name.replace('_', ' ')}" if name else title)
            numbers = [float(cell.attributes["value"]) for cell in cells if cell.tag == "data"]
            if isinstance(part, int | float) and not isinstance(part, bool):
                assert numbers == [part]
                assert float(cells[0].text.replace(",", "")) == pytest.approx(part, rel=1e-3)
            else:
                said = {True: "yes", False: "no", None: "–"}.get(part, part)
                assert cells[0].text.strip() == str(said).replace("_", " ")
    assert shown == {}


def test_surfaces_files_and_who_asked_are_told(written: tuple[dict[str, Any], str]) -> None:
    report, text = written
    MODELS[report["task"]].model_validate(report)
    facts, page = report["provenance"], Page(text)
    rows = page.rows("table-of-surfaces")
    sides = [facts["after"]] if report["task"] == "decode" else [facts["before"], facts["after"]]
    assert (facts["before"] is None) == (report["task"] == "decode")
    for cells, name in zip(rows, ("triangles", "boundary_loops", "boundary_length", "area"), strict=False):
        assert [float(cell.attributes["value"]) for cell in cells if cell.tag == "data"] == [
            side[name] for side in sides
        ]
    texts = {cell.text for cell in page.all("td")}
    assert {facts["source"]["sha256"], facts["output"]["sha256"], "station 4", HOSTILE} <= texts
    assert "seed" in {cell.text for cell in page.all("th")} or report["task"] == "decode"
    assert f"quadpatch {facts['software_version']}" in texts
    assert report["stages"][-1]["name"] == "html_report"
    assert not page.all("script", "iframe", "link")


def test_the_first_lines_answer_in_words(written: tuple[dict[str, Any], str]) -> None:
    report, text = written
    said = task_in_short(report)
    assert [question for question, _ in said] == list(QUESTIONS)
    assert all(answers for _, answers in said)
    (short,) = [element for element in Page(text).all("dl") if element.attributes["class"] == "short"]
    assert all(answer.text in short.text for _, answers in said for answer in answers)


def test_what_is_left_to_do_is_said(written: tuple[dict[str, Any], str]) -> None:
    report, _ = written
    worse = {
        **report,
        "warnings": [str(warning("no_preview", reason="no memory"))],
        **({"vertices": {"missing": 3, "restored": 0, "left": 3}} if report["task"] == "restore" else {}),
        **({"moved_vertices": 0} if report["task"] == "denoise" else {}),
    }
    todo = " ".join(answer.text for answer in task_in_short(worse)[-1][1])
    assert "Read the 1 warning below." in todo
    assert report["task"] != "restore" or "3 vertices have no position still" in todo
    assert report["task"] != "denoise" or "no vertex was moved" in todo


def test_a_page_that_can_not_be_written_is_a_warning(tmp_path: Path) -> None:
    source, output = scan(tmp_path), tmp_path / "out.ply"
    start = note_start(source)
    result = restored(source, output)
    add_task_report(result, PageOrder(start, output), tmp_path / "missing" / "folder" / "report.html")
    assert result.report["warning_details"][-1]["code"] == "no_html_report"

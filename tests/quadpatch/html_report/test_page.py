"""The page says what the report says, and nothing that a client wrote is more than text.

Also tests `quadpatch.html_report.words`.
"""

import base64
import html
import json
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest

from quadpatch.html_report import page as page_module
from quadpatch.html_report import words
from quadpatch.html_report.page import Pictures, render_page
from quadpatch_rules.acceptance import judge
from tests.quadpatch.html_report.pages import HOSTILE, Element, Page, ball, repaired_with_page

ASKED = {
    "job_id": "job_01jd7z3v5qk8m2x4c6b8n0a9de",
    "tenant": "default",
    "asked_by": "station 4",
    "request_id": "r-1",
    "label": HOSTILE,
    "metadata": {"order": HOSTILE},
    "mesh_name": HOSTILE,
}
PNG = b"\x89PNG\r\n\x1a\n"


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> tuple[dict[str, Any], str]:
    """Report and page of a repair that was asked for with hostile names."""
    folder = tmp_path_factory.mktemp("page")
    repaired = repaired_with_page(ball(folder), folder / "report.html", ASKED)
    assert repaired.report["warnings"] == []
    return repaired.report, (folder / "report.html").read_text("utf-8")


def value_of(data: Element) -> float:
    """The number in an element `data`, which people read rounded."""
    exact = float(data.attributes["value"])
    assert float(data.text.replace(",", "")) == pytest.approx(exact, rel=1e-3)
    return exact


def numbers(cells: list[Element]) -> list[float]:
    return [value_of(cell) for cell in cells if cell.tag == "data"]


def test_the_figures_of_the_table_of_holes_are_those_of_the_report(written: tuple[dict[str, Any], str]) -> None:
    report, text = written
    rows = Page(text).rows("table-of-holes")
    assert len(rows) == len(report["holes"]) == 2
    shown = ("id", "hole_id", "diameter", "perimeter", "area", "confidence", "expected_error", "new_triangles")
    for cells, hole in zip(rows, report["holes"], strict=True):
        assert hole["verdict"] == "filled_smooth"
        assert numbers(cells) == [hole[name] for name in shown]
        said = [cell.text for cell in cells]
        assert f"{words.VERDICTS[hole['verdict']]}: {hole['reason']}" in said
        assert ", ".join(f"{coordinate:.4g}" for coordinate in hole["centre"]) in said


def test_the_counts_before_and_after_are_those_of_the_report(written: tuple[dict[str, Any], str]) -> None:
    report, text = written
    facts, page = report["provenance"], Page(text)
    rows = page.rows("table-of-surfaces")
    names = ("triangles", "boundary_loops", "boundary_length", "area", "volume", "components")
    for cells, name in zip(rows, names, strict=False):
        expected = [facts[when][name] for when in ("before", "after")]
        assert numbers(cells) == [number for number in expected if number is not None]
    assert [cell.text for cell in rows[-1]] == ["Watertight", "no", "yes"]
    assert facts["after"]["is_watertight"]
    assert not facts["before"]["is_watertight"]
    for file in (facts["source"], facts["output"]):
        assert file["sha256"] in {cell.text for cell in page.all("td")}


def test_the_whole_report_can_be_copied_out_of_the_page(written: tuple[dict[str, Any], str]) -> None:
    """But for the stage that wrote the page."""
    report, text = written
    assert json.loads(Page(text).by_id("report-json").text) == {**report, "stages": report["stages"][:-1]}


def test_the_page_says_who_asked(written: tuple[dict[str, Any], str]) -> None:
    report, text = written
    said = [cell.text for cell in Page(text).all("th", "td")]
    for name in ("job_id", "tenant", "asked_by", "request_id"):
        assert said[said.index(f"Request: {name}") + 1] == report["provenance"]["request"][name] == ASKED[name]


def test_what_a_client_wrote_is_text_wherever_it_stands(written: tuple[dict[str, Any], str]) -> None:
    _, text = written
    page = Page(text)
    assert {element.tag for element in page.elements} & {"script", "b", "iframe", "object", "link"} == set()
    assert not any(name.startswith("on") for element in page.elements for name in element.attributes)
    assert all(image.attributes["src"].startswith("data:image/png;base64,") for image in page.all("img"))
    assert page.all("title")[0].text == page.all("h1")[0].text == f"Repair report: {HOSTILE}"
    assert text.count(html.escape(HOSTILE, quote=False)[:20]) >= 4
    assert "49" not in page.all("h1")[0].text


def test_the_policy_of_the_page_allows_its_style_sheet_and_pictures_inside_it(
    written: tuple[dict[str, Any], str],
) -> None:
    (policy,) = [
        element.attributes["content"]
        for element in Page(written[1]).all("meta")
        if element.attributes.get("http-equiv") == "Content-Security-Policy"
    ]
    assert policy.startswith("default-src 'none'; img-src data:; style-src 'sha256-")
    assert "unsafe" not in policy


def test_headings_tables_and_pictures_can_be_told_by_a_screen_reader(written: tuple[dict[str, Any], str]) -> None:
    page = Page(written[1])
    assert page.all("html")[0].attributes["lang"] == "en"
    levels = [int(heading.tag[1]) for heading in page.all("h1", "h2", "h3")]
    assert levels[0] == 1
    assert levels.count(1) == 1
    assert all(after - before <= 1 for before, after in pairwise(levels))
    assert all(image.attributes["alt"] for image in page.all("img"))
    assert all(cell.attributes["scope"] in {"col", "row"} for cell in page.all("th"))
    assert len(page.all("table")) == len(page.all("caption"))
    ids = [element.attributes["id"] for element in page.elements if "id" in element.attributes]
    assert len(ids) == len(set(ids))
    links = [link.attributes["href"].removeprefix("#") for link in page.all("a")]
    assert links
    assert set(links) <= set(ids)
    for element in page.elements:
        assert set(element.attributes.get("aria-labelledby", "").split()) <= set(ids)


def test_close_ups_stand_in_the_page_the_widest_hole_first(written: tuple[dict[str, Any], str]) -> None:
    report, text = written
    shown = [image.attributes["alt"].split(" before")[0] for image in Page(text).all("img")[1:]]
    assert shown == [f"Hole {hole['id']}" for hole in report["holes"]]
    one = Page(render_page(report, Pictures(close_ups={1: PNG})))
    assert [base64.b64decode(image.attributes["src"].partition(",")[2]) for image in one.all("img")] == [PNG]


def test_the_page_says_whether_the_limits_are_met_and_by_which_holes_not(tmp_path: Path) -> None:
    asked = {**ASKED, "rule": "castings@3", "acceptance": {"min_confidence": 1.0, "max_expected_error": 1e-9}}
    report = repaired_with_page(ball(tmp_path), tmp_path / "report.html", asked).report
    page = Page((tmp_path / "report.html").read_text("utf-8"))
    unmet = report["acceptance"]["unmet"]
    assert [hole["id"] for hole in unmet] == [hole["id"] for hole in report["holes"]] == [0, 1]
    rows = page.rows("table-of-unmet")
    for cells, hole in zip(rows, unmet, strict=True):
        assert numbers(cells) == [hole["id"], hole["expected_error"], hole["confidence"]]
        assert ", ".join(words.FAULTS[fault] for fault in hole["faults"]) in [cell.text for cell in cells]
    assert "Not accepted: 2 of 2 chosen holes miss the limits of the rule castings@3." in page.text
    assert "1e-09" in [cell.text for cell in page.all("td")]


def test_the_page_says_that_limits_are_met(written: tuple[dict[str, Any], str]) -> None:
    report, text = written
    met = {**report, "acceptance": judge(report["holes"], {"min_confidence": 0.0})}
    assert "Accepted: each of the 2 chosen holes meets the limits." in Page(render_page(met)).text
    assert "Accepted" not in Page(text).text


def test_a_page_without_pictures_says_the_same(written: tuple[dict[str, Any], str]) -> None:
    report, text = written
    bare = Page(render_page(report))
    assert bare.all("img") == []
    assert len(bare.rows("table-of-holes")) == len(Page(text).rows("table-of-holes"))


def test_long_tables_are_cut_and_say_so(written: tuple[dict[str, Any], str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(page_module, "MOST_ROWS", 30)
    monkeypatch.setattr(page_module, "MOST_PRINTED_ROWS", 10)
    report = {**written[0], "holes": [{**written[0]["holes"][0], "id": i} for i in range(33)]}
    text = render_page(report)
    page = Page(text)
    assert len(page.rows("table-of-holes")) == 30
    kept_off_paper = [row for row in page.all("tr") if row.attributes.get("class") == "screen"]
    assert len(kept_off_paper) == 20
    assert "The table shows the 30 widest of 33 holes" in text
    assert len(json.loads(page.by_id("report-json").text)["holes"]) == 33


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (None, "–"),
        (0, "0"),
        (16700, "16,700"),
        (178.8426, "178.8"),
        (0.0, "0"),
        (21575.8, "21,576"),
        (1e-9, "1e-09"),
    ],
)
def test_numbers_are_written_for_people(value: float | None, text: str) -> None:
    assert words.figure(value) == text


def test_a_hole_names_its_energies_by_the_legend() -> None:
    first, second = ({"membrane": 0.0, "plate": 1.0, "variation": v, "slope": 1.0} for v in (0.0, 0.4))
    energies = [{**first, "share": 0.25}, {**second, "share": 0.75}]
    row = {"fill": "energies", "energies": energies}
    names = words.energy_names({"holes": [row, {"energies": None}]})
    assert list(names.items()) == [((0.0, 1.0, 0.0, 1.0), "E1"), ((0.0, 1.0, 0.4, 1.0), "E2")]
    assert words.geometric_fill(row, names) == "fairing energies: E2\u00a075\u00a0%, E1\u00a025\u00a0%"
    assert words.geometric_fill({"fill": "flat", "energies": None}, names) == "plane patch"
    assert words.geometric_fill({"fill": None, "energies": None}, names) == "–"


def test_the_model_of_a_fill_is_named_with_its_version_or_its_shares() -> None:
    shares = {"model": {"name": "auto", "shares": {"self": 0.5, "general-residual": 0.5}}}
    assert words.model_of_hole({"verdict": "filled"}, shares) == "self 50\u00a0%, general-residual 50\u00a0%"
    named = {"model": {"name": "general-dictionary", "version": 1}}
    assert words.model_of_hole({"verdict": "filled"}, named) == "general-dictionary@1"
    assert words.model_of_hole({"verdict": "filled_smooth"}, named) == "none"
    assert words.model_of_hole({"verdict": "skipped"}, named) == "–"
    for without in ({"name": "smooth"}, {"name": "auto", "shares": {}}, {"name": "auto", "effort": "fast"}):
        assert words.model({"model": without}) == "none: geometry alone"

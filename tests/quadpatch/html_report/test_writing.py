"""The page is optional: the mesh and the report are there whatever becomes of it."""

from pathlib import Path

import pytest

from quadpatch.html_report import writing
from quadpatch.html_report.provenance import note_start
from quadpatch.html_report.writing import PageOrder, add_html_report
from quadpatch.preview.drawing import draw_widest
from quadpatch.repair import RepairedFile, repair_and_keep
from tests.quadpatch.html_report.pages import Page, ball


def repaired(folder: Path) -> tuple[RepairedFile, PageOrder]:
    source, output = ball(folder), folder / "out.ply"
    start = note_start(source)
    return repair_and_keep(source, output, "smooth"), PageOrder(start, output)


def test_the_page_is_written_and_its_stage_has_seconds(tmp_path: Path) -> None:
    done, order = repaired(tmp_path)
    seen: list[tuple[str, float]] = []
    add_html_report(done, order, tmp_path / "page.html", lambda stage, fraction: seen.append((stage, fraction)))
    assert len(Page((tmp_path / "page.html").read_text("utf-8")).all("img")) == 3
    assert done.report["warnings"] == []
    assert done.report["stages"][-1]["name"] == "html_report"
    assert done.report["stages"][-1]["seconds"] > 0
    assert seen == [("html_report", 0.0), ("html_report", 0.0), ("html_report", 0.5)]


@pytest.mark.parametrize("error", [ValueError("secret"), MemoryError(), OSError(28, "disk full")])
def test_a_page_that_can_not_be_made_is_a_warning(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, error: Exception
) -> None:
    def fail(*_: object) -> None:
        raise error

    monkeypatch.setattr(writing, "render_page", fail)
    done, order = repaired(tmp_path)
    add_html_report(done, order, tmp_path / "page.html")
    (warning,) = done.report["warnings"]
    assert warning.startswith("there is no HTML report: ")
    assert "secret" not in warning
    assert not (tmp_path / "page.html").exists()


def test_a_page_does_without_a_picture_of_the_whole(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object) -> bytes:
        raise ValueError("secret")

    monkeypatch.setattr(writing, "before_after_png", fail)
    done, order = repaired(tmp_path)
    add_html_report(done, order, tmp_path / "page.html")
    assert done.report["warnings"] == ["the HTML report has no picture of the whole: an internal error (ValueError)"]
    assert len(Page((tmp_path / "page.html").read_text("utf-8")).all("img")) == 2


def test_a_picture_that_is_drawn_already_is_taken(tmp_path: Path) -> None:
    done, order = repaired(tmp_path)
    (tmp_path / "drawn.png").write_bytes(b"drawn before")
    order = PageOrder(order.start, order.output, overview=tmp_path / "drawn.png")
    add_html_report(done, order, tmp_path / "page.html")
    assert "ZHJhd24gYmVmb3Jl" in Page((tmp_path / "page.html").read_text("utf-8")).all("img")[0].attributes["src"]


def test_pictures_are_bounded_in_number_and_in_bytes(tmp_path: Path) -> None:
    done, _ = repaired(tmp_path)
    both = draw_widest(done, 9, 1 << 30)
    widest = sorted(done.repair.chosen, key=lambda hole: -hole.diameter)
    assert list(both) == [hole.id for hole in widest]
    assert draw_widest(done, 1, 1 << 30) == {widest[0].id: both[widest[0].id]}
    assert list(draw_widest(done, 9, len(both[widest[0].id]))) == [widest[0].id]
    assert draw_widest(done, 9, 10) == {}

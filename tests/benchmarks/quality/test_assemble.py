from pathlib import Path

import pytest

from benchmarks.quality.assemble import END, assemble


@pytest.fixture
def document(tmp_path: Path) -> Path:
    path = tmp_path / "docs" / "results.md"
    path.parent.mkdir()
    path.write_text(
        f"# Results\n\n<!-- results: bench/repair -->\nold\n{END}\n\nprose\n\n<!-- results: further/repair -->\n{END}\n"
    )
    return path


def _run(folder: Path) -> Path:
    folder.mkdir()
    (folder / "repair.md").write_text("| a |\n\n![repair: plot](repair_plot.png)\n")
    (folder / "repair_plot.png").write_bytes(b"png")
    return folder


def test_results_take_the_place_of_older_ones_and_their_plots_come_along(document: Path, tmp_path: Path) -> None:
    untouched = assemble(document, {"bench": _run(tmp_path / "run")})
    text = document.read_text()
    assert untouched == ["further/repair"]
    assert "old" not in text
    assert "| a |" in text
    assert "\n\nprose\n\n" in text
    assert "![repair: plot](images/results/bench_repair_plot.png)" in text
    assert (document.parent / "images" / "results" / "bench_repair_plot.png").read_bytes() == b"png"


def test_assembling_twice_changes_nothing(document: Path, tmp_path: Path) -> None:
    runs = {"bench": _run(tmp_path / "run")}
    assemble(document, runs)
    once = document.read_text()
    assemble(document, runs)
    assert document.read_text() == once


def test_places_without_a_run_stay_as_they_are(document: Path) -> None:
    before = document.read_text()
    assert assemble(document, {}) == ["bench/repair", "further/repair"]
    assert document.read_text() == before

"""Tests `benchmarks.performance.series`, `benchmarks.performance.programs` and `benchmarks.performance.fragments`."""

import sys
from functools import partial
from pathlib import Path

import pytest

from benchmarks.performance import __main__ as command
from benchmarks.performance.fragments import write_fragment
from benchmarks.performance.processes import Cost
from benchmarks.performance.programs import FLOOR, MESHLIB, Program, floor, ours
from benchmarks.performance.scans import dome
from benchmarks.performance.series import Case, Row, Series, all_series, measure_series, median
from tests.waiting import GUARD_S

TINY = Series("triangles", "tiny", "scan", "triangles", [Case(f"{n}", n, partial(dome, n, 1, 0.3)) for n in (300, 800)])


def test_a_scan_goes_through_floor_and_repair_as_whole_processes(tmp_path: Path) -> None:
    first, second = measure_series(TINY, [floor(), ours("smooth")], 1, GUARD_S, tmp_path)
    for row in (first, second):
        copied, repaired = row.costs[FLOOR], row.costs["smooth"]
        assert isinstance(copied, Cost)
        assert isinstance(repaired, Cost)
        assert 0 < copied.peak_mb < repaired.peak_mb
    assert first.n_triangles < second.n_triangles
    assert list(tmp_path.iterdir()) == []


def test_a_program_that_fails_is_not_run_on_larger_scans(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    failing = Program("self", lambda source, output: [sys.executable, "-S", "-c", "raise SystemExit('too large')"])
    rows = list(measure_series(TINY, [failing, floor()], 2, GUARD_S, tmp_path))
    assert [row.costs["self"] for row in rows] == ["too large", "too large"]
    assert all(isinstance(row.costs[FLOOR], Cost) for row in rows)
    assert capsys.readouterr().err.count("too large") == 1


def test_the_median_is_that_of_each_figure() -> None:
    assert median([Cost(1, 9, 5), Cost(2, 7, 4), Cost(3, 8, 6)]) == Cost(2, 8, 5)


def test_tables_have_ratios_to_meshlib_and_the_plot_comes_along(tmp_path: Path) -> None:
    costs: list[dict[str, Cost | str]] = [
        {FLOOR: Cost(0.1, 0.1, 20), "smooth": Cost(3, 2, 100), MESHLIB: Cost(2, 2, 400)},
        {FLOOR: Cost(0.2, 0.2, 40), "smooth": Cost(6, 4, 300), MESHLIB: "over 1800 s"},
    ]
    rows = [Row(case, 100, cost) for case, cost in zip(TINY.cases, costs, strict=True)]
    seconds, _, memory = write_fragment(TINY, rows, tmp_path)
    assert list(seconds.columns) == ["scan", "triangles", FLOOR, "smooth", MESHLIB, "smooth / MeshLib"]
    assert [row[-1] for row in seconds.rows] == ["1.50", "–"]
    assert memory.rows[0][-1] == "0.25"
    assert memory.rows[1][-2] == "–"
    assert "![seconds and memory by triangles](triangles.png)" in (tmp_path / "triangles.md").read_text()
    assert (tmp_path / "triangles.png").read_bytes().startswith(b"\x89PNG")


def test_without_peers_there_are_no_ratios(tmp_path: Path) -> None:
    rows = [Row(TINY.cases[0], 100, {FLOOR: Cost(0.1, 0.1, 20), "smooth": Cost(3, 2, 100)})]
    table, *_ = write_fragment(TINY, rows, tmp_path)
    assert list(table.columns) == ["scan", "triangles", FLOOR, "smooth"]


def test_a_quick_run_prints_tables_and_leaves_the_document_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    arguments = ["performance", "--quick", "--series", "holes", "--model", "smooth", "--output", str(tmp_path / "out")]
    monkeypatch.setattr(sys, "argv", [*arguments, "--document", str(tmp_path / "no such page.md")])
    command.main()
    output = capsys.readouterr()
    assert "CPU seconds" in output.out
    assert "MeshLib" not in output.out
    assert "left out" in output.err
    assert "cores" in (tmp_path / "out" / "machine.md").read_text()


def test_the_document_has_a_place_for_every_series() -> None:
    names = ["machine", *(series.name for series in all_series())]
    text = command.DOCUMENT.read_text("utf-8")
    assert [name for name in names if f"<!-- results: performance/{name} -->" not in text] == []

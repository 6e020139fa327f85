from pathlib import Path

import pytest
from PIL import Image

from benchmarks.quality.failures import failures_experiment
from benchmarks.quality.measurement import measure
from benchmarks.quality.outcome import Progress
from benchmarks.quality.paper_dictionaries import Learner
from benchmarks.quality.paper_experiments import Paper
from benchmarks.quality.results import Results
from benchmarks.quality.sheets import TILE
from tests.benchmarks.quality.small_bench import SHAPES, small_bench

pytestmark = pytest.mark.slow


@pytest.fixture
def paper(tmp_path: Path) -> Paper:
    bench, results = small_bench(tmp_path / "bench"), Results(tmp_path / "results")
    return Paper(bench, results, Learner(bench, results, tmp_path / "models"), Progress(2))


def test_the_worst_hole_of_each_mesh_is_tabled_and_drawn(paper: Paper, tmp_path: Path) -> None:
    every = paper.bench.shapes()
    cases = [paper.bench.case(shape, "0.1", tmp_path / "out") for shape in every]
    outcome = failures_experiment(paper, cases, every)
    (table,) = outcome.tables
    assert [row[0] for row in table.rows] == list(SHAPES)
    for case, found, row in zip(cases, outcome.data["worst"], table.rows, strict=True):
        method = paper.learner.local(case.shape, paper.learner.scale(every, "0.1"))
        assert method is not None
        (hole,) = measure(paper.bench, case, method, paper.results)["per_hole"]
        assert found["hole"] == hole
        assert row[1:4] == ["1", *2 * [f"{1e3 * hole['true_error']:.1f}"]]
        assert row[4] == hole["verdict"]
    sheet = outcome.plots["worst_holes"]
    assert isinstance(sheet, Image.Image)
    assert sheet.width > 3 * TILE
    assert 2 * TILE < sheet.height < 3 * TILE


def test_a_mesh_with_too_few_patches_has_no_figures_and_no_picture(paper: Paper, tmp_path: Path) -> None:
    hills = paper.bench.shapes()[0]
    plate = paper.bench.read(hills.truth)
    paper.bench.write(hills.truth, type(plate)(0.3 * plate.vertices, plate.triangles))
    outcome = failures_experiment(paper, [paper.bench.case(hills, "0.1", tmp_path / "out")], [hills])
    assert outcome.tables[0].rows == [[SHAPES[0], *["–"] * 5]]
    assert not outcome.plots

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from benchmarks.quality.bench import Bench, Shape
from benchmarks.quality.outcome import Outcome, Progress
from benchmarks.quality.paper_dictionaries import Learner
from benchmarks.quality.paper_experiments import FAIR, MESHLAB, Paper
from benchmarks.quality.results import Results
from benchmarks.quality.sheets import TILE
from benchmarks.quality.transfer_experiment import N_TRANSFERS, TRANSFERRED, Halves, transfer_experiment
from quadpatch.types import TriangleMesh
from tests.benchmarks.quality.small_bench import small_bench
from tests.quadpatch.shapes import open_grid

pytestmark = pytest.mark.slow

RADIUS = "0.1"


def _relief(bench: Bench, path: Path) -> Shape:
    """Write a plate of two squares side by side, whose second half has its middle where the bench punches."""
    flat = open_grid(61, 1.5).vertices * np.array([4 / 3, 2 / 3, 1.0])
    x, y = (flat[:, :2] + np.random.default_rng(0).uniform(-0.003, 0.003, (len(flat), 2))).T
    z = 0.02 * np.sin(25 * x) * np.sin(25 * y)
    bench.write(path, TriangleMesh(np.stack([x - 0.5, y, z], axis=1), open_grid(61).triangles))
    return Shape("relief", path, {})


@pytest.fixture(scope="module")
def paper(tmp_path_factory: pytest.TempPathFactory) -> Paper:
    folder = tmp_path_factory.mktemp("transfer")
    bench, results = small_bench(folder / "bench"), Results(folder / "results")
    return Paper(bench, results, Learner(bench, results, folder / "models"), Progress(N_TRANSFERS))


@pytest.fixture(scope="module")
def relief(paper: Paper) -> Shape:
    return _relief(paper.bench, paper.learner.folder.parent / "relief.ply")


@pytest.fixture(scope="module")
def outcome(paper: Paper, relief: Shape) -> Outcome:
    return transfer_experiment(paper, [relief], [relief], RADIUS, paper.learner.folder.parent / "out")


def test_the_halves_make_up_the_mesh_and_the_second_is_punched(paper: Paper, relief: Shape) -> None:
    cut = Halves.of(paper, relief, RADIUS, paper.learner.folder.parent / "out")
    whole, first, second, punched = (
        paper.bench.read(path)
        for path in (relief.truth, cut.learned_from.truth, cut.case.shape.truth, cut.case.punched)
    )
    assert len(first.triangles) + len(second.triangles) == len(whole.triangles)
    assert first.vertices[:, 0].max() < second.vertices[:, 0].min() + 0.1
    assert len(punched.triangles) < len(second.triangles)


def test_every_repair_is_measured_beside_the_closings_that_learn_nothing(outcome: Outcome) -> None:
    (row,) = outcome.data["rows"]
    errors = row["errors"]
    assert list(errors)[-2:] == [MESHLAB, FAIR]
    assert len(errors) == N_TRANSFERS + 2
    assert errors[TRANSFERRED] == errors["paper, same half"] == errors[MESHLAB] == 0.5
    # So small a mesh has fewer patches than a dictionary of ours has atoms.
    assert errors["ours, other half"] is None
    assert [cells[0] for cells in outcome.tables[0].rows] == list(errors)


def test_one_hole_is_drawn_in_four_ways(outcome: Outcome) -> None:
    sheet = outcome.plots["hole"]
    assert isinstance(sheet, Image.Image)
    assert 4 * TILE < sheet.width < 5 * TILE
    assert len(sheet.getcolors(1 << 20) or []) > 100

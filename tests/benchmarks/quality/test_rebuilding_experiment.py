from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image

from benchmarks.quality.outcome import Outcome, Progress
from benchmarks.quality.paper_dictionaries import Learner
from benchmarks.quality.paper_experiments import ATOMS, Paper
from benchmarks.quality.rebuilding_experiment import Rebuilder, rebuilding_experiment
from benchmarks.quality.results import Results
from tests.benchmarks.quality.small_bench import SHAPES, small_bench

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def rebuilder(tmp_path_factory: pytest.TempPathFactory) -> Rebuilder:
    folder = tmp_path_factory.mktemp("rebuilding")
    bench, results = small_bench(folder / "bench"), Results(folder / "results")
    learner = Learner(bench, results, folder / "models")
    paper = Paper(bench, results, learner, Progress(len(ATOMS)))
    return Rebuilder(paper, learner.scale(bench.shapes()[:1], "0.1", 1.0), folder / "rebuilt")


@pytest.fixture(scope="module")
def outcome(rebuilder: Rebuilder) -> Outcome:
    return rebuilding_experiment(rebuilder, rebuilder.paper.bench.shapes()[:1])


def test_more_atoms_rebuild_a_mesh_closer_to_the_true_surface(outcome: Outcome) -> None:
    errors = outcome.data["errors"][SHAPES[0]]
    assert len(errors) == len(ATOMS)
    assert errors[0] > 1.2 * errors[1] > 1.2 * errors[2] > 0


def test_more_atoms_than_patches_have_no_figure(outcome: Outcome) -> None:
    assert outcome.data["errors"][SHAPES[0]][-1] is None
    assert outcome.tables[0].rows[0][-1] == "–"


def test_a_rebuilt_mesh_is_as_far_from_the_true_one_as_its_figure_says(rebuilder: Rebuilder, outcome: Outcome) -> None:
    (hills, _) = rebuilder.paper.bench.shapes()
    truth = rebuilder.paper.bench.read(hills.truth)
    rebuilt = rebuilder.paper.bench.read(rebuilder.path(hills, ATOMS[0]))
    np.testing.assert_array_equal(rebuilt.triangles, truth.triangles)
    moved = np.linalg.norm(rebuilt.vertices - truth.vertices, axis=1)
    # The nearest point of the surface is no farther than where the vertex was.
    assert 0.2 * np.sqrt((moved**2).mean()) < outcome.data["errors"][SHAPES[0]][0] < 1.1 * moved.max()


def test_the_curve_the_atoms_and_the_meshes_are_drawn(outcome: Outcome) -> None:
    assert isinstance(outcome.plots["curve"], Figure)
    atoms, meshes = outcome.plots["atoms"], outcome.plots["five_and_hundred"]
    assert isinstance(atoms, Figure)
    assert sum(bool(axes.images) for axes in atoms.axes) == 100
    assert isinstance(meshes, Image.Image)
    assert len(meshes.getcolors(1 << 20) or []) > 100


def test_kept_results_are_not_made_again(rebuilder: Rebuilder, outcome: Outcome) -> None:
    (hills, _) = rebuilder.paper.bench.shapes()
    path: Path = rebuilder.path(hills, ATOMS[0])
    written = path.stat().st_mtime_ns
    assert rebuilder.error(hills, ATOMS[0]) == outcome.data["errors"][SHAPES[0]][0]
    assert path.stat().st_mtime_ns == written

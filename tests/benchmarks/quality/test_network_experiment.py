from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure

from benchmarks.quality.bench import BenchError
from benchmarks.quality.measurement import measure
from benchmarks.quality.network_experiment import Networks, find_architectures, networks_experiment
from benchmarks.quality.network_options import PROTOCOLS, Budget, NetworkOptions
from benchmarks.quality.network_tables import DICTIONARY
from benchmarks.quality.outcome import Progress
from benchmarks.quality.paper_dictionaries import Learner
from benchmarks.quality.paper_experiments import Paper
from benchmarks.quality.paper_networks import NetworkTrainer
from benchmarks.quality.results import Results
from quadpatch.errors import OptionError
from tests.benchmarks.quality.small_bench import SHAPES, small_bench
from training.architectures import ARCHITECTURES, Architecture

pytestmark = pytest.mark.slow

BUDGET = Budget(None, 2)
SMALL = ARCHITECTURES["small_4x"]
# The same network by another name, so that there are two to compare.
COPY = Architecture("copy", SMALL.resolution, SMALL.recipe, SMALL.channels, SMALL.build, SMALL.output)


@pytest.fixture(scope="module")
def networks(tmp_path_factory: pytest.TempPathFactory) -> Networks:
    folder = tmp_path_factory.mktemp("networks")
    bench, results = small_bench(folder / "bench"), Results(folder / "results")
    paper = Paper(bench, results, Learner(bench, results, folder / "models"), Progress(1))
    trainer = NetworkTrainer(bench, results, folder / "networks", BUDGET)
    return Networks(paper, trainer, bench.shapes(), [SMALL])


def test_every_protocol_learns_from_its_own_meshes_and_gives_three_tables_and_a_picture(
    networks: Networks, tmp_path: Path
) -> None:
    cases = [networks.paper.bench.case(networks.all_shapes[0], "0.1", tmp_path)]
    outcome = networks_experiment(networks, cases, NetworkOptions(protocols=PROTOCOLS, budget=BUDGET), is_drawing=True)
    assert [sum(name in table.title for table in outcome.tables) for name in PROTOCOLS] == [3, 3, 3]
    assert set(outcome.plots) == {f"patches_{name}" for name in PROTOCOLS}
    rows = outcome.data["rows"]
    assert [(row["protocol"], row["mesh"]) for row in rows] == [(name, SHAPES[0]) for name in PROTOCOLS]
    assert all(
        row["errors"] == {"small_4x": 0.5, DICTIONARY: 0.5, "meshlab_refine": None, "fair": 0.25} for row in rows
    )
    of_one, of_all, of_others = (row["networks"]["small_4x"]["n_patches"] for row in rows)
    assert of_all == of_one + of_others
    assert rows[0]["networks"]["small_4x"]["n_completed"] > 0


def test_several_networks_are_drawn_over_their_parameters(networks: Networks, tmp_path: Path) -> None:
    two = replace(networks, architectures=[SMALL, COPY])
    cases = [networks.paper.bench.case(networks.all_shapes[0], "0.1", tmp_path)]
    outcome = networks_experiment(two, cases, NetworkOptions(budget=BUDGET), is_drawing=False)
    plot = outcome.plots["parameters_local_0.1"]
    assert isinstance(plot, Figure)
    (axes,) = plot.axes
    assert [np.asarray(line.get_xydata()).tolist() for line in axes.lines[:2]] == [[[65_345, 2.0]]] * 2
    assert [text.get_text() for text in axes.texts] == ["small_4x", "copy"]


def test_a_network_repairs_by_the_recipe_of_the_paper(networks: Networks, tmp_path: Path) -> None:
    case = networks.paper.bench.case(networks.all_shapes[0], "0.1", tmp_path)
    trained = networks.trained("local", case)
    found = measure(networks.paper.bench, case, trained["small_4x"].method, networks.paper.results)
    assert "inpaint" in found["stages"]
    assert "smooth" in found["stages"]
    assert found["per_hole"][0]["confidence"] is None


def test_only_the_papers_networks_are_compared() -> None:
    assert [found.name for found in find_architectures(["long_12x", "small_4x", "long_12x"])] == [
        "long_12x",
        "small_4x",
    ]
    with pytest.raises(BenchError, match="residual is none of the paper's networks"):
        find_architectures(["residual"])
    with pytest.raises(OptionError, match="no network is called 'huge'"):
        find_architectures(["huge"])

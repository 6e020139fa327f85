from dataclasses import replace
from pathlib import Path

import pytest

from benchmarks.quality.network_experiment import Networks
from benchmarks.quality.network_options import Budget, Order
from benchmarks.quality.network_order import network_order_experiment
from benchmarks.quality.outcome import Progress
from benchmarks.quality.paper_dictionaries import Learner
from benchmarks.quality.paper_experiments import Paper
from benchmarks.quality.paper_networks import NetworkTrainer
from benchmarks.quality.results import Results
from tests.benchmarks.quality.small_bench import SHAPES, small_bench
from training.architectures import ARCHITECTURES, Architecture

pytestmark = pytest.mark.slow

SMALL = ARCHITECTURES["small_4x"]
# The same network by another name, so that there are two to rank.
COPY = Architecture("copy", SMALL.resolution, SMALL.recipe, SMALL.channels, SMALL.build, SMALL.output)
ORDER = Order(steps=10, batch=8, rates=(1e-6, 3e-3), seeds=(0, 1))


def test_networks_are_ranked_by_equal_terms_with_a_rate_of_their_own(tmp_path: Path) -> None:
    bench, results = small_bench(tmp_path / "bench"), Results(tmp_path / "results")
    paper = Paper(bench, results, Learner(bench, results, tmp_path / "models"), Progress(1))
    trainer = NetworkTrainer(bench, results, tmp_path / "networks", Budget())
    networks = Networks(paper, trainer, bench.shapes(), [SMALL, COPY])
    case = bench.case(networks.all_shapes[0], "0.1", tmp_path)
    (table,) = network_order_experiment(networks, [case], ORDER).tables
    assert SHAPES[0] in table.title
    assert "10 steps of 8 patches" in table.title
    assert [row[0] for row in table.rows] == ["small_4x", "copy"]
    for row in table.rows:
        assert row[1] == "0.003"
        assert row[2] != row[3]
    one, other = (dict(zip(table.columns[2:], row[2:], strict=True)) for row in table.rows)
    assert one == other
    rows = network_order_experiment(replace(networks, architectures=[SMALL]), [case], ORDER).data["rows"]
    assert [len(entry["ratios"]) for entry in rows[0]["networks"]] == [2]

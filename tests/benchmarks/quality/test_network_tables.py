from pathlib import Path

import pytest

from benchmarks.quality.bench import Case, Shape
from benchmarks.quality.network_tables import DICTIONARY, Finding, mean_to_fair, network_tables
from benchmarks.quality.tables import NOTHING

FACTS = {
    "resolution": 24,
    "n_parameters": 65_345,
    "n_patches": 100,
    "steps": 40,
    "validation_loss": 0.005,
    "train_s": 60.0,
    "train_cpu_s": 30.0,
    "complete_s": 2.0,
    "n_completed": 1000,
}


def finding(mesh: str, network: float | None, dictionary: float, fair: float) -> Finding:
    case = Case(Shape(mesh, Path(), {}), "0.025", Path())
    errors = {"small_4x": network, DICTIONARY: dictionary, "meshlab_refine": 2 * fair, "fair": fair}
    return Finding(case, errors, {} if network is None else {"small_4x": FACTS})


FOUND = [finding("igea", 0.002, 0.004, 0.001), finding("relief", 0.008, 0.004, 0.001)]


def test_ratios_are_to_fair_and_means_to_the_dictionary_as_well() -> None:
    ratios = network_tables("local", FOUND)[0]
    assert "training and test share the mesh" in ratios.title
    assert [list(row) for row in ratios.rows] == [
        ["igea", "2.000", "4.000", "2.000"],
        ["relief", "8.000", "4.000", "2.000"],
        ["geometric mean", "4.000", "4.000", "2.000"],
        ["to the dictionary", "1.000", "1.000", "0.500"],
    ]
    assert mean_to_fair(FOUND, "small_4x") == pytest.approx(4.0)


def test_errors_are_in_millionths_with_those_of_fair() -> None:
    errors = network_tables("global", FOUND)[1]
    assert list(errors.columns) == ["mesh", "small_4x", DICTIONARY, "meshlab_refine", "fair"]
    assert list(errors.rows[0]) == ["igea", "2000", "4000", "2000", "1000"]


def test_costs_are_means_over_the_meshes() -> None:
    costs = network_tables("leave-one-out", FOUND)[2]
    (row,) = costs.rows
    assert list(row) == ["small_4x", "24 x 24", "65,345", "100", "40", "0.00500", "60", "30", "2", "2.0"]


def test_a_network_that_could_not_be_trained_leaves_dashes_and_no_mean() -> None:
    found = [finding("igea", None, 0.004, 0.001)]
    ratios, errors, costs = network_tables("local", found)
    assert ratios.rows[0][1] == ratios.rows[1][1] == errors.rows[0][1] == NOTHING
    assert list(costs.rows[0]) == ["small_4x", *[NOTHING] * 9]
    assert mean_to_fair(found, "small_4x") is None

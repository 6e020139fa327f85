from pathlib import Path

import pytest

from benchmarks.quality.bench import Bench, BenchError, Shape, named
from benchmarks.quality.measurement import Method
from tests.benchmarks.quality.small_bench import SHAPES, small_bench


def test_a_folder_without_the_script_is_no_bench(tmp_path: Path) -> None:
    with pytest.raises(BenchError, match=r"there is no .*bench\.py"):
        Bench.open(tmp_path)


def test_shapes_come_by_name_with_the_figures_of_their_peers(tmp_path: Path) -> None:
    shapes = small_bench(tmp_path / "bench").shapes()
    assert tuple(shape.name for shape in shapes) == SHAPES
    assert shapes[0].peers["0.1"]["fair"]["error"] == 0.25


def test_names_choose_shapes_and_none_means_all(tmp_path: Path) -> None:
    shapes = small_bench(tmp_path / "bench").shapes()
    assert named(shapes, []) == shapes
    assert named(shapes, [SHAPES[1], SHAPES[1]]) == [shapes[1]]
    with pytest.raises(BenchError, match="no mesh 'igea'; there are hills, valleys"):
        named(shapes, ["igea"])


def test_a_shape_is_punched_once_unless_its_truth_changes(tmp_path: Path) -> None:
    bench = small_bench(tmp_path / "bench")
    hills, valleys = bench.shapes()
    case = bench.case(hills, "0.1", tmp_path / "out")
    assert case.peers["fair"]["error"] == 0.25
    case.punched.unlink()
    case = bench.case(hills, "0.1", tmp_path / "out")
    first = case.punched.stat().st_mtime_ns
    assert bench.case(hills, "0.1", tmp_path / "out").punched.stat().st_mtime_ns == first
    other = bench.case(Shape("hills", valleys.truth, {}), "0.1", tmp_path / "out")
    assert other.punched.stat().st_mtime_ns > first
    assert other.peers == {}


def test_a_network_that_is_fitted_is_known_by_the_one_it_starts_from() -> None:
    fitted, base = Method.of("self-network").key(), Method.of("general-residual").key()
    assert Method.of("auto").key()["model_sha256"] == base["model_sha256"]
    best = Method.of("best")
    assert (best.name, best.model, best.options) == ("best", "auto", {"effort": "best"})
    assert best.key()["model_sha256"] == base["model_sha256"]
    assert fitted == {**base, "method": "self-network"}

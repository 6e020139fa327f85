"""Networks that the service is asked for; also tests `training.held_out`."""

import json
from functools import partial
from pathlib import Path

import pytest

from benchmarks.quality.bench import Bench, Shape
from benchmarks.quality.measurement import Method, measure
from benchmarks.quality.results import Results
from jobkit.models.network_header import read_network_card
from quadpatch.errors import OptionError
from quadpatch.model_choice import SMOOTH
from quadpatch.types import TriangleMesh
from tests.quadpatch.shapes import bumpy_plate, write_ply
from tests.training.walls import wall
from training.requested_network import NetworkTrainingOptions, train_network
from training.sources import Source

SHARED_BENCH = Path(__file__).resolve().parents[3] / "shared" / "bench"


def source(folder: Path, name: str, mesh: TriangleMesh) -> Source:
    return Source(name, write_ply(folder / f"{name}.ply", mesh), name * 4)


def _note(stages: list[str], stage: str, _: float) -> None:
    stages.append(stage)


def test_a_tiny_network_is_fitted_with_its_card_and_repeats_bit_for_bit(tmp_path: Path) -> None:
    meshes = [source(tmp_path, f"wall{i}", wall(i, n=50)) for i in range(2)]
    options = NetworkTrainingOptions("tiny", steps=2, held_out=0.5)
    reports, files = [], []
    for name in ("first", "second"):
        (tmp_path / name).mkdir()
        stages: list[str] = []
        output = tmp_path / name / "learned.onnx"
        reports.append(train_network(meshes, output, options, partial(_note, stages)))
        files.append(output.read_bytes())
    assert files[0] == files[1]
    assert list(dict.fromkeys(stages)) == ["read", "learn", "judge", "write"]
    report = reports[0]
    assert (report["kind"], len(report["learning_errors"])) == ("network", 2)
    assert report["patches"] > 0
    (judged,) = report["judged"]
    assert sorted([judged["mesh_id"], *report["learned_from"]]) == ["wall0", "wall1"]
    card = read_network_card(tmp_path / "first" / "learned.onnx")
    assert card is not None
    assert (card["kind"], card["name"], card["architecture"]) == ("autoencoder", "tiny", "residual")
    assert (card["started_from"], card["verdict"]) == ("general-residual", report["verdict"])
    assert [entry["name"] for entry in card["training_corpus"]] == report["learned_from"]


def test_meshes_without_room_for_holes_say_so(tmp_path: Path) -> None:
    options = NetworkTrainingOptions("none", steps=1)
    with pytest.raises(OptionError, match="no room for holes to learn a network from"):
        train_network([source(tmp_path, "small", bumpy_plate(8, 1.0))], tmp_path / "learned.onnx", options)


@pytest.mark.slow
def test_the_verdict_on_a_network_agrees_with_the_quality_benchmark(tmp_path: Path) -> None:
    """Its script punches and scores: other holes than the training's own, in the same mesh."""
    if not (SHARED_BENCH / "bench.py").is_file():
        pytest.skip("the script of the benchmark is not beside the repository")
    bench = Bench.open(SHARED_BENCH)
    for period, steps, is_better in ((12.0, 200, True), (60.0, 2, False)):
        folder = tmp_path / str(period)
        folder.mkdir()
        meshes = []
        # The first one is held out: it has room for calibration holes beside all those of the script.
        for i, n in enumerate((140, 100)):
            mesh = wall(i, n, period)
            bench.write(folder / f"wall{i}.ply", TriangleMesh(mesh.vertices / 100.0, mesh.triangles))
            meshes.append(Source(f"wall{i}", folder / f"wall{i}.ply", str(i)))
        model = folder / "learned.onnx"
        report = train_network(meshes, model, NetworkTrainingOptions("walls", steps=steps, held_out=0.5))
        (judged,) = report["judged"]
        case = bench.case(Shape(judged["mesh_id"], folder / f"{judged['mesh_id']}.ply", {}), "0.045", folder / "cases")
        results = Results(folder / "results", (), "0")
        errors = {name: measure(bench, case, Method.of(name), results)["error"] for name in (SMOOTH, str(model))}
        assert report["is_better"] is is_better
        assert (errors[str(model)] < 0.99 * errors[SMOOTH]) is is_better, json.dumps(errors)

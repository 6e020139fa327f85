import json
from pathlib import Path

import pytest

from benchmarks.quality.bench import Bench, Shape
from benchmarks.quality.measurement import Method, measure
from benchmarks.quality.results import Results
from quadpatch.errors import OptionError, StageError
from quadpatch.inpainters.model_file import model_card
from quadpatch.model_choice import SMOOTH
from quadpatch.types import TriangleMesh
from tests.quadpatch.shapes import bumpy_plate, write_ply
from tests.training.walls import wall
from training.held_out import MOST_JUDGED
from training.requested import TrainingOptions, train_dictionary
from training.sources import Source

SHARED_BENCH = Path(__file__).resolve().parents[3] / "shared" / "bench"
SMALL = TrainingOptions("small", atoms=8, patch_resolution=8, steps=1, held_out=0.5)


def source(folder: Path, name: str, mesh: TriangleMesh) -> Source:
    return Source(name, write_ply(folder / f"{name}.ply", mesh), name * 4)


def test_the_card_says_what_was_learned_from_and_what_the_judgement_is(tmp_path: Path) -> None:
    meshes = [source(tmp_path, f"plate{i}", bumpy_plate(60, 1.0, i)) for i in range(3)]
    stages: list[str] = []
    output = tmp_path / "learned.safetensors"
    report = train_dictionary(meshes, output, SMALL, lambda stage, _: stages.append(stage))
    assert list(dict.fromkeys(stages)) == ["read", "learn", "judge", "write"]
    judged = [mesh["mesh_id"] for mesh in report["judged"]]
    assert len(judged) == 2
    assert sorted([*judged, *report["learned_from"]]) == ["plate0", "plate1", "plate2"]
    card = model_card(output)
    assert [entry["name"] for entry in card["training_corpus"]] == report["learned_from"]
    assert [entry["name"] for entry in card["held_out"]] == judged
    assert (card["verdict"], card["judged"]) == (report["verdict"], report["judged"])
    assert card["metrics"]["meshes_judged"] == len(judged)
    assert (card["n_atoms"], card["patch_resolution"]) == (8, 8)


def test_a_training_repeats_bit_for_bit(tmp_path: Path) -> None:
    meshes = [source(tmp_path, f"plate{i}", bumpy_plate(50, 1.0, i)) for i in range(2)]
    for name in ("first", "second"):
        (tmp_path / name).mkdir()
        train_dictionary(meshes, tmp_path / name / "learned.safetensors", SMALL)
    first, second = ((tmp_path / name / "learned.safetensors").read_bytes() for name in ("first", "second"))
    assert first == second


def test_of_a_single_mesh_holes_are_kept_from_learning(tmp_path: Path) -> None:
    report = train_dictionary([source(tmp_path, "only", bumpy_plate(80, 1.0))], tmp_path / "learned.safetensors", SMALL)
    ((only, kept),) = [(mesh["mesh_id"], mesh["kept"]) for mesh in report["judged"]]
    assert (only, kept, report["learned_from"]) == ("only", "holes", ["only"])


def test_what_cannot_be_read_is_left_out_with_its_code(tmp_path: Path) -> None:
    broken = tmp_path / "broken.ply"
    broken.write_bytes(b"ply")
    meshes = [source(tmp_path, "good", bumpy_plate(60, 1.0)), Source("broken", broken, "0")]
    report = train_dictionary(meshes, tmp_path / "learned.safetensors", SMALL)
    assert any(text.startswith("mesh broken is left out (unreadable_mesh)") for text in report["warnings"])
    assert report["learned_from"] == ["good"]
    with pytest.raises(StageError, match="none of the meshes can be read"):
        train_dictionary(meshes[1:], tmp_path / "learned.safetensors", SMALL)


def test_a_training_without_enough_patches_says_so(tmp_path: Path) -> None:
    few = TrainingOptions("few", atoms=1024, patch_resolution=8, steps=1)
    with pytest.raises(OptionError, match="1024 atoms need at least as many"):
        train_dictionary([source(tmp_path, "small", bumpy_plate(20, 1.0))], tmp_path / "learned.safetensors", few)


@pytest.mark.parametrize("n_meshes", [1, 10, 200])
def test_the_patches_of_many_meshes_stay_within_a_bound(n_meshes: int) -> None:
    options = TrainingOptions("many", patch_resolution=32).learning(n_meshes)
    places = options.recipe.max_seeds * n_meshes
    assert places * len(options.recipe.scales) * 32**2 <= 7_000_000
    assert options.recipe.max_seeds >= 1
    assert MOST_JUDGED < 10


@pytest.mark.slow
def test_the_verdict_agrees_with_the_quality_benchmark(tmp_path: Path) -> None:
    """Its script punches and scores: other holes than the training's own, in the same mesh."""
    if not (SHARED_BENCH / "bench.py").is_file():
        pytest.skip("the script of the benchmark is not beside the repository")
    bench = Bench.open(SHARED_BENCH)
    options = TrainingOptions("walls", atoms=64, patch_resolution=24, steps=5, held_out=0.5)
    for period, is_better in ((12.0, True), (60.0, False)):
        folder = tmp_path / str(period)
        folder.mkdir()
        meshes = []
        for i in range(2):
            mesh = wall(i, period=period)
            scaled = TriangleMesh(mesh.vertices / 100.0, mesh.triangles)
            bench.write(folder / f"wall{i}.ply", scaled)
            meshes.append(Source(f"wall{i}", folder / f"wall{i}.ply", str(i)))
        model = folder / "learned.safetensors"
        report = train_dictionary(meshes, model, options)
        (judged,) = report["judged"]
        held_out = Shape(judged["mesh_id"], folder / f"{judged['mesh_id']}.ply", {})
        case = bench.case(held_out, "0.045", folder / "cases")
        results = Results(folder / "results", (), "0")
        errors = {name: measure(bench, case, Method.of(name), results)["error"] for name in (SMOOTH, str(model))}
        assert report["is_better"] is is_better
        assert (errors[str(model)] < 0.99 * errors[SMOOTH]) is is_better, json.dumps(errors)

from pathlib import Path

import pytest

from benchmarks.quality.paper_dictionaries import Learner
from benchmarks.quality.results import Results
from quadpatch.inpainters.model_file import load_model
from quadpatch.options import RepairOptions
from tests.benchmarks.quality.small_bench import small_bench


@pytest.fixture
def learner(tmp_path: Path) -> Learner:
    return Learner(small_bench(tmp_path / "bench"), Results(tmp_path / "results"), tmp_path / "models")


def test_the_patch_length_keeps_the_ratio_of_hole_to_patch_that_is_asked_for(learner: Learner) -> None:
    assert learner.scale(learner.bench.shapes(), "0.1", 0.5).length == pytest.approx(2 * 0.1 / 0.5)


def test_a_local_dictionary_is_learned_once_for_the_papers_recipe_and_fits_the_repair(learner: Learner) -> None:
    (hills, _) = learner.bench.shapes()
    scale = learner.scale([hills], "0.1", 0.8)
    method = learner.local(hills, scale, 12)
    assert method is not None
    model = load_model(method.model)
    assert model.recipe == "paper"
    assert model.dictionary is not None
    assert (model.dictionary.n_atoms, model.dictionary.resolution) == (12, scale.resolution)
    assert RepairOptions.from_dict(method.options).patches.length == scale.length
    written = Path(method.model).stat().st_mtime_ns
    assert learner.local(hills, scale, 12) == method
    assert Path(method.model).stat().st_mtime_ns == written


def test_more_atoms_code_the_mesh_that_they_were_learned_from_better(learner: Learner) -> None:
    (hills, _) = learner.bench.shapes()
    scale = learner.scale([hills], "0.1", 0.8)
    errors = []
    for n_atoms in (2, 8, 24):
        method = learner.local(hills, scale, n_atoms)
        assert method is not None
        errors.append(learner.coding_error(hills, scale, method))
    assert errors[0] > 1.5 * errors[1] > 2 * errors[2] > 0


def test_the_same_name_for_other_shapes_is_another_dictionary(learner: Learner) -> None:
    hills, valleys = learner.bench.shapes()
    scale = learner.scale([hills, valleys], "0.1", 0.8)
    one, both = learner.many("some", [hills], scale, 12), learner.many("some", [hills, valleys], scale, 12)
    assert one is not None
    assert both is not None
    assert one.key()["model_sha256"] != both.key()["model_sha256"]


def test_a_mesh_without_room_for_patches_gives_no_dictionary(learner: Learner) -> None:
    (hills, _) = learner.bench.shapes()
    assert learner.local(hills, learner.scale([hills], "0.1", 0.02)) is None

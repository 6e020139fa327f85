from pathlib import Path

import numpy as np
import pytest
import torch

from benchmarks.quality.bench import Shape
from benchmarks.quality.network_options import Budget
from benchmarks.quality.paper_networks import HELD_OUT_EVERY, NetworkTrainer, TrainedNetwork, held_out_rows
from benchmarks.quality.results import NETWORKS, Results
from quadpatch.inpainters.onnx_network import AutoencoderInpainter
from quadpatch.options import RepairOptions
from quadpatch.patches.scale import PatchScale
from tests.benchmarks.quality.small_bench import small_bench
from training.architectures import find_architecture

pytestmark = pytest.mark.slow

SCALE = PatchScale(0.25, 24, 1)
SMALL = find_architecture("small_4x")
SHORT = Budget(None, 4)


@pytest.fixture(scope="module")
def trainer(tmp_path_factory: pytest.TempPathFactory) -> NetworkTrainer:
    folder = tmp_path_factory.mktemp("networks")
    return NetworkTrainer(small_bench(folder / "bench"), Results(folder / "results"), folder / "networks", SHORT)


def with_budget(trainer: NetworkTrainer, budget: Budget) -> NetworkTrainer:
    return NetworkTrainer(trainer.bench, trainer.results, trainer.folder, budget)


def train(trainer: NetworkTrainer, *shapes: Shape, scale: PatchScale = SCALE) -> TrainedNetwork | None:
    return trainer.train("some", shapes, scale, SMALL)


def test_a_network_is_trained_once_and_fits_the_repair(trainer: NetworkTrainer) -> None:
    (hills, _) = trainer.bench.shapes()
    network = train(trainer, hills)
    assert network is not None
    assert (network.facts["steps"], network.facts["n_parameters"]) == (4, 65_345)
    loaded = AutoencoderInpainter.load(Path(network.method.model))
    assert (loaded.recipe, loaded.resolution) == ("paper", 24)
    assert loaded.card["use"] == "measuring only, not for publication"
    options = RepairOptions.from_dict(network.method.options)
    assert (options.recipe, options.patches.length, options.patches.overlap) == ("paper", 0.25, 1)
    written = Path(network.method.model).stat().st_mtime_ns
    assert train(trainer, hills) == network
    assert Path(network.method.model).stat().st_mtime_ns == written


def test_other_meshes_are_another_network(trainer: NetworkTrainer) -> None:
    hills, valleys = trainer.bench.shapes()
    networks = [train(trainer, hills), train(trainer, hills, valleys)]
    assert len({network.method.key()["model_sha256"] for network in networks if network is not None}) == 2


def test_more_training_is_another_network_and_completes_patches_better(trainer: NetworkTrainer) -> None:
    (hills, _) = trainer.bench.shapes()
    short, long = train(trainer, hills), train(with_budget(trainer, Budget(None, 120)), hills)
    assert short is not None
    assert long is not None
    assert short.method.model != long.method.model
    assert 0 < long.facts["validation_loss"] < 0.5 * short.facts["validation_loss"]


def test_the_same_steps_give_the_same_file(trainer: NetworkTrainer, tmp_path: Path) -> None:
    (hills, _) = trainer.bench.shapes()
    elsewhere = NetworkTrainer(trainer.bench, Results(tmp_path / "results"), tmp_path / "networks", SHORT)
    one, two = train(trainer, hills), train(elsewhere, hills)
    assert one is not None
    assert two is not None
    assert Path(one.method.model).read_bytes() == Path(two.method.model).read_bytes()


def test_of_every_mesh_some_patches_are_held_out_and_of_few_bins_none_is_learned(trainer: NetworkTrainer) -> None:
    (hills, _) = trainer.bench.shapes()
    network = train(trainer, hills)
    assert network is not None
    known = trainer.patches(hills, SCALE)["known"]
    usable = known.mean(axis=(1, 2)) >= 0.7
    usable[held_out_rows(len(usable))] = False
    assert network.facts["n_patches"] == usable.sum()
    assert len(held_out_rows(100)) == 100 / HELD_OUT_EVERY


def test_patches_are_the_same_places_in_any_resolution(trainer: NetworkTrainer) -> None:
    (hills, _) = trainer.bench.shapes()
    coarse, fine = (trainer.patches(hills, PatchScale(0.25, n, 1)) for n in (24, 48))
    halved = fine["heights"].reshape(-1, 24, 2, 24, 2).mean(axis=(2, 4))
    known = fine["known"].reshape(-1, 24, 2, 24, 2).all(axis=(2, 4)) & coarse["known"]
    assert known.mean() > 0.3
    # Bins hold the means of points that are drawn anew for each resolution.
    assert np.abs(halved - coarse["heights"])[known].mean() < 0.02 * np.ptp(coarse["heights"][known])


def test_a_mesh_without_room_for_patches_gives_no_network(trainer: NetworkTrainer) -> None:
    (hills, _) = trainer.bench.shapes()
    assert train(trainer, hills, scale=PatchScale(3.0, 24, 1)) is None


def test_networks_are_trained_again_only_where_that_is_asked_for_and_threads_are_given_back(
    trainer: NetworkTrainer,
) -> None:
    (hills, _) = trainer.bench.shapes()
    threads, first = torch.get_num_threads(), train(trainer, hills)
    fresh = Results(trainer.results.folder, (NETWORKS,))
    again = train(NetworkTrainer(trainer.bench, fresh, trainer.folder, SHORT), hills)
    assert first is not None
    assert again is not None
    # No two trainings take the same nanoseconds.
    assert first.facts["train_s"] != again.facts["train_s"]
    assert torch.get_num_threads() == threads

"""The network `residual`, trained by the same commands as the paper's."""

import json
from pathlib import Path

import numpy as np
import pytest
import torch
from torch import Tensor, nn

from quadpatch.inpainters.onnx_network import AutoencoderInpainter
from quadpatch.networks.residual import Residual, errors
from quadpatch.networks.weights import load_residual
from quadpatch.options import HoleOptions, RepairOptions
from quadpatch.patches.residual_input import RESOLUTION
from quadpatch.repair import repair_file
from quadpatch.types import Patches
from tests.quadpatch.shapes import punched
from tests.training.test_main import write_ply
from tests.training.test_network_run import call
from training.architectures import find_architecture
from training.errors import CorpusError
from training.procedural import relief_mesh
from training.residual_task import ResidualTask
from training.shards import Corpus, PatchSet
from training.tasks import open_task

pytestmark = pytest.mark.slow

N = RESOLUTION
CPU = torch.device("cpu")


def pair_set(n: int, seed: int) -> PatchSet:
    """Patches that say nothing, but for a number that tells each of them from the others."""
    rng = np.random.default_rng(seed)
    loss_mask = rng.random((n, N, N)) > 0.7
    known = ~loss_mask
    channels = np.stack([rng.normal(size=(n, N, N)), known], axis=1).astype(np.float16)
    correction = np.where(loss_mask, rng.normal(size=(n, N, N)), 0.0).astype(np.float16)
    return PatchSet([{"channels": channels, "correction": correction, "asked": loss_mask}])


@pytest.fixture(scope="module")
def task() -> ResidualTask:
    return ResidualTask(find_architecture("residual"), pair_set(40, 0), pair_set(20, 1), "0" * 64)


def batch_of(task: ResidualTask, seed: int, share: slice = slice(0, 8)) -> tuple[Tensor, ...]:
    return task.batch(np.random.default_rng(seed), 8, share, CPU)


def test_a_batch_is_made_of_training_pairs_turned_alike(task: ResidualTask) -> None:
    channels, correction, loss_mask = batch_of(task, 0)
    assert (channels.shape, correction.shape, loss_mask.shape) == ((8, 2, N, N), (8, 1, N, N), (8, 1, N, N))
    assert {tensor.dtype for tensor in (channels, correction, loss_mask)} == {torch.float32}
    # Whatever the turn, what is asked is not known, and what is known needs no correction.
    assert (channels[:, 1:] + loss_mask == 1).all()
    assert (correction[loss_mask == 0] == 0).all()


def test_batches_follow_from_the_generator_and_shares_of_one_make_it_up(task: ResidualTask) -> None:
    whole, same, other = batch_of(task, 1), batch_of(task, 1), batch_of(task, 2)
    assert all(torch.equal(one, another) for one, another in zip(whole, same, strict=True))
    assert not torch.equal(whole[0], other[0])
    halves = batch_of(task, 1, slice(0, 4)), batch_of(task, 1, slice(4, 8))
    assert all(torch.equal(torch.cat(parts), one) for *parts, one in zip(*halves, whole, strict=True))


def test_validation_shows_every_held_out_training_pair_once_as_it_is(task: ResidualTask) -> None:
    batches = list(task.validation(8, CPU))
    assert [len(channels) for channels, _, _ in batches] == [8, 8, 4]
    arrays = task.held_out.gather(np.arange(20))
    np.testing.assert_array_equal(torch.cat([channels for channels, _, _ in batches]).numpy(), arrays["channels"])


def test_the_loss_is_that_of_the_fill_until_something_is_learned(task: ResidualTask) -> None:
    module, batch = task.build(), batch_of(task, 3)
    assert isinstance(module, Residual)
    _, correction, loss_mask = batch
    found = task.loss(module, batch)
    assert found.item() == pytest.approx(
        errors(torch.zeros_like(correction), correction, loss_mask).relative_loss.item()
    )

    class Right(nn.Module):
        def forward(self, channels: Tensor) -> Tensor:
            return correction

    assert task.loss(Right(), batch).item() == 0


def test_its_identity_is_the_network_and_the_corpus(task: ResidualTask) -> None:
    assert task.identity() == {"architecture": "residual", "corpus_sha256": "0" * 64}


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder with two `scans`, the `corpus` of training pairs cut from them, and the network `own.onnx` of it."""
    folder = tmp_path_factory.mktemp("made")
    (folder / "scans").mkdir()
    for seed, name in enumerate(("waves", "scales")):
        write_ply(folder / "scans" / f"{name}.ply", relief_mesh(name, np.random.default_rng(seed), 50))
    corpus: list[str | Path] = [
        "--recipe",
        "residual",
        "--output",
        folder / "corpus",
        "--holdout",
        "scales",
        "--places",
        "25",
    ]
    call("corpus", folder / "scans", *corpus)
    short = ["--steps", "20", "--batch", "8", "--precision", "float32", "--device", "cpu"]
    target: list[str | Path] = ["--corpus", folder / "corpus", "--name", "own@2", "--output", folder / "own.onnx"]
    call("network", "--arch", "residual", *target, *short, "--curve", folder / "curve.json")
    return folder


def test_a_corpus_of_training_pairs_says_what_it_is_for(made: Path) -> None:
    corpus = Corpus.open(made / "corpus")
    assert (corpus.facts["recipe"], corpus.facts["resolution"]) == ("residual", N)
    assert {mesh["name"]: mesh["count"] > 20 for mesh in corpus.meshes("train")} == {"waves": True}
    assert isinstance(open_task(find_architecture("residual"), corpus), ResidualTask)
    with pytest.raises(CorpusError, match="bins cut for the recipe paper"):
        open_task(find_architecture("small_4x"), corpus)


def test_the_network_that_comes_out_is_one_that_a_repair_can_run(made: Path, tmp_path: Path) -> None:
    inpainter = AutoencoderInpainter.load(made / "own.onnx")
    assert (inpainter.recipe, inpainter.resolution) == ("residual", N)
    assert (inpainter.card["name"], inpainter.card["version"], inpainter.card["architecture"]) == ("own", 2, "residual")
    assert inpainter.card["corpus_sha256"] == Corpus.open(made / "corpus").sha256
    losses = json.loads((made / "curve.json").read_text())["validation_loss"]
    assert inpainter.card["metrics"]["validation_loss"] == pytest.approx(min(losses), abs=1e-6)

    rng = np.random.default_rng(0)
    shape = (5, N, N)
    heights, known = 0.1 * rng.normal(size=shape), rng.random(shape) > 0.3
    frames = np.tile(np.eye(3), (5, 1, 1))
    patches = Patches(np.zeros((5, 3)), frames, 1.0, heights, known, np.ones_like(known), np.zeros(shape, np.int64))
    predicted = inpainter.predict(patches, np.zeros(shape))
    assert predicted[known].tobytes() == heights[known].tobytes()
    assert (predicted[~known] != heights[~known]).mean() > 0.9

    damaged = punched(relief_mesh("waves", np.random.default_rng(7), 50), (0.0, 0.0, 0.0), radius=4.0)
    source = write_ply(tmp_path / "scan.ply", damaged)
    report = repair_file(source, tmp_path / "out.ply", made / "own.onnx", RepairOptions(HoleOptions(ids=(1,))))
    assert report["counts"]["filled"] + report["counts"]["filled_smooth"] == 1
    assert report["patches"]["resolution"] == N


def test_the_network_that_comes_out_can_be_fitted_to_a_mesh(made: Path) -> None:
    """What torch reads back from the file answers as the file does."""
    patches = pair_set(6, 5).gather(np.arange(6))["channels"].astype(np.float32)
    inpainter = AutoencoderInpainter.load(made / "own.onnx")
    (in_file,) = inpainter.session.run(None, {inpainter.session.get_inputs()[0].name: patches})
    with torch.inference_mode():
        read_back = load_residual(made / "own.onnx")(torch.from_numpy(patches)).numpy()
    np.testing.assert_allclose(read_back, in_file, atol=1e-5)

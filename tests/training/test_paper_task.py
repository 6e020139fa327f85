from pathlib import Path

import numpy as np
import pytest
import torch
from torch import Tensor, nn

from quadpatch.inpainters.onnx_network import AutoencoderInpainter
from quadpatch.types import Patches
from tests.training.patches import SCALE, small_task, write_corpus
from training.architectures import ARCHITECTURES
from training.errors import CorpusError
from training.export import to_onnx, write_network
from training.paper_task import entropy, paper_scale, spread_rows
from training.shards import PatchSet
from training.tasks import open_task

CPU = torch.device("cpu")


class Answer(nn.Module):
    """Gives the same logits whatever it is asked."""

    def __init__(self, logits: Tensor) -> None:
        super().__init__()
        self.logits = logits

    def forward(self, patches: Tensor) -> Tensor:
        return self.logits


def test_batches_follow_from_the_generator_alone() -> None:
    task = small_task()
    one, two, other = (task.batch(np.random.default_rng([0, step]), 8, slice(0, 8), CPU) for step in (5, 5, 6))
    assert all(torch.equal(a, b) for a, b in zip(one, two, strict=True))
    assert not torch.equal(one[0], other[0])


def test_shares_of_a_batch_are_the_batch() -> None:
    task = small_task()
    whole = task.batch(np.random.default_rng(3), 12, slice(0, 12), CPU)
    parts = [task.batch(np.random.default_rng(3), 12, slice(start, start + 4), CPU) for start in (0, 4, 8)]
    for one, joined in zip(whole, (torch.cat(p) for p in zip(*parts, strict=True)), strict=True):
        assert torch.equal(one, joined)


def test_holes_and_what_was_never_measured_look_the_same_but_only_the_former_is_learned() -> None:
    inputs, clean, known = small_task().batch(np.random.default_rng(0), 64, slice(0, 64), CPU)
    visible = inputs < 1.0
    assert 0.0 <= float(clean.min()) < float(clean.max()) <= np.float32(SCALE.scaled_high)
    assert torch.equal(inputs[visible], clean[visible])
    # The corner of 3 x 3 bins that no scan saw, in one of its four places.
    assert torch.equal((~known).sum(dim=(1, 2, 3)), torch.full((64,), 9))
    assert not (visible & ~known).any()
    assert 0.05 < float((known & ~visible).double().mean()) < 0.4


@pytest.mark.slow
def test_a_batch_is_scaled_as_a_repair_scales_its_patches(tmp_path: Path) -> None:
    """A network that copies its input, asked through the code of repairs, gives back what training calls clean."""
    task = small_task()
    inputs, clean, _ = next(task.validation(16, CPU))
    visible = (inputs < 1.0)[:, 0].numpy()
    write_network(
        tmp_path / "copy.onnx",
        to_onnx(nn.Identity(), 1, 24),
        {"patch_resolution": 24, "recipe": "paper", **task.card_facts()},
    )
    heights = task.held_out.gather(spread_rows(16, 16))["heights"].astype(np.float64)
    zeros = np.zeros((16, 3))
    patches = Patches(
        zeros, np.tile(np.eye(3), (16, 1, 1)), 1.0, heights, visible, visible, np.zeros(visible.shape, int)
    )
    predicted = AutoencoderInpainter.load(tmp_path / "copy.onnx").predict(patches, np.zeros_like(heights))
    span = (SCALE.high - SCALE.low) / SCALE.scaled_high
    expected = clean[:, 0].numpy() * span + SCALE.low
    np.testing.assert_allclose(predicted[visible], expected[visible], atol=1e-6)


def test_the_loss_is_zero_for_the_clean_patch_and_is_blind_where_nothing_was_measured() -> None:
    task = small_task()
    inputs, clean, known = next(task.validation(16, CPU))
    perfect = torch.logit(clean.double(), eps=1e-12).float()
    assert abs(float(task.loss(Answer(perfect), (inputs, clean, known)))) < 1e-6
    elsewhere = torch.where(known, perfect, perfect + 5.0)
    assert abs(float(task.loss(Answer(elsewhere), (inputs, clean, known)))) < 1e-6
    assert float(task.loss(Answer(perfect + 1.0), (inputs, clean, known))) > 0.01


def test_the_loss_is_the_cross_entropy_less_the_entropy_of_the_truth() -> None:
    task = small_task()
    batch = next(task.validation(16, CPU))
    logits = torch.randn(batch[1].shape, generator=torch.Generator().manual_seed(0))
    said, (_, clean, known) = torch.sigmoid(logits), batch
    each = -(clean * said.log() + (1 - clean) * (1 - said).log()) - entropy(clean)
    by_hand = torch.stack([bins[mask].mean() for bins, mask in zip(each, known, strict=True)]).mean()
    torch.testing.assert_close(task.loss(Answer(logits), batch), by_hand, rtol=1e-5, atol=1e-6)


def test_entropy_is_that_of_a_coin() -> None:
    values = torch.tensor([0.0, 0.5, 1.0], dtype=torch.float64)
    torch.testing.assert_close(entropy(values), torch.tensor([0.0, np.log(2.0), 0.0], dtype=torch.float64))


def test_validation_is_the_same_every_time_whatever_the_size_of_its_batches() -> None:
    task = small_task()
    whole = next(task.validation(16, CPU))
    parts = list(task.validation(5, CPU))
    assert [len(part[0]) for part in parts] == [5, 5, 5, 1]
    for one, joined in zip(whole, (torch.cat(p) for p in zip(*parts, strict=True)), strict=True):
        assert torch.equal(one, joined)


def test_the_scale_leaves_out_the_outermost_heights_and_bins_that_are_unknown() -> None:
    heights = np.linspace(-0.2, 0.3, 200 * 24 * 24, dtype=np.float32).reshape(200, 24, 24)
    heights[0, 20, 20], heights[1, 0, 0] = 50.0, 99.0
    known = np.ones(heights.shape, bool)
    known[1, 0, 0] = False
    scale = paper_scale(PatchSet([{"heights": heights, "known": known}]))
    assert (scale.low, scale.high) == pytest.approx((-0.2, 0.3), abs=0.01)


def test_rows_are_spread_evenly() -> None:
    assert spread_rows(0, 5).tolist() == []
    assert spread_rows(3, 5).tolist() == [0, 1, 2]
    assert spread_rows(101, 5).tolist() == [0, 25, 50, 75, 100]


def test_every_network_of_the_paper_learns_from_a_corpus_of_its_own_resolution_only(tmp_path: Path) -> None:
    corpora = {resolution: write_corpus(tmp_path / str(resolution), resolution) for resolution in (24, 100)}
    for architecture in (a for a in ARCHITECTURES.values() if a.recipe == "paper"):
        fitting, other = corpora[architecture.resolution], corpora[124 - architecture.resolution]
        assert open_task(architecture, fitting).identity() == {
            "architecture": architecture.name,
            "corpus_sha256": fitting.sha256,
        }
        with pytest.raises(CorpusError, match=f"learns from {architecture.resolution} x"):
            open_task(architecture, other)

"""Training the paper's networks: clean patches out of holed ones (section 5 of the paper).

Heights are scaled as `quadpatch.inpainters.onnx_network` scales them in a repair: `low`..`high` of the training set
become 0..0.83, bins that can't be seen 1.

The loss is the binary cross-entropy against the clean patch over all bins that were measured, less the entropy of the
clean patch itself. That part is none of the network's doing and has no gradient, but it is nearly all of the
cross-entropy: without it a perfect network and a useless one differ in the third digit. What is left is 0 for a perfect
network.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import torch
from torch import Tensor, nn
from torch.nn import functional

from quadpatch.inpainters.onnx_network import RAW_HEIGHTS, PaperScale
from quadpatch.types import IntArray
from training.architectures import Architecture
from training.holes import N_TURNS, Holes, draw_holes, turn
from training.shards import Corpus, PatchSet
from training.task import Batch

# Limits of the scale: heights beyond are cut off. The outermost bins of all stand for folds and spikes.
PERCENTILES = (0.25, 99.75)
MAX_SCALE_PATCHES = 5000
# Validation is the same for every run, so that runs with several seeds can be compared.
VALIDATION_SEED = 20_190_325
MAX_VALIDATION_PATCHES = 2048


@dataclass(frozen=True)
class PaperTask:
    """One of the paper's networks, and patches with the arrays `heights` and `known`.

    Attributes
    ----------
    architecture : Architecture
    train, held_out : PatchSet
    scale : PaperScale
    corpus_sha256 : str
    """

    architecture: Architecture
    train: PatchSet
    held_out: PatchSet
    scale: PaperScale
    corpus_sha256: str

    def identity(self) -> dict[str, Any]:
        """See `Task`."""
        return {"architecture": self.architecture.name, "corpus_sha256": self.corpus_sha256}

    def card_facts(self) -> dict[str, Any]:
        """See `Task`."""
        scale = self.scale
        return {
            "height_low": scale.low,
            "height_high": scale.high,
            "scaled_high": scale.scaled_high,
            "normalisation": RAW_HEIGHTS,
        }

    def build(self) -> nn.Module:
        """See `Task`."""
        return self.architecture.build()

    def batch(self, rng: np.random.Generator, size: int, share: slice, device: torch.device) -> Batch:
        """See `Task`; patches are drawn with repeats, each turned and holed in its own way."""
        rows = rng.integers(0, len(self.train), size)
        turns = rng.integers(0, N_TURNS, size)
        holes = draw_holes(size, rng)
        mine = Holes(holes.centre[share], holes.width[share], holes.is_square[share])
        return self._make(self.train, rows[share], turns[share], mine, device)

    def validation(self, size: int, device: torch.device) -> Iterator[Batch]:
        """See `Task`; patches evenly from all held-out meshes, not turned."""
        rows = spread_rows(len(self.held_out), MAX_VALIDATION_PATCHES)
        holes = draw_holes(len(rows), np.random.default_rng(VALIDATION_SEED))
        for start in range(0, len(rows), size):
            part = slice(start, start + size)
            mine = Holes(holes.centre[part], holes.width[part], holes.is_square[part])
            yield self._make(self.held_out, rows[part], np.zeros(len(rows[part]), np.int64), mine, device)

    def loss(self, module: nn.Module, batch: Batch) -> Tensor:
        """See `Task`: cross-entropy less entropy, in nats a bin."""
        inputs, clean, known = batch
        logits = module(inputs).float()
        excess = functional.binary_cross_entropy_with_logits(logits, clean, reduction="none") - entropy(clean)
        count = known.sum(dim=(1, 2, 3)).clamp(min=1)
        loss: Tensor = (torch.where(known, excess, 0.0).sum(dim=(1, 2, 3)) / count).mean()
        return loss

    def _make(self, patches: PatchSet, rows: IntArray, turns: IntArray, holes: Holes, device: torch.device) -> Batch:
        arrays = patches.gather(rows)
        heights = turn(torch.from_numpy(arrays["heights"]).to(device, torch.float32), turns)
        known = turn(torch.from_numpy(arrays["known"]).to(device), turns)
        visible = known & holes.cut(self.architecture.resolution, device)
        scale = self.scale
        scaled = (heights - scale.low) / (scale.high - scale.low) * scale.scaled_high
        clean = scaled.clamp(0.0, scale.scaled_high)
        inputs = torch.where(visible, clean, 1.0)
        return inputs[:, None], clean[:, None], known[:, None]


def open_paper_task(architecture: Architecture, corpus: Corpus) -> PaperTask:
    """Join a network and a corpus that was cut for the recipe `paper`."""
    train = corpus.patches("train")
    return PaperTask(architecture, train, corpus.patches("validation"), paper_scale(train), corpus.sha256)


def paper_scale(patches: PatchSet) -> PaperScale:
    """Find the limits of a training set's heights, in patch lengths."""
    arrays = patches.gather(spread_rows(len(patches), MAX_SCALE_PATCHES))
    low, high = np.percentile(arrays["heights"][arrays["known"]], PERCENTILES)
    return PaperScale(round(float(low), 5), round(float(high), 5))


def spread_rows(count: int, most: int) -> IntArray:
    """Choose at most so many rows, evenly."""
    return np.unique(np.linspace(0, count - 1, min(count, most)).astype(np.int64)) if count else np.zeros(0, np.int64)


def entropy(values: Tensor) -> Tensor:
    """Entropy of values between 0 and 1, in nats: what a cross-entropy against them can't fall below."""
    nats: Tensor = -torch.special.xlogy(values, values) - torch.special.xlogy(1.0 - values, 1.0 - values)
    return nats

"""Training the network `residual`: what a fill got wrong, from the fill itself. See `quadpatch.networks.residual`."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import torch
from torch import Tensor, nn

from quadpatch.networks.residual import errors, rotated
from quadpatch.types import IntArray
from training.architectures import Architecture
from training.paper_task import spread_rows
from training.shards import Corpus, PatchSet
from training.task import Batch

MAX_VALIDATION_PATCHES = 4096
_ARRAYS = ("channels", "correction", "asked")


@dataclass(frozen=True)
class ResidualTask:
    """The network, and training pairs as `training.training_pairs` cuts them.

    Attributes
    ----------
    architecture : Architecture
    train, held_out : PatchSet
    corpus_sha256 : str
    """

    architecture: Architecture
    train: PatchSet
    held_out: PatchSet
    corpus_sha256: str

    def identity(self) -> dict[str, Any]:
        """See `Task`."""
        return {"architecture": self.architecture.name, "corpus_sha256": self.corpus_sha256}

    def card_facts(self) -> dict[str, Any]:
        """See `Task`; how patches are prepared follows from the recipe alone."""
        return {}

    def build(self) -> nn.Module:
        """See `Task`."""
        return self.architecture.build()

    def batch(self, rng: np.random.Generator, size: int, share: slice, device: torch.device) -> Batch:
        """See `Task`; pairs are drawn with repeats, each batch turned in its own way."""
        rows = rng.integers(0, len(self.train), size)
        turn = int(rng.integers(0, 8))
        return rotated(self._make(self.train, rows[share], device), turn % 4, mirrored=turn >= 4)

    def validation(self, size: int, device: torch.device) -> Iterator[Batch]:
        """See `Task`; pairs evenly from all held-out meshes, not turned."""
        rows = spread_rows(len(self.held_out), MAX_VALIDATION_PATCHES)
        for start in range(0, len(rows), size):
            yield self._make(self.held_out, rows[start : start + size], device)

    def loss(self, module: nn.Module, batch: Batch) -> Tensor:
        """See `Task`: the error in shares of the fill's, with its slopes."""
        channels, correction, loss_mask = batch
        inputs = channels.contiguous(memory_format=torch.channels_last)
        return errors(module(inputs).float(), correction, loss_mask).relative_loss

    def _make(self, patches: PatchSet, rows: IntArray, device: torch.device) -> Batch:
        arrays = patches.gather(rows)
        channels, correction, loss_mask = (torch.from_numpy(arrays[name]).to(device, torch.float32) for name in _ARRAYS)
        return channels, correction[:, None], loss_mask[:, None]


def open_residual_task(architecture: Architecture, corpus: Corpus) -> ResidualTask:
    """Join the network and a corpus of training pairs."""
    return ResidualTask(architecture, corpus.patches("train"), corpus.patches("validation"), corpus.sha256)

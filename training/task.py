"""What the trainer needs to know about a network: how it is built, fed, measured and named."""

from collections.abc import Iterator
from typing import Any, Protocol

import numpy as np
import torch
from torch import Tensor, nn

# Inputs first; the rest is the task's own affair.
Batch = tuple[Tensor, ...]


class Task(Protocol):
    """A network and its data, with the randomness taken out: the same generator gives the same batch."""

    def identity(self) -> dict[str, Any]:
        """Return the facts that a checkpoint must agree with, JSON-ready."""
        ...

    def card_facts(self) -> dict[str, Any]:
        """Return what the card must say for a repair to prepare patches as in training, JSON-ready."""
        ...

    def build(self) -> nn.Module:
        """Build the network; its weights follow from torch's generator."""
        ...

    def batch(self, rng: np.random.Generator, size: int, share: slice, device: torch.device) -> Batch:
        """Make a training batch of `size` patches and return those of a share of it: one process of several."""
        ...

    def validation(self, size: int, device: torch.device) -> Iterator[Batch]:
        """Make the validation batches, of at most that size: the same ones every time, whatever the seed."""
        ...

    def loss(self, module: nn.Module, batch: Batch) -> Tensor:
        """Compute the mean over the patches of a batch: a scalar in float32."""
        ...

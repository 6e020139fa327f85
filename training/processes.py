"""Where a training run takes place: one process or several, each with its device.

`torchrun` starts the same command several times and says so in the environment; without it there is one process. The
processes train one network together: each takes its share of every batch, and gradients are averaged.
"""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import torch
import torch.distributed as dist
from torch import nn
from torch.nn.parallel import DistributedDataParallel

from quadpatch.errors import OptionError
from quadpatch.networks.precision import has_fast_bfloat16

DEVICES = ("auto", "cpu", "cuda")


@dataclass(frozen=True)
class Place:
    """One process of a run.

    Attributes
    ----------
    device : torch.device
    rank : int
        0 is the one that talks and writes.
    n_processes : int
    """

    device: torch.device
    rank: int = 0
    n_processes: int = 1

    @property
    def is_first(self) -> bool:
        """Whether this process talks and writes files."""
        return self.rank == 0

    @property
    def has_bfloat16(self) -> bool:
        """Whether the device multiplies bfloat16 matrices faster than float32 ones."""
        if self.device.type == "cuda":
            return bool(torch.cuda.is_bf16_supported())
        return has_fast_bfloat16()

    def share(self, size: int) -> slice:
        """Return this process's part of a batch of that size."""
        return slice(self.rank * size // self.n_processes, (self.rank + 1) * size // self.n_processes)

    def distributed(self, module: nn.Module) -> nn.Module:
        """Wrap a module so that its gradients are averaged over the processes."""
        return DistributedDataParallel(module) if self.n_processes > 1 else module

    def most(self, *values: float) -> list[float]:
        """Agree on the largest of each value over the processes."""
        return self._reduce(values, dist.ReduceOp.MAX)

    def total(self, *values: float) -> list[float]:
        """Add each value up over the processes."""
        return self._reduce(values, dist.ReduceOp.SUM)

    def _reduce(self, values: tuple[float, ...], how: dist.ReduceOp.RedOpType) -> list[float]:
        if self.n_processes == 1:
            return list(values)
        numbers = torch.tensor(values, dtype=torch.float64, device=self.device)
        dist.all_reduce(numbers, how)
        reduced: list[float] = numbers.tolist()
        return reduced


@contextmanager
def take_place(device: str = "auto") -> Iterator[Place]:
    """Find out which process this is, and join the others.

    Parameters
    ----------
    device : str
        One of `DEVICES`.

    Raises
    ------
    OptionError
        If there is no such device.
    """
    if device not in DEVICES:
        raise OptionError(f"the device is one of {', '.join(DEVICES)}; got {device!r}")
    if device == "cuda" and not torch.cuda.is_available():
        raise OptionError("torch finds no GPU here: take --device cpu, or install a torch build for your GPU")
    on_gpu = torch.cuda.is_available() if device == "auto" else device == "cuda"
    rank, n_processes = int(os.environ.get("RANK", "0")), int(os.environ.get("WORLD_SIZE", "1"))
    chosen = torch.device("cuda", int(os.environ.get("LOCAL_RANK", "0"))) if on_gpu else torch.device("cpu")
    if n_processes == 1:
        yield Place(chosen)
        return
    if on_gpu:
        torch.cuda.set_device(chosen)
    dist.init_process_group("nccl" if on_gpu else "gloo")
    try:
        yield Place(chosen, rank, n_processes)
    finally:
        dist.destroy_process_group()

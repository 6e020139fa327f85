"""Which precision the processor is fast at, and how many threads compute."""

from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache

import torch


@cache
def has_fast_bfloat16() -> bool:
    """Whether the processor multiplies bfloat16 matrices itself.

    One that does not converts every number there and back, which takes ten times as long as float32.

    Returns
    -------
    bool
    """
    capabilities = torch.cpu.get_capabilities()
    return bool(capabilities.get("amx_bf16") or capabilities.get("avx512_bf16"))


@contextmanager
def one_thread() -> Iterator[None]:
    """Compute in one thread: the sums of several depend on how many there are."""
    before = torch.get_num_threads()
    torch.set_num_threads(1)
    try:
        yield
    finally:
        torch.set_num_threads(before)

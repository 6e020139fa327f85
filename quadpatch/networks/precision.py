"""Which precision the processor is fast at."""

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

from pathlib import Path

import pytest

from quadpatch.networks.precision import has_fast_bfloat16


def test_bfloat16_is_fast_where_the_processor_multiplies_it() -> None:
    cpu_info = Path("/proc/cpuinfo")
    if not cpu_info.exists():
        pytest.skip("only Linux lists what the processor can do")
    flags = set(cpu_info.read_text().split())
    assert has_fast_bfloat16() == bool({"avx512_bf16", "amx_bf16"} & flags)

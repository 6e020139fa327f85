"""Tests `benchmarks.performance.launcher` as well: `benchmarks/performance/launcher.py` starts every command."""

import sys

import numpy as np
import pytest

from benchmarks.performance.processes import RunFailedError, measure
from tests.waiting import GUARD_S

HELD_MB = 200


def test_peak_memory_is_that_of_the_command_whatever_this_process_holds() -> None:
    held = np.ones(HELD_MB << 17)
    cost = measure([sys.executable, "-S", "-c", "pass"], GUARD_S)
    assert 1 < cost.peak_mb < HELD_MB / 2
    assert held.all()
    large = measure([sys.executable, "-S", "-c", f"data = bytearray({HELD_MB} << 20)"], GUARD_S)
    assert large.peak_mb > HELD_MB
    assert large.cpu_s > 0
    assert large.wall_s > 0


def test_a_command_that_fails_says_why() -> None:
    with pytest.raises(RunFailedError, match="no such thing"):
        measure([sys.executable, "-S", "-c", "raise SystemExit('no such thing')"], GUARD_S)
    with pytest.raises(RunFailedError, match="No such file"):
        measure(["/no/such/program"], GUARD_S)


def test_a_command_is_ended_at_its_limit() -> None:
    with pytest.raises(RunFailedError, match=r"over 0\.5 s"):
        measure([sys.executable, "-S", "-c", "import signal; signal.pause()"], 0.5)


def test_a_command_gets_as_many_cores_as_it_may_use() -> None:
    program = "import os, sys; sys.exit(len(os.sched_getaffinity(0)) != 1)"
    assert measure([sys.executable, "-S", "-c", program], GUARD_S, n_cores=1).cpu_s > 0

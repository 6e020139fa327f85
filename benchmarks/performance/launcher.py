"""Runs one command and prints what it cost as JSON. A program of its own, of the standard library alone.

The peak memory of a process counts what its parent held when it was started, so the parent has to be small: a
benchmark that has just generated a large scan is not.

Usage: launcher.py LIMIT_S CORES COMMAND [ARGUMENT...]; 0 cores: all of them. The command is killed at its limit.

Tested in `tests/benchmarks/performance/test_processes.py`.
"""

import json
import os
import signal
import sys
import time
from types import FrameType


def main(arguments: list[str]) -> int:
    """Run the command; its standard output goes nowhere, its standard error to that of this process."""
    limit_s, n_cores, command = float(arguments[0]), int(arguments[1]), arguments[2:]
    if n_cores:
        os.sched_setaffinity(0, sorted(os.sched_getaffinity(0))[:n_cores])
    silence = [(os.POSIX_SPAWN_OPEN, 1, os.devnull, os.O_WRONLY, 0)]
    start = time.perf_counter()
    pid = os.posix_spawn(command[0], command, os.environ, file_actions=silence, setpgroup=0)

    def end(_signal: int, _frame: FrameType | None) -> None:
        os.killpg(pid, signal.SIGKILL)

    signal.signal(signal.SIGALRM, end)
    signal.setitimer(signal.ITIMER_REAL, limit_s)
    _, status, usage = os.wait4(pid, 0)
    wall_s = time.perf_counter() - start
    signal.setitimer(signal.ITIMER_REAL, 0)
    costs = {"cpu_s": usage.ru_utime + usage.ru_stime, "wall_s": wall_s, "peak_mb": usage.ru_maxrss / 1024}
    print(json.dumps({**costs, "status": os.waitstatus_to_exitcode(status)}))  # noqa: T201  data for the benchmark
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

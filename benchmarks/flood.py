"""What others notice of a client that takes all the places it can get.

Run ``python -m benchmarks.flood``, or ``make flood``. It starts a queue and the API of a local stack with their default
settings in a fresh folder, on two cores together with the clients, opens waiters, half-open requests and endless heads
at once, and asks `/healthz` over a new connection each time: before, while they are opened, and while they stay.

Tested in `tests/benchmarks/test_commands.py`.
"""

import argparse
import http.client
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table

from benchmarks.flooding import Flood
from benchmarks.served import HOST, furnish, running_service

MOST_P95_MS = 100.0
_CORES = 2
_PAUSE_S = 0.02
_LEAST_ASKED = 40
_TIMEOUT_S = 60.0


def ask(port: int, goes_on: Callable[[int], bool]) -> list[float]:
    """Ask `/healthz` again and again; return the milliseconds of each answer.

    Parameters
    ----------
    port : int
    goes_on : callable
        Takes the count of the answers so far.
    """
    times: list[float] = []
    while goes_on(len(times)):
        started = time.perf_counter()
        connection = http.client.HTTPConnection(HOST, port, timeout=_TIMEOUT_S)
        connection.request("GET", "/healthz")
        answer = connection.getresponse()
        answer.read()
        connection.close()
        if answer.status != http.HTTPStatus.OK:
            raise SystemExit(f"/healthz answered {answer.status}")
        times.append(1000 * (time.perf_counter() - started))
        time.sleep(_PAUSE_S)
    return times


def until(seconds: float) -> Callable[[int], bool]:
    """Make a condition that holds for so many seconds."""
    deadline = time.monotonic() + seconds
    return lambda _: time.monotonic() < deadline


class Flooders:
    """The process of the clients.

    Parameters
    ----------
    process : subprocess.Popen
    """

    def __init__(self, process: "subprocess.Popen[str]") -> None:
        self._process = process
        assert process.stdout is not None
        os.set_blocking(process.stdout.fileno(), False)

    def are_open(self) -> bool:
        """Tell whether each client has had its first connection."""
        assert self._process.stdout is not None
        if self._process.poll() is not None:
            raise SystemExit("the clients ended early")
        return bool(self._process.stdout.readline())

    def stop(self) -> dict[str, Any]:
        """End them and return their tally."""
        assert self._process.stdout is not None
        os.set_blocking(self._process.stdout.fileno(), True)
        text, _ = self._process.communicate()
        tally: dict[str, Any] = json.loads(text)
        return tally


@contextmanager
def flooding(plan: Flood) -> Iterator[Flooders]:
    """Run the clients for the length of a `with` block."""
    command = [sys.executable, "-m", "benchmarks.flooding"]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdin is not None
        process.stdin.write(json.dumps(asdict(plan)) + "\n")
        process.stdin.flush()
        try:
            yield Flooders(process)
        finally:
            process.kill()


def measure(port: int, plan: Flood, seconds: float) -> tuple[dict[str, list[float]], dict[str, Any]]:
    """Return the milliseconds of each phase, and what became of the clients."""
    phases = {"before": ask(port, until(seconds / 4))}
    with flooding(plan) as flooders:
        phases["while they are opened"] = ask(port, lambda n: not flooders.are_open() or n < _LEAST_ASKED)
        phases["while they stay"] = ask(port, until(seconds))
        tally = flooders.stop()
    phases["after"] = ask(port, until(seconds / 4))
    return phases, tally


def main() -> int:
    """Read the command line and print the figures; return 1 where the limit is passed."""
    parser = argparse.ArgumentParser(prog="make flood ARGS=...", description="a flood of idle clients against the API")
    parser.add_argument("--waiters", type=int, default=1000, help="requests that wait for a job")
    parser.add_argument("--half-open", type=int, default=1100, help="requests whose body never comes")
    parser.add_argument("--endless", type=int, default=40, help="requests whose head never ends")
    parser.add_argument("--seconds", type=float, default=40.0, help="how long they stay")
    arguments = parser.parse_args()
    os.sched_setaffinity(0, sorted(os.sched_getaffinity(0))[:_CORES])
    with tempfile.TemporaryDirectory() as folder, running_service(Path(folder), {}) as service:
        ids, _ = furnish(service.settings, 4)
        job_path = f"/v1/jobs/{ids[-1]}"
        plan = Flood(HOST, service.port, job_path, arguments.waiters, arguments.half_open, arguments.endless)
        phases, tally = measure(service.port, plan, arguments.seconds)
        memory_mb = service.process.memory_info().rss / (1 << 20)
    table, holds = to_table(plan, phases)
    answers = ", ".join(f"{name}: {n}" for name, n in sorted(tally["answers"].items()))
    table.caption = (
        f"at most {MOST_P95_MS:g} ms at p95: {'held' if holds else 'BROKEN'}; open at the end: {tally['n_open']}; "
        f"answers: {answers}; memory of the API: {memory_mb:.0f} MiB; load of the machine: {os.getloadavg()[0]:.1f}"
    )
    Console().print(table)
    return 0 if holds else 1


def to_table(plan: Flood, phases: dict[str, list[float]]) -> tuple[Table, bool]:
    """Return the figures of all phases, and whether each keeps the limit."""
    table = Table(
        title=f"/healthz, {plan.n_waiters} waiters, {plan.n_half_open} half-open, {plan.n_endless} endless heads"
    )
    for head in ("phase", "answers", "p50 ms", "p95 ms", "most ms"):
        table.add_column(head, justify="left" if head == "phase" else "right")
    worst = 0.0
    for name, times in phases.items():
        cuts = statistics.quantiles(times, n=20)
        table.add_row(name, str(len(times)), f"{cuts[9]:.1f}", f"{cuts[18]:.1f}", f"{max(times):.1f}")
        worst = max(worst, cuts[18])
    return table, worst <= MOST_P95_MS


if __name__ == "__main__":
    sys.exit(main())

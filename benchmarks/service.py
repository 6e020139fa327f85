"""Load on the service: clients that poll and follow jobs, and the memory that a large upload takes.

Run ``python -m benchmarks.service``. It starts a queue and the API of a local stack with their default settings in a
fresh folder, on two cores together with the clients, fills the database with jobs in all states, and keeps some of
them moving as workers do. Times mean something only on an idle machine.

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
from collections.abc import Iterator
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table

from benchmarks.polling import Plan
from benchmarks.served import HOST, N_RUNNING, RunningService, furnish, moving, running_service

MOST_P95_MS = 50.0
MOST_GROWTH_MB = 64.0
_CORES = 2
_MB = 1 << 20


def measure_polling(service: RunningService, plan: Plan) -> dict[str, float]:
    """Let clients poll while some of the jobs move; times in milliseconds, rates a second, shares of one core."""
    before = service.process.cpu_times()
    tally = _run_clients("benchmarks.polling", plan)
    after = service.process.cpu_times()
    times = [1000 * seconds for seconds in tally["times"]]
    cuts = statistics.quantiles(times, n=100)
    cpu_s = after.user + after.system - before.user - before.system
    return {
        "answers": len(times),
        "errors": len(tally["errors"]),
        "rate": len(times) / plan.seconds,
        "unchanged": tally["unchanged"] / len(times),
        "p50": cuts[49],
        "p95": cuts[94],
        "p99": cuts[98],
        "most": max(times),
        "cpu_ms": 1000 * cpu_s / len(times),
    }


def measure_streams(service: RunningService, plan: Plan) -> dict[str, float]:
    """Let clients follow jobs that move; delays in milliseconds, share of one core, memory of a stream in KiB."""
    before, before_mb = service.process.cpu_times(), service.process.memory_info().rss / _MB
    _forget_peak(service.process.pid)
    tally = _run_clients("benchmarks.streaming", plan)
    after = service.process.cpu_times()
    cuts = statistics.quantiles([1000 * seconds for seconds in tally["delays"]], n=100)
    return {
        "events": len(tally["delays"]) / plan.seconds,
        "errors": len(tally["errors"]),
        "p50": cuts[49],
        "p95": cuts[94],
        "cpu": (after.user + after.system - before.user - before.system) / plan.seconds,
        "each_kb": 1024 * (_peak_mb(service.process.pid) - before_mb) / plan.n_clients,
    }


def _run_clients(module: str, plan: Plan) -> dict[str, Any]:
    command = [sys.executable, "-m", module]
    client = subprocess.run(command, input=json.dumps(asdict(plan)), capture_output=True, text=True, check=True)
    tally: dict[str, Any] = json.loads(client.stdout)
    return tally


def measure_upload(service: RunningService, mib: int, is_form: bool) -> dict[str, float]:
    """Upload a file of that size; memory in MiB before and at its peak, seconds of the whole."""
    before_mb = service.process.memory_info().rss / _MB
    _forget_peak(service.process.pid)
    started = time.monotonic()
    status = _upload(service.port, mib, is_form)
    seconds = time.monotonic() - started
    peak_mb = _peak_mb(service.process.pid)
    return {"status": status, "before": before_mb, "peak": peak_mb, "growth": peak_mb - before_mb, "seconds": seconds}


def _upload(port: int, mib: int, is_form: bool) -> int:
    head, tail, kind = b"", b"", "application/octet-stream"
    if is_form:
        kind = "multipart/form-data; boundary=frame"
        head = b'--frame\r\nContent-Disposition: form-data; name="file"; filename="scan.ply"\r\n\r\n'
        tail = b"\r\n--frame--\r\n"
    # Other bytes every time: the store keeps the same bytes once.
    chunk = os.urandom(_MB)
    connection = http.client.HTTPConnection(HOST, port, timeout=600)
    connection.putrequest("POST", "/v1/meshes")
    connection.putheader("Content-Type", kind)
    connection.putheader("Content-Length", str(len(head) + mib * _MB + len(tail)))
    connection.endheaders()
    for part in (head, *[chunk] * mib, tail):
        connection.send(part)
    answer = connection.getresponse()
    answer.read()
    connection.close()
    return answer.status


def _forget_peak(pid: int) -> None:
    """Let the kernel measure the peak anew."""
    Path(f"/proc/{pid}/clear_refs").write_text("5")


def _peak_mb(pid: int) -> float:
    lines = Path(f"/proc/{pid}/status").read_text().splitlines()
    (peak,) = [line.split()[1] for line in lines if line.startswith("VmHWM")]
    return int(peak) * 1024 / _MB


def polling_plans(paths: list[str], port: int, arguments: argparse.Namespace) -> Iterator[tuple[str, Plan]]:
    """Yield the loads to measure: once a second with and without entity tags, then as fast as answers come."""
    plan = Plan(HOST, port, paths, arguments.clients, arguments.seconds, 1.0, False)
    yield "once a second", plan
    yield "once a second, If-None-Match", replace(plan, is_conditional=True)
    yield "twice a second", replace(plan, interval_s=0.5)
    yield "twice a second, If-None-Match", replace(plan, interval_s=0.5, is_conditional=True)
    yield "without a pause", replace(plan, interval_s=0.0)
    yield "without a pause, If-None-Match", replace(plan, interval_s=0.0, is_conditional=True)


def streams_table(service: RunningService, arguments: argparse.Namespace) -> tuple[Table, bool]:
    """Measure event streams of jobs that move; return the table, and whether nothing was lost or came twice."""
    table = Table(title=f"{arguments.clients} clients follow {N_RUNNING} jobs that move, {arguments.seconds:g} s")
    for head in ("events/s", "errors", "delay p50 ms", "p95 ms", "share of one core", "KiB for each stream"):
        table.add_column(head, justify="right")
    _, attempts = furnish(service.settings, 4 * N_RUNNING)
    paths = [f"/v1/jobs/{attempt.job_id}" for attempt in attempts]
    with moving(service, attempts):
        plan = Plan(HOST, service.port, paths, arguments.clients, arguments.seconds, 0.0, False)
        seen = measure_streams(service, plan)
    values = [f"{seen['p50']:.0f}", f"{seen['p95']:.0f}", f"{seen['cpu']:.0%}", f"{seen['each_kb']:.0f}"]
    table.add_row(f"{seen['events']:.0f}", f"{seen['errors']:.0f}", *values)
    return table, not seen["errors"]


def polling_table(service: RunningService, arguments: argparse.Namespace) -> tuple[Table, bool]:
    """Measure every load; return the table, and whether those with a pause of a second stay within the limit."""
    table = Table(title=f"{arguments.clients} clients poll {arguments.jobs} jobs, {arguments.seconds:g} s each")
    heads = (
        "each client polls",
        "answers/s",
        "304",
        "errors",
        "p50 ms",
        "p95 ms",
        "p99 ms",
        "most ms",
        "CPU ms/answer",
    )
    for head in heads:
        table.add_column(head, justify="left" if head == heads[0] else "right")
    ids, attempts = furnish(service.settings, arguments.jobs)
    holds = True
    with moving(service, attempts):
        for name, plan in polling_plans([f"/v1/jobs/{job_id}" for job_id in ids], service.port, arguments):
            seen = measure_polling(service, plan)
            times = [f"{seen[key]:.1f}" for key in ("p50", "p95", "p99", "most")]
            counts = [f"{seen['rate']:.0f}", f"{seen['unchanged']:.0%}", f"{seen['errors']:.0f}"]
            table.add_row(name, *counts, *times, f"{seen['cpu_ms']:.2f}")
            if plan.interval_s == 1.0:
                holds = holds and not seen["errors"] and seen["p95"] <= MOST_P95_MS
    table.caption = f"at most {MOST_P95_MS:g} ms at p95 and no error, once a second: {'held' if holds else 'BROKEN'}"
    return table, holds


def upload_table(service: RunningService, mib: int) -> tuple[Table, bool]:
    """Upload a file both ways; return the table, and whether memory stays where it should."""
    table = Table(title=f"upload of {mib:,} MiB")
    for head in ("body", "status", "RSS before, MiB", "peak, MiB", "growth, MiB", "seconds"):
        table.add_column(head, justify="left" if head == "body" else "right")
    holds = True
    for name, is_form in (("file", False), ("form", True)):
        seen = measure_upload(service, mib, is_form)
        values = [f"{seen[key]:.1f}" for key in ("before", "peak", "growth", "seconds")]
        table.add_row(name, f"{seen['status']:.0f}", *values)
        holds = holds and seen["status"] == http.HTTPStatus.CREATED and seen["growth"] <= MOST_GROWTH_MB
    table.caption = f"at most {MOST_GROWTH_MB:g} MiB of growth: {'held' if holds else 'BROKEN'}"
    return table, holds


def main() -> int:
    """Read the command line and print the tables; return 1 where a limit is exceeded."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0] if __doc__ else None)
    parser.add_argument("what", nargs="*", help="polling, streams or upload; default: all")
    parser.add_argument("--clients", type=int, default=200)
    parser.add_argument("--jobs", type=int, default=1000, help="jobs in the database")
    parser.add_argument("--seconds", type=float, default=20.0, help="length of each load")
    parser.add_argument("--mib", type=int, default=2048, help="size of the upload")
    parser.add_argument("--database-url", default="", help="default: SQLite in the fresh folder")
    parser.add_argument("--object-store-url", default="", help="default: the fresh folder")
    arguments = parser.parse_args()
    changes = {name: getattr(arguments, name) for name in ("database_url", "object_store_url")}
    changes["max_upload_mb"] = arguments.mib
    os.sched_setaffinity(0, sorted(os.sched_getaffinity(0))[:_CORES])
    console, holds = Console(), []
    with tempfile.TemporaryDirectory() as folder, running_service(Path(folder), changes) as service:
        tables = {
            "polling": lambda: polling_table(service, arguments),
            "streams": lambda: streams_table(service, arguments),
            "upload": lambda: upload_table(service, arguments.mib),
        }
        for name in arguments.what or tables:
            table, held = tables[name]()
            console.print(table)
            holds.append(held)
    return 0 if all(holds) else 1


if __name__ == "__main__":
    sys.exit(main())

"""Jobs of a whole local stack: how soon they start, how many a minute, and what HTTP adds to a large one.

Run ``python -m benchmarks.jobs``. It starts queue, dispatcher, API and workers with their default settings in a fresh
folder, on the same cores as the client. Times mean something only on an idle machine.

Tested in `tests/benchmarks/test_commands.py`.
"""

import argparse
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from benchmarks.performance.scans import dome, write_scan
from onebox.demo import running_stack
from quadpatch_client.schema import Job, JobSpec
from quadpatch_client.sdk import Client

_SMALL, _N_HOLES = 20_000, 3
# Seconds that the stack gets to come to rest between two jobs.
_PAUSE_S = 0.3


def main() -> None:
    """Read the command line, measure and print."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.jobs", description=__doc__)
    parser.add_argument("--jobs", type=int, default=100, help="small jobs, for start and for throughput")
    parser.add_argument("--large", type=int, default=10_000_000, help="triangles of the large scan; 0: none")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        small, large = Path(folder, "small.ply"), Path(folder, "large.ply")
        write_scan(small, dome(_SMALL, _N_HOLES, radius=0.06))
        if options.large:
            write_scan(large, dome(options.large, 20))
        with running_stack(Path(folder, "box")) as url, Client(url) as client:
            _measure_small(client, small, options.jobs)
            if options.large:
                _measure_large(client, large, Path(folder, "out.ply"))


def _measure_small(client: Client, scan: Path, n_jobs: int) -> None:
    mesh = client.upload(scan)
    client.wait_for_mesh(mesh.id)
    spec = _spec(mesh.id)
    waits = []
    for _ in range(n_jobs):
        job = client.wait(client.create_job(spec, runs_anew=True).id)
        waits.append(1000 * _waited_s(job))
        time.sleep(_PAUSE_S)
    p50, p95 = np.percentile(waits, [50, 95])
    _say(f"{n_jobs} jobs on an idle stack start after {p50:.0f} ms (median), {p95:.0f} ms (95 of 100)")
    for words, has_picture in (("with", True), ("without", False)):
        spec = _spec(mesh.id, has_picture=has_picture)
        start = time.perf_counter()
        for identifier in [client.create_job(spec, runs_anew=True).id for _ in range(n_jobs)]:
            client.wait(identifier)
        rate = 60 * n_jobs / (time.perf_counter() - start)
        _say(f"{n_jobs} jobs at once, {_SMALL:,} triangles and {_N_HOLES} holes, {words} pictures: {rate:.0f} a minute")


def _measure_large(client: Client, scan: Path, output: Path) -> None:
    # With a picture, as a job draws one if it is not told otherwise.
    command = [sys.executable, "-m", "quadpatch", "fill", str(scan), "-o", str(output), "--model", "smooth"]
    command += ["--preview", str(output.with_suffix(".png"))]
    start = time.perf_counter()
    subprocess.run(command, check=True, capture_output=True)
    alone_s = time.perf_counter() - start
    mesh = client.upload(scan)
    client.wait_for_mesh(mesh.id)
    job = client.wait(client.create_job(_spec(mesh.id), runs_anew=True).id)
    if job.finished_at is None:
        sys.exit(f"error: job {job.id} says no end")
    over_http_s = (job.finished_at - job.created_at).total_seconds()
    n_mb = scan.stat().st_size / 1e6
    _say(
        f"a scan of {n_mb:.0f} MB: {alone_s:.1f} s by the command line, {over_http_s:.1f} s as a job "
        f"({over_http_s / alone_s:.2f} times as long)"
    )


def _spec(mesh_id: str, *, has_picture: bool = True) -> JobSpec:
    spec = {"mesh_id": mesh_id, "method": {"method": "smooth"}, "output": {"preview": has_picture}}
    return JobSpec.model_validate(spec)


def _waited_s(job: Job) -> float:
    """Time from the answer 202 to the start of the work."""
    if job.started_at is None:
        sys.exit(f"error: job {job.id} says no start")
    return (job.started_at - job.created_at).total_seconds()


def _say(line: str) -> None:
    print(line, flush=True)  # noqa: T201


if __name__ == "__main__":
    main()

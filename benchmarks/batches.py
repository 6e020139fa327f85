"""Seconds until a batch of 5,000 jobs is accepted and canceled, and milliseconds of answers that a stored result gives.

`python -m benchmarks.batches [--jobs 5000]` starts a local stack; QUADPATCH_DATABASE_URL takes another database.

Tested in `tests/benchmarks/test_commands.py`.
"""

import argparse
import statistics
import sys
import tempfile
import time
from pathlib import Path

import httpx

from onebox.demo import running_stack

_N_ANSWERS = 50
_SMOOTH = {"method": "smooth"}
_WIDTH = 20


def main() -> None:
    """Print the figures."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.batches", description=__doc__)
    parser.add_argument("--jobs", type=int, default=5000)
    n_jobs = parser.parse_args().jobs
    with (
        tempfile.TemporaryDirectory(prefix="quadpatch-batch-") as folder,
        running_stack(Path(folder)) as url,
        httpx.Client(base_url=url, timeout=300) as client,
    ):
        mesh_id = client.post("/v1/meshes?filename=scan.ply", content=_scan()).raise_for_status().json()["id"]
        spec = {"mesh_id": mesh_id, "method": _SMOOTH}
        client.post("/v1/jobs", json=spec, headers={"Prefer": "wait=30"}).raise_for_status()
        answers_ms = []
        for _ in range(_N_ANSWERS):
            started = time.perf_counter()
            answer = client.post("/v1/jobs", json=spec)
            answers_ms.append(1000 * (time.perf_counter() - started))
            assert answer.headers["Cache-Status"] == "quadpatch; hit", answer.text
        sys.stdout.write(
            f"stored result: median {statistics.median(answers_ms):.1f} ms, max {max(answers_ms):.1f} ms\n"
        )
        started = time.perf_counter()
        jobs = [{**spec, "seed": seed} for seed in range(1, n_jobs + 1)]
        batch = client.post("/v1/batches", json={"jobs": jobs}).raise_for_status().json()
        sys.stdout.write(f"{n_jobs} jobs accepted: {time.perf_counter() - started:.1f} s\n")
        started, path = time.perf_counter(), f"/v1/batches/{batch['id']}"
        client.post(f"{path}/cancel").raise_for_status()
        while (state := client.get(path).json())["state"] != "ended":
            time.sleep(0.2)
        sys.stdout.write(f"ended {time.perf_counter() - started:.1f} s after the cancel: {state['counts']}\n")


def _scan() -> bytes:
    """Write a square of 20 by 20 vertices with a hole of two triangles."""
    n, middle = _WIDTH, _WIDTH // 2 * _WIDTH + _WIDTH // 2
    corners = [row * n + column for row in range(n - 1) for column in range(n - 1) if row * n + column != middle]
    faces = [face for c in corners for face in (f"3 {c} {c + 1} {c + n + 1}", f"3 {c} {c + n + 1} {c + n}")]
    vertices = [f"{i % n} {i // n} {0.1 * (i % 3)}" for i in range(n * n)]
    header = f"ply\nformat ascii 1.0\nelement vertex {n * n}\nproperty float x\nproperty float y\nproperty float z\n"
    header += f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    return (header + "\n".join([*vertices, *faces]) + "\n").encode()


if __name__ == "__main__":
    main()

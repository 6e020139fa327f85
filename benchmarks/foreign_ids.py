"""Whether the time of an answer tells an id of another tenant from one that does not exist.

Run ``python -m benchmarks.foreign_ids``. It starts a local stack with keys, lets one tenant have a mesh, a job, a
webhook and an upload, and asks for them by the key of another tenant, each in turn with an id that nothing has. Printed
are the medians, and how often the slower one of a random pair is the foreign one: 0.5 where nothing can be told, with
the spread of that share where both ids are alike (Mann and Whitney, 1947).

Tested in `tests/benchmarks/test_commands.py`.
"""

import argparse
import math
import os
import tempfile
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import httpx
import numpy as np

from benchmarks.performance.scans import dome, write_scan
from onebox.demo import running_stack
from quadpatch.types import FloatArray

_OPERATOR = "the-key-of-the-operator"
_TUS = {"Tus-Resumable": "1.0.0"}
_ABSENT: Mapping[str, str] = {
    "/v1/meshes/{}": "f" * 64,
    "/v1/jobs/{}": "job_01jd7z3v5qk8m2x4c6b8n0a9de",
    "/v1/jobs/{}/events": "job_01jd7z3v5qk8m2x4c6b8n0a9de",
    "/v1/webhooks/{}": "wh_01jd7z3v5qk8m2x4c6b8n0a9de",
    "/v1/uploads/{}": "",
}


def main() -> None:
    """Read the command line, measure and print."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.foreign_ids", description=__doc__)
    parser.add_argument("--requests", type=int, default=500, help="of each kind, for each route")
    options = parser.parse_args()
    os.environ["QUADPATCH_API_KEYS"] = _OPERATOR
    with (
        tempfile.TemporaryDirectory() as folder,
        running_stack(Path(folder, "box")) as url,
        httpx.Client(base_url=url, timeout=60) as client,
    ):
        owner, other = (_key(client, tenant) for tenant in ("plant-north", "plant-south"))
        ids = _things(client, owner, Path(folder, "scan.ply"))
        for route, absent in _ABSENT.items():
            paths = route.format(ids[route]), route.format(absent or _like(ids[route]))
            _say(route, *_times(client, paths, {**other, **_TUS}, options.requests))


def _key(client: httpx.Client, tenant: str) -> dict[str, str]:
    new = {"name": "station", "tenant": tenant, "scopes": ["read", "upload", "repair"]}
    made = client.post("/v1/keys", json=new, headers={"X-API-Key": _OPERATOR}).raise_for_status()
    return {"X-API-Key": str(made.json()["key"])}


def _things(client: httpx.Client, key: dict[str, str], scan: Path) -> dict[str, str]:
    """Let a tenant have one of each; return the ids by the routes that show them."""
    write_scan(scan, dome(20_000, 3, radius=0.06))

    def made(path: str, **content: Any) -> str:
        headers = {**key, **_TUS, **content.pop("headers", {})}
        return str(client.post(path, headers=headers, **content).raise_for_status().json()["id"])

    mesh = made("/v1/meshes?filename=scan.ply", content=scan.read_bytes())
    job = made("/v1/jobs", json={"mesh_id": mesh})
    webhook = made("/v1/webhooks", json={"url": "https://93.184.216.34/hook"})
    upload = made("/v1/uploads", headers={"Upload-Length": "1000"})
    return dict(zip(_ABSENT, (mesh, job, job, webhook, upload), strict=True))


def _like(identifier: str) -> str:
    """Return an id of the same form that nothing has."""
    kind, _, rest = identifier.rpartition("_")
    return f"{kind}_{rest[::-1]}" if kind else rest[::-1]


def _times(client: httpx.Client, paths: tuple[str, str], headers: dict[str, str], count: int) -> tuple[FloatArray, ...]:
    """Milliseconds of the answers to each of two paths, asked in turn, in a random order of the two."""
    rng, times = np.random.default_rng(0), np.zeros((2, count))
    for i in range(count):
        for which in rng.permutation(2):
            start = time.perf_counter()
            answer = client.get(paths[which], headers=headers)
            times[which, i] = 1000 * (time.perf_counter() - start)
            if answer.status_code != httpx.codes.NOT_FOUND:
                raise SystemExit(f"error: {paths[which]} was answered with {answer.status_code}")
    return times[0], times[1]


def _say(route: str, foreign: FloatArray, absent: FloatArray) -> None:
    share = float((foreign[:, None] > absent).mean() + 0.5 * (foreign[:, None] == absent).mean())
    n = len(foreign)
    spread = math.sqrt((2 * n + 1) / (12 * n * n))
    medians = f"foreign {np.median(foreign):.2f} ms, absent {np.median(absent):.2f} ms"
    print(f"{route}: {medians}; foreign is slower in {share:.3f} of pairs (0.5 ± {2 * spread:.3f})")  # noqa: T201


if __name__ == "__main__":
    main()

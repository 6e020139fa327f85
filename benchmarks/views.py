"""Seconds until a viewer has something to show of a scan, and sizes of the views.

`python -m benchmarks.views scan.ply [--after]` starts a local stack and uploads the scan. The coarse view is asked for
at once, with `--after` when the analysis has ended; the others follow it, as a page asks for them.

Tested in `tests/benchmarks/test_commands.py`.
"""

import argparse
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import httpx

from onebox.demo import running_stack

_FIRST, _OTHERS = "view?level=coarse", ("outlines", "view?level=fine")
_WAIT = {"Prefer": "wait=60"}


def main() -> None:
    """Print the figures."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.views", description=__doc__)
    parser.add_argument("scan", type=Path)
    parser.add_argument("--after", action="store_true")
    options = parser.parse_args()
    with (
        tempfile.TemporaryDirectory(prefix="quadpatch-views-") as folder,
        running_stack(Path(folder)) as url,
        httpx.Client(base_url=url, timeout=300) as client,
        ThreadPoolExecutor(len(_OTHERS)) as pool,
    ):
        data = options.scan.read_bytes()
        mesh_id = client.post("/v1/meshes?filename=scan.ply", content=data).raise_for_status().json()["id"]
        path, started = f"/v1/meshes/{mesh_id}", time.perf_counter()

        def fetched(name: str) -> str:
            while (answer := client.get(f"{path}/{name}", headers=_WAIT)).status_code == httpx.codes.ACCEPTED:
                pass
            seconds = time.perf_counter() - started
            return f"{name}: {seconds:.1f} s, {len(answer.raise_for_status().content):,} bytes\n"

        early = None if options.after else pool.submit(fetched, _FIRST)
        while (mesh := client.get(path, headers=_WAIT).json())["state"] == "analysing":
            pass
        sys.stdout.write(f"analysis: {time.perf_counter() - started:.1f} s, {mesh['state']}\n")
        sys.stdout.write(early.result() if early is not None else fetched(_FIRST))
        for line in pool.map(fetched, _OTHERS):
            sys.stdout.write(line)


if __name__ == "__main__":
    main()

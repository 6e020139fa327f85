"""Peak memory of engines beside what jobs are expected to need before there are past ones.

Run ``python -m benchmarks.memory``. Engines run as a worker runs them, one after the other, with a picture, on the
domes of the other benchmarks as binary PLY files.

Tested in `tests/benchmarks/test_commands.py`.
"""

import argparse
import tempfile
from pathlib import Path
from typing import Any

from benchmarks.performance.scans import dome, write_scan
from jobkit.jobs.memory_needs import expected_from_bytes
from worker.engine.client import ForkServer
from worker.engine.limits import EngineLimits
from worker.engine.request import MESH_FOLDER, EngineRequest, EngineTask
from worker.engine.supervision import Observer, run_engine

_LIMITS = EngineLimits(time_s=3600.0, memory_mb=16_384)
_MIB = 1 << 20
# By kind of job: the engine's task, the model, the file that is made, and options.
_KINDS: dict[str, tuple[EngineTask, str, str, dict[str, Any]]] = {
    "fill none": ("repair", "smooth", "repaired.ply", {}),
    "fill self": ("repair", "self", "repaired.ply", {}),
    "denoise self": ("denoise", "self", "denoised.ply", {}),
    "encode self": ("encode", "self", "encoded.qpz", {"max_error": 0.5}),
}


def main() -> None:
    """Read the command line, measure and print."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.memory", description=__doc__)
    parser.add_argument("--triangles", type=int, nargs="+", default=[20_000, 100_000, 300_000, 1_000_000])
    options = parser.parse_args()
    print("| kind | triangles | MiB of the file | peak in MiB | expected |")  # noqa: T201
    print("| --- | ---: | ---: | ---: | ---: |")  # noqa: T201
    with tempfile.TemporaryDirectory() as folder, ForkServer(n_threads=1) as fork_server:
        for n_triangles in options.triangles:
            scan = Path(folder, f"{n_triangles}.ply")
            write_scan(scan, dome(n_triangles, 20))
            for kind in _KINDS:
                size_bytes = scan.stat().st_size
                peak_mb, expected_mb = _peak_mb(fork_server, scan, kind), expected_from_bytes(kind, size_bytes)
                row = f"| {kind} | {n_triangles:,} | {size_bytes / _MIB:.1f} | {peak_mb:,.0f} | {expected_mb:,} |"
                print(row, flush=True)  # noqa: T201


def _peak_mb(fork_server: ForkServer, scan: Path, kind: str) -> float:
    task, model, output, task_options = _KINDS[kind]
    peaks: list[float] = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / MESH_FOLDER).mkdir()
        (folder / MESH_FOLDER / "source.ply").symlink_to(scan)
        request = EngineRequest(
            task, f"{MESH_FOLDER}/source.ply", _LIMITS, output, model, task_options, with_preview=True
        )
        run_engine(fork_server, request, folder, Observer(lambda *_: None, lambda: None, on_peak=peaks.append))
    return peaks[0]


if __name__ == "__main__":
    main()

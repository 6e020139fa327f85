"""``python -m benchmarks.performance``: seconds and memory of whole processes, ours beside peers and a floor.

Writes tables and plots into a folder and fills the places of docs/performance.md with them. The figures mean something
only on an idle machine.

MeshLib and MeshLab run in the environment whose Python `--peer-python` names (`pip install meshlib pymeshlab numpy`);
without one their columns are left out.
"""

import argparse
import os
import platform
import sys
from collections.abc import Sequence
from pathlib import Path

from rich.console import Console

from benchmarks.performance.fragments import write_fragment
from benchmarks.performance.programs import (
    FLOOR,
    MESHLIB,
    MODELS,
    PEER_PACKAGES,
    Program,
    all_programs,
    peer_version,
)
from benchmarks.performance.series import all_series, measure_series
from benchmarks.quality.assemble import assemble

DOCUMENT = Path(__file__).resolve().parents[2] / "docs" / "performance.md"
_RUN = "performance"
_QUICK_SHARE = 0.01
# Where many damages are the point, geometry alone is measured; on few cores, what a learned model adds as well.
_ONLY = {"damages": {FLOOR, "smooth"}, "cores": {"smooth", "self", MESHLIB}}


def main() -> None:
    """Measure, print the tables, and fill the document."""
    arguments = _arguments()
    arguments.output.mkdir(parents=True, exist_ok=True)
    programs = all_programs(arguments.model or MODELS, arguments.peer_python)
    if arguments.peer_python is None:
        sys.stderr.write("without --peer-python the columns of MeshLib and MeshLab are left out\n")
    share, n_runs = (_QUICK_SHARE, 1) if arguments.quick else (1.0, arguments.runs)
    console = Console()
    for series in all_series(share):
        if arguments.series and series.name not in arguments.series:
            continue
        chosen = _chosen(programs, series.name)
        rows = list(measure_series(series, chosen, n_runs, arguments.limit, arguments.output))
        for table in write_fragment(series, rows, arguments.output):
            console.print(table.to_rich())
    (arguments.output / "machine.md").write_text(machine(n_runs, arguments.peer_python) + "\n", "utf-8")
    if not arguments.quick:
        assemble(arguments.document, {_RUN: arguments.output})


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.performance",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    names = [series.name for series in all_series()]
    parser.add_argument("--peer-python", help="Python of the environment that has the peers")
    parser.add_argument("--quick", action="store_true", help="one run on small scans; leaves the document alone")
    parser.add_argument("--series", action="append", choices=names, help="measure just this; repeat for more")
    parser.add_argument("--model", action="append", help=f"instead of {', '.join(MODELS)}; repeat for more")
    parser.add_argument("--runs", type=int, default=3, help="runs of each program on each scan; medians count")
    parser.add_argument("--limit", type=float, default=1800.0, help="seconds after which a run is given up")
    parser.add_argument("--output", type=Path, default=Path("var/performance"), help="folder for tables and plots")
    parser.add_argument("--document", type=Path, default=DOCUMENT, help="document whose places are filled")
    return parser.parse_args()


def _chosen(programs: Sequence[Program], series: str) -> list[Program]:
    """Return the programs that a series is about."""
    names = _ONLY.get(series)
    return [program for program in programs if names is None or program.name in names]


def machine(n_runs: int, peer_python: str | None) -> str:
    """Say in one sentence where the figures come from."""
    memory_gb = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 2**30
    n_cores = len(os.sched_getaffinity(0))
    text = f"Medians of {n_runs} interleaved runs on {n_cores} cores with {memory_gb:.0f} GiB of memory, "
    text += f"{platform.system()}, Python {platform.python_version()}"
    versions = {name: peer_version(peer_python, name) for name in PEER_PACKAGES} if peer_python else {}
    return text + "".join(f", {name} {version}" for name, version in versions.items() if version) + "."


if __name__ == "__main__":
    main()

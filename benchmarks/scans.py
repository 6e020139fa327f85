"""``python -m benchmarks.scans FOLDER``: raw scans through the repair, judged by what the repaired files show.

Nothing is known of their truth. What counts is that no fill folds or crosses other surface without the report's naming
it, and that each loop is filled or says why not. One table goes to the console; into the output folder go `scans.md`
and `scans.json`, and for each scan and model one line per loop, a sheet before and after, and the widest loops.
"""

import argparse
import csv
import json
import os
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any

from rich.console import Console

from benchmarks.quality.outcome import Outcome, Progress
from benchmarks.quality.tables import Table
from benchmarks.scan_pictures import draw_scan
from benchmarks.surface_faults import find_faults_in_files

MODELS = ("smooth", "self", "general-residual@1")
PATTERN = "*photogrammetry*"
_SUFFIXES = (".ply", ".stl", ".obj", ".off")
_OPEN = ("skipped", "refused")
_COLUMNS = ("scan", "model", "loops", "filled", "by geometry", "folds", "crossings", "CPU s", "peak MB")
_POLL_S = 0.02
# Tables are wide; into a file they go as they are.
_WIDTH = 160


@dataclass(frozen=True)
class Run:
    """One scan and one model, and where its files go."""

    scan: Path
    model: str
    folder: Path

    @property
    def name(self) -> str:
        """Name of the run's files."""
        return f"{self.scan.stem}_{self.model.replace('/', '-')}"

    @property
    def repaired(self) -> Path:
        """The repaired mesh."""
        return self.folder / "repaired" / f"{self.name}{self.scan.suffix}"

    @property
    def report(self) -> Path:
        """The report of the repair."""
        return self.repaired.with_suffix(".json")


def main(arguments: Sequence[str] | None = None) -> None:
    """Read the command line, repair and judge the scans."""
    chosen = _parser().parse_args(arguments)
    scans = sorted(path for path in chosen.folder.glob(chosen.match) if path.suffix.lower() in _SUFFIXES)
    if not scans:
        sys.exit(f"error: there is no mesh {chosen.match} in {chosen.folder}")
    runs = [Run(scan, model, chosen.output) for scan in scans for model in chosen.model or MODELS]
    progress, measured = Progress(len(runs)), []
    for run in runs:
        measured.append(measure(run))
        progress.step(f"{run.name}: {measured[-1]['error'] or _summary(measured[-1])}")
        if not measured[-1]["error"]:
            write_loops(run, measured[-1]["holes"])
            if not chosen.no_pictures:
                draw_scan(run.scan, run.repaired, measured[-1]["holes"], chosen.output / "pictures", run.name)
    console = Console()
    outcome = Outcome("scans", [_faults(measured), _reasons(measured)], {"scans": measured})
    outcome.publish(chosen.output, console if console.is_terminal else Console(width=_WIDTH))


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.scans", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("folder", type=Path, help="folder of scans")
    parser.add_argument("--match", default=PATTERN, help=f"which files of the folder; default {PATTERN}")
    parser.add_argument("--model", action="append", help=f"repeat for more; default {', '.join(MODELS)}")
    parser.add_argument("--output", type=Path, default=Path("var/scans"), help="folder for meshes and results")
    parser.add_argument("--no-pictures", action="store_true", help="draw nothing")
    return parser


def measure(run: Run) -> dict[str, Any]:
    """Repair one scan in a process of its own and judge the result.

    Returns
    -------
    dict
        `error`: what the repair said where it failed, else empty; `cpu_s` and `peak_mb` of the process; `counts` and
        `holes` of the report; `found`: faults by the judge, `named`: folds and crossings by the report.
    """
    run.repaired.parent.mkdir(parents=True, exist_ok=True)
    command = [sys.executable, "-m", "quadpatch", "fill", str(run.scan), "-o", str(run.repaired)]
    command += ["--report", str(run.report), "--model", run.model, "--quiet"]
    error_log = run.report.with_suffix(".err")
    with error_log.open("w") as errors:
        exit_code, cpu_s, peak_mb = _run(command, errors)
    facts: dict[str, Any] = {"scan": run.scan.stem, "model": run.model, "error": "", "cpu_s": cpu_s, "peak_mb": peak_mb}
    if exit_code:
        return {**facts, "error": error_log.read_text().strip() or f"exit code {exit_code}"}
    report = json.loads(run.report.read_text())
    faults = find_faults_in_files(run.scan, run.repaired)
    facts |= {"counts": report["counts"], "holes": report["holes"], "warnings": report["warnings"]}
    facts["found"] = {
        "is_kept": faults.is_kept,
        "folds": faults.n_folds,
        "crossings": faults.n_crossings,
        "doubled": faults.n_doubled,
        "nonmanifold": faults.n_nonmanifold,
        "slivers": faults.n_slivers,
    }
    measures = ("folds", "crossings")
    facts["named"] = {name: int(sum(hole["measures"].get(name, 0) for hole in report["holes"])) for name in measures}
    return facts


def _run(command: Sequence[str], errors: IO[str]) -> tuple[int, float, float]:
    """Run a process to its end; its exit code, CPU seconds, and peak of resident memory in MB."""
    process, peak_kb, pid = subprocess.Popen(command, stderr=errors), 0, 0
    # The peak that the kernel hands over at the end counts this process too, which it was forked from.
    status_file = Path("/proc", str(process.pid), "status")
    while not pid:
        peaks = [line.split()[1] for line in status_file.read_text().splitlines() if line.startswith("VmHWM")]
        peak_kb = max([peak_kb, *map(int, peaks)])
        time.sleep(_POLL_S)
        pid, status, usage = os.wait4(process.pid, os.WNOHANG)
    process.returncode = os.waitstatus_to_exitcode(status)
    return process.returncode, usage.ru_utime + usage.ru_stime, peak_kb / 1024


def write_loops(run: Run, holes: Sequence[dict[str, Any]]) -> Path:
    """Write one line per loop: what it is, and what became of it, as tab-separated values."""
    path = run.folder / f"loops_{run.name}.tsv"
    with path.open("w", newline="") as file:
        rows = csv.writer(file, delimiter="\t")
        rows.writerow(["id", "edges", "diameter", "verdict", "code", "reason", "confidence", "folds", "crossings"])
        for hole in holes:
            confidence = "" if hole["confidence"] is None else f"{hole['confidence']:.2f}"
            facts = [
                hole["id"],
                hole["edges"],
                f"{hole['diameter']:.4g}",
                hole["verdict"],
                hole["code"],
                hole["reason"],
            ]
            rows.writerow(
                [*facts, confidence, *(int(hole["measures"].get(name, 0)) for name in ("folds", "crossings"))]
            )
    return path


def _summary(facts: dict[str, Any]) -> str:
    found = facts["found"]
    return f"{found['folds']} folds, {found['crossings']} crossing triangles in {facts['cpu_s']:.1f} CPU s"


def _faults(measured: Sequence[dict[str, Any]]) -> Table:
    rows = []
    for facts in measured:
        cost = [f"{facts['cpu_s']:.1f}", f"{facts['peak_mb']:.0f}"]
        if facts["error"]:
            rows.append([facts["scan"], facts["model"], "–", facts["error"], "–", "–", "–", *cost])
            continue
        counts, faults_found, reported = facts["counts"], facts["found"], facts["named"]
        faults = [f"{faults_found[name]} ({reported[name]} named)" for name in ("folds", "crossings")]
        closed = [str(counts[name]) for name in ("found", "filled", "filled_smooth")]
        rows.append([facts["scan"], facts["model"], *closed, *faults, *cost])
    return Table("raw scans: faults of the repaired files, and those that the report names", _COLUMNS, rows)


def _reasons(measured: Sequence[dict[str, Any]]) -> Table:
    """Count the loops left open, by verdict and code."""
    found = [(facts, _open(facts.get("holes", []))) for facts in measured]
    codes = sorted({code for _, counts in found for code in counts})
    rows = [[facts["scan"], facts["model"], *(str(counts[code]) for code in codes)] for facts, counts in found]
    return Table("raw scans: loops left open, by reason", ["scan", "model", *(" ".join(code) for code in codes)], rows)


def _open(holes: Sequence[dict[str, Any]]) -> Counter[tuple[str, str]]:
    return Counter((hole["verdict"], str(hole["code"])) for hole in holes if hole["verdict"] in _OPEN)


if __name__ == "__main__":
    main()

"""What is measured: series of scans, each with the programs that it is given to.

Tested in `tests/benchmarks/performance/test_main.py`.
"""

import statistics
import sys
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from benchmarks.performance.processes import Cost, RunFailedError, measure
from benchmarks.performance.programs import Program
from benchmarks.performance.scans import Arrays, dome, long_rim, loose_pieces, three_edge_holes, write_scan

_TRIANGLES = (100_000, 300_000, 1_000_000, 3_000_000, 10_000_000)
_HOLES = (1, 20, 200, 2_000)
_N_HOLES = 20
# Enough of them for two cores to have their parts.
_N_SHARED = 200
# Two thousand holes of this radius have room on a dome.
_RADIUS = 0.014


@dataclass(frozen=True)
class Case:
    """A scan: what it is called in tables, where it stands in plots, and how it is made.

    Attributes
    ----------
    label : str
    x : float
    make : callable
    n_cores : int
        Cores that programs may use; 0 for all.
    """

    label: str
    x: float
    make: Callable[[], Arrays]
    n_cores: int = 0


@dataclass(frozen=True)
class Series:
    """Cases that make up one table.

    Attributes
    ----------
    name : str
    title : str
    head : str
        Of the column of labels.
    unit : str
        What `x` counts; empty where it counts nothing, and no plot is drawn.
    cases : sequence of Case
    """

    name: str
    title: str
    head: str
    unit: str
    cases: Sequence[Case]


@dataclass(frozen=True)
class Row:
    """What the programs cost on one scan: medians, or why one did not do it."""

    case: Case
    n_triangles: int
    costs: dict[str, Cost | str]


def all_series(share: float = 1.0) -> list[Series]:
    """Return the series; `share` makes the scans smaller, for a look at whether everything runs."""
    triangles, holes = [round(n * share) for n in _TRIANGLES], [max(round(n * share), 1) for n in _HOLES]
    middle = round(1_000_000 * share)
    sizes = [Case(f"{n / 1e6:.3g} million", n, partial(dome, n, _N_HOLES)) for n in triangles]
    counts = [Case(f"{n:,}", n, partial(dome, middle, n, _RADIUS)) for n in dict.fromkeys(holes)]
    n_edges, n_slits, n_pieces = (round(n * share) for n in (20_000, 100_000, 1_000_000))
    damages = [
        Case(f"one rim of about {n_edges:,} edges", 0, partial(long_rim, n_edges)),
        Case(f"{n_slits:,} holes of three edges", 0, partial(three_edge_holes, n_slits)),
        Case(f"{n_pieces:,} loose triangles", 0, partial(loose_pieces, n_pieces)),
    ]
    n_shared = round(_N_SHARED * share)
    cores = [Case(f"{n}", n, partial(dome, middle, n_shared, _RADIUS), n) for n in (1, 2)]
    return [
        Series("triangles", f"{_N_HOLES} round holes in a dome", "scan", "triangles", sizes),
        Series("holes", f"round holes in a dome of {middle:,} triangles", "holes", "holes", counts),
        Series("damages", "scans of many damages", "damage", "", damages),
        Series("cores", f"{n_shared} round holes in a dome of {middle:,} triangles, by cores", "cores", "", cores),
    ]


def measure_series(
    series: Series, programs: Sequence[Program], n_runs: int, limit_s: float, folder: Path
) -> Iterable[Row]:
    """Measure every program on every scan; a program that failed on a scan is not run on larger ones of a plot.

    The runs of one scan take turns, so that what else the machine does falls on all of them.
    """
    left_out: dict[str, str] = {}
    for case in series.cases:
        scan = case.make()
        source = folder / "scan.ply"
        write_scan(source, scan)
        found: dict[str, list[Cost]] = {program.name: [] for program in programs}
        failures = dict(left_out)
        sys.stderr.write(f"{series.name}: {case.label}\n")
        for _ in range(n_runs):
            for program in programs:
                if program.name not in failures:
                    try:
                        found[program.name].append(_measure(program, source, limit_s, case.n_cores))
                    except RunFailedError as error:
                        failures[program.name] = str(error)
                        sys.stderr.write(f"{series.name}, {case.label}, {program.name}: {error}\n")
        source.unlink()
        if series.unit:
            left_out = failures
        costs: dict[str, Cost | str] = {
            name: failures[name] if name in failures else median(runs) for name, runs in found.items()
        }
        yield Row(case, len(scan.triangles), costs)


def _measure(program: Program, source: Path, limit_s: float, n_cores: int) -> Cost:
    output = source.with_name("filled.ply")
    try:
        return measure(program.command(source, output), limit_s, n_cores)
    finally:
        output.unlink(missing_ok=True)


def median(runs: Sequence[Cost]) -> Cost:
    """Return the median of each figure."""
    rows = [(run.cpu_s, run.wall_s, run.peak_mb) for run in runs]
    return Cost(*(statistics.median(column) for column in zip(*rows, strict=True)))

"""Errors of whole repairs beside those of the peers, and what the confidences are worth.

Tested in `tests/benchmarks/quality/test_main.py`.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from benchmarks.quality.bench import Bench, Case
from benchmarks.quality.calibration import calibrate
from benchmarks.quality.measurement import Method, measure
from benchmarks.quality.outcome import Outcome, Progress
from benchmarks.quality.plots import calibration_plot, ratio_plot
from benchmarks.quality.results import Results
from benchmarks.quality.tables import NOTHING, Table, figure, geometric_mean, ratio, scientific

REFERENCE = "fair"
PAPER_BASELINE = "meshlab_refine"


@dataclass(frozen=True)
class Row:
    """One mesh at one radius: errors and seconds by method or peer."""

    mesh: str
    radius: str
    errors: dict[str, float]
    seconds: dict[str, float]

    def to(self, reference: str, name: str) -> float | None:
        """Error of one over that of another; None where one was not measured."""
        return ratio(self.errors.get(name), self.errors.get(reference))


def repair_experiment(
    bench: Bench, cases: Sequence[Case], methods: Sequence[Method], results: Results, progress: Progress
) -> Outcome:
    """Repair every case by every method.

    Parameters
    ----------
    bench : Bench
    cases : sequence of Case
        With the figures of their peers.
    methods : sequence of Method
    results : Results
    progress : Progress

    Returns
    -------
    Outcome
        One table of ratios, one of errors and one of seconds for each radius; one of calibration.
    """
    measured: list[dict[str, Any]] = []
    rows = []
    for case in cases:
        found = {}
        for method in methods:
            found[method.name] = measure(bench, case, method, results)
            measured.append({"mesh": case.shape.name, "radius": case.radius, "method": method.name})
            measured[-1] |= found[method.name]
            progress.step(_summary(case, method, found[method.name]))
        rows.append(_row(case, found))
    names = [method.name for method in methods]
    tables, plots = [], {}
    for radius in dict.fromkeys(row.radius for row in rows):
        of_radius = [row for row in rows if row.radius == radius]
        tables += [_ratios(of_radius, names), _errors(of_radius, names), _seconds(of_radius, names)]
        plots[f"ratios_{radius}"] = ratio_plot(
            f"error / {REFERENCE}, hole radius {radius}",
            [row.mesh for row in of_radius],
            {name: [row.to(REFERENCE, name) for row in of_radius] for name in _all_names(of_radius, names)},
        )
    tables.append(_calibration(measured, names))
    holes = {name: [h for m in measured if m["method"] == name for h in m["per_hole"]] for name in names}
    plots["calibration"] = calibration_plot(holes)
    data = {
        "rows": [{"mesh": r.mesh, "radius": r.radius, "errors": r.errors, "seconds": r.seconds} for r in rows],
        "calibration": {name: c.facts() if (c := calibrate(found)) else None for name, found in holes.items()},
        "repairs": measured,
    }
    return Outcome("repair", tables, data, plots)


def _summary(case: Case, method: Method, measured: dict[str, Any]) -> str:
    to_reference = ratio(measured["error"], case.peers.get(REFERENCE, {}).get("error"))
    text = f"{figure(to_reference)} of {REFERENCE} in {measured['seconds']:.1f} s"
    return f"{case.shape.name} {case.radius} {method.name}: {text}"


def _row(case: Case, measured: dict[str, dict[str, Any]]) -> Row:
    figures = {**case.peers, **measured}
    errors = {name: float(figure["error"]) for name, figure in figures.items()}
    seconds = {name: float(f.get("seconds", f.get("fill_seconds", float("nan")))) for name, f in figures.items()}
    return Row(case.shape.name, case.radius, errors, seconds)


def _all_names(rows: Sequence[Row], methods: Sequence[str]) -> list[str]:
    """Ours, then all peers of any row but the reference."""
    peers = dict.fromkeys(name for row in rows for name in row.errors if name not in methods)
    return [*methods, *(name for name in peers if name != REFERENCE)]


def _ratios(rows: Sequence[Row], methods: Sequence[str]) -> Table:
    names = _all_names(rows, methods)
    body = [[row.mesh, *(figure(row.to(REFERENCE, name)) for name in names)] for row in rows]
    means = [["geometric mean", *(figure(geometric_mean(r.to(REFERENCE, n) for r in rows)) for n in names)]]
    means += [["worst", *(figure(_worst([row.to(REFERENCE, name) for row in rows])) for name in names)]]
    means += [[f"to {PAPER_BASELINE}", *(figure(geometric_mean(r.to(PAPER_BASELINE, n) for r in rows)) for n in names)]]
    return Table(f"error / {REFERENCE}, hole radius {rows[0].radius}", ["mesh", *names], [*body, *means], 3)


def _worst(ratios: Sequence[float | None]) -> float | None:
    return max((value for value in ratios if value is not None), default=None)


def _errors(rows: Sequence[Row], methods: Sequence[str]) -> Table:
    names = [*_all_names(rows, methods), REFERENCE]
    body = [[row.mesh, *(scientific(row.errors.get(name)) for name in names)] for row in rows]
    return Table(f"error, millionths of the object's size, hole radius {rows[0].radius}", ["mesh", *names], body)


def _seconds(rows: Sequence[Row], methods: Sequence[str]) -> Table:
    body = [[row.mesh, *(figure(row.seconds[name], 1) for name in methods)] for row in rows]
    mean = ["mean", *(figure(sum(row.seconds[name] for row in rows) / len(rows), 1) for name in methods)]
    return Table(f"seconds of the repair, hole radius {rows[0].radius}", ["mesh", *methods], [*body, mean], 1)


def _calibration(measured: Sequence[dict[str, Any]], methods: Sequence[str]) -> Table:
    rows = []
    for method in methods:
        of_method = [m for m in measured if m["method"] == method]
        for radius in (*dict.fromkeys(m["radius"] for m in of_method), "all"):
            found = calibrate([h for m in of_method if radius in (m["radius"], "all") for h in m["per_hole"]])
            cells = [NOTHING] * 4
            if found:
                cells = [str(found.n_holes), figure(found.rank_correlation, 2), figure(found.tenth_ratio, 1)]
                cells.append(figure(found.true_per_expected, 2))
            rows.append([method, radius, *cells])
    columns = ["method", "radius", "holes", "rank correlation", "least confident tenth / rest", "true / expected"]
    return Table("confidence: expected against true error of every hole", columns, rows)

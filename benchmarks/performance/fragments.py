"""Tables and plots of measured series, as Markdown for a document.

Tested in `tests/benchmarks/performance/test_main.py`.
"""

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from benchmarks.performance.processes import Cost
from benchmarks.performance.programs import FLOOR, MESHLIB
from benchmarks.performance.series import Row, Series
from benchmarks.quality.tables import NOTHING, Table

_FIGURES: tuple[tuple[str, Callable[[Cost], float]], ...] = (
    ("CPU seconds", lambda cost: cost.cpu_s),
    ("wall seconds", lambda cost: cost.wall_s),
    ("peak memory in MiB", lambda cost: cost.peak_mb),
)


def write_fragment(series: Series, rows: Sequence[Row], folder: Path) -> list[Table]:
    """Write the Markdown of a series, and its plot where it has one; return its tables."""
    tables = [_table(f"{title}, {series.title}", series.head, value, rows) for title, value in _FIGURES]
    text = "\n\n".join(table.to_markdown() for table in tables)
    if series.unit and len(rows) > 1:
        name = f"{series.name}.png"
        _plot(series, rows).savefig(folder / name, dpi=110)
        text += f"\n\n![seconds and memory by {series.unit}]({name})"
    (folder / f"{series.name}.md").write_text(text + "\n", "utf-8")
    return tables


def _table(title: str, head: str, value: Callable[[Cost], float], rows: Sequence[Row]) -> Table:
    """One column for each program, then those of ours over MeshLib's."""
    names = list(rows[0].costs)
    compared = [name for name in names if name.islower() and name != FLOOR] if MESHLIB in names else []
    cells = []
    for row in rows:
        values = {name: value(cost) for name, cost in row.costs.items() if isinstance(cost, Cost)}
        ratios = [_ratio(values.get(name), values.get(MESHLIB)) for name in compared]
        cells.append([row.case.label, f"{row.n_triangles:,}", *(_number(values.get(name)) for name in names), *ratios])
    return Table(title, [head, "triangles", *names, *(f"{name} / {MESHLIB}" for name in compared)], cells)


def _ratio(ours: float | None, theirs: float | None) -> str:
    return f"{ours / theirs:.2f}" if ours is not None and theirs else NOTHING


def _number(value: float | None) -> str:
    if value is None:
        return NOTHING
    return f"{value:,.0f}" if value >= 100 else f"{value:.2f}"


def _plot(series: Series, rows: Sequence[Row]) -> Figure:
    """CPU seconds and memory over the scan, logarithmic both; the floor is the dashed line."""
    figure = Figure(figsize=(10.0, 4.6), layout="constrained")
    for k, (title, value) in enumerate((_FIGURES[0], _FIGURES[2])):
        axes = figure.add_subplot(1, 2, k + 1)
        for name in rows[0].costs:
            costs = [row.costs[name] for row in rows]
            heights = [value(cost) if isinstance(cost, Cost) else np.nan for cost in costs]
            style = {"color": "black", "linestyle": "--"} if name == FLOOR else {"marker": "o"}
            axes.loglog([row.case.x for row in rows], heights, label=name if k == 0 else None, **style)
        axes.set_xlabel(series.unit)
        axes.set_title(title)
        axes.grid(visible=True, which="major", alpha=0.3)
    figure.legend(loc="outside lower center", ncols=6, fontsize="small")
    return figure

"""Plots, drawn without a display."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from quadpatch.sparse.dictionary import Dictionary

_WIDTH, _HEIGHT = 9.0, 4.6
_MOST_RATIO = 2.5
# Of atoms: their side in inches, and how many stand in a row.
_ATOM, _ATOMS_IN_ROW = 0.62, 20


def ratio_plot(title: str, meshes: Sequence[str], series: Mapping[str, Sequence[float | None]]) -> Figure:
    """Draw one group of bars for each mesh, one bar for each method; the line at 1 is the reference."""
    figure = Figure(figsize=(_WIDTH, _HEIGHT), layout="constrained")
    axes = figure.add_subplot()
    width = 0.8 / max(len(series), 1)
    places = np.arange(len(meshes))
    for k, (name, values) in enumerate(series.items()):
        heights = [np.nan if value is None else value for value in values]
        axes.bar(places + (k + 0.5) * width - 0.4, heights, width, label=name)
    axes.axhline(1.0, color="black", linewidth=0.8)
    axes.set_xticks(places, meshes, rotation=30, ha="right")
    # Beyond that it is enough to know that a bar leaves the picture.
    axes.set_ylim(0, _MOST_RATIO)
    axes.set_title(title)
    figure.legend(loc="outside lower center", ncols=5, fontsize="small")
    return figure


def calibration_plot(holes: Mapping[str, Sequence[dict[str, Any]]]) -> Figure:
    """Draw true over expected error of every hole, one panel for each method; on the line they agree."""
    figure = Figure(figsize=(4.0 * max(len(holes), 1), 4.2), layout="constrained")
    for k, (name, method_holes) in enumerate(holes.items()):
        axes = figure.add_subplot(1, len(holes), k + 1)
        # A missing expectation becomes a NaN, which no comparison holds for.
        expected = np.array([hole["expected_error"] for hole in method_holes], dtype=np.float64)
        true = np.array([hole["true_error"] for hole in method_holes], dtype=np.float64)
        is_shown = (expected > 0) & (true > 0)
        axes.loglog(expected[is_shown], true[is_shown], ".", markersize=2, alpha=0.5)
        if is_shown.any():
            ends = [
                min(expected[is_shown].min(), true[is_shown].min()),
                max(expected[is_shown].max(), true[is_shown].max()),
            ]
            axes.loglog(ends, ends, color="black", linewidth=0.8)
        axes.set_xlabel("expected error")
        axes.set_ylabel("true error")
        axes.set_title(f"{name}, {len(method_holes)} holes")
    return figure


def curve_plot(
    title: str, labels: tuple[str, str], x: Sequence[float], series: Mapping[str, Sequence[float | None]]
) -> Figure:
    """Draw one line for each name through its values at x, with gaps for None; `labels` are those of the axes."""
    figure = Figure(figsize=(_WIDTH, _HEIGHT), layout="constrained")
    axes = figure.add_subplot()
    for name, values in series.items():
        heights = [np.nan if value is None else value for value in values]
        axes.plot(list(x), heights, marker="o", markersize=3, label=name)
    axes.set_xlabel(labels[0])
    axes.set_ylabel(labels[1])
    axes.set_title(title)
    axes.grid(alpha=0.3)
    axes.legend(fontsize="small", ncols=2)
    return figure


def labelled_plot(
    title: str, labels: tuple[str, str], points: Mapping[str, tuple[float, float]], lines: Mapping[str, float]
) -> Figure:
    """Draw named points over a logarithmic axis, and values to compare them with as lines across."""
    figure = Figure(figsize=(_WIDTH, _HEIGHT), layout="constrained")
    axes = figure.add_subplot()
    for name, (x, y) in points.items():
        axes.semilogx([x], [y], marker="o", color="tab:blue")
        axes.annotate(name, (x, y), xytext=(5, 5), textcoords="offset points", fontsize="small")
    for k, (name, y) in enumerate(lines.items()):
        axes.axhline(y, color=f"C{k + 1}", linewidth=0.8, linestyle="--", label=name)
    axes.set_xlabel(labels[0])
    axes.set_ylabel(labels[1])
    axes.set_title(title, fontsize="medium")
    axes.margins(x=0.15)
    axes.grid(alpha=0.3)
    axes.legend(fontsize="small")
    return figure


def atoms_plot(title: str, dictionary: Dictionary) -> Figure:
    """Draw the atoms of a dictionary as height maps, smooth ones first; grey is zero, each has its own scale.

    Smooth is what differs little from one bin to the next.
    """
    n = dictionary.resolution
    maps = dictionary.atoms.T.reshape(-1, n, n)
    roughness = (np.diff(maps, axis=1) ** 2).sum(axis=(1, 2)) + (np.diff(maps, axis=2) ** 2).sum(axis=(1, 2))
    n_rows = -(-len(maps) // _ATOMS_IN_ROW)
    figure = Figure(figsize=(_ATOM * _ATOMS_IN_ROW, _ATOM * n_rows + 0.4), layout="constrained")
    figure.suptitle(title)
    grid = figure.subplots(n_rows, _ATOMS_IN_ROW, squeeze=False).ravel()
    for axes in grid:
        axes.set_axis_off()
    for axes, atom in zip(grid, maps[np.argsort(roughness, kind="stable")], strict=False):
        most = np.abs(atom).max()
        axes.imshow(atom, cmap="gray", vmin=-most, vmax=most, interpolation="nearest")
    return figure

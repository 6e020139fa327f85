"""The paper's experiments: which dictionary, how many atoms, how large a patch, how many shapes to learn from.

All dictionaries are those of the recipe `paper`. Errors are those of the bench, after the holes were filled.

Tested in `tests/benchmarks/quality/test_network_experiment.py`.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from benchmarks.quality.bench import Bench, Case, Shape
from benchmarks.quality.measurement import Method, measure
from benchmarks.quality.outcome import Outcome, Progress
from benchmarks.quality.paper_dictionaries import Learner
from benchmarks.quality.plots import curve_plot, ratio_plot
from benchmarks.quality.results import Results
from benchmarks.quality.tables import Table, figure, geometric_mean, ratio, scientific

ATOMS = (5, 10, 25, 50, 100, 200, 500)
# Diameter of the holes over side of the patches.
# At 0.8 patches have the paper's length, 0.062, for holes of radius 0.025.
HOLE_TO_PATCH = (0.2, 0.3, 0.4, 0.55, 0.8, 0.9)
N_SHAPES = (1, 2, 4, 8)
# Shapes to measure on while others are learned from, unless others are named: smooth, patterned, detailed.
HELD_OUT = ("igea", "relief_gyroid", "boot_tread")
# How many of the paper's dictionaries are compared.
N_DICTIONARIES = 4
# Starts the order in which shapes are added to those learned from.
ORDER_SEED = 0

# A figure for each place on the axis; None where nothing could be measured.
Series = dict[str, list[float | None]]

FAIR = "fair"
MESHLAB = "meshlab_refine"


@dataclass(frozen=True)
class Paper:
    """What the experiments have in common."""

    bench: Bench
    results: Results
    learner: Learner
    progress: Progress

    def to_fair(self, case: Case, method: Method | None) -> float | None:
        """Error over that of `fair`."""
        return ratio(self.error(case, method), float(case.peers[FAIR]["error"]))

    def error(self, case: Case, method: Method | None) -> float | None:
        """Repair and measure, or take what was kept; None without a method."""
        if method is None:
            self.progress.step(f"{case.shape.name} {case.radius}: too few patches to learn from")
            return None
        error = float(measure(self.bench, case, method, self.results)["error"])
        to_fair = figure(ratio(error, case.peers.get(FAIR, {}).get("error")))
        self.progress.step(f"{case.shape.name} {case.radius} {method.name}: {to_fair} of {FAIR}")
        return error


def dictionaries_experiment(
    paper: Paper, cases: Sequence[Case], every: Sequence[Shape], own_methods: Sequence[Method]
) -> Outcome:
    """Compare local, global, leave-one-out and self-similar dictionaries, and our methods with the default recipe.

    Parameters
    ----------
    paper : Paper
    cases : sequence of Case
    every : sequence of Shape
        What the global dictionaries are learned from.
    own_methods : sequence of Method
    """
    tables, plots, data = [], {}, []
    for radius in dict.fromkeys(case.radius for case in cases):
        of_radius = [case for case in cases if case.radius == radius]
        scale = paper.learner.scale(every, radius)
        rows = {case.shape.name: _row(paper, case, every, own_methods) for case in of_radius}
        fair = {case.shape.name: case.peers[FAIR]["error"] for case in of_radius}
        names = [*next(iter(rows.values())), MESHLAB]
        for case in of_radius:
            rows[case.shape.name][MESHLAB] = float(case.peers[MESHLAB]["error"])
        ratios = {name: [ratio(rows[mesh][name], fair[mesh]) for mesh in rows] for name in names}
        body = [[mesh, *(figure(ratios[name][i]) for name in names)] for i, mesh in enumerate(rows)]
        body.append(["geometric mean", *(figure(geometric_mean(ratios[name])) for name in names)])
        title = f"error / {FAIR}, hole radius {radius}, patch length {scale.length:.3g} of the recipe paper"
        tables += [Table(title, ["mesh", *names], body, 1), _to_closing(radius, rows, names)]
        plots[f"ratios_{radius}"] = ratio_plot(title, list(rows), ratios)
        data += [{"mesh": mesh, "radius": radius, "length": scale.length, "errors": rows[mesh]} for mesh in rows]
    return Outcome("dictionaries", tables, {"rows": data}, plots)


def _to_closing(radius: str, rows: Mapping[str, dict[str, float | None]], names: Sequence[str]) -> Table:
    """Compare with MeshLab's closing, as the paper does."""
    names = [name for name in names if name != MESHLAB]
    ratios = {name: [ratio(row[name], row[MESHLAB]) for row in rows.values()] for name in names}
    body = [[mesh, *(figure(ratios[name][i]) for name in names)] for i, mesh in enumerate(rows)]
    body.append(["geometric mean", *(figure(geometric_mean(ratios[name])) for name in names)])
    return Table(f"error / that of MeshLab's closing, hole radius {radius}", ["mesh", *names], body, 1)


def _row(paper: Paper, case: Case, every: Sequence[Shape], own_methods: Sequence[Method]) -> dict[str, float | None]:
    learner, shape = paper.learner, case.shape
    scale = learner.scale(every, case.radius)
    others = [other for other in every if other.name != shape.name]
    methods = {
        "paper local": learner.local(shape, scale),
        "paper global": learner.many("global", every, scale),
        "paper leave-one-out": learner.many(f"without-{shape.name}", others, scale),
        "paper self-similar": learner.self_similar(scale),
        **{f"ours {method.name}": method for method in own_methods},
    }
    return {name: paper.error(case, method) for name, method in methods.items()}


def atoms_experiment(paper: Paper, cases: Sequence[Case], every: Sequence[Shape]) -> Outcome:
    """Measure filling and plain coding against the number of atoms of a local dictionary."""
    filled: Series = {case.shape.name: [] for case in cases}
    coded: Series = {case.shape.name: [] for case in cases}
    for case in cases:
        scale = paper.learner.scale(every, case.radius)
        for n_atoms in ATOMS:
            method = paper.learner.local(case.shape, scale, n_atoms)
            filled[case.shape.name].append(paper.to_fair(case, method))
            coding = paper.learner.coding_error(case.shape, scale, method) if method else None
            coded[case.shape.name].append(coding)
    radius = cases[0].radius
    tables = [
        curve_table(f"error / {FAIR} by atoms, local dictionary, hole radius {radius}", ATOMS, filled, figure),
        curve_table("error of coding whole patches by atoms, millionths", ATOMS, coded, scientific),
    ]
    plots = {
        "filling": curve_plot(tables[0].title, ("atoms", f"error / {FAIR}"), ATOMS, filled),
        "coding": curve_plot(tables[1].title, ("atoms", "error"), ATOMS, coded),
    }
    return Outcome("atoms", tables, {"atoms": list(ATOMS), "filling": filled, "coding": coded}, plots)


def patch_length_experiment(paper: Paper, cases: Sequence[Case], own_methods: Sequence[Method]) -> Outcome:
    """Measure against the ratio of hole to patch: local dictionaries of the paper, our methods with set patches."""
    by_name: dict[str, Series] = {}
    for case in cases:
        for share in HOLE_TO_PATCH:
            scale = paper.learner.scale([case.shape], case.radius, share)
            methods: dict[str, Method | None] = {"paper local": paper.learner.local(case.shape, scale)}
            for method in own_methods:
                options = {"patches": {"length": scale.length}}
                methods[f"ours {method.name}"] = Method(f"{method.name}_{scale.length:.4g}", method.model, options)
            for name, chosen in methods.items():
                by_name.setdefault(name, {}).setdefault(case.shape.name, []).append(paper.to_fair(case, chosen))
    tables, plots = [], {}
    for name, series in by_name.items():
        title = f"{name}: error / {FAIR} by hole diameter / patch length, hole radius {cases[0].radius}"
        tables.append(curve_table(title, HOLE_TO_PATCH, series, figure))
        labels = "hole diameter / patch length", f"error / {FAIR}"
        plots[name.replace(" ", "_")] = curve_plot(title, labels, HOLE_TO_PATCH, series)
    return Outcome("patch_length", tables, {"hole_to_patch": list(HOLE_TO_PATCH), "ratios": by_name}, plots)


def shapes_experiment(paper: Paper, cases: Sequence[Case], every: Sequence[Shape]) -> Outcome:
    """Measure on some shapes against the number of others that were learned from; each set holds the smaller ones."""
    tested = {case.shape.name for case in cases}
    rest = [shape for shape in every if shape.name not in tested]
    order = np.random.default_rng(ORDER_SEED).permutation(len(rest)).tolist()
    counts = sorted({min(count, len(rest)) for count in N_SHAPES})
    series: Series = {case.shape.name: [] for case in cases}
    for count in counts:
        sources = [rest[i] for i in order[:count]]
        scale = paper.learner.scale(every, cases[0].radius)
        method = paper.learner.many(f"of-{count}-shapes", sources, scale)
        for case in cases:
            series[case.shape.name].append(paper.to_fair(case, method))
    title = f"error / {FAIR} by number of training shapes, hole radius {cases[0].radius}"
    table = curve_table(title, counts, series, figure)
    plot = curve_plot(title, ("training shapes", f"error / {FAIR}"), counts, series)
    data = {"shapes": counts, "order": [rest[i].name for i in order], "ratios": series}
    return Outcome("shapes", [table], data, {"curve": plot})


def curve_table(title: str, x: Sequence[float], series: Series, write: Callable[[float | None], str]) -> Table:
    """Tabulate one row of values at x for each name, and their geometric means."""
    body = [[name, *(write(value) for value in values)] for name, values in series.items()]
    mean = ["geometric mean", *(write(geometric_mean(values)) for values in zip(*series.values(), strict=True))]
    return Table(title, ["", *(f"{value:g}" for value in x)], [*body, mean], 1)

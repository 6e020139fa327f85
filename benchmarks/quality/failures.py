"""Where the recipe of the paper fails: for every mesh the worst hole of its local dictionary, by true error."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from benchmarks.quality.bench import Case, Shape
from benchmarks.quality.measurement import Method, measure, repaired_path
from benchmarks.quality.outcome import Outcome
from benchmarks.quality.paper_experiments import Paper
from benchmarks.quality.pictures import REPAIRED, DrawnCase, percent_of_radius
from benchmarks.quality.sheets import Row, compose
from benchmarks.quality.tables import NOTHING, Table, figure


def failures_experiment(paper: Paper, cases: Sequence[Case], every: Sequence[Shape]) -> Outcome:
    """Draw the worst hole of each case on one sheet, and say how wrong it is.

    Parameters
    ----------
    paper : Paper
    cases : sequence of Case
        At least one; all of one radius.
    every : sequence of Shape
        What the patch length is chosen for, as in the experiment `dictionaries`.
    """
    body, rows, data = [], [], []
    for case in cases:
        method = paper.learner.local(case.shape, paper.learner.scale(every, case.radius))
        paper.error(case, method)
        holes = measure(paper.bench, case, method, paper.results)["per_hole"] if method else []
        if method is None or not holes:
            body.append([case.shape.name, *[NOTHING] * 5])
            continue
        worst = max(holes, key=lambda hole: float(hole["true_error"]))
        middle = float(np.median([percent_of_radius(case, hole) for hole in holes]))
        percent = percent_of_radius(case, worst)
        verdict = [str(worst["verdict"]), str(worst["code"] or NOTHING)]
        body.append([case.shape.name, str(len(holes)), figure(middle, 1), figure(percent, 1), *verdict])
        data.append({"mesh": case.shape.name, "radius": case.radius, "median_percent": middle, "hole": worst})
        caption = f"{case.shape.name}, hole {worst['id']}: error {percent:.1f} % of the hole's radius"
        caption += f" (median of its {len(holes)} holes {middle:.1f} %), verdict {worst['code'] or worst['verdict']}"
        rows += _drawn(paper, case, method, worst, caption)
    title = f"worst hole of each mesh, recipe paper, local dictionary, hole radius {cases[0].radius}"
    columns = ["mesh", "holes", "median error, % of the radius", "worst error, % of the radius", "verdict", "code"]
    plots = {"worst_holes": compose(rows)} if rows else {}
    return Outcome("failures", [Table(title, columns, body)], {"worst": data}, plots)


def _drawn(paper: Paper, case: Case, method: Method, hole: Mapping[str, Any], caption: str) -> list[Row]:
    """Draw one hole; nothing where the result was kept, but the repaired mesh was not."""
    repaired = repaired_path(case, method)
    if not repaired.is_file():
        return []
    drawn = DrawnCase.of(paper.bench, case, {REPAIRED: repaired})
    return [Row(caption, drawn.tiles(np.array(hole["centre"])))]

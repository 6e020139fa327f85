"""Judging every hole: how much of it was learned, how sure that is, and what to call it.

Confidence is ``exp(-10 e / d)`` with e the expected mean error of the fill and d the hole's diameter: a fill off by a
hundredth of the hole's width has 0.9, one off by a tenth has 0.37.
"""

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from quadpatch.expectation import Expectation
from quadpatch.filling.fill import FilledMesh
from quadpatch.mesh.holes import Hole, Selection
from quadpatch.reconstruction.displacement import Displacement
from quadpatch.types import BoolArray, FloatArray, IntArray

if TYPE_CHECKING:
    from quadpatch.completion import Completion

# A hole is completed by the model only where its patches see at least this share of the new vertices.
LEAST_COVERAGE = 0.6

# Patches of a hole that differ by more than this share of what they say contradict each other.
MOST_DISAGREEMENT = 1.5

FALL_PER_ERROR = 10.0


@dataclass(frozen=True)
class HoleResult:
    """What became of one hole. Lengths in mesh units.

    Attributes
    ----------
    verdict : str
        `filled` by the model, `filled_smooth` by geometry alone, `skipped` by rule, `refused` as impossible.
    code, reason : str
        Why, for programs and for people; empty for `filled`.
    confidence : float or None
        0..1; None where nothing was filled.
    expected_error : float or None
        Expected mean distance of the fill to the true surface.
    measures : dict
        What the verdict rests on.
    """

    hole: Hole
    verdict: str
    code: str = ""
    reason: str = ""
    confidence: float | None = None
    expected_error: float | None = None
    n_new_vertices: int = 0
    n_new_triangles: int = 0
    measures: dict[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Evidence:
    """What the patches said about every hole, (n_holes,) float64 each, by position in the list of loops.

    Attributes
    ----------
    coverage : share of the hole's new vertices that a patch sees
    spread : mean standard deviation between patches, mesh units
    departure : mean length of the displacement, mesh units
    rim_misfit : mean error of the model at the rim, where the truth is known, mesh units
    """

    coverage: FloatArray
    spread: FloatArray
    departure: FloatArray
    rim_misfit: FloatArray


def gather(
    filled: FilledMesh, inside: Displacement, joined: FloatArray, rim_hole: IntArray, at_rim: Displacement
) -> Evidence:
    """Collect the evidence of all holes from the displacements inside them and at their rims."""
    hole, n_holes = filled.vertex_hole, len(filled.gap)
    covered = (inside.overlap > 0).astype(np.float64)
    return Evidence(
        _mean_by(hole, covered, n_holes),
        _mean_by(hole, inside.spread, n_holes),
        _mean_by(hole, np.linalg.norm(joined, axis=1), n_holes),
        _mean_by(rim_hole, np.linalg.norm(at_rim.mean, axis=1), n_holes),
    )


def trusted(evidence: Evidence) -> BoolArray:
    """Which holes (n_holes,) the model may complete."""
    disagreement = evidence.spread / np.maximum(evidence.departure + evidence.rim_misfit, 1e-300)
    trust: BoolArray = (evidence.coverage >= LEAST_COVERAGE) & (disagreement <= MOST_DISAGREEMENT)
    return trust


def judge(
    holes: list[Hole],
    selection: Selection,
    filled: FilledMesh,
    completion: "Completion | None",
    expectation: Expectation,
) -> list[HoleResult]:
    """Say of every hole what became of it, in the order of their ids."""
    position = {hole.id: i for i, hole in enumerate(selection.chosen)}
    n_vertices = np.bincount(filled.vertex_hole, minlength=len(position))
    n_triangles = np.bincount(filled.triangle_hole, minlength=len(position))
    expected_errors = expectation.errors(filled, [hole.diameter for hole in selection.chosen])
    results = []
    for hole in holes:
        if hole.id in selection.skipped:
            results.append(HoleResult(hole, "skipped", *selection.skipped[hole.id]))
            continue
        i = position[hole.id]
        if i in filled.unfilled:
            why = "every triangulation of the rim would give an existing edge a third face"
            results.append(HoleResult(hole, "refused", "no_triangulation", why))
            continue
        expected = float(expected_errors[i])
        verdict, code, reason = _verdict(i, int(n_vertices[i]), completion)
        results.append(
            HoleResult(
                hole,
                verdict,
                code,
                reason,
                confidence(expected, hole.diameter),
                expected,
                int(n_vertices[i]),
                int(n_triangles[i]),
                _measures(i, filled, completion),
            )
        )
    return results


def _verdict(i: int, n_new_vertices: int, completion: "Completion | None") -> tuple[str, str, str]:
    if completion is None:
        return "filled_smooth", "geometry", "no learned model took part"
    if completion.trust[i]:
        return "filled", "", ""
    coverage = completion.evidence.coverage[i] if completion.evidence else 0.0
    reasons = (
        (not n_new_vertices, "no_new_vertex", "so small that its rim alone spans it: there is nothing to displace"),
        (completion.expectation is None, "no_practice", "too little undamaged surface to try the model on"),
        (completion.believed == 0, "no_gain", "practice on this mesh showed no gain over the geometric fill"),
        (
            coverage < LEAST_COVERAGE,
            "no_height_map",
            f"patches see only {100 * coverage:.0f} % of the hole: the surface is folded there",
        ),
        (True, "patches_disagree", "overlapping patches contradict each other"),
    )
    return next(("filled_smooth", code, reason) for applies, code, reason in reasons if applies)


def _measures(i: int, filled: FilledMesh, completion: "Completion | None") -> dict[str, float]:
    measures = {"gap": float(filled.gap[i]), "rim_turn": float(filled.rim_turn[i])}
    if completion is not None and completion.evidence is not None:
        for name in ("coverage", "spread", "departure", "rim_misfit"):
            measures[name] = float(getattr(completion.evidence, name)[i])
    return measures


def confidence(expected_error: float, diameter: float) -> float:
    """See the module's head."""
    return float(np.exp(-FALL_PER_ERROR * expected_error / diameter)) if diameter > 0 else 0.0


def _mean_by(group: IntArray, values: FloatArray, n_groups: int) -> FloatArray:
    total = np.bincount(group, values, minlength=n_groups)
    mean: FloatArray = total / np.maximum(np.bincount(group, minlength=n_groups), 1)
    return mean

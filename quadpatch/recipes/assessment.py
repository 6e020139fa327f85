"""Assessment of every hole: how much of it was learned, how sure that is, and what to call it.

Confidence is ``exp(-e / (0.003 D))`` with e the expected mean error of the fill and D the diagonal of the bounding box
of what was measured: a fill off by 0.03 % of the diagonal has 0.90, one off by 0.3 % has 0.37. It goes by the object's
size, not the hole's, so that it tells which holes of a part to distrust.
"""

import numpy as np

from quadpatch.calibration.error_model import ErrorModel
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.mesh.averages import mean_by
from quadpatch.mesh.holes import Hole, Selection
from quadpatch.recipes.result import Completion, HoleResult, PatchAgreement
from quadpatch.reconstruction.displacement import Displacement
from quadpatch.types import BoolArray, FloatArray, IntArray

# A hole is completed by the model only where its patches see at least this share of the new vertices.
LEAST_COVERAGE = 0.6

# Patches of a hole that differ by more than this share of what they say contradict each other.
MOST_INCONSISTENCY = 1.5

# An expected error of this share of the object's diagonal leaves a confidence of 0.37.
DOUBTFUL_SHARE = 0.003


def measure_agreement(
    filled: FilledMesh, inside: Displacement, joined: FloatArray, rim_hole: IntArray, at_rim: Displacement
) -> PatchAgreement:
    """Measure for all holes how far their patches agree, from the displacements inside them and at their rims."""
    hole, n_holes = filled.vertex_hole, len(filled.disagreement)
    covered = (inside.overlap > 0).astype(np.float64)
    return PatchAgreement(
        mean_by(hole, covered, n_holes),
        mean_by(hole, inside.deviation, n_holes),
        mean_by(hole, np.linalg.norm(joined, axis=1), n_holes),
        mean_by(rim_hole, np.linalg.norm(at_rim.mean, axis=1), n_holes),
    )


def agreeing_holes(agreement: PatchAgreement) -> BoolArray:
    """Say which holes (n_holes,) the model may complete."""
    inconsistency = agreement.deviation / np.maximum(agreement.departure + agreement.rim_misfit, 1e-300)
    displaced_holes: BoolArray = (agreement.coverage >= LEAST_COVERAGE) & (inconsistency <= MOST_INCONSISTENCY)
    return displaced_holes


def assess(
    holes: list[Hole],
    selection: Selection,
    filled: FilledMesh,
    completion: Completion | None,
    error_model: ErrorModel,
    size: float,
) -> list[HoleResult]:
    """Say of every hole what became of it, in the order of their ids; `size` is the object's diagonal."""
    expected_errors = error_model.errors(filled, selection.widths).tolist()
    gaps, turns = filled.disagreement.tolist(), filled.rim_variation.tolist()
    closed = []
    for i, (hole, n_vertices, n_triangles) in enumerate(zip(selection.chosen, *count_new(filled), strict=True)):
        verdict, code, reason = _verdict(i, n_vertices, completion)
        closed.append(
            HoleResult(
                hole,
                verdict,
                code,
                reason,
                confidence(expected_errors[i], size),
                expected_errors[i],
                n_vertices,
                n_triangles,
                {"gap": gaps[i], "rim_turn": turns[i], **agreement_of(i, completion)},
            )
        )
    return with_open_holes(closed, holes, selection, filled)


def with_open_holes(
    closed: list[HoleResult], holes: list[Hole], selection: Selection, filled: FilledMesh
) -> list[HoleResult]:
    """Bring results into the order of all holes' ids, and say of those that stayed open why.

    Parameters
    ----------
    closed : list of HoleResult
        One for each chosen hole, as if all of them had been closed.
    holes : list of Hole
        All of them, by id.
    selection : Selection
    filled : FilledMesh
        Knows the chosen holes that could not be closed.
    """
    results = {result.hole.id: result for result in closed}
    for hole in (selection.chosen[i] for i in filled.unfilled):
        why = "every triangulation of the rim would give an existing edge a third face"
        results[hole.id] = HoleResult(hole, "refused", "no_triangulation", why)
    skipped = selection.skipped
    return [
        HoleResult(hole, "skipped", *skipped[hole.id]) if hole.id in skipped else results[hole.id] for hole in holes
    ]


def count_new(filled: FilledMesh) -> tuple[list[int], list[int]]:
    """Count the new vertices and the new triangles of every chosen hole."""
    n_holes = len(filled.disagreement)
    n_vertices, n_triangles = (
        np.bincount(hole, minlength=n_holes).tolist() for hole in (filled.vertex_hole, filled.triangle_hole)
    )
    return n_vertices, n_triangles


def agreement_of(i: int, completion: Completion | None) -> dict[str, float]:
    """Name what the patches said about one hole; nothing where none were asked."""
    if completion is None or completion.agreement is None:
        return {}
    agreement = completion.agreement
    return {
        "coverage": float(agreement.coverage[i]),
        "spread": float(agreement.deviation[i]),
        "departure": float(agreement.departure[i]),
        "rim_misfit": float(agreement.rim_misfit[i]),
    }


def _verdict(i: int, n_new_vertices: int, completion: Completion | None) -> tuple[str, str, str]:
    if completion is None:
        return "filled_smooth", "geometry", "no learned model took part"
    if completion.displaced_holes[i]:
        return "filled", "", ""
    coverage = completion.agreement.coverage[i] if completion.agreement else 0.0
    undone = completion.undone is not None and bool(completion.undone[i])
    left_out = completion.left_out is not None and bool(completion.left_out[i])
    reasons = (
        (left_out, "geometry", "a rule asks for geometry alone"),
        (undone, "model_faulty", "displaced by the model, the fill folds or runs through other surface: it was undone"),
        (not n_new_vertices, "no_new_vertex", "so small that its rim alone spans it: there is nothing to displace"),
        (completion.error_model is None, "no_practice", "too little undamaged surface to try the model on"),
        (
            completion.blend_factor == 0,
            "no_gain",
            "on calibration holes the model gained nothing over the geometric fill",
        ),
        (
            coverage < LEAST_COVERAGE,
            "no_height_map",
            f"patches see only {100 * coverage:.0f} % of the hole: the surface is folded there",
        ),
        (True, "patches_disagree", "overlapping patches contradict each other"),
    )
    return next(("filled_smooth", code, reason) for applies, code, reason in reasons if applies)


def confidence(expected_error: float, size: float) -> float:
    """Turn an expected error into a confidence, 0..1, as the module's head says.

    Parameters
    ----------
    expected_error : float
        In mesh units.
    size : float
        Diagonal of the object's bounding box, in mesh units; 0 gives no confidence.
    """
    return float(np.exp(-expected_error / (DOUBTFUL_SHARE * size))) if size > 0 else 0.0

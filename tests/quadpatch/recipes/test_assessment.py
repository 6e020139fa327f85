from dataclasses import dataclass
from typing import Any, cast

import numpy as np
import pytest

from quadpatch.calibration.error_model import ErrorModel
from quadpatch.filling.fairing import THIN_PLATE
from quadpatch.filling.fill import close_holes, fair_holes
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.mesh.holes import Selection, find_holes, select_holes
from quadpatch.mesh.measures import diagonal
from quadpatch.options import HoleOptions
from quadpatch.patches.scale import PatchScale
from quadpatch.recipes.assessment import (
    LEAST_COVERAGE,
    MOST_INCONSISTENCY,
    agreeing_holes,
    assess,
    confidence,
    measure_agreement,
)
from quadpatch.recipes.result import Completion, PatchAgreement
from quadpatch.reconstruction.displacement import Displacement, rim_vertices
from quadpatch.types import BoolArray, FloatArray, TriangleMesh
from tests.quadpatch.shapes import bumpy_plate, punched

MESH = punched(bumpy_plate(60, 2.0), (-0.5, -0.5, 0), (0.5, 0.5, 0), (0.5, -0.5, 0), radius=0.2)
HOLES = find_holes(MESH)
SELECTION = select_holes(HOLES, HoleOptions(), 3.0)
FILLED = fair_holes(close_holes(MESH, [hole.loop for hole in SELECTION.chosen]), THIN_PLATE)


@dataclass(frozen=True)
class Says:
    """What evidence says of three holes."""

    coverage: tuple[float, float, float] = (1.0, 1.0, 1.0)
    deviation: tuple[float, float, float] = (0.0, 0.0, 0.0)
    departure: tuple[float, float, float] = (0.01, 0.01, 0.01)
    rim_misfit: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def agreement(self) -> PatchAgreement:
        return PatchAgreement(
            *(np.array(getattr(self, name)) for name in ("coverage", "deviation", "departure", "rim_misfit"))
        )


EXPECTATION = ErrorModel(0.3, 0.7)
SIZE = diagonal(MESH)


def completion(says: Says, blend_factor: float = 1.0, error_model: ErrorModel | None = EXPECTATION) -> Completion:
    agreement = says.agreement()
    displaced_holes = agreeing_holes(agreement) & (blend_factor > 0)
    return Completion(
        np.zeros((len(FILLED.vertex_hole), 3)),
        agreement,
        displaced_holes,
        blend_factor,
        error_model,
        PatchScale(0.5, 24, 2),
        100,
    )


@pytest.mark.parametrize(
    ("says", "displaced_holes"),
    [
        (Says(), [True, True, True]),
        (Says(coverage=(LEAST_COVERAGE, LEAST_COVERAGE - 0.01, 0.0)), [True, False, False]),
        (Says(deviation=(0.01 * MOST_INCONSISTENCY, 0.0101 * MOST_INCONSISTENCY, 1.0)), [True, False, False]),
        (Says(deviation=(0.02, 0.02, 0.02), rim_misfit=(0.0, 0.01, 1.0)), [False, True, True]),
        (Says(departure=(0.0, 0.0, 0.0)), [True, True, True]),
    ],
)
def test_a_model_may_complete_what_its_patches_cover_and_agree_about(says: Says, displaced_holes: list[bool]) -> None:
    assert agreeing_holes(says.agreement()).tolist() == displaced_holes


@pytest.mark.parametrize(
    ("done", "expected"),
    [
        (None, ["geometry"] * 3),
        (completion(Says()), ["", "", ""]),
        (completion(Says(), blend_factor=0.0), ["no_gain"] * 3),
        (completion(Says(), blend_factor=0.0, error_model=None), ["no_practice"] * 3),
        (completion(Says(coverage=(1.0, 0.2, 1.0))), ["", "no_height_map", ""]),
        (completion(Says(deviation=(1.0, 0.0, 0.0))), ["patches_disagree", "", ""]),
    ],
)
def test_every_hole_says_why_it_was_not_filled_by_the_model(done: Completion | None, expected: list[str]) -> None:
    results = assess(HOLES, SELECTION, FILLED, done, EXPECTATION, SIZE)
    assert [result.hole.id for result in results] == [0, 1, 2, 3]
    assert (results[0].verdict, results[0].code) == ("skipped", "border")
    assert [result.code for result in results[1:]] == expected
    for result in results[1:]:
        assert result.verdict == ("filled_smooth" if result.code else "filled")
        assert bool(result.reason) == bool(result.code)


def test_the_share_that_patches_see_is_told() -> None:
    results = assess(HOLES, SELECTION, FILLED, completion(Says(coverage=(0.254, 1.0, 1.0))), EXPECTATION, SIZE)
    assert "only 25 %" in results[1].reason


def test_expected_errors_are_those_of_the_expectation_and_confidence_follows_them() -> None:
    errors = EXPECTATION.errors(FILLED, [hole.diameter for hole in SELECTION.chosen])
    assert (errors > 0).all()
    for i, result in enumerate(assess(HOLES, SELECTION, FILLED, None, EXPECTATION, SIZE)[1:]):
        assert result.expected_error == errors[i]
        assert result.confidence == pytest.approx(np.exp(-errors[i] / (0.003 * diagonal(MESH))))
        assert (result.measures["gap"], result.measures["rim_turn"]) == (
            FILLED.disagreement[i],
            FILLED.rim_variation[i],
        )


def test_new_vertices_and_triangles_are_counted_by_hole() -> None:
    results = assess(HOLES, SELECTION, FILLED, None, EXPECTATION, SIZE)
    assert [result.n_new_vertices for result in results] == [0, *np.bincount(FILLED.vertex_hole).tolist()]
    assert [result.n_new_triangles for result in results] == [0, *np.bincount(FILLED.triangle_hole).tolist()]


def test_a_hole_that_could_not_be_closed_is_refused() -> None:
    values: dict[str, Any] = {**FILLED.__dict__, "unfilled": [1]}
    results = assess(HOLES, SELECTION, FilledMesh(**values), None, EXPECTATION, SIZE)
    assert [result.verdict for result in results] == ["skipped", "filled_smooth", "refused", "filled_smooth"]
    refused = results[2]
    assert refused.code == "no_triangulation"
    assert refused.confidence is None
    assert refused.expected_error is None


def test_nothing_chosen_is_judged_too() -> None:
    nothing = fair_holes(close_holes(MESH, []), THIN_PLATE)
    selection = Selection([], {hole.id: ("not_chosen", "not among the chosen ids") for hole in HOLES})
    assert {result.verdict for result in assess(HOLES, selection, nothing, None, EXPECTATION, SIZE)} == {"skipped"}


@pytest.mark.parametrize(
    ("error", "size", "expected"), [(0.0, 1.0, 1.0), (0.0003, 1.0, 0.905), (0.6, 200.0, 0.368), (1.0, 0.0, 0.0)]
)
def test_confidence_is_one_without_error_and_falls_by_e_for_three_thousandths_of_the_diagonal(
    error: float, size: float, expected: float
) -> None:
    assert confidence(error, size) == pytest.approx(expected, abs=1e-3)


def test_of_two_holes_of_a_part_the_one_with_the_larger_error_is_less_sure_however_wide_it_is() -> None:
    # Bumps that grow from left to right: a wide hole in the calm half, a narrow one in the rough half.
    sheet = bumpy_plate(60, 2.0)
    bumps = sheet.vertices[:, 2] * np.exp(1.5 * sheet.vertices[:, 0])
    sheet = TriangleMesh(np.column_stack([sheet.vertices[:, :2], bumps]), sheet.triangles)
    mesh = punched(punched(sheet, (0.5, 0.5, 0), radius=0.15), (-0.5, 0.4, 0), radius=0.3)
    holes = find_holes(mesh)
    selection = select_holes(holes, HoleOptions(), 3.0)
    filled = fair_holes(close_holes(mesh, [hole.loop for hole in selection.chosen]), THIN_PLATE)
    _, wide, narrow = assess(holes, selection, filled, None, EXPECTATION, diagonal(mesh))
    assert wide.expected_error is not None
    assert wide.confidence is not None
    assert narrow.expected_error is not None
    assert narrow.confidence is not None
    assert wide.expected_error > narrow.expected_error
    assert wide.confidence < narrow.confidence
    # In relation to their own widths the narrow one is the worse.
    assert wide.expected_error / wide.hole.diameter < 0.8 * narrow.expected_error / narrow.hole.diameter


def test_the_same_part_in_another_unit_has_the_same_confidences() -> None:
    scaled = TriangleMesh(1024.0 * MESH.vertices, MESH.triangles)
    holes = find_holes(scaled)
    selection = select_holes(holes, HoleOptions(), 3.0 * 1024)
    filled = fair_holes(close_holes(scaled, [hole.loop for hole in selection.chosen]), THIN_PLATE)
    here, there = (
        assess(HOLES, SELECTION, FILLED, None, EXPECTATION, SIZE),
        assess(holes, selection, filled, None, EXPECTATION, diagonal(scaled)),
    )
    assert len(here) == 4
    for one, other in zip(here[1:], there[1:], strict=True):
        assert one.confidence is not None
        assert other.confidence == pytest.approx(one.confidence, rel=1e-9)


def test_evidence_is_averaged_over_the_vertices_of_each_hole() -> None:
    rng = np.random.default_rng(0)
    rim, rim_hole = rim_vertices(FILLED)
    n = len(FILLED.vertex_hole)
    overlap = (rng.random(n) < 0.5).astype(np.int64) * 3
    inside = Displacement(rng.normal(size=(n, 3)), rng.random(n), overlap)
    at_rim = Displacement(rng.normal(size=(len(rim), 3)), np.zeros(len(rim)), np.ones(len(rim), np.int64))
    joined = rng.normal(size=(n, 3))
    agreement = measure_agreement(FILLED, inside, joined, rim_hole, at_rim)
    for hole in range(3):
        here: BoolArray = FILLED.vertex_hole == hole
        expected: dict[str, FloatArray] = {
            "coverage": (overlap[here] > 0).astype(np.float64),
            "spread": inside.deviation[here],
            "departure": np.linalg.norm(joined[here], axis=1),
            "rim_misfit": np.linalg.norm(at_rim.mean[rim_hole == hole], axis=1),
        }
        for name, values in expected.items():
            assert cast(FloatArray, getattr(agreement, "deviation" if name == "spread" else name))[
                hole
            ] == pytest.approx(values.mean())

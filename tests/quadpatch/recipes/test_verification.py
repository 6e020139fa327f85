from dataclasses import replace

import numpy as np
import pytest

from quadpatch.calibration.energy_selection import EnergyBlend
from quadpatch.calibration.error_model import PRIOR, ErrorModel
from quadpatch.filling.checked_fill import CheckedFill, fill_checked
from quadpatch.filling.fairing import THIN_PLATE, Energy
from quadpatch.filling.faults import find_faults
from quadpatch.filling.fill import close_holes, fair_holes
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.filling.islands import JoinedRims
from quadpatch.mesh.holes import Hole, Selection, find_holes
from quadpatch.patches.scale import PatchScale
from quadpatch.recipes.assessment import assess, confidence
from quadpatch.recipes.result import Completion, HoleResult
from quadpatch.recipes.verification import energies_of, verified_results, with_named_faults, without_faults
from quadpatch.types import FloatArray, IntArray, TriangleMesh
from tests.quadpatch.filling.fills import assert_keeps
from tests.quadpatch.filling.handmade import as_holes
from tests.quadpatch.shapes import bumpy_plate, punched

MESH = punched(bumpy_plate(40, 2.0), (-0.5, -0.5, 0), (0.5, 0.5, 0), (0.5, -0.5, 0), radius=0.2)
HOLES = find_holes(MESH)
CHOSEN = [hole for hole in HOLES if not hole.is_border]
RIMS = JoinedRims([hole.loop for hole in CHOSEN], CHOSEN, {})
SIZE = 2.9


BLEND = EnergyBlend.of_one(THIN_PLATE)


def plate(mesh: TriangleMesh, loops: list[IntArray]) -> FilledMesh:
    return fair_holes(close_holes(mesh, loops), THIN_PLATE)


CHECKED = fill_checked(MESH, as_holes(RIMS.loops), plate)


def displaced(displacement: FloatArray, displaced_holes: tuple[bool, bool, bool] = (True, True, True)) -> Completion:
    """A completion that moves the new vertices of trusted holes."""
    moved = np.where(np.array(displaced_holes)[CHECKED.filled.vertex_hole][:, None], displacement, 0.0)
    return Completion(moved, None, np.array(displaced_holes), 1.0, ErrorModel(0.3, 0.7), PatchScale(0.5, 24, 2), 9)


def ripple(height: float) -> FloatArray:
    n = len(CHECKED.filled.vertex_hole)
    return np.asarray(height * np.random.default_rng(0).normal(size=(n, 1)) * np.array([0.0, 0.0, 1.0]))


def noise(size: float, *holes: int) -> FloatArray:
    """Displacements that crumple some holes."""
    hole = CHECKED.filled.vertex_hole
    thrown = size * np.random.default_rng(0).normal(size=(len(hole), 3))
    return np.where(np.isin(hole, holes)[:, None], thrown, 0.001 * thrown)


def new_of(filled: FilledMesh, hole: int) -> bytes:
    vertices: FloatArray = filled.mesh.vertices[filled.n_measured_vertices :][filled.vertex_hole == hole]
    return vertices.tobytes()


def test_a_displacement_without_faults_is_left_as_it_is() -> None:
    completion = displaced(ripple(0.002))
    done, mesh, faults = without_faults(completion, CHECKED, None)
    assert done is completion
    np.testing.assert_array_equal(mesh.mesh.vertices, completion.apply(CHECKED.filled).mesh.vertices)
    assert faults.severity.tolist() == [0, 0, 0]


@pytest.mark.parametrize("crumpled", [(0,), (1, 2), (0, 1, 2)])
def test_a_displacement_that_crumples_its_fill_is_taken_back_there_alone(
    crumpled: tuple[int, ...],
) -> None:
    completion = displaced(noise(0.05, *crumpled))
    crumpled_mesh = completion.apply(CHECKED.filled)
    assert (find_faults(crumpled_mesh).severity > 0).tolist() == [i in crumpled for i in range(3)]
    done, mesh, faults = without_faults(completion, CHECKED, None)
    assert done is not None
    assert done.undone is not None
    assert done.undone.tolist() == [i in crumpled for i in range(3)]
    assert done.displaced_holes.tolist() == [i not in crumpled for i in range(3)]
    assert_keeps(mesh, MESH)
    assert faults.severity.tolist() == [0, 0, 0]
    for hole in range(3):
        source = CHECKED.filled if hole in crumpled else crumpled_mesh
        assert new_of(mesh, hole) == new_of(source, hole)


def test_a_displacement_into_an_obstacle_is_taken_back() -> None:
    # A small roof a little above the first hole; the model lifts that fill through it.
    new = CHECKED.filled.mesh.vertices[CHECKED.filled.n_measured_vertices :][CHECKED.filled.vertex_hole == 0]
    top = new[new[:, 2].argmax()] + [0.003, 0.002, 0.05]
    roof = top + 0.02 * np.array([[-1.0, -1, 0], [1, -1, 0], [0, 1, 0]])
    mesh = TriangleMesh(np.concatenate([MESH.vertices, roof]), MESH.triangles)
    obstacle = len(MESH.vertices) + np.array([[0, 1, 2]])
    checked = fill_checked(mesh, as_holes(RIMS.loops), plate, obstacle)
    assert checked.faults.severity.tolist() == [0, 0, 0]
    lift = np.where(checked.filled.vertex_hole == 0, 0.1, 0.001)[:, None] * [0.0, 0, 1]
    completion = replace(displaced(ripple(0.0)), displacement=lift)
    assert without_faults(completion, checked, None)[0] is completion
    done, _, _ = without_faults(completion, checked, obstacle)
    assert done is not None
    assert done.displaced_holes.tolist() == [False, True, True]


def test_faults_that_the_fill_had_before_are_no_reason_to_take_a_displacement_back() -> None:
    crumpled = CHECKED.filled.with_vertices(
        CHECKED.filled.mesh.vertices[CHECKED.filled.n_measured_vertices :] + noise(0.05, 1)
    )
    before = replace(CHECKED, filled=crumpled, faults=find_faults(crumpled))
    completion = displaced(ripple(0.0))
    assert without_faults(completion, before, None)[0] is completion


@pytest.mark.parametrize("completion", [None, displaced(noise(0.05, 0, 1, 2), (False, False, False))])
def test_where_no_hole_was_displaced_the_check_of_the_fill_holds(completion: Completion | None) -> None:
    done, mesh, faults = without_faults(completion, CHECKED, None)
    assert done is completion
    assert mesh is CHECKED.filled
    assert faults is CHECKED.faults


def judged(
    checked: CheckedFill = CHECKED, rims: JoinedRims = RIMS, completion: Completion | None = None
) -> list[HoleResult]:
    chosen = {hole.id for hole in rims.chosen}
    selection = Selection(rims.chosen, {hole.id: ("not_chosen", "") for hole in HOLES if hole.id not in chosen})
    results = assess(HOLES, selection, checked.filled, completion, PRIOR, SIZE)
    return verified_results(results, rims, checked, BLEND, checked.faults, SIZE)


def test_every_filled_hole_names_its_fill_and_its_faults() -> None:
    results = judged(replace(CHECKED, fill=["energies", "membrane", "unfaired"]))
    assert [result.fill for result in results] == ["", "energies", "membrane", "unfaired"]
    for result in results[1:]:
        assert (result.measures["folds"], result.measures["crossings"]) == (0.0, 0.0)
    assert "folds" not in results[0].measures


def test_a_refused_hole_says_why_and_claims_nothing() -> None:
    reason = ("crosses_surface", "every fill that was tried runs through other surface, by 3 triangles")
    refused = replace(CHECKED, filled=CHECKED.filled.without(np.array([1])), refused={1: reason})
    result = judged(refused)[2]
    assert (result.verdict, result.code, result.reason) == ("refused", *reason)
    assert (result.confidence, result.expected_error, result.fill, result.measures) == (None, None, "", {})
    assert (result.n_new_vertices, result.n_new_triangles) == (0, 0)


def test_a_displacement_that_was_undone_is_told_by_the_verdict() -> None:
    done, _, _ = without_faults(displaced(noise(0.05, 1)), CHECKED, None)
    assert [(r.verdict, r.code) for r in judged(completion=done)[1:]] == [
        ("filled", ""),
        ("filled_smooth", "model_faulty"),
        ("filled", ""),
    ]


def test_a_plainer_fill_far_from_the_best_one_is_expected_to_be_as_wrong_as_it_is_far() -> None:
    plain = judged()
    assert plain[1].expected_error is not None
    expected = plain[1].expected_error
    departure = np.array([0.5 * expected, 3 * expected, 0.0])
    results = judged(replace(CHECKED, fill=["unfaired", "unfaired", "energies"], departure=departure))
    assert results[1].expected_error == plain[1].expected_error
    assert results[1].confidence == plain[1].confidence
    assert results[2].expected_error == departure[1]
    assert results[2].confidence == confidence(float(departure[1]), SIZE)
    assert results[3].expected_error == plain[3].expected_error


def test_an_island_is_filled_with_the_hole_that_it_was_joined_to() -> None:
    island, rest = CHOSEN[2], CHOSEN[:2]
    rims = JoinedRims([hole.loop for hole in rest], rest, {island.id: rest[0].id})
    result = judged(fill_checked(MESH, as_holes(rims.loops), plate), rims)[island.id]
    assert (result.verdict, result.code) == ("filled_smooth", "joined")
    assert f"hole {rest[0].id}" in result.reason


def test_an_island_in_a_hole_that_was_refused_is_refused_with_it() -> None:
    """It claims no fill: the ring around it is open."""
    island, rest = CHOSEN[2], CHOSEN[:2]
    rims = JoinedRims([hole.loop for hole in rest], rest, {island.id: rest[0].id})
    checked = fill_checked(MESH, as_holes(rims.loops), plate)
    refused = replace(checked, filled=checked.filled.without(np.array([0])), refused={0: ("folds_over", "it folds")})
    result = judged(refused, rims)[island.id]
    assert (result.verdict, result.code) == ("refused", "folds_over")
    assert result.reason == f"an island in hole {rest[0].id}, which was refused: it folds"


def test_faults_are_named_for_filled_holes_and_no_others() -> None:
    crumpled = displaced(noise(0.05, 1)).apply(CHECKED.filled)
    faults = find_faults(crumpled)
    results = [HoleResult(hole, "skipped" if hole.is_border else "filled", measures={"gap": 1.0}) for hole in HOLES]
    results[3] = replace(results[3], verdict="refused")
    named = with_named_faults(results, CHOSEN, faults)
    assert named[0] == results[0]
    assert named[3] == results[3]
    assert named[1].measures == {"gap": 1.0, "folds": 0.0, "crossings": 0.0}
    assert named[2].measures["folds"] == faults.n_folds[1] > 0
    assert named[2].measures["crossings"] == faults.crossings[1] > 0


def holes_of(results: list[HoleResult]) -> list[Hole]:
    return [result.hole for result in results]


def test_results_stay_in_the_order_of_the_holes() -> None:
    assert holes_of(judged()) == HOLES


def test_a_plane_patch_expects_no_error_and_says_why_where_there_is_none() -> None:
    flat = replace(CHECKED, fill=["flat", "energies", "energies"])
    result = judged(flat)[1]
    assert (result.verdict, result.code) == ("filled_smooth", "flat")
    assert (result.confidence, result.expected_error) == (None, None)
    missing = replace(flat, filled=replace(CHECKED.filled.without(np.array([0])), unfilled=[0]))
    assert (judged(missing)[1].verdict, judged(missing)[1].code) == ("refused", "no_plane_patch")


def test_a_rule_may_keep_the_model_out_of_a_hole() -> None:
    completion = displaced(noise(0.001, 2))
    by_model = np.array([True, False, True])
    limited = replace(completion.limited_to(by_model, CHECKED.filled), left_out=~by_model)
    moved = np.linalg.norm(limited.apply(CHECKED.filled).mesh.vertices - CHECKED.filled.mesh.vertices, axis=1)
    hole = CHECKED.filled.vertex_hole
    new = moved[CHECKED.filled.n_measured_vertices :]
    assert (new[hole == 1] == 0).all()
    assert (new[hole != 1] > 0).any()
    assert [result.code for result in judged(completion=limited)[1:]] == ["", "geometry", ""]


def test_the_energies_of_a_fill_are_named_with_their_shares_and_those_of_other_fills_are_not() -> None:
    energies = (Energy(membrane=0.3, plate=1.0), THIN_PLATE, Energy(plate=1.0, variation=2.0))
    blend = EnergyBlend(energies, np.zeros(3), np.zeros(3))
    checked = fill_checked(MESH, as_holes(RIMS.loops), blend.fill)
    weights = checked.filled.energy_weights
    assert weights is not None
    np.testing.assert_allclose(weights.sum(axis=1), 1.0)
    named = energies_of(1, checked, blend)
    assert dict(named) == {e: w for e, w in zip(energies, weights[1].tolist(), strict=True) if w >= 0.005}
    assert energies_of(1, replace(checked, fill=["energies", "thin_plate", "energies"]), blend) == []
    # Where a loop is closed by a plane patch, the others keep their own energies.
    loops = as_holes(RIMS.loops)
    beside_flat = fill_checked(MESH, replace(loops, flat=np.array([True, False, False])), blend.fill)
    assert [bool(energies_of(i, beside_flat, blend)) for i in range(3)] == [False, True, True]

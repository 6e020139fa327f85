import signal
from dataclasses import replace

import numpy as np
import pytest

from quadpatch.calibration.calibration_set import choose_energy, cut_calibration_set, error_per_hole
from quadpatch.calibration.energy_selection import SHARPNESS, EnergyBlend, learn_energy_blend
from quadpatch.filling.fairing import THIN_PLATE, Energy
from quadpatch.filling.fill import close_holes, fair_holes
from quadpatch.filling.rim_residuals import rim_residuals
from quadpatch.mesh.holes import find_holes
from quadpatch.mesh.measures import mean_edge_length
from quadpatch.processes import ProcessPool
from quadpatch.recipes.fairing_energies import CALIBRATED_ENERGIES, DEFAULT_ENERGY, FAIRING_ENERGIES
from quadpatch.types import FloatArray, IntArray, TriangleMesh
from tests.quadpatch.shapes import bumpy_plate, open_grid, punched, sphere

SMOOTH = Energy(plate=1.0, variation=40.0)
PAIR = (THIN_PLATE, SMOOTH)
STEEP = Energy(plate=1.0, slope=1.5)


def blend_of(log_error: list[float], log_miss: list[float]) -> EnergyBlend:
    return EnergyBlend(PAIR, np.array(log_error), np.array(log_miss))


def rims(mesh: TriangleMesh) -> list[IntArray]:
    return [hole.loop for hole in find_holes(mesh)]


def roof(n: int = 100) -> TriangleMesh:
    """One half is smooth and curved, the other is rough: no energy suits both."""
    flat = open_grid(n, 2.0)
    x, y = flat.vertices[:, 0], flat.vertices[:, 1]
    noise = np.random.default_rng(0).normal(0.0, 0.02, len(x))
    height = np.where(x < 0, 0.5 * x**2 + 0.4 * x * y, noise)
    return TriangleMesh(np.stack([x, y, height], axis=1), flat.triangles)


def test_without_a_rim_that_tells_weights_follow_calibration_alone() -> None:
    weights = blend_of([np.log(1.0), np.log(1.1)], [0.0, 0.0]).weights(np.full((3, 2), np.nan))
    assert weights.sum(axis=1) == pytest.approx(1.0)
    assert weights[0, 1] / weights[0, 0] == pytest.approx(1.1**-SHARPNESS)
    assert (weights == weights[0]).all()


def test_an_energy_that_misses_its_rim_by_more_than_usual_counts_less() -> None:
    blend = blend_of([0.0, 0.0], [np.log(2.0), np.log(1.0)])
    as_usual, worse, unknown = blend.weights(np.array([[0.02, 0.01], [0.02, 0.02], [np.nan, np.nan]]))
    assert as_usual == pytest.approx([0.5, 0.5])
    assert worse[0] > 0.99
    assert unknown == pytest.approx([0.5, 0.5])


def test_weights_do_not_depend_on_the_unit_of_length() -> None:
    misses = np.abs(np.random.default_rng(0).normal(1, 0.2, (20, 2)))
    blend = blend_of([0.1, 0.0], [0.0, 0.1])
    metres, millimetres = (
        blend.weights(misses),
        blend_of([0.1, 0.0], np.log(1000) + blend.log_miss).weights(1000 * misses),
    )
    assert metres == pytest.approx(millimetres)


def test_weights_are_the_mean_of_both_ways_to_choose_by_the_belief_in_weighing() -> None:
    blend = blend_of([0.0, 0.0], [0.0, 0.0])
    misses = np.array([[0.02, 0.01], [0.01, 0.02]])
    alone, by_rim = np.array([0.0, 1.0]), blend.weights(misses)
    half = replace(blend, best=1, belief=0.25).weights(misses)
    assert half == pytest.approx(0.25 * by_rim + 0.75 * alone)
    assert half.sum(axis=1) == pytest.approx(1.0)


def test_an_energy_of_little_weight_takes_no_part() -> None:
    mesh = punched(bumpy_plate(50, 2.0), (0.4, 0.4, 0), (-0.4, 0.2, 0), radius=0.2)
    loops = [hole.loop for hole in find_holes(mesh) if hole.diameter < 1.0]
    blend = blend_of([0.0, 0.0], [0.0, 0.0])
    filled = blend.fill_weighted(close_holes(mesh, loops), np.array([[0.995, 0.005], [1.0, 0.0]]))
    assert filled.energy_weights is not None
    assert filled.energy_weights.tolist() == [[1.0, 0.0], [1.0, 0.0]]
    plate = fair_holes(close_holes(mesh, loops), THIN_PLATE)
    assert filled.mesh.vertices.tobytes() == plate.mesh.vertices.tobytes()


def test_energies_rank_on_graded_fills_as_on_uniform_ones() -> None:
    mesh = bumpy_plate(160, 2.0)
    calibration = cut_calibration_set(mesh, 0.3, mean_edge_length(mesh), np.random.default_rng(0))
    assert calibration is not None
    assert calibration.is_graded
    uniform = close_holes(calibration.closed.mesh, calibration.loops)
    graded, dense = (
        np.array([error_per_hole(calibration, fair_holes(closed, energy)).mean() for energy in CALIBRATED_ENERGIES])
        for closed in (calibration.closed, uniform)
    )
    # Errors of the best ones lie within a few percent of each other, those of the others far off.
    near = dense < 3 * dense.min()
    assert near.sum() >= 3
    assert (near == (graded < 3 * graded.min())).all()
    assert graded[near] / graded.min() == pytest.approx(dense[near] / dense.min(), rel=0.15)
    assert graded[~near].argsort().tolist() == dense[~near].argsort().tolist()


def test_a_rim_that_no_energy_misses_tells_nothing() -> None:
    weights = blend_of([0.0, 0.0], [0.0, 0.0]).weights(np.array([[0.0, 0.0], [0.1, 0.1]]))
    assert weights == pytest.approx(0.5)


def test_holes_on_a_rough_and_on_a_smooth_half_are_filled_by_other_weights() -> None:
    mesh = roof()
    calibration = cut_calibration_set(mesh, 0.3, mean_edge_length(mesh), np.random.default_rng(0))
    assert calibration is not None
    misses = rim_residuals(calibration.closed, FAIRING_ENERGIES)
    blend = EnergyBlend(FAIRING_ENERGIES, np.zeros(len(FAIRING_ENERGIES)), np.log(np.nanmean(misses, axis=0)))
    weights = blend.weights(misses)
    middles = np.array([mesh.vertices[loop, 0].mean() for loop in calibration.loops])
    on_smooth, on_rough = weights[middles < -0.2].mean(axis=0), weights[middles > 0.2].mean(axis=0)
    # A plate under tension cuts off what is curved; of noise no energy knows more than another.
    assert on_smooth[0] < 0.01
    assert on_rough == pytest.approx(1 / len(FAIRING_ENERGIES), abs=0.05)


def test_learning_takes_what_fills_the_calibration_holes_best() -> None:
    mesh = bumpy_plate(100, 2.0)
    calibration = cut_calibration_set(mesh, 0.3, mean_edge_length(mesh), np.random.default_rng(0))
    assert calibration is not None
    _, filled = learn_energy_blend(calibration, FAIRING_ENERGIES, DEFAULT_ENERGY)
    errors = np.array(
        [error_per_hole(calibration, fair_holes(calibration.closed, energy)) for energy in FAIRING_ENERGIES]
    )
    chosen = FAIRING_ENERGIES.index(choose_energy(errors, calibration.diameter, FAIRING_ENERGIES, DEFAULT_ENERGY))
    assert error_per_hole(calibration, filled).mean() <= errors[chosen].mean()


def test_rims_of_calibration_holes_that_no_helper_looks_at_are_looked_at_here() -> None:
    """The helper waits for a signal that never comes."""
    mesh = bumpy_plate(100, 2.0)
    calibration = cut_calibration_set(mesh, 0.3, mean_edge_length(mesh), np.random.default_rng(0))
    assert calibration is not None
    alone, _ = learn_energy_blend(calibration, FAIRING_ENERGIES, DEFAULT_ENERGY)
    with ProcessPool(2) as pool:
        pool.submit(signal.pause)
        beside, _ = learn_energy_blend(calibration, FAIRING_ENERGIES, DEFAULT_ENERGY, pool=pool)
    assert beside.log_error.tobytes() == alone.log_error.tobytes()
    assert beside.log_miss.tobytes() == alone.log_miss.tobytes()
    assert beside.belief == alone.belief


def test_where_weighing_gains_nothing_one_energy_fills_all_holes() -> None:
    mesh = open_grid(100, 2.0)
    calibration = cut_calibration_set(mesh, 0.3, mean_edge_length(mesh), np.random.default_rng(0))
    assert calibration is not None
    blend, _ = learn_energy_blend(calibration, FAIRING_ENERGIES, DEFAULT_ENERGY)
    assert tuple(blend.energies) == (DEFAULT_ENERGY,)


def two_holes() -> tuple[TriangleMesh, list[IntArray]]:
    """A rough sheet with a wide hole and a narrow one, 0.3 and 0.7 across at most and at least."""
    mesh = punched(bumpy_plate(60, 2.0), (0.4, 0.4, 0), radius=0.4)
    mesh = punched(mesh, (-0.6, -0.6, 0), radius=0.12)
    loops = [hole.loop for hole in find_holes(mesh) if hole.diameter < 1.0]
    return mesh, sorted(loops, key=len)


@pytest.mark.parametrize("belief", [0.0, 0.4])
def test_holes_wider_than_calibration_holes_are_filled_without_a_slope(belief: float) -> None:
    mesh, (narrow, wide) = two_holes()
    zeros = np.zeros(3)
    blend = EnergyBlend((STEEP, *PAIR), zeros - [1.0, 0.0, 0.5], zeros, 0, belief, widest=0.5)
    filled = blend.fill(mesh, [narrow, wide])
    assert filled.energy_weights is not None
    of_narrow, of_wide = filled.energy_weights
    assert of_narrow[0] > 0.5
    assert of_wide[0] == 0.0
    assert of_wide.argmax() == 2
    if not belief:
        assert (of_narrow.tolist(), of_wide.tolist()) == ([1.0, 0.0, 0.0], [0.0, 0.0, 1.0])


def corners(mesh: TriangleMesh) -> FloatArray:
    return mesh.vertices[mesh.triangles]


def test_a_weighed_fill_keeps_what_was_measured_and_lies_between_the_fills() -> None:
    mesh = punched(bumpy_plate(50, 2.0), (0.4, 0.4, 0), (-0.4, 0.2, 0), radius=0.2)
    loops = [hole.loop for hole in find_holes(mesh) if hole.diameter < 1.0]
    filled = blend_of([0.0, 0.0], [0.0, 0.0]).fill(mesh, loops)
    assert filled.mesh.vertices[: len(mesh.vertices)].tobytes() == mesh.vertices.tobytes()
    assert corners(filled.mesh)[: len(mesh.triangles)].tobytes() == corners(mesh).tobytes()
    closed = close_holes(mesh, loops)
    first, second = (fair_holes(closed, energy).mesh.vertices for energy in PAIR)
    low, high = np.minimum(first, second), np.maximum(first, second)
    assert (filled.mesh.vertices >= low - 1e-12).all()
    assert (filled.mesh.vertices <= high + 1e-12).all()
    assert not np.array_equal(filled.mesh.vertices, first)


def test_one_energy_alone_is_that_energy() -> None:
    mesh = punched(sphere(4), (0, 0, 1), radius=0.3)
    loops = rims(mesh)
    expected = fair_holes(close_holes(mesh, loops), SMOOTH)
    assert EnergyBlend.of_one(SMOOTH).fill(mesh, loops).mesh.vertices.tobytes() == expected.mesh.vertices.tobytes()


def test_without_holes_nothing_is_filled() -> None:
    mesh = sphere(2)
    assert blend_of([0.0, 0.0], [0.0, 0.0]).fill(mesh, []).n_measured_triangles == len(mesh.triangles)

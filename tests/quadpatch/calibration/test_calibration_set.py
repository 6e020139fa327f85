from dataclasses import replace

import numpy as np
import pytest

from quadpatch.calibration.calibration_set import (
    MARGIN_EDGES,
    MAX_HOLES,
    MIN_HOLES,
    MORE_HOLES,
    CalibrationSet,
    choose_blend_factor,
    choose_energy,
    choose_share,
    cut_calibration_set,
    distance_per_hole,
    error_per_hole,
    expect,
    is_open,
)
from quadpatch.calibration.synthetic_holes import Spacing, UncutSurface, cut_holes
from quadpatch.filling.fairing import THIN_PLATE, Energy
from quadpatch.filling.fill import fair_holes
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.mesh.boundary import boundary_loops
from quadpatch.mesh.distance import distance_to_mesh
from quadpatch.mesh.measures import mean_edge_length
from quadpatch.mesh.raycast import RayScene
from quadpatch.recipes.fairing_energies import DEFAULT_ENERGY, FAIRING_ENERGIES
from quadpatch.types import FloatArray, TriangleMesh
from tests.quadpatch.shapes import bumpy_plate, open_grid, punched, relief, sphere

DIAMETER = 0.25


def calibration_on(mesh: TriangleMesh, seed: int = 0, diameter: float = DIAMETER) -> CalibrationSet | None:
    return cut_calibration_set(mesh, diameter, mean_edge_length(mesh), np.random.default_rng(seed))


def some_calibration(mesh: TriangleMesh, seed: int = 0, diameter: float = DIAMETER) -> CalibrationSet:
    found = calibration_on(mesh, seed, diameter)
    assert found is not None
    return found


def loops_of(mesh: TriangleMesh) -> set[tuple[int, ...]]:
    return {tuple(loop.tolist()) for loop in boundary_loops(mesh.triangles).loops}


def new_vertices(filled: FilledMesh) -> FloatArray:
    return filled.mesh.vertices[filled.n_measured_vertices :]


SHEET = punched(bumpy_plate(120, 2.0), (0.3, 0.3, 0), (-0.5, 0.2, 0), (0, -0.6, 0), radius=0.12)
FLAT = TriangleMesh(bumpy_plate(100, 2.0).vertices * [1, 1, 0], bumpy_plate(100, 2.0).triangles)
RELIEF = relief(120, 2.0, 0.03, 10)


def test_real_rims_stay_as_they_are_and_calibration_keeps_away_from_them() -> None:
    calibration = some_calibration(SHEET)
    opened = calibration.closed.mesh
    real = loops_of(SHEET)
    assert real < loops_of(opened)
    assert MIN_HOLES <= len(loops_of(opened) - real) <= MAX_HOLES
    assert calibration.closed.n_holes == len(loops_of(opened) - real)
    rims = SHEET.vertices[np.concatenate([np.array(loop) for loop in real])]
    for loop in loops_of(opened) - real:
        apart = np.linalg.norm(opened.vertices[list(loop)][:, None] - rims[None], axis=2)
        # The margin of four edges, less the triangles that a disk's border cuts.
        assert apart.min() > 2 * mean_edge_length(SHEET)


def test_calibration_holes_are_about_as_wide_as_the_real_ones_and_apart() -> None:
    calibration = some_calibration(SHEET)
    loops = [np.array(loop) for loop in loops_of(calibration.closed.mesh) - loops_of(SHEET)]
    widths = [np.ptp(SHEET.vertices[loop, 0]) for loop in loops]
    assert calibration.diameter <= DIAMETER
    assert abs(np.median(widths) - calibration.diameter) < mean_edge_length(SHEET)
    corners = np.concatenate(loops)
    assert len(np.unique(corners)) == len(corners)


def test_only_surface_is_cut_away() -> None:
    calibration = some_calibration(SHEET)
    kept = {tuple(row) for row in calibration.closed.mesh.triangles.tolist()}
    assert kept < {tuple(row) for row in SHEET.triangles.tolist()}
    assert (
        calibration.closed.mesh.vertices is SHEET.vertices or (calibration.closed.mesh.vertices == SHEET.vertices).all()
    )


def test_the_same_generator_cuts_the_same_holes_and_another_one_others() -> None:
    one, same, other = some_calibration(SHEET, 1), some_calibration(SHEET, 1), some_calibration(SHEET, 2)
    assert (one.closed.mesh.triangles == same.closed.mesh.triangles).all()
    assert one.closed.plate.vertices.tobytes() == same.closed.plate.vertices.tobytes()
    assert loops_of(one.closed.mesh) != loops_of(other.closed.mesh)


@pytest.mark.parametrize(
    "mesh", [sphere(1), open_grid(5, 0.4), punched(sphere(3), (0, 0, 1), (0, 0, -1), (1, 0, 0), radius=0.9)]
)
def test_without_room_there_is_no_calibration(mesh: TriangleMesh) -> None:
    assert calibration_on(mesh, diameter=0.5) is None


def test_smaller_holes_are_tried_where_there_is_no_room_for_large_ones() -> None:
    calibration = some_calibration(sphere(5), diameter=0.8)
    assert calibration.diameter < 0.8


def test_where_wide_margins_leave_no_room_narrow_ones_are_tried_before_smaller_holes() -> None:
    rows = np.arange(-2, 3) * 0.4
    mesh = punched(open_grid(100, 2.0), *[(x, y, 0.0) for x in rows for y in rows], radius=0.1)
    edge = mean_edge_length(mesh)
    wide = Spacing(edge, MARGIN_EDGES * edge)
    assert len(cut_holes(UncutSurface(mesh), 0.2, wide, np.random.default_rng(0)).loops) < MIN_HOLES
    assert some_calibration(mesh, diameter=0.2).diameter == 0.2


def chosen_for(calibration: CalibrationSet, default: Energy = DEFAULT_ENERGY) -> Energy:
    errors = np.array(
        [error_per_hole(calibration, fair_holes(calibration.closed, energy)) for energy in FAIRING_ENERGIES]
    )
    return choose_energy(errors, calibration.diameter, FAIRING_ENERGIES, default)


def test_a_smooth_surface_is_continued_by_a_smooth_energy() -> None:
    assert chosen_for(some_calibration(sphere(5), diameter=0.5)) == FAIRING_ENERGIES[-1]


def test_a_noisy_surface_is_continued_by_an_energy_that_carries_no_curvature_on() -> None:
    mesh = open_grid(100, 2.0)
    noise = np.random.default_rng(0).normal(0, 0.01, mesh.vertices.shape) * [0, 0, 1]
    calibration = some_calibration(TriangleMesh(mesh.vertices + noise, mesh.triangles))
    assert chosen_for(calibration).variation == 0


def test_the_usual_energy_stays_where_calibration_can_not_tell() -> None:
    for default in FAIRING_ENERGIES:
        assert chosen_for(some_calibration(FLAT), default) == default


def test_a_flat_surface_is_filled_without_error() -> None:
    calibration = some_calibration(FLAT)
    filled = fair_holes(calibration.closed, THIN_PLATE)
    errors = error_per_hole(calibration, filled)
    assert errors.shape == (calibration.closed.n_holes,)
    assert errors.max() < 1e-9


def test_the_error_is_the_distance_to_what_was_cut_away() -> None:
    calibration = some_calibration(FLAT)
    filled = fair_holes(calibration.closed, THIN_PLATE)
    lifted = filled.with_vertices(new_vertices(filled) + np.array([0, 0, 0.001]))
    # Triangles at the rim are lifted in part only.
    assert error_per_hole(calibration, lifted).mean() == pytest.approx(0.001, rel=0.25)
    one_hole = filled.vertex_hole == 3
    one = filled.with_vertices(new_vertices(filled) + one_hole[:, None] * np.array([0, 0, 0.001]))
    errors = error_per_hole(calibration, one)
    assert errors[3] > 0.0007
    assert np.delete(errors, 3).max() < 1e-9


def test_errors_count_surface_by_its_area_however_dense_its_vertices_are() -> None:
    calibration = some_calibration(open_grid(200, 2.0), diameter=0.3)
    filled = fair_holes(calibration.closed, THIN_PLATE)
    centres = np.array([filled.mesh.vertices[calibration.loops[hole]].mean(axis=0) for hole in filled.vertex_hole])
    from_centre = np.linalg.norm(new_vertices(filled) - centres, axis=1)
    # Hills in the middle, where graded fills are coarse; so low that distances are heights.
    height = 0.001 * np.exp(-((from_centre / 0.05) ** 2))
    lifted = filled.with_vertices(new_vertices(filled) + height[:, None] * np.array([0, 0, 1]))
    corners = lifted.mesh.vertices[lifted.mesh.triangles[lifted.n_measured_triangles :]]
    heights, areas = (
        corners[:, :, 2].mean(axis=1),
        np.linalg.norm(np.cross(*np.diff(corners, axis=1).swapaxes(0, 1)), axis=1),
    )
    volumes, surfaces = (np.bincount(lifted.triangle_hole, values) for values in (areas * heights, areas))
    there = (volumes / surfaces).mean()
    back = distance_to_mesh(calibration.removed_vertices, lifted.mesh).mean()
    assert error_per_hole(calibration, lifted).mean() == pytest.approx(0.5 * (there + back), rel=0.04)


def test_the_distance_of_a_fill_looks_one_way_only() -> None:
    calibration = some_calibration(FLAT)
    filled = fair_holes(calibration.closed, THIN_PLATE)
    lift = 0.001 * (filled.vertex_hole == 3)[:, None] * np.array([0, 0, 1])
    lifted = filled.with_vertices(new_vertices(filled) + lift)
    distance = distance_per_hole(calibration, lifted)
    assert distance[3] == pytest.approx(0.001)
    assert np.delete(distance, 3).max() < 1e-9
    gone = np.array([0.0, 0, 1]) * calibration.removed[:, None]
    elsewhere = replace(calibration, truth=TriangleMesh(calibration.truth.vertices + gone, calibration.truth.triangles))
    elsewhere.__dict__["truth_tree"] = calibration.truth_tree
    assert (distance_per_hole(elsewhere, lifted) == distance).all()
    assert error_per_hole(elsewhere, lifted).min() > 0.4


def test_every_calibration_hole_is_as_wide_as_its_rim() -> None:
    calibration = some_calibration(SHEET)
    loops = [np.array(loop) for loop in loops_of(calibration.closed.mesh) - loops_of(SHEET)]
    widths = [np.linalg.norm(SHEET.vertices[loop][:, None] - SHEET.vertices[loop], axis=2).max() for loop in loops]
    np.testing.assert_allclose(np.sort(calibration.diameters), np.sort(widths))


def test_what_is_expected_of_the_calibration_holes_is_their_mean_distance() -> None:
    calibration = some_calibration(RELIEF)
    filled = fair_holes(calibration.closed, FAIRING_ENERGIES[1])
    expected = expect(calibration, filled).errors(filled, calibration.diameters)
    assert expected.sum() == pytest.approx(distance_per_hole(calibration, filled).sum())


@pytest.fixture(scope="module")
def on_relief() -> tuple[CalibrationSet, FilledMesh, FloatArray]:
    """Calibration on a relief, its fill, and what would take every new vertex to the truth."""
    calibration = some_calibration(RELIEF)
    filled = fair_holes(calibration.closed, THIN_PLATE)
    above = new_vertices(filled) * [1, 1, 0] + [0, 0, 1]
    _, distance = RayScene(RELIEF).cast(above, np.tile([0.0, 0, -1], (len(above), 1)))
    return calibration, filled, np.column_stack([np.zeros((len(above), 2)), 1 - distance - new_vertices(filled)[:, 2]])


def test_a_model_that_is_right_is_believed(on_relief: tuple[CalibrationSet, FilledMesh, FloatArray]) -> None:
    calibration, filled, correction = on_relief
    assert choose_blend_factor(calibration, filled, correction) == 1.0


def test_a_model_that_says_twice_as_much_is_believed_by_half(
    on_relief: tuple[CalibrationSet, FilledMesh, FloatArray],
) -> None:
    calibration, filled, correction = on_relief
    assert choose_blend_factor(calibration, filled, 2 * correction) == 0.5


@pytest.mark.parametrize("kind", ["nothing", "the opposite", "noise"])
def test_a_model_that_does_not_help_is_not_believed(
    on_relief: tuple[CalibrationSet, FilledMesh, FloatArray], kind: str
) -> None:
    calibration, filled, correction = on_relief
    noise = np.random.default_rng(0).normal(0, np.abs(correction).mean(), correction.shape)
    says = {"nothing": 0 * correction, "the opposite": -correction, "noise": noise}[kind]
    assert choose_blend_factor(calibration, filled, says) == 0.0


def test_a_model_that_helps_one_hole_a_lot_and_harms_the_others_a_little_is_not_believed(
    on_relief: tuple[CalibrationSet, FilledMesh, FloatArray],
) -> None:
    calibration, filled, correction = on_relief
    errors = error_per_hole(calibration, filled)
    helped = filled.vertex_hole == int(errors.argmax())
    n = len(errors)
    for harm in np.linspace(0.0, 1.0, 41) / n:
        says = np.where(helped[:, None], correction, -harm * correction)
        gains = errors - error_per_hole(calibration, filled.with_vertices(new_vertices(filled) + says))
        if gains.mean() < 0.6 * gains.std() / np.sqrt(n):
            break
    # It gains in the mean, by less than chance does.
    assert gains.mean() > 0
    assert choose_blend_factor(calibration, filled, says) == 0.0


def gains_of(mean: float, in_errors: float, n_holes: int = 24) -> FloatArray:
    """Errors (n_shares, n_holes): 1 without a model, with all of it less by a mean and so many standard errors."""
    pattern = np.tile([1.0, -1.0], n_holes // 2)
    gains = mean + (mean / in_errors) * np.sqrt(n_holes) * pattern
    return np.array([np.ones(n_holes), *(1.0 - share * gains for share in (0.25, 0.5, 0.75, 1.0))])


@pytest.mark.parametrize(
    ("mean", "in_errors", "is_taken", "is_left_open"),
    [
        (0.15, 0.8, False, False),
        (0.15, 1.1, False, True),
        (0.15, 1.5, False, True),
        (0.15, 2.0, True, True),
        (0.15, 3.0, True, False),
        (0.015, 1.5, False, False),
    ],
)
def test_a_gain_is_open_where_it_is_worth_it_and_neither_hopeless_nor_sure(
    mean: float, in_errors: float, is_taken: bool, is_left_open: bool
) -> None:
    errors = gains_of(mean, in_errors)
    assert (choose_share(errors) > 0, is_open(errors)) == (is_taken, is_left_open)


def test_gains_at_hardly_any_loss_are_not_open() -> None:
    gains = np.zeros(24)
    gains[:2] = 1.0
    errors = np.array([np.ones(24), *(1.0 - share * gains for share in (0.25, 0.5, 0.75, 1.0))])
    assert choose_share(errors) == 4
    assert not is_open(errors)


def test_more_holes_have_the_first_ones_among_them() -> None:
    few, edge = some_calibration(RELIEF, diameter=0.12), mean_edge_length(RELIEF)
    more = cut_calibration_set(RELIEF, 0.12, edge, np.random.default_rng(0), MORE_HOLES)
    assert more is not None
    first, every = ({tuple(sorted(loop.tolist())) for loop in holes.loops} for holes in (few, more))
    assert len(first) == MAX_HOLES < 1.5 * MAX_HOLES < len(every) <= MORE_HOLES
    assert first < every

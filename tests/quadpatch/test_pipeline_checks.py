"""Meshes whose repair can go wrong: what the pipeline refuses, joins and names."""

from collections import Counter

import numpy as np
import pytest

from quadpatch.filling.faults import find_faults
from quadpatch.mesh.boundary import boundary_loops
from quadpatch.mesh.holes import find_holes
from quadpatch.options import HoleOptions, RepairOptions
from quadpatch.recipes.default import inpaint
from quadpatch.recipes.result import HoleResult, Repair
from quadpatch.types import IntArray, TriangleMesh
from tests.quadpatch.filling.fills import assert_keeps
from tests.quadpatch.shapes import (
    cylinder,
    euler_characteristic,
    flipped,
    is_oriented_manifold,
    joined,
    moved,
    open_grid,
    plate_with_disc,
    plate_with_window,
    punched,
    sphere,
)

BALL = punched(sphere(3), (0, 0, 1), radius=0.45)


def mesh_of(vertices: list[list[float]], triangles: list[list[int]]) -> TriangleMesh:
    return TriangleMesh(np.array(vertices, np.float64), np.array(triangles, np.int64))


def without(mesh: TriangleMesh, gone: IntArray) -> TriangleMesh:
    return TriangleMesh(mesh.vertices, np.delete(mesh.triangles, gone, axis=0))


def repaired(mesh: TriangleMesh, *ids: int, obstacles: IntArray | None = None) -> Repair:
    """Repair some holes, or all loops without any exception, and see that nothing wrong is handed out in silence."""
    chosen = ids or tuple(hole.id for hole in find_holes(mesh))
    repair = inpaint(mesh, None, RepairOptions(HoleOptions(ids=chosen)), obstacles=obstacles)
    assert_keeps(repair.filled, mesh)
    assert [result.hole.id for result in repair.results] == list(range(len(find_holes(mesh))))
    faults = find_faults(repair.filled, obstacles=obstacles)
    by_id = {result.hole.id: result for result in repair.results}
    for i, hole in enumerate(repair.chosen):
        result = by_id[hole.id]
        assert (result.n_new_triangles > 0) == (i in repair.filled.triangle_hole) == (result.verdict == "filled_smooth")
        if result.verdict == "filled_smooth":
            assert (result.measures["folds"], result.measures["crossings"]) == (faults.n_folds[i], faults.crossings[i])
    assert not faults.is_wrong.any()
    new = repair.filled.mesh.triangles[repair.filled.n_measured_triangles :]
    rest = np.array([result.hole.is_manifold for result in repair.results])
    if is_oriented_manifold(mesh.triangles) and rest.all():
        assert is_oriented_manifold(repair.filled.mesh.triangles)
    assert (new != np.roll(new, 1, axis=1)).all()
    return repair


def codes(repair: Repair) -> Counter[str]:
    return Counter(result.code for result in repair.results)


def result_of(repair: Repair, n_edges: int) -> HoleResult:
    (result,) = (result for result in repair.results if result.hole.n_edges == n_edges)
    return result


def test_an_island_is_joined_and_the_ring_around_it_filled() -> None:
    mesh = joined(plate_with_window(16), open_grid(5))
    repair = repaired(mesh, 1)
    window, island = result_of(repair, 36), result_of(repair, 16)
    assert (window.verdict, window.code) == ("filled_smooth", "geometry")
    assert (island.verdict, island.code) == ("filled_smooth", "joined")
    assert f"hole {window.hole.id}" in island.reason
    assert euler_characteristic(repair.filled.mesh.triangles) == 1
    assert np.abs(repair.filled.mesh.vertices[:, 2]).max() < 1e-9


@pytest.mark.parametrize("island", [flipped(open_grid(5)), moved(open_grid(5), (4.2, 0, 0))])
def test_an_island_that_can_not_be_joined_makes_its_hole_refused(island: TriangleMesh) -> None:
    repair = repaired(joined(plate_with_window(16), island), 1)
    result = result_of(repair, 36)
    assert (result.verdict, result.code) == ("refused", "crosses_surface")
    assert (result.confidence, result.expected_error) == (None, None)
    assert "other surface" in result.reason


@pytest.mark.parametrize(("radius", "height"), [(0.4, 0.75), (0.3, 1.0), (0.3, 1.2), (0.2, 0.9)])
def test_an_eyeball_in_its_socket_is_run_into_by_nothing(radius: float, height: float) -> None:
    repair = repaired(joined(BALL, moved(sphere(2, radius), (0, 0, height))), 0)
    (result,) = repair.results
    assert result.code in ("crosses_surface", "geometry")
    assert (result.fill != "energies") == (result.code == "crosses_surface") or result.measures["crossings"] == 0


def test_what_the_mesh_leaves_out_is_run_into_as_well() -> None:
    blade = np.array([[-0.05, 0.02, 0.5], [0.05, 0.03, 0.5], [0.01, 0.025, 1.5]])
    mesh = TriangleMesh(np.concatenate([BALL.vertices, blade]), BALL.triangles)
    obstacle = len(BALL.vertices) + np.array([[0, 1, 2]])
    assert codes(repaired(mesh)) == {"geometry": 1}
    assert codes(repaired(mesh, obstacles=obstacle)) == {"crosses_surface": 1}


@pytest.mark.parametrize("size", [1e-30, 1e-12, 1e12, 1e17])
def test_every_other_unit_gives_the_same_repair(size: float) -> None:
    here, there = repaired(BALL), repaired(TriangleMesh(size * BALL.vertices, BALL.triangles))
    assert codes(there) == codes(here) == {"geometry": 1}
    assert there.filled.mesh.vertices / size == pytest.approx(here.filled.mesh.vertices, abs=1e-6)


@pytest.mark.parametrize("offset", [1e6, 1e12, 1e15, 1e17])
def test_a_mesh_far_away_is_repaired_as_far_as_its_digits_go(offset: float) -> None:
    repaired(TriangleMesh(BALL.vertices + offset, BALL.triangles))


NOTHING_TO_FILL = {
    "a double-sided triangle": mesh_of([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 1]]),
    "a face with a repeated corner": mesh_of([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 1]]),
    "no triangle": TriangleMesh(np.eye(3), np.zeros((0, 3), np.int64)),
}


@pytest.mark.parametrize("name", NOTHING_TO_FILL)
def test_meshes_without_a_loop_come_back(name: str) -> None:
    repair = inpaint(NOTHING_TO_FILL[name], None, RepairOptions())
    assert (repair.results, len(repair.filled.triangle_hole)) == ([], 0)


def band(n: int, n_half_turns: int) -> TriangleMesh:
    """A band around the z axis, twisted by half turns."""
    angle = 2 * np.pi * np.arange(n) / n
    tilt = n_half_turns * angle / 2
    sides = [
        np.stack([r * np.cos(angle), r * np.sin(angle), 0.3 * side * np.sin(tilt)], axis=1)
        for side in (-1, 1)
        for r in [1 + 0.3 * side * np.cos(tilt)]
    ]
    low, high = 2 * np.arange(n), 2 * np.arange(n) + 1
    next_low, next_high = np.roll(low, -1), np.roll(high, -1)
    if n_half_turns % 2:
        next_low[-1], next_high[-1] = next_high[-1], next_low[-1]
    triangles = [np.stack([low, next_low, high], 1), np.stack([high, next_low, next_high], 1)]
    return TriangleMesh(np.stack(sides, axis=1).reshape(-1, 3), np.concatenate(triangles))


ODD = {
    "a triangle": (mesh_of([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]), {"folds_over", "doubles_surface"}),
    "two triangles": (open_grid(2), {"doubles_surface"}),
    "three points in one": (mesh_of([[1, 2, 3]] * 3, [[0, 1, 2]]), {"geometry", "folds_over"}),
    "a tetrahedron without a face": (
        mesh_of([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 2, 1], [0, 1, 3], [0, 3, 2]]),
        {"geometry"},
    ),
    "a Moebius strip": (band(12, 1), {"non_manifold_rim"}),
    "a band of two half turns": (band(24, 2), {"crosses_surface", "folds_over"}),
    "a band": (band(24, 0), {"geometry", "crosses_surface", "doubles_surface"}),
    "a tube": (cylinder(24, 12), {"geometry"}),
    "a fin at a rim": (
        TriangleMesh(
            np.append(BALL.vertices, [[0, 0, 2.0]], axis=0),
            np.append(BALL.triangles, [[*boundary_loops(BALL.triangles).loops[0][:2], len(BALL.vertices)]], axis=0),
        ),
        {"non_manifold_rim"},
    ),
    "every third triangle of a sheet gone": (
        without(open_grid(8), np.arange(0, 98, 3)),
        {"geometry", "crosses_surface", "folds_over", "doubles_surface"},
    ),
    "every second triangle of a sheet gone": (
        without(open_grid(6), np.arange(0, 50, 2)),
        {"geometry", "crosses_surface", "folds_over", "doubles_surface"},
    ),
}


@pytest.mark.parametrize("name", ODD)
def test_odd_meshes_are_filled_where_it_can_be_done_and_refused_with_a_code(name: str) -> None:
    mesh, expected = ODD[name]
    assert set(codes(repaired(mesh))) <= expected


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("share", [0.02, 0.1, 0.5])
def test_triangles_that_are_gone_anywhere_come_back_or_are_refused(seed: int, share: float) -> None:
    # Holes of three edges, holes that share corners, flakes that hang on a corner, loose flakes.
    rng = np.random.default_rng(seed)
    ball = sphere(2)
    gone = rng.choice(len(ball.triangles), int(share * len(ball.triangles)), replace=False)
    repair = repaired(without(ball, gone))
    if share < 0.2:
        assert set(codes(repair)) <= {"geometry", "joined"}


def test_the_border_of_a_sheet_costs_none_of_its_holes() -> None:
    mesh = without(open_grid(10), np.arange(20, 140, 20))
    repair = repaired(mesh)
    assert [result.code for result in repair.results] == ["crosses_surface"] + ["geometry"] * (len(repair.results) - 1)


def test_a_ring_longer_than_the_table_is_filled_around_its_island() -> None:
    island = TriangleMesh(0.3 * sphere(3).vertices * [1, 1, 0.05], sphere(3).triangles)
    half = island.triangles[(island.vertices[island.triangles].mean(axis=1)[:, 2] > 0)]
    mesh = joined(plate_with_disc(110), TriangleMesh(island.vertices, half))
    window = next(hole.id for hole in find_holes(mesh) if hole.n_edges == 110 and not hole.is_border)
    repair = repaired(mesh, window)
    assert repair.results[window].verdict == "filled_smooth"
    assert codes(repair)["joined"] == 1

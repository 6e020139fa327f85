import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from quadpatch.mesh.intersections import LEAST_HEIGHT, box_contacts, crossing_pairs, heights, touching_boxes
from quadpatch.types import FloatArray, IntArray, TriangleMesh
from tests.quadpatch.shapes import bumpy_plate, joined, moved, open_grid, random_rotation, sphere

FLOOR: list[list[float]] = [[-1.0, -1, 0], [2, -1, 0], [0, 2, 0]]
SIZES = st.sampled_from([1e-12, 1e-6, 1.0, 1e6, 1e12])


def soup(*triangles: list[list[float]]) -> TriangleMesh:
    """Triangles without common vertices."""
    corners = np.array(triangles).reshape(-1, 3)
    return TriangleMesh(corners, np.arange(len(corners)).reshape(-1, 3))


def pairs_of(mesh: TriangleMesh) -> set[tuple[int, int]]:
    return {(min(pair), max(pair)) for pair in crossing_pairs(mesh).tolist()}


def crossed_by_edges(corners: FloatArray) -> set[tuple[int, int]]:
    """Pairs of triangles (n, 3, 3) in general position that cross: an edge of one passes through the other."""

    def volume(a: FloatArray, b: FloatArray, c: FloatArray, d: FloatArray) -> float:
        return float(np.linalg.det(np.stack([b - a, c - a, d - a])))

    def passes(start: FloatArray, end: FloatArray, t: FloatArray) -> bool:
        a, b, c = t
        sides = volume(a, b, c, start) * volume(a, b, c, end) < 0
        around = {volume(start, end, t[k - 1], t[k]) > 0 for k in range(3)}
        return sides and len(around) == 1

    return {
        (i, j)
        for i, j in itertools.combinations(range(len(corners)), 2)
        if any(
            passes(corners[one][k - 1], corners[one][k], corners[other])
            for one, other in ((i, j), (j, i))
            for k in range(3)
        )
    }


@given(seed=st.integers(0, 2**32 - 1), size=SIZES, far=st.sampled_from([0.0, 10.0, 1e3]))
@settings(max_examples=25)
def test_random_triangles_cross_where_an_edge_passes_through_in_any_unit_and_place(
    seed: int, size: float, far: float
) -> None:
    rng = np.random.default_rng(seed)
    corners = rng.uniform(-1, 1, (8, 1, 3)) + rng.uniform(-1, 1, (8, 3, 3))
    placed = size * (corners @ random_rotation(rng) + far)
    mesh = TriangleMesh(placed.reshape(-1, 3), np.arange(24).reshape(-1, 3))
    exact, shrunk = crossed_by_edges(corners), crossed_by_edges(corners + 0.01 * (corners.mean(1)[:, None] - corners))
    # Crossings by less than a hundredth of a triangle are left out: those are a matter of taste.
    assert shrunk <= pairs_of(mesh) <= exact


@pytest.mark.parametrize("size", [1e-150, 1e-40, 1e-6, 1.0, 1e6, 1e40])
def test_a_blade_through_the_floor_crosses_it_and_one_that_stands_on_it_does_not(size: float) -> None:
    for depth, expected in ((0.3, {(0, 1)}), (0.0, set()), (-0.1, set())):
        blade: list[list[float]] = [[-0.2, 0.1, -depth], [0.2, 0.1, 1.0], [0.0, 0.2, 1.0]]
        mesh = soup(FLOOR, blade)
        assert pairs_of(TriangleMesh(size * mesh.vertices, mesh.triangles)) == expected


def test_triangles_of_one_surface_do_not_cross_at_their_edges_and_corners() -> None:
    for mesh in (open_grid(6), sphere(2), bumpy_plate(12, 2.0)):
        assert len(crossing_pairs(mesh)) == 0


def test_planes_that_overlap_cross_and_those_that_touch_do_not() -> None:
    assert pairs_of(soup(FLOOR, [[0.1 + x, y, z] for x, y, z in FLOOR])) == {(0, 1)}
    assert pairs_of(soup(FLOOR, [[x + 3.0, y, z] for x, y, z in FLOOR])) == set()
    # One is in the other as a whole, and no edge meets an edge.
    assert pairs_of(soup(FLOOR, [[0.1 * x, 0.1 * y, z] for x, y, z in FLOOR])) == {(0, 1)}


def test_triangles_with_three_corners_in_common_do_not_cross() -> None:
    # They fold onto each other at three edges: `quadpatch.filling.faults` counts that.
    assert pairs_of(TriangleMesh(np.array(FLOOR), np.array([[0, 1, 2], [0, 2, 1]]))) == set()


def test_neighbours_in_a_plane_cross_once_they_fold_onto_each_other() -> None:
    # They share the edge 0-1; the apex of the second lies beyond that edge, or on the side of the first.
    for y, expected in ((-1.0, set()), (0.5, {(0, 1)})):
        vertices = np.array([[0.0, 0, 0], [1, 0, 0], [0.4, 1, 0], [0.5, y, 0]])
        assert pairs_of(TriangleMesh(vertices, np.array([[0, 1, 2], [1, 0, 3]]))) == expected


def test_triangles_with_one_corner_in_common_cross_where_they_pass_through() -> None:
    vertices = np.array([[0.0, 0, 0], [2, -1, 0], [2, 1, 0], [2, 0, 1], [2, 0, -1], [-2, 0, 1], [-2, 0, -1]])
    assert pairs_of(TriangleMesh(vertices, np.array([[0, 1, 2], [0, 3, 4]]))) == {(0, 1)}
    assert pairs_of(TriangleMesh(vertices, np.array([[0, 1, 2], [0, 5, 6]]))) == set()


@given(seed=st.integers(0, 2**32 - 1), size=SIZES)
@settings(max_examples=10)
def test_noise_in_the_last_bit_makes_no_crossing(seed: int, size: float) -> None:
    # Two plates that meet in a seam whose vertices are not joined, at places that differ by one unit in the last place.
    rng = np.random.default_rng(seed)
    plate = open_grid(5)
    flipped = joined(plate, moved(plate, (4.0, 0, 0))).vertices @ random_rotation(rng) + [100.0, -50.0, 30.0]
    noisy = size * flipped
    noisy = np.nextafter(noisy, rng.choice([-np.inf, np.inf], noisy.shape))
    mesh = TriangleMesh(noisy, joined(plate, plate).triangles)
    assert len(crossing_pairs(mesh)) == 0


def test_what_has_no_height_crosses_nothing() -> None:
    needle: list[list[float]] = [[0.0, 0, -1], [0, 0, 1], [0, 0, 0.5]]
    point: list[list[float]] = [[0.0, 0, 0]] * 3
    assert pairs_of(soup(FLOOR, needle, point)) == set()
    assert pairs_of(soup(needle)) == set()
    assert len(crossing_pairs(TriangleMesh(np.zeros((0, 3)), np.zeros((0, 3), np.int64)))) == 0


@pytest.mark.parametrize("size", [5e-324, 1e-310, 1e-200, 1e-100, 1.0, 1e100])
def test_heights_are_shares_of_the_longest_edge_in_every_unit(size: float) -> None:
    flat = np.array([[[0.0, 0, 0], [4, 0, 0], [1, 1, 0]], [[0, 0, 0], [1, 0, 0], [3, 0, 0]], [[2, 2, 2]] * 3])
    measured = heights(size * flat.reshape(-1, 3), np.arange(9).reshape(-1, 3))
    assert measured == pytest.approx([0.25, 0.0, 0.0])
    assert not measured[1] > LEAST_HEIGHT


@given(seed=st.integers(0, 2**32 - 1), size=SIZES)
@settings(max_examples=25)
def test_boxes_touch_the_triangles_whose_own_boxes_meet_them(seed: int, size: float) -> None:
    rng = np.random.default_rng(seed)
    corners = size * (rng.uniform(-5, 5, (200, 1, 3)) + rng.uniform(-0.5, 0.5, (200, 3, 3)))
    # A few triangles across everything.
    corners[:3] = size * rng.uniform(-5, 5, (3, 3, 3))
    low = size * rng.uniform(-5, 5, (4, 3))
    high = low + size * rng.uniform(0, 2, (4, 3))
    mesh = TriangleMesh(corners.reshape(-1, 3), np.arange(600).reshape(-1, 3))
    apart = (corners.min(1)[:, None] > high[None]) | (corners.max(1)[:, None] < low[None])
    expected: IntArray = np.flatnonzero((~apart.any(axis=2)).any(axis=1))
    found = np.flatnonzero(touching_boxes(low, high, mesh))
    assert found.tolist() == expected.tolist()
    contacts = box_contacts(low, high, mesh)
    triangle, box = np.nonzero(~apart.any(axis=2))
    assert sorted(contacts.tolist()) == sorted(np.stack([box, triangle], axis=1).tolist())


def test_no_box_and_no_triangle_touch_nothing() -> None:
    none = np.zeros((0, 3))
    assert not touching_boxes(none, none, open_grid(4)).any()
    assert len(touching_boxes(np.zeros((1, 3)), np.ones((1, 3)), TriangleMesh(none, np.zeros((0, 3), np.int64)))) == 0


@given(seed=st.integers(0, 2**32 - 1), size=SIZES, lift=st.sampled_from([0.0, 1e-15, 1e-9]))
@settings(max_examples=25)
def test_sheets_in_one_plane_but_for_rounding_lie_on_each_other(seed: int, size: float, lift: float) -> None:
    rng = np.random.default_rng(seed)
    small = 0.3 * (np.array(FLOOR) + rng.uniform(-0.5, 0.5, 3) * [1, 1, 0]) + [0, 0, lift]
    above = np.array(FLOOR) + np.array([0, 0, 0.01])
    corners = np.stack([np.array(FLOOR), small, above]) @ random_rotation(rng)
    mesh = TriangleMesh(size * corners.reshape(-1, 3), np.arange(9).reshape(-1, 3))
    assert pairs_of(mesh) == {(0, 1)}


@pytest.mark.parametrize("angle", [1e-4, 0.01, 0.5])
def test_neighbours_do_not_lie_on_each_other_however_sharp_their_edge(angle: float) -> None:
    flap = [[-1.0, -1, 0], [2, -1, 0], [0, 3 * np.cos(angle) - 1, 3 * np.sin(angle)]]
    corners = np.array([FLOOR, flap])
    mesh = TriangleMesh(corners.reshape(-1, 3)[[0, 1, 2, 5]], np.array([[0, 1, 2], [1, 0, 3]]))
    assert pairs_of(mesh) == set()


def test_many_small_triangles_on_few_large_ones_are_all_found() -> None:
    grid = open_grid(40, 2.0)
    floor = soup(*[(10 * np.array(FLOOR)).tolist()] * 3)
    mesh = joined(grid, moved(floor, (0, 0, 1e-13)))
    n = len(grid.triangles)
    assert {i for i, _ in pairs_of(mesh)} >= set(range(n))


@given(seed=st.integers(0, 2**32 - 1), n_first=st.integers(0, 30))
@settings(max_examples=20)
def test_pairs_with_one_of_the_first_are_those_of_all_that_have_one(seed: int, n_first: int) -> None:
    # Corners on a coarse grid of a plane: most triangles lie on others.
    rng = np.random.default_rng(seed)
    corners = np.concatenate([rng.integers(0, 5, (30, 3, 2)), np.zeros((30, 3, 1), np.int64)], axis=2)
    mesh = TriangleMesh(corners.reshape(-1, 3).astype(np.float64), np.arange(90).reshape(-1, 3))
    everything, some = (
        {tuple(sorted(pair)) for pair in crossing_pairs(mesh, n).tolist() if min(pair) < n_first}
        for n in (None, n_first)
    )
    assert some == everything

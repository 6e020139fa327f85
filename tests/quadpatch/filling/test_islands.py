from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from quadpatch.filling import islands
from quadpatch.filling.checked_fill import fill_checked
from quadpatch.filling.faults import find_faults
from quadpatch.filling.fill import close_flat
from quadpatch.filling.islands import MOST_HEIGHT, JoinedRims, join_islands
from quadpatch.mesh.holes import Hole, find_holes
from quadpatch.types import IntArray, TriangleMesh
from tests.quadpatch.filling.fills import assert_keeps
from tests.quadpatch.filling.handmade import as_holes
from tests.quadpatch.shapes import (
    euler_characteristic,
    faces_per_edge,
    flipped,
    is_oriented_manifold,
    joined,
    moved,
    open_grid,
    plate_with_disc,
    plate_with_window,
    random_rotation,
)

# The hole is 17 units wide, 24 from corner to corner.
PLATE = plate_with_window(24)
ISLAND = open_grid(5)


def turned(mesh: TriangleMesh, angle_deg: float) -> TriangleMesh:
    """Turn a mesh about the x axis."""
    c, s = np.cos(np.radians(angle_deg)), np.sin(np.radians(angle_deg))
    return TriangleMesh(mesh.vertices @ np.array([[1, 0, 0], [0, c, s], [0, -s, c]]), mesh.triangles)


def inner_hole(mesh: TriangleMesh) -> Hole:
    """The largest loop that is no border: the window of the plate."""
    return next(hole for hole in find_holes(mesh) if not hole.is_border)


def joins(mesh: TriangleMesh) -> JoinedRims:
    return join_islands(mesh, find_holes(mesh), [inner_hole(mesh)])


HEIGHT = MOST_HEIGHT * 24


@pytest.mark.parametrize(
    ("island", "is_joined"),
    [
        (ISLAND, True),
        (moved(ISLAND, (5.5, -5.5, 0)), True),
        (moved(ISLAND, (0, 0, 0.9 * HEIGHT)), True),
        (moved(ISLAND, (0, 0, -0.9 * HEIGHT)), True),
        (turned(ISLAND, 40), True),
        (flipped(ISLAND), False),
        (moved(ISLAND, (0, 0, 1.2 * HEIGHT)), False),
        (moved(ISLAND, (0, 0, -1.2 * HEIGHT)), False),
        (turned(ISLAND, 80), False),
        (moved(ISLAND, (8.0, 0, 0)), False),
        (moved(ISLAND, (30.0, 0, 0)), False),
    ],
)
def test_an_island_is_joined_where_it_lies_inside_near_the_rim_and_faces_its_way(
    island: TriangleMesh, is_joined: bool
) -> None:
    mesh = joined(PLATE, island)
    rims = joins(mesh)
    window = inner_hole(mesh)
    assert list(rims.host_of.values()) == ([window.id] if is_joined else [])
    assert [hole.id for hole in rims.chosen] == [window.id]
    (loop,) = rims.loops
    expected = set(window.loop.tolist()) | (set(range(len(PLATE.vertices), len(mesh.vertices))) if is_joined else set())
    assert set(loop.tolist()) <= expected
    assert len(loop) == (window.n_edges + 16 + 2 if is_joined else window.n_edges)


@given(seed=st.integers(0, 2**32 - 1), size=st.sampled_from([1e-6, 1.0, 1e6]))
@settings(max_examples=10)
def test_islands_are_found_in_every_unit_place_and_order(seed: int, size: float) -> None:
    rng = np.random.default_rng(seed)
    mesh = joined(PLATE, moved(ISLAND, (*rng.uniform(-5, 5, 2), 0)))
    rotation = random_rotation(rng)
    mesh = TriangleMesh(size * (mesh.vertices @ rotation.T + rng.normal(0, 30, 3)), rng.permutation(mesh.triangles))
    assert len(joins(mesh).host_of) == 1


def edges_of(loop: IntArray) -> set[tuple[int, int]]:
    return set(zip(loop.tolist(), np.roll(loop, -1).tolist(), strict=True))


def test_the_joined_loop_passes_both_rims_once_and_the_shortest_edge_to_and_fro() -> None:
    mesh = joined(PLATE, moved(ISLAND, (3.0, 0.2, 0)))
    holes = find_holes(mesh)
    rims = joins(mesh)
    (loop,) = rims.loops
    (island_id,) = rims.host_of
    window, island = inner_hole(mesh).loop, holes[island_id].loop
    edges = edges_of(loop)
    assert len(edges) == len(loop)
    joining = edges - edges_of(window) - edges_of(island)
    assert edges - joining == edges_of(window) | edges_of(island)
    (start, end), back = sorted(joining)
    assert back == (end, start)
    between = np.linalg.norm(mesh.vertices[window][:, None] - mesh.vertices[island][None], axis=2)
    assert np.linalg.norm(mesh.vertices[start] - mesh.vertices[end]) == between.min()


def filled_over(mesh: TriangleMesh, chosen: list[Hole]) -> TriangleMesh:
    """Fill holes flat, and see that nothing is wrong with the fill."""
    rims = join_islands(mesh, find_holes(mesh), chosen)
    filled = close_flat(mesh, rims.loops)
    faults = find_faults(filled)
    assert (faults.n_folds.sum(), faults.crossings.sum()) == (0, 0)
    assert filled.unfilled == []
    assert_keeps(filled, mesh)
    assert is_oriented_manifold(filled.mesh.triangles)
    return filled.mesh


@pytest.mark.parametrize(
    "places",
    [
        [(0.0, 0.0)],
        [(-5, 0), (5, 0)],
        [(-5, -5), (5, 5), (5, -5), (-5, 5)],
        [(-6, 0), (0, 0), (6, 0)],
        # The first lies behind the second, seen from the rim that is next to it.
        [(-1.4, 0.1), (-5.6, 0)],
        [(5.6, 0.3), (1.4, 0), (-2.8, 0.2)],
    ],
)
def test_any_number_of_islands_in_one_hole_becomes_one_sheet_with_one_border(places: list[tuple[float, float]]) -> None:
    mesh = joined(PLATE, *(moved(open_grid(4), (x, y, 0)) for x, y in places))
    rims = joins(mesh)
    assert len(rims.host_of) == len(places)
    whole = filled_over(mesh, [inner_hole(mesh)])
    assert euler_characteristic(whole.triangles) == 1
    assert (faces_per_edge(whole.triangles) == 1).sum() == 4 * 23


@given(seed=st.integers(0, 2**32 - 1), n=st.integers(2, 8))
@settings(max_examples=6)
def test_islands_anywhere_are_joined_without_a_fault(seed: int, n: int) -> None:
    rng = np.random.default_rng(seed)
    cells = rng.permutation(25)[:n]
    places = 3.0 * np.stack([cells % 5 - 2, cells // 5 - 2], axis=1) + rng.uniform(-0.4, 0.4, (n, 2))
    mesh = joined(PLATE, *(moved(open_grid(3), (x, y, 0)) for x, y in places))
    assert euler_characteristic(filled_over(mesh, [inner_hole(mesh)]).triangles) == 1


def test_a_long_ring_is_divided_without_a_fault() -> None:
    big, small = plate_with_disc(80), plate_with_disc(60)
    disc = close_flat(small, [find_holes(small)[1].loop]).mesh
    mesh = joined(big, TriangleMesh(0.25 * disc.vertices, disc.triangles))
    whole = filled_over(mesh, [next(hole for hole in find_holes(mesh) if hole.n_edges == 80 and not hole.is_border)])
    assert euler_characteristic(whole.triangles) == 1


def test_an_island_with_a_hole_of_its_own_is_joined_and_its_hole_stays_one() -> None:
    mesh = joined(PLATE, plate_with_window(9, 2))
    holes = find_holes(mesh)
    window, own = (hole for hole in holes if not hole.is_border)
    rims = join_islands(mesh, holes, [window, own])
    assert rims.host_of == {next(hole.id for hole in holes if hole.n_edges == 32): window.id}
    assert [hole.id for hole in rims.chosen] == [window.id, own.id]
    assert rims.loops[1].tolist() == own.loop.tolist()
    assert euler_characteristic(filled_over(mesh, [window, own]).triangles) == 1


def test_an_island_in_the_hole_of_an_island_is_joined_to_that_one() -> None:
    middle, small = plate_with_window(13, 2), open_grid(3)
    mesh = joined(PLATE, middle, small)
    holes = find_holes(mesh)
    window, own = (hole for hole in holes if not hole.is_border)
    by_edges = {hole.n_edges: hole.id for hole in holes}
    rims = join_islands(mesh, holes, [window, own])
    assert rims.host_of == {by_edges[8]: own.id, by_edges[48]: window.id}
    assert euler_characteristic(filled_over(mesh, [window, own]).triangles) == 1


def test_a_flap_that_belongs_to_the_surface_around_is_no_island() -> None:
    # The same island, held to the plate by one bent strip below it.
    mesh = joined(PLATE, ISLAND)
    window = inner_hole(mesh)
    corner = len(PLATE.vertices)
    tied = np.concatenate([mesh.triangles, [[int(window.loop[1]), int(window.loop[0]), corner]]])
    holes = find_holes(TriangleMesh(mesh.vertices, tied))
    assert join_islands(TriangleMesh(mesh.vertices, tied), holes, holes).host_of == {}


def test_an_island_that_was_chosen_itself_is_no_loop_of_its_own_any_more() -> None:
    mesh = joined(PLATE, ISLAND)
    holes = find_holes(mesh)
    rims = join_islands(mesh, holes, holes)
    (island,) = rims.host_of
    assert [hole.id for hole in rims.chosen] == [hole.id for hole in holes if hole.id != island]
    assert len(rims.loops) == len(rims.chosen)


def test_without_islands_loops_are_those_of_the_chosen_holes() -> None:
    holes = find_holes(PLATE)
    for chosen in (holes, holes[:1], holes[1:], []):
        rims = join_islands(PLATE, holes, chosen)
        assert (rims.chosen, rims.host_of) == (chosen, {})
        assert [loop.tolist() for loop in rims.loops] == [hole.loop.tolist() for hole in chosen]


def test_an_island_that_faces_the_other_way_is_run_into_and_its_hole_refused() -> None:
    mesh = joined(PLATE, flipped(moved(ISLAND, (0.1, 0.2, 0))))
    rims = joins(mesh)
    checked = fill_checked(mesh, as_holes(rims.loops), close_flat)
    assert [code for code, _ in checked.refused.values()] == ["crosses_surface"]


def nested_rings(n: int) -> TriangleMesh:
    """Flat octagonal rings, one around the other, each a piece of its own."""
    angle = np.pi * np.arange(8) / 4
    circle = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    i, j = np.arange(8), (np.arange(8) + 1) % 8
    triangles = np.concatenate([np.stack([i, 8 + i, 8 + j], 1), np.stack([i, 8 + j, j], 1)])
    return joined(*(TriangleMesh(np.concatenate([r * circle, (r + 0.5) * circle]), triangles) for r in range(1, n + 1)))


@pytest.mark.parametrize("n", [3, 60])
def test_of_rings_around_rings_each_knows_the_narrowest_holes_it_lies_in(
    n: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    mesh = nested_rings(n)
    looked_at: list[int] = []
    lies_in = islands._lies_in

    def counted(*arguments: Any) -> bool:
        looked_at.append(1)
        return lies_in(*arguments)

    monkeypatch.setattr(islands, "_lies_in", counted)
    holes = find_holes(mesh)
    found = islands.hosts_of(mesh, holes, holes)
    # Loops go by width, so those of a ring are neighbours; the outer one is the island.
    borders = {hole.id for hole in holes if hole.loop.max() % 16 >= 8}
    assert found.keys() == borders - {0}
    for island, hosts in found.items():
        assert hosts == [island - 1 - 2 * k for k in range(min(islands.MOST_HOSTS, (island + 1) // 2))][: len(hosts)]
        assert len(hosts) == min(islands.MOST_HOSTS, island // 2)
    # The cost of a pair is that of its rims: none but those that are told is looked at.
    assert len(looked_at) == sum(map(len, found.values()))


def test_long_rims_are_compared_with_long_islands_part_by_part(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(islands, "_PAIRS_AT_A_TIME", 50)
    assert len(joins(joined(PLATE, moved(ISLAND, (5.5, -5.5, 0)))).host_of) == 1
    assert joins(joined(PLATE, moved(ISLAND, (8.0, 0, 0)))).host_of == {}

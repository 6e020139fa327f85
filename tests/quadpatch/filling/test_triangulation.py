import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from quadpatch.filling.triangulation import MAX_TABLE_SIZE, EdgeSet, Forbidden, triangulate_loops
from quadpatch.mesh.boundary import boundary_loops
from quadpatch.mesh.normals import area_vectors, triangle_normals
from quadpatch.mesh.topology import directed_edges
from quadpatch.types import FloatArray, IntArray, Triangles
from tests.quadpatch.shapes import faces_per_edge, is_oriented_manifold

NO_EDGES = EdgeSet(np.zeros((0, 2), np.int64))
NOTHING = Forbidden(NO_EDGES)
UP = np.array([0.0, 0.0, 1.0])


def star(n: int, seed: int, low: float = 0.3) -> FloatArray:
    """Corners (n, 3) of a flat star-shaped polygon, clockwise: as the rim of a hole in a plane seen from above."""
    rng = np.random.default_rng(seed)
    angle = -2 * np.pi * (np.arange(n) + rng.uniform(-0.3, 0.3, n)) / n
    radius = rng.uniform(low, 1.0, n)
    return np.stack([radius * np.cos(angle), radius * np.sin(angle), np.zeros(n)], axis=1)


def wavy(n: int) -> FloatArray:
    """Corners (n, 3) of a clockwise loop that waves in all directions, smooth on the scale of its edges."""
    angle = -2 * np.pi * np.arange(n) / n
    radius = 1 + 0.3 * np.sin(5 * angle)
    return np.stack([radius * np.cos(angle), radius * np.sin(angle), 0.1 * np.cos(7 * angle)], axis=1)


def polygon_area(corners: FloatArray) -> float:
    x, y, _ = corners.T
    return abs(float((x * np.roll(y, -1) - y * np.roll(x, -1)).sum())) / 2


def triangulate(
    corners: FloatArray, existing_edges: EdgeSet = NO_EDGES, normals: FloatArray | None = None
) -> Triangles | None:
    normals = np.tile(UP, (len(corners), 1)) if normals is None else normals
    (found,) = triangulate_loops([np.arange(len(corners))], corners, [normals], Forbidden(existing_edges))
    return found


def signed_areas(corners: FloatArray, triangles: Triangles) -> FloatArray:
    return np.asarray(area_vectors(corners, triangles)[:, 2] / 2)


def assert_closes(loop: IntArray, triangles: Triangles) -> None:
    """The triangles are an oriented disk whose rim is the loop, passed the other way."""
    assert len(triangles) == len(loop) - 2
    assert is_oriented_manifold(triangles)
    (rim,) = boundary_loops(triangles).loops
    back = loop[::-1]
    assert np.roll(back, -int(np.argmin(back))).tolist() == rim.tolist()


@given(n=st.integers(3, 24), seed=st.integers(0, 2**32 - 1), low=st.sampled_from([0.3, 1.0]))
@settings(max_examples=60)
def test_flat_polygons_convex_or_not_are_covered_once(n: int, seed: int, low: float) -> None:
    corners = star(n, seed, low)
    found = triangulate(corners)
    assert found is not None
    assert_closes(np.arange(n), found)
    areas = signed_areas(corners, found)
    assert (areas > -1e-12).all()
    assert areas.sum() == pytest.approx(polygon_area(corners), rel=1e-12)


@pytest.mark.parametrize("n", [MAX_TABLE_SIZE, MAX_TABLE_SIZE + 1, 2 * MAX_TABLE_SIZE + 1, 500, 3000])
def test_long_loops_are_closed_by_an_oriented_disk(n: int) -> None:
    loop = np.random.default_rng(0).permutation(4000)[:n]
    vertices = np.zeros((4000, 3))
    vertices[loop] = wavy(n)
    (found,) = triangulate_loops([loop], vertices, [np.tile(UP, (n, 1))], NOTHING)
    assert found is not None
    assert_closes(loop, found)
    areas = area_vectors(vertices, found)[:, 2] / 2
    # Slivers of the concave parts may fold over by their own small area.
    assert areas.sum() == pytest.approx(polygon_area(vertices[loop]), rel=1e-9)
    assert -areas[areas < 0].sum() < 0.02 * areas.sum()


@pytest.mark.slow
def test_a_loop_longer_than_the_square_of_the_table_is_closed() -> None:
    n = MAX_TABLE_SIZE**2 + 300
    found = triangulate(wavy(n))
    assert found is not None
    assert_closes(np.arange(n), found)


# A quadrilateral that is no plane, and the two roofs over it: creased along 0-2 or along 1-3.
SADDLE = np.array([[0.0, -1, 0], [-1, 0, 0.5], [0, 1, 0], [1, 0, 0.5]])
ROOFS = {(0, 2): np.array([[0, 2, 1], [0, 3, 2]]), (1, 3): np.array([[0, 3, 1], [1, 3, 2]])}


@pytest.mark.parametrize("crease", ROOFS)
def test_of_two_roofs_the_one_that_continues_the_surface_is_chosen(crease: tuple[int, int]) -> None:
    # The faces around the hole fall off like the roof's face at that edge, three times as steep.
    normals = triangle_normals(SADDLE * [1, 1, 3], ROOFS[crease])
    edges = directed_edges(ROOFS[crease])
    rim = [normals[int(np.flatnonzero((edges == [(i + 1) % 4, i]).all(axis=1))[0]) // 3] for i in range(4)]
    found = triangulate(SADDLE, normals=np.stack(rim))
    assert found is not None
    assert set(crease) in [set(pair) for pair in directed_edges(found).tolist()]


def test_the_smaller_area_decides_between_equal_angles() -> None:
    # Both diagonals of a steep saddle bend alike against a rim without normals; one spans less area.
    corners = np.array([[0.0, -2, 0], [-1, 0, 0.5], [0, 2, 0], [1, 0, 0.5]])
    found = triangulate(corners, normals=np.zeros((4, 3)))
    assert found is not None
    long_crease, short_crease = (np.linalg.norm(area_vectors(corners, roof), axis=1).sum() for roof in ROOFS.values())
    assert short_crease < long_crease
    assert np.linalg.norm(area_vectors(corners, found), axis=1).sum() == pytest.approx(short_crease)


@given(lengths=st.lists(st.integers(3, 12), min_size=1, max_size=8), seed=st.integers(0, 1000))
@settings(max_examples=20)
def test_many_loops_at_once_are_triangulated_as_one_by_one(lengths: list[int], seed: int) -> None:
    pieces = [star(n, seed + i) + np.random.default_rng(i).normal(0, 0.1, (n, 3)) for i, n in enumerate(lengths)]
    starts = np.cumsum([0, *lengths])
    loops = [np.arange(a, b) for a, b in itertools.pairwise(starts)]
    normals = [np.tile(UP, (n, 1)) for n in lengths]
    together = triangulate_loops(loops, np.concatenate(pieces), normals, NOTHING)
    for loop, piece, found in zip(loops, pieces, together, strict=True):
        alone = triangulate(piece)
        assert found is not None
        assert alone is not None
        assert (found == alone + loop[0]).all()


@given(n=st.integers(4, 12), seed=st.integers(0, 2**32 - 1))
@settings(max_examples=60)
def test_edges_that_are_taken_are_not_used_again(n: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    chords = np.array([(i, j) for j in range(n) for i in range(j - 1) if (i, j) != (0, n - 1)])
    existing_edges = chords[rng.random(len(chords)) < 0.3]
    found = triangulate(star(n, seed), EdgeSet(existing_edges))
    if found is None:
        return
    assert_closes(np.arange(n), found)
    used = {frozenset(edge) for edge in directed_edges(found).tolist()}
    assert not used & {frozenset(edge) for edge in existing_edges.tolist()}


def test_a_rim_whose_chords_are_all_taken_has_no_triangulation() -> None:
    assert triangulate(star(4, 0), EdgeSet(np.array([[2, 0], [1, 3]]))) is None
    found = triangulate(star(4, 0), EdgeSet(np.array([[2, 0]])))
    assert found is not None
    assert {frozenset(edge) for edge in directed_edges(found).tolist()} >= {frozenset({1, 3})}


def test_one_impossible_loop_does_not_spoil_its_batch() -> None:
    vertices = np.concatenate([star(4, 0), star(4, 1)])
    loops = [np.arange(4), np.arange(4, 8)]
    normals = [np.tile(UP, (4, 1))] * 2
    first, second = triangulate_loops(loops, vertices, normals, Forbidden(EdgeSet(np.array([[0, 2], [1, 3]]))))
    assert first is None
    assert second is not None


@pytest.mark.parametrize("n", [MAX_TABLE_SIZE + 2, 200, 2 * MAX_TABLE_SIZE, 900])
@pytest.mark.parametrize("reach", [2, 3])
def test_long_loops_use_no_edge_that_is_taken_either(n: int, reach: int) -> None:
    # Faces that stick out into the hole: rim vertices two or three steps apart are joined by an edge already.
    start = np.arange(0, n, reach)
    ears = EdgeSet(np.stack([start, (start + reach) % n], axis=1))
    found = triangulate(wavy(n), ears)
    assert found is not None
    assert_closes(np.arange(n), found)
    inner = directed_edges(found)
    on_rim = np.isin(np.abs(inner[:, 0] - inner[:, 1]), [1, n - 1])
    assert not ears.contains(inner[~on_rim]).any()


def test_two_holes_never_share_a_chord() -> None:
    # Two roofs over the same ridge, one above the other: both would be creased along 0-2.
    vertices = np.concatenate([SADDLE, SADDLE[[1, 3]] - [0, 0, 0.2]])
    loops = [np.array([0, 1, 2, 3]), np.array([0, 5, 2, 4])]
    normals = [np.zeros((4, 3)), np.zeros((4, 3))]
    found = [t for t in triangulate_loops(loops, vertices, normals, NOTHING) if t is not None]
    assert len(found) == 2
    assert faces_per_edge(np.concatenate(found)).max() <= 2


def test_an_edge_set_knows_its_edges_in_both_directions() -> None:
    edges = EdgeSet(np.array([[3, 1], [2, 5]]))
    assert edges.contains(np.array([[[1, 3], [3, 1]], [[5, 2], [1, 2]]])).tolist() == [[True, True], [True, False]]
    assert NO_EDGES.contains(np.array([[1, 3]])).tolist() == [False]


def ring(n: int) -> tuple[FloatArray, IntArray]:
    """The flat ring between a rim and an island, n vertices each: their places, and the loop that joins them."""
    angle = -2 * np.pi * np.arange(n) / n
    rim = np.stack([np.cos(angle), np.sin(angle), np.zeros(n)], axis=1)
    island = n + np.append(0, np.arange(n - 1, 0, -1))
    return np.concatenate([rim, 0.5 * rim]), np.concatenate([np.arange(n), [0], island, [n]])


@pytest.mark.parametrize("n", [3, 4, 10, 63, 64, 150, 400])
def test_a_ring_whose_rims_an_edge_joins_is_closed_once_and_that_is_an_edge_like_any_other(n: int) -> None:
    points, loop = ring(n)
    (found,) = triangulate_loops([loop], points, [np.tile(UP, (len(loop), 1))], NOTHING)
    assert found is not None
    assert len(found) == len(loop) - 2 == 2 * n
    assert is_oriented_manifold(found)
    assert (found != np.roll(found, 1, axis=1)).all()
    assert faces_per_edge(found).tolist().count(1) == 2 * n
    edges = [frozenset(edge) for edge in directed_edges(found).tolist()]
    assert edges.count(frozenset({0, n})) == 2
    areas = signed_areas(points, found)
    assert areas.min() > 0
    assert areas.sum() == pytest.approx(0.75 * polygon_area(points[:n]))


@pytest.mark.parametrize("n_roofs", [2, 3, 12])
def test_of_many_roofs_over_one_ridge_one_is_creased_along_it(n_roofs: int) -> None:
    levels = [SADDLE[[1, 3]] - [0, 0, 0.2 * i] for i in range(n_roofs)]
    vertices = np.concatenate([SADDLE[[0, 2]], *levels])
    loops = [np.array([0, 2 + 2 * i, 1, 3 + 2 * i]) for i in range(n_roofs)]
    found = [t for t in triangulate_loops(loops, vertices, [np.zeros((4, 3))] * n_roofs, NOTHING) if t is not None]
    assert len(found) == n_roofs
    assert faces_per_edge(np.concatenate(found)).max() <= 2


def test_edges_among_some_vertices_are_those_with_both_ends_there() -> None:
    edges = EdgeSet(np.array([[0, 1], [1, 2], [2, 3], [3, 0]])).among(np.array([2, 1, 0]))
    assert edges.contains(np.array([[1, 0], [2, 1], [3, 2], [0, 3]])).tolist() == [True, True, False, False]


@given(n=st.integers(3, 12), seed=st.integers(0, 2**32 - 1))
@settings(max_examples=60)
def test_triangles_that_are_forbidden_are_not_used(n: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    every = np.array(list(itertools.combinations(range(n), 3)))
    some = every[rng.random(len(every)) < 0.3]
    loop, corners = rng.permutation(n), np.zeros((n, 3))
    corners[loop] = star(n, seed)
    forbidden = Forbidden(NO_EDGES, rng.permuted(some, axis=1))
    (found,) = triangulate_loops([loop], corners, [np.tile(UP, (n, 1))], forbidden)
    if found is None:
        return
    assert_closes(loop, found)
    assert not {frozenset(t) for t in found.tolist()} & {frozenset(t) for t in some.tolist()}


def test_the_next_best_triangulation_is_taken_where_the_best_is_forbidden() -> None:
    # A square has two: without one triangle of the first it is the second, without one of each there is none.
    corners = star(4, 0)
    normals = [np.tile(UP, (4, 1))]
    first = triangulate(corners)
    assert first is not None
    (second,) = triangulate_loops([np.arange(4)], corners, normals, Forbidden(NO_EDGES, first[:1]))
    assert second is not None
    assert {frozenset(t) for t in second.tolist()}.isdisjoint(frozenset(t) for t in first.tolist())
    both = Forbidden(NO_EDGES, np.concatenate([first[:1], second[1:]]))
    assert triangulate_loops([np.arange(4)], corners, normals, both) == [None]


@pytest.mark.parametrize("n", [200, 3 * MAX_TABLE_SIZE])
def test_long_loops_do_without_what_is_forbidden_too(n: int) -> None:
    corners, normals = wavy(n), [np.tile(UP, (n, 1))]
    plain = triangulate(corners)
    assert plain is not None
    forbidden = plain[:: len(plain) // 10]
    (found,) = triangulate_loops([np.arange(n)], corners, normals, Forbidden(NO_EDGES, forbidden))
    assert found is not None
    assert_closes(np.arange(n), found)
    assert {frozenset(t) for t in found.tolist()}.isdisjoint(frozenset(t) for t in forbidden.tolist())

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from quadpatch.mesh.boundary import Boundary, boundary_loops
from quadpatch.mesh.boundary import boundary_edges as edges_with_one_face
from quadpatch.mesh.topology import directed_edges
from quadpatch.types import IntArray, Triangles
from tests.quadpatch.shapes import cylinder, joined, open_grid, punched, sphere


def triangles(*rows: tuple[int, int, int]) -> Triangles:
    return np.array(rows, dtype=np.int64)


def boundary_edges(faces: Triangles) -> set[tuple[int, int]]:
    """Directed edges whose undirected edge has one face, counted the slow way."""
    count: dict[frozenset[int], int] = {}
    directed = [(t[k], t[(k + 1) % 3]) for t in faces.tolist() for k in range(3)]
    for edge in directed:
        count[frozenset(edge)] = count.get(frozenset(edge), 0) + 1
    return {edge for edge in directed if count[frozenset(edge)] == 1}


def edges_of(loop: IntArray) -> list[tuple[int, int]]:
    return list(zip(loop.tolist(), np.roll(loop, -1).tolist(), strict=True))


def as_sets(boundary: Boundary) -> list[tuple[frozenset[tuple[int, int]], bool]]:
    pairs = zip(boundary.loops, boundary.is_manifold, strict=True)
    return sorted(((frozenset(edges_of(loop)), good) for loop, good in pairs), key=lambda item: sorted(item[0]))


@given(n=st.integers(2, 12))
def test_open_grid_has_one_loop_of_perimeter_length(n: int) -> None:
    boundary = boundary_loops(open_grid(n).triangles)
    (loop,) = boundary.loops
    assert len(loop) == 4 * (n - 1)
    assert boundary.is_manifold == [True]


@pytest.mark.parametrize("faces", [sphere(1).triangles, np.zeros((0, 3), np.int64), triangles((0, 1, 2), (0, 2, 1))])
def test_closed_and_empty_meshes_have_no_loop(faces: Triangles) -> None:
    assert boundary_loops(faces) == Boundary([], [])


def test_a_single_triangle_is_its_own_rim() -> None:
    (loop,) = boundary_loops(triangles((4, 7, 5))).loops
    assert loop.tolist() == [4, 7, 5]


def test_a_loop_runs_with_the_surface_on_its_left() -> None:
    mesh = punched(open_grid(9), (0, 0, 0), radius=1.2)
    hole, border = sorted(boundary_loops(mesh.triangles).loops, key=len)
    for loop, sign in ((border, 1), (hole, -1)):
        x, y = mesh.vertices[loop, :2].T
        shoelace = float((x * np.roll(y, -1) - y * np.roll(x, -1)).sum())
        assert np.sign(shoelace) == sign
        assert set(edges_of(loop)) <= set(map(tuple, directed_edges(mesh.triangles).tolist()))


def test_an_open_cylinder_has_two_loops() -> None:
    assert [len(loop) for loop in boundary_loops(cylinder(12, 5).triangles).loops] == [12, 12]


def test_two_holes_that_share_one_vertex_are_two_simple_loops() -> None:
    flat = open_grid(9)
    shared = 4 * 9 + 4
    gone = np.array([a_row * 9 + a_column for a_row, a_column in ((3, 4), (5, 4))])
    faces = flat.triangles[~np.isin(flat.triangles, gone).any(axis=1)]
    boundary = boundary_loops(faces)
    border, *holes = sorted(boundary.loops, key=len, reverse=True)
    assert len(border) == 32
    assert len(holes) == 2
    assert boundary.is_manifold == [True] * 3
    for hole in holes:
        assert len(set(hole.tolist())) == len(hole) == 6
        assert shared in hole
    assert set(holes[0].tolist()) & set(holes[1].tolist()) == {shared}


def test_a_flap_held_by_two_corners_parts_two_holes() -> None:
    # Around a diamond (0, 2, 1, 3) whose tips 0 and 1 alone touch the frame: the holes lie left and right of it.
    frame = [(0, 8, 4), (6, 8, 0), (5, 9, 1), (1, 9, 7), (4, 10, 5), (7, 11, 6)]
    faces = triangles((0, 2, 3), (2, 1, 3), *frame)
    loops = {frozenset(loop.tolist()) for loop in boundary_loops(faces).loops}
    assert loops == {frozenset({0, 2, 1, 5, 4}), frozenset({0, 6, 7, 1, 3}), frozenset(range(4, 12))}


def test_loops_start_at_their_lowest_vertex_and_come_in_its_order() -> None:
    mesh = punched(open_grid(15), (-3, -3, 0), (3, 3, 0), (3, -3, 0), radius=1.2)
    loops = boundary_loops(mesh.triangles).loops
    firsts = [int(loop[0]) for loop in loops]
    assert firsts == sorted(firsts) == [int(loop.min()) for loop in loops]


def test_a_rim_that_touches_an_edge_of_three_faces_is_flagged_and_others_are_not() -> None:
    # A fin on an edge next to one of two holes.
    mesh = punched(open_grid(15), (-3, 0, 0), (3, 0, 0), radius=1.2)
    whole = boundary_loops(mesh.triangles)
    by_side = {int(np.sign(mesh.vertices[loop, 0].mean().round(6))): loop for loop in whole.loops}
    rim = by_side[1]
    start, end = next(
        (a, b) for a, b in directed_edges(mesh.triangles).tolist() if a in rim and b not in np.concatenate(whole.loops)
    )
    boundary = boundary_loops(np.concatenate([mesh.triangles, triangles((start, end, len(mesh.vertices)))]))
    flagged = [set(loop.tolist()) for loop, good in zip(boundary.loops, boundary.is_manifold, strict=True) if not good]
    good = [loop.tolist() for loop, good in zip(boundary.loops, boundary.is_manifold, strict=True) if good]
    assert flagged
    assert all(chain & {int(start), int(end)} for chain in flagged)
    assert by_side[-1].tolist() in good
    assert by_side[0].tolist() in good


def test_faces_that_disagree_about_direction_are_flagged() -> None:
    boundary = boundary_loops(triangles((0, 1, 2), (0, 3, 2)))
    assert boundary.is_manifold == [False, False]
    assert {vertex for loop in boundary.loops for vertex in loop.tolist()} == {0, 1, 2, 3}


def test_a_moebius_strip_has_no_rim_that_could_be_filled() -> None:
    n = 20
    rows = [(2 * i, 2 * i + 1, 2 * i + 2) for i in range(n - 1)] + [
        (2 * i + 1, 2 * i + 3, 2 * i + 2) for i in range(n - 1)
    ]
    last = 2 * (n - 1)
    boundary = boundary_loops(triangles(*rows, (last, last + 1, 1), (last + 1, 0, 1)))
    assert boundary.loops
    assert not any(boundary.is_manifold)


def test_a_flipped_patch_inside_a_sound_surface_spoils_no_rim() -> None:
    mesh = punched(open_grid(15), (-3, 0, 0), radius=1.2)
    faces = mesh.triangles.copy()
    centres = mesh.vertices[faces].mean(axis=1)
    inner = np.linalg.norm(centres - [3, 0, 0], axis=1) < 1.5
    faces[inner] = faces[inner, ::-1]
    assert as_sets(boundary_loops(faces)) == as_sets(boundary_loops(mesh.triangles))


def test_duplicate_faces_flag_the_rim_that_they_touch() -> None:
    mesh = open_grid(6)
    boundary = boundary_loops(np.concatenate([mesh.triangles, mesh.triangles[:1]]))
    assert not any(boundary.is_manifold)


def test_a_chain_that_can_not_close_keeps_its_order() -> None:
    # A fan around vertex 0 with one face flipped: chains along its rim, not sorted heaps of vertices.
    order = [9, 3, 8, 2, 7, 1, 6]
    rows = [(0, a, b) for a, b in itertools.pairwise(order)]
    rows[2] = rows[2][::-1]
    faces = triangles(*rows)
    single = boundary_edges(faces)
    for loop in boundary_loops(faces).loops:
        along = set(edges_of(loop)[:-1]) | {edges_of(loop)[-1]}
        assert len(along & single) >= len(loop) - 1


@st.composite
def broken_meshes(draw: st.DrawFn) -> Triangles:
    """Two meshes with random faces missing, and some faces flipped or repeated."""
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    mesh = joined(sphere(1), open_grid(6))
    faces = mesh.triangles[rng.random(len(mesh.triangles)) > draw(st.sampled_from([0.05, 0.2, 0.5]))]
    flipped = rng.random(len(faces)) < draw(st.sampled_from([0.0, 0.0, 0.05]))
    faces = np.where(flipped[:, None], faces[:, ::-1], faces)
    return np.concatenate([faces, faces[rng.random(len(faces)) < draw(st.sampled_from([0.0, 0.0, 0.05]))]])


@given(faces=broken_meshes())
def test_every_boundary_edge_lies_on_exactly_one_loop_or_its_chain_is_flagged(faces: Triangles) -> None:
    boundary = boundary_loops(faces)
    single = boundary_edges(faces)
    covered: list[tuple[int, int]] = []
    flagged: set[int] = set()
    for loop, is_manifold in zip(boundary.loops, boundary.is_manifold, strict=True):
        assert len(set(loop.tolist())) == len(loop)
        if is_manifold:
            assert len(loop) >= 3
            assert set(edges_of(loop)) <= single
            covered += edges_of(loop)
        else:
            flagged |= set(loop.tolist())
    assert len(covered) == len(set(covered))
    assert all({a, b} <= flagged for a, b in single - set(covered))


@given(faces=broken_meshes(), seed=st.integers(0, 2**32 - 1))
def test_the_order_of_triangles_does_not_matter(faces: Triangles, seed: int) -> None:
    rng = np.random.default_rng(seed)
    flipped = np.take_along_axis(faces, (np.arange(3) + rng.integers(0, 3, (len(faces), 1))) % 3, axis=1)
    shuffled = boundary_loops(rng.permutation(flipped))
    expected = boundary_loops(faces)
    assert [loop.tolist() for loop in shuffled.loops] == [loop.tolist() for loop in expected.loops]
    assert shuffled.is_manifold == expected.is_manifold


@given(n_holes=st.integers(1, 3), seed=st.integers(0, 2**32 - 1))
def test_relabelling_vertices_relabels_the_loops(n_holes: int, seed: int) -> None:
    mesh = punched(open_grid(15), *[(-4.0, 0, 0), (0.0, 2, 0), (4.0, 1, 0)][:n_holes], radius=1.2)
    names = np.random.default_rng(seed).permutation(1000)[: len(mesh.vertices)]
    renamed = boundary_loops(names[mesh.triangles])
    expected = boundary_loops(mesh.triangles)
    edges = {frozenset((int(names[a]), int(names[b])) for a, b in edges_of(loop)) for loop in expected.loops}
    assert {frozenset(edges_of(loop)) for loop in renamed.loops} == edges
    assert renamed.is_manifold == [True] * (n_holes + 1)


@given(faces=broken_meshes())
def test_boundary_edges_are_those_of_one_face(faces: Triangles) -> None:
    marked = edges_with_one_face(faces)
    assert sorted(map(tuple, marked.tolist())) == sorted(boundary_edges(faces))


def test_a_loop_of_many_thousand_edges_is_walked_in_one_go() -> None:
    n = 20_000
    here = np.arange(n)
    after = np.roll(here, -1)
    ring = np.concatenate([np.stack([here, after, n + here], 1), np.stack([after, n + after, n + here], 1)])
    inner, outer = boundary_loops(ring).loops
    assert inner.tolist() == here.tolist()
    assert sorted(outer.tolist()) == list(range(n, 2 * n))


@pytest.mark.parametrize("step", [1, 2])
def test_ten_thousands_of_faces_around_a_vertex_or_on_an_edge_are_walked_one_by_one(step: int) -> None:
    # Step 1: the pages of a book, all on the edge (0, 1). Step 2: triangles that share nothing but vertex 0.
    n = 20_000
    here = 1 + step * np.arange(n)
    first = np.ones(n, np.int64) if step == 1 else here
    boundary = boundary_loops(np.stack([np.zeros(n, np.int64), first, here + 1], 1))
    assert boundary.is_manifold == [step == 2] * n
    assert {frozenset(loop.tolist()) for loop in boundary.loops} == {
        frozenset((0, a, b)) for a, b in zip(first.tolist(), (here + 1).tolist(), strict=True)
    }

"""Fins: which of the faces at a crowded edge are left out."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from quadpatch.mesh.boundary import boundary_loops
from quadpatch.mesh.fins import fin_triangles
from quadpatch.mesh.topology import directed_edges
from quadpatch.mesh.weld import weld
from quadpatch.types import IntArray, TriangleMesh, Triangles
from tests.quadpatch.shapes import bumpy_plate, joined, open_grid, punched, sphere

BALL = punched(sphere(3), (0, 0, 1), radius=0.3)
(RIM,) = boundary_loops(BALL.triangles).loops


def with_fin(mesh: TriangleMesh, start: int, end: int, depth: int = 1, lift: float = 0.1) -> TriangleMesh:
    """Put a strip of `depth` triangles on an edge, that stands off the surface."""
    n = len(mesh.vertices)
    middle = mesh.vertices[[start, end]].mean(axis=0)
    tips = [middle + lift * (i + 1) * middle / np.linalg.norm(middle) + 0.01 * (i % 2) for i in range(depth)]
    chain = [start, end, *range(n, n + depth)]
    rows = [(chain[i], chain[i + 1], chain[i + 2]) for i in range(depth)]
    return TriangleMesh(np.concatenate([mesh.vertices, tips]), np.concatenate([mesh.triangles, np.array(rows)]))


def inner_edge_at_rim() -> tuple[int, int]:
    """An edge with two faces that begins at the rim."""
    edges = directed_edges(BALL.triangles)
    at_rim = np.isin(edges, RIM)
    start, end = edges[at_rim[:, 0] & ~at_rim[:, 1]][0].tolist()
    return start, end


@pytest.mark.parametrize("depth", [1, 2, 5])
@pytest.mark.parametrize("is_flipped", [False, True])
def test_a_chain_of_fins_at_a_rim_is_left_out_whole(depth: int, is_flipped: bool) -> None:
    start, end = inner_edge_at_rim()
    mesh = with_fin(BALL, *((end, start) if is_flipped else (start, end)), depth)
    assert not any(boundary_loops(mesh.triangles).is_manifold)
    welded = weld(mesh.vertices, mesh.triangles)
    assert (welded.mesh.triangles == BALL.triangles).all()
    assert welded.ignored_triangles.tolist() == mesh.triangles[len(BALL.triangles) :].tolist()
    assert welded.counts.fin_triangles == depth


@given(seed=st.integers(0, 1000))
def test_the_fin_is_found_whatever_the_order_of_the_faces(seed: int) -> None:
    rng = np.random.default_rng(seed)
    edges = directed_edges(BALL.triangles)
    mesh = BALL
    for row in rng.permutation(len(edges))[:2].tolist():
        start, end = edges[row].tolist()
        mesh = with_fin(mesh, start, end, depth=int(rng.integers(1, 3)))
    order = rng.permutation(len(mesh.triangles))
    found = fin_triangles(mesh.vertices, mesh.triangles[order])
    # On a rim edge, a single scrap is the second face and no fin.
    crowded = _is_crowded(mesh.triangles)[len(BALL.triangles) :]
    assert (np.flatnonzero(found[np.argsort(order)]) >= len(BALL.triangles)).all()
    assert found.any() == crowded.any()


def _is_crowded(triangles: Triangles) -> IntArray:
    edges = np.sort(directed_edges(triangles), axis=1)
    _, which, count = np.unique(edges, axis=0, return_inverse=True, return_counts=True)
    return np.asarray((count[which.reshape(-1)] > 2).reshape(-1, 3).any(axis=1))


def test_a_fin_on_a_fin_goes_with_it() -> None:
    start, end = inner_edge_at_rim()
    mesh = with_fin(BALL, start, end)
    tip = len(BALL.vertices)
    mesh = with_fin(with_fin(mesh, start, tip), tip, start, lift=0.2)
    found = fin_triangles(mesh.vertices, mesh.triangles)
    assert np.flatnonzero(found).tolist() == [len(BALL.triangles) + i for i in range(3)]


def test_a_flap_of_two_equal_faces_is_left_out_with_both_sides() -> None:
    start, end = inner_edge_at_rim()
    mesh = with_fin(BALL, start, end)
    both = np.concatenate([mesh.triangles, mesh.triangles[-1:, ::-1]])
    welded = weld(mesh.vertices, both)
    assert (welded.mesh.triangles == BALL.triangles).all()
    assert (welded.counts.duplicate_triangles, welded.counts.fin_triangles) == (1, 1)


@pytest.mark.parametrize("ear_first", [False, True])
def test_of_two_scraps_the_one_that_continues_the_surface_is_surface(ear_first: bool) -> None:
    # An ear in the plane of a sheet, hanging on one of its border's edges, and a fin that stands on the same edge.
    sheet = open_grid(11)
    start, end = 5, 6
    tips = np.array([[0.5, -6.0, 0.0], [0.5, -5.0, 1.0]])
    ear, fin = [end, start, 121], [end, start, 122]
    rows = np.array([ear, fin] if ear_first else [fin, ear])
    vertices = np.concatenate([sheet.vertices, tips])
    for order in (np.concatenate([sheet.triangles, rows]), np.concatenate([rows, sheet.triangles])):
        found = fin_triangles(vertices, order)
        assert order[found].tolist() == [fin]


def test_three_sheets_that_meet_are_no_fins() -> None:
    page = open_grid(7)
    along = np.arange(7)
    vertices, triangles = [page.vertices], [page.triangles]
    for angle in (2.0, 4.0):
        flipped = page.vertices - page.vertices[0]
        x, y, _ = flipped.T
        vertices.append(page.vertices[0] + np.stack([x, np.cos(angle) * y, np.sin(angle) * y], axis=1))
        numbers = np.arange(49) + len(vertices) * 49 - 49
        numbers[along] = along
        triangles.append(numbers[page.triangles])
    welded = weld(np.concatenate(vertices), np.concatenate(triangles))
    assert welded.counts.fin_triangles == 0
    assert not any(boundary_loops(welded.mesh.triangles).is_manifold)


def test_the_pages_of_a_book_are_no_fins_of_each_other() -> None:
    tips = np.array([[0.0, 0, 0], [0, 0, 1], *[[np.cos(a), np.sin(a), 0.5] for a in range(3)]])
    assert not fin_triangles(tips, np.array([[0, 1, 2], [0, 1, 3], [0, 1, 4]])).any()


def test_a_bubble_without_a_free_edge_is_no_fin() -> None:
    plate = bumpy_plate(20, 2.0)
    a, b, n = 100, 101, len(plate.vertices)
    tips = plate.vertices[a] + np.array([[0.05, 0, 0.3], [0.05, 0.05, 0.3]])
    bubble = np.array([[a, b, n], [b, a, n + 1], [a, n, n + 1], [n, b, n + 1]])
    mesh = TriangleMesh(np.concatenate([plate.vertices, tips]), np.concatenate([plate.triangles, bubble]))
    assert not fin_triangles(mesh.vertices, mesh.triangles).any()


def test_a_large_scrap_is_kept() -> None:
    # A sheet of half the ball's faces that hangs on one edge.
    sheet = open_grid(20, 0.5)
    both = joined(BALL, TriangleMesh(sheet.vertices + np.array([0, 0, 5]), sheet.triangles))
    start, end = inner_edge_at_rim()
    joint = np.arange(len(both.vertices))
    joint[len(BALL.vertices)], joint[len(BALL.vertices) + 1] = start, end
    welded = weld(both.vertices, joint[both.triangles])
    assert welded.counts.fin_triangles == 0

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from quadpatch.mesh.topology import (
    compacted,
    components,
    directed_edges,
    edge_keys,
    edges_found,
    face_components,
    order_of,
    with_marked_edge,
)
from tests.quadpatch.shapes import joined, moved, open_grid, sphere


def test_edge_k_of_a_triangle_runs_from_its_corner_k() -> None:
    np.testing.assert_array_equal(directed_edges(np.array([[4, 7, 9]])), [[4, 7], [7, 9], [9, 4]])


@given(edges=st.lists(st.tuples(st.integers(0, 40), st.integers(0, 40)), min_size=1, max_size=30))
def test_keys_tell_edges_apart_and_know_no_direction(edges: list[tuple[int, int]]) -> None:
    keys = edge_keys(np.array(edges), 41)
    np.testing.assert_array_equal(keys, edge_keys(np.array(edges)[:, ::-1], 41))
    assert len(np.unique(keys)) == len({frozenset(edge) for edge in edges})


@given(links=st.lists(st.tuples(st.integers(0, 11), st.integers(0, 11)), max_size=14))
def test_components_are_those_of_a_union_find(links: list[tuple[int, int]]) -> None:
    parent = list(range(12))

    def root(i: int) -> int:
        while parent[i] != i:
            i = parent[i]
        return i

    for one, other in links:
        parent[root(one)] = root(other)
    found = components(np.array(links, np.int64).reshape(-1, 2), 12)
    for i in range(12):
        for j in range(12):
            assert (found[i] == found[j]) == (root(i) == root(j))
    assert sorted(set(found.tolist())) == list(range(found.max() + 1))


def test_faces_that_share_a_vertex_are_in_one_component() -> None:
    grid, ball = open_grid(4), moved(sphere(1), (5.0, 0.0, 0.0))
    mesh = joined(grid, ball)
    expected = np.repeat([0, 1], [len(grid.triangles), len(ball.triangles)])
    np.testing.assert_array_equal(face_components(mesh.triangles, len(mesh.vertices)), expected)
    quads = np.array([[0, 1, 2, 3], [7, 8, 9, 10], [3, 4, 5, 6]])
    np.testing.assert_array_equal(face_components(quads, 11), [0, 1, 0])


def test_two_marked_corners_make_a_marked_edge() -> None:
    marked = np.array([True, True, False, False, True])
    found = with_marked_edge(np.array([[0, 1, 2], [3, 4, 0], [2, 1, 3], [0, 1, 4]]), marked)
    assert found.tolist() == [True, True, False, True]


@given(seed=st.integers(0, 99))
def test_directed_edges_are_found_where_they_stand(seed: int) -> None:
    mesh = open_grid(5)
    edges = directed_edges(mesh.triangles)
    wanted = np.random.default_rng(seed).permutation(len(edges))
    start, end = edges[wanted].T
    assert edges_found(mesh.triangles, start, end, 25).tolist() == wanted.tolist()


def test_an_edge_is_not_found_the_other_way_round_or_without_triangles() -> None:
    triangle, start, end = np.array([[0, 1, 2]]), np.array([0, 1, 2]), np.array([1, 0, 0])
    assert edges_found(triangle, start, end, 3).tolist() == [0, -1, 2]
    assert edges_found(triangle[:0], start, end, 3).tolist() == [-1, -1, -1]


@given(st.lists(st.integers(0, 30), max_size=20))
def test_new_numbers_are_those_of_a_sort(indices: list[int]) -> None:
    used, numbers = compacted(np.array(indices, np.int64), 31)
    expected = np.unique(np.array(indices, np.int64), return_inverse=True)
    assert (used.tolist(), numbers.tolist()) == (expected[0].tolist(), expected[1].tolist())


@pytest.mark.parametrize("bound", [7, 2**40, 2**62])
def test_keys_are_sorted_as_by_a_stable_sort_whatever_their_bound(bound: int) -> None:
    keys = np.random.default_rng(0).integers(0, 7, 1000) * (bound // 7)
    np.testing.assert_array_equal(order_of(keys, bound), np.argsort(keys, kind="stable"))
    assert len(order_of(keys[:0], bound)) == 0

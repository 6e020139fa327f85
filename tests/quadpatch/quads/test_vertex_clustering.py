import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from quadpatch.quads.vertex_clustering import cluster_vertices, split_fans
from quadpatch.types import TriangleMesh


def plane(n: int) -> TriangleMesh:
    x, y = np.meshgrid(np.linspace(0, 1, n), np.linspace(0, 1, n))
    index = np.arange(n * n).reshape(n, n)
    a, b, c, d = (part.ravel() for part in (index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]))
    triangles = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    return TriangleMesh(np.stack([x.ravel(), y.ravel(), np.zeros(n * n)], axis=1), triangles)


def area(mesh: TriangleMesh) -> float:
    a, b, c = (mesh.vertices[mesh.triangles[:, k]] for k in range(3))
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()) / 2


def test_a_cell_smaller_than_every_edge_changes_no_triangle() -> None:
    mesh = plane(8)
    thin = cluster_vertices(mesh, 1e-4)
    np.testing.assert_allclose(thin.vertices[thin.triangles], mesh.vertices[mesh.triangles], rtol=0, atol=0)


def test_a_thinned_plane_keeps_its_plane_its_direction_and_nearly_its_area() -> None:
    thin = cluster_vertices(plane(101), 0.05)
    assert len(thin.vertices) == 21**2
    a, b, c = (thin.vertices[thin.triangles[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    assert (normals[:, 2] > 0).all()
    np.testing.assert_array_equal(thin.vertices[:, 2], 0)
    assert area(thin) == pytest.approx(1, rel=0.1)


def test_the_two_sides_of_a_wall_thinner_than_a_cell_stay_apart() -> None:
    front = plane(41)
    vertices = np.concatenate([front.vertices, front.vertices - [0, 0, 1e-3]])
    wall = TriangleMesh(vertices, np.concatenate([front.triangles, front.triangles[:, ::-1] + len(front.vertices)]))
    thin = cluster_vertices(wall, 0.1)
    assert set(np.round(thin.vertices[:, 2], 9)) == {0.0, -1e-3}
    assert area(thin) == pytest.approx(2 * area(cluster_vertices(front, 0.1)))


def test_cells_so_fine_that_their_number_overflows_are_still_told_apart() -> None:
    mesh = plane(5)
    assert len(cluster_vertices(mesh, 1e-9).vertices) == 25


def test_a_copy_of_a_triangle_is_dropped_and_a_sheet_folded_onto_itself_vanishes() -> None:
    mesh = plane(5)
    twice = TriangleMesh(mesh.vertices, np.concatenate([mesh.triangles, mesh.triangles[:, [1, 2, 0]]]))
    np.testing.assert_array_equal(cluster_vertices(twice, 1e-4).triangles, cluster_vertices(mesh, 1e-4).triangles)
    folded = TriangleMesh(mesh.vertices, np.concatenate([mesh.triangles, mesh.triangles[:, ::-1]]))
    assert len(cluster_vertices(folded, 1e-4).triangles) == 0


def test_a_manifold_keeps_its_vertices() -> None:
    mesh = plane(6)
    original, triangles = split_fans(mesh.triangles)
    assert len(original) == len(mesh.vertices)
    np.testing.assert_array_equal(original[triangles], mesh.triangles)


def test_two_fans_at_one_vertex_get_a_vertex_each() -> None:
    original, triangles = split_fans(np.array([[0, 1, 2], [0, 2, 3], [0, 4, 5], [0, 5, 6]]))
    assert sorted(original.tolist()) == [0, 0, 1, 2, 3, 4, 5, 6]
    assert triangles[0, 0] == triangles[1, 0] != triangles[2, 0] == triangles[3, 0]


def test_triangles_turned_against_each_other_are_cut_apart() -> None:
    original, _ = split_fans(np.array([[0, 1, 2], [0, 3, 2][::-1]]))
    assert len(original) == 4
    original, _ = split_fans(np.array([[0, 1, 2], [0, 3, 2]]))
    assert len(original) == 6


@given(st.integers(0, 2**32 - 1))
def test_after_the_cut_no_edge_has_more_than_two_triangles_and_all_are_turned_alike(seed: int) -> None:
    rng = np.random.default_rng(seed)
    soup = rng.integers(0, 8, size=(20, 3))
    soup = soup[(soup[:, 0] != soup[:, 1]) & (soup[:, 1] != soup[:, 2]) & (soup[:, 2] != soup[:, 0])]
    original, triangles = split_fans(soup)
    np.testing.assert_array_equal(original[triangles], soup)
    directed = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    assert len(np.unique(directed, axis=0)) == len(directed)

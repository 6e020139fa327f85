import itertools

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from quadpatch.mesh.smoothing import laplacian_smooth, neighbour_average
from quadpatch.types import TriangleMesh


def grid(n: int) -> TriangleMesh:
    """Build a flat, open grid of n x n unit squares, each cut in two."""
    x, y = np.meshgrid(np.arange(n + 1.0), np.arange(n + 1.0), indexing="xy")
    vertices = np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=1)
    corner = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
    lower = np.stack([corner, corner + 1, corner + n + 2], axis=1)
    upper = np.stack([corner, corner + n + 2, corner + n + 1], axis=1)
    return TriangleMesh(vertices, np.concatenate([lower, upper]))


def bumpy_grid(n: int, seed: int) -> TriangleMesh:
    mesh = grid(n)
    rng = np.random.default_rng(seed)
    return TriangleMesh(mesh.vertices + rng.normal(0.0, 0.2, mesh.vertices.shape), mesh.triangles)


def test_one_iteration_moves_each_vertex_to_the_mean_of_its_neighbours() -> None:
    mesh = bumpy_grid(5, seed=0)
    n = len(mesh.vertices)
    neighbours: list[set[int]] = [set() for _ in range(n)]
    faces_of_edge: dict[frozenset[int], int] = {}
    for a, b, c in mesh.triangles.tolist():
        for i, j in ((a, b), (b, c), (c, a)):
            faces_of_edge[frozenset((i, j))] = faces_of_edge.get(frozenset((i, j)), 0) + 1
            neighbours[i].add(j)
            neighbours[j].add(i)
    rim = {e for e, count in faces_of_edge.items() if count == 1}
    rim_vertices = set().union(*rim)
    smooth = laplacian_smooth(mesh, 1).vertices
    for i in range(n):
        around = [j for j in neighbours[i] if i not in rim_vertices or frozenset((i, j)) in rim]
        np.testing.assert_allclose(smooth[i], mesh.vertices[around].mean(axis=0), atol=1e-12)


@given(seed=st.integers(0, 100), n_iterations=st.integers(0, 30))
@settings(max_examples=20)
def test_a_moved_mesh_smooths_to_the_moved_base_surface(seed: int, n_iterations: int) -> None:
    rng = np.random.default_rng(seed)
    mesh = bumpy_grid(4, seed)
    rotation = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    shift = rng.normal(size=3)
    moved = TriangleMesh(mesh.vertices @ rotation.T + shift, mesh.triangles)
    expected = laplacian_smooth(mesh, n_iterations).vertices @ rotation.T + shift
    np.testing.assert_allclose(laplacian_smooth(moved, n_iterations).vertices, expected, atol=1e-10)


def test_every_iteration_lowers_the_bumps() -> None:
    mesh = bumpy_grid(12, seed=1)
    heights = [laplacian_smooth(mesh, k).vertices[:, 2].std() for k in range(0, 31, 5)]
    assert all(later < earlier for earlier, later in itertools.pairwise(heights))
    assert heights[-1] < 0.2 * heights[0]


def test_an_open_flat_grid_stays_flat_and_keeps_its_sides_away_from_its_corners() -> None:
    smooth = laplacian_smooth(grid(60), 30).vertices.reshape(61, 61, 3)
    assert (smooth[..., 2] == 0.0).all()
    np.testing.assert_allclose(smooth[0, 30], [30.0, 0.0, 0.0], atol=1e-4)


def test_no_iteration_gives_the_same_vertices_and_lonely_vertices_stay() -> None:
    mesh = bumpy_grid(3, seed=2)
    lonely = TriangleMesh(np.vstack([mesh.vertices, [[7.0, 8.0, 9.0]]]), mesh.triangles)
    assert laplacian_smooth(lonely, 0).vertices is lonely.vertices
    smooth = laplacian_smooth(lonely, 5)
    np.testing.assert_array_equal(smooth.vertices[-1], [7.0, 8.0, 9.0])
    assert smooth.triangles is mesh.triangles


def test_rows_of_the_averaging_matrix_sum_to_one_on_a_non_manifold_mesh() -> None:
    fan = np.array([[0, 1, 2], [0, 1, 3], [0, 1, 4], [5, 5, 6]], dtype=np.int64)
    average = neighbour_average(fan, 8)
    np.testing.assert_allclose(average.sum(axis=1), 1.0, rtol=1e-15)

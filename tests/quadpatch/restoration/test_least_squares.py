import numpy as np

from quadpatch.restoration.least_squares import adjacency, extend_smoothly, within_reach
from tests.quadpatch.restoration.boxes import scattered
from tests.quadpatch.shapes import joined, moved, open_grid, relief, sphere


def test_an_even_plane_is_restored_exactly() -> None:
    plane = open_grid(20)
    inner = (np.abs(plane.vertices[:, :2]) < 6).all(axis=1)
    missing = scattered(plane, 0.5) & inner
    restored = extend_smoothly(plane.triangles, missing, plane.vertices)
    np.testing.assert_allclose(restored, plane.vertices, atol=1e-9)


def test_missing_positions_are_never_read_and_measured_ones_keep_their_bits() -> None:
    mesh = relief(30)
    missing = scattered(mesh, 0.5)
    spoilt = np.where(missing[:, None], 1e30, mesh.vertices)
    restored = extend_smoothly(mesh.triangles, missing, spoilt)
    np.testing.assert_array_equal(restored, extend_smoothly(mesh.triangles, missing, mesh.vertices))
    assert restored[~missing].tobytes() == mesh.vertices[~missing].tobytes()


def test_the_sum_of_squared_laplacians_can_not_be_lowered() -> None:
    mesh = relief(12)
    missing = scattered(mesh, 0.4)
    restored = extend_smoothly(mesh.triangles, missing, mesh.vertices)
    neighbours = adjacency(mesh.triangles, len(mesh.vertices))

    def energy(vertices: np.ndarray) -> float:
        mean = (neighbours @ vertices) / neighbours.sum(axis=1)[:, None]
        return float(((vertices - mean) ** 2).sum())

    rng = np.random.default_rng(0)
    for _ in range(5):
        other = restored + 1e-3 * rng.normal(size=restored.shape) * missing[:, None]
        assert energy(restored) < energy(other)


def test_an_edge_of_two_triangles_joins_its_vertices_once() -> None:
    ball = sphere(1)
    degree = adjacency(ball.triangles, len(ball.vertices)).sum(axis=1)
    assert sorted(set(degree.tolist())) == [5.0, 6.0]


def test_a_piece_without_a_measured_vertex_is_out_of_reach() -> None:
    mesh = joined(sphere(1), moved(sphere(1), (5.0, 0, 0)))
    n = len(mesh.vertices) // 2
    missing = np.zeros(2 * n, bool)
    missing[n:] = True
    missing[3] = True
    np.testing.assert_array_equal(np.flatnonzero(within_reach(mesh.triangles, missing)), [3])

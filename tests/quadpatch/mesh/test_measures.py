import numpy as np
import pytest

from quadpatch.mesh.measures import diagonal, edge_statistics, mean_edge_length
from quadpatch.types import TriangleMesh
from tests.quadpatch.shapes import bumpy_plate, open_grid


def test_an_edge_counts_once_for_each_of_its_triangles() -> None:
    assert mean_edge_length(open_grid(5)) == pytest.approx((2 + np.sqrt(2)) / 3)


def test_more_edges_than_are_looked_at_together_have_one_mean_and_one_longest() -> None:
    mesh = bumpy_plate(200, 2.0)
    corners = mesh.vertices[mesh.triangles]
    lengths = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)
    edges = edge_statistics(mesh)
    assert edges.mean == pytest.approx(lengths.mean(), rel=1e-12)
    assert edges.longest == pytest.approx(lengths.max(), rel=1e-12)


def test_the_diagonal_is_that_of_the_box_around_all_triangles() -> None:
    mesh = open_grid(5)
    assert diagonal(mesh) == pytest.approx(4 * np.sqrt(2))
    lonely = TriangleMesh(np.concatenate([mesh.vertices, [[100.0, 0, 0]]]), mesh.triangles)
    assert diagonal(lonely) == diagonal(mesh)


def test_no_triangle_has_no_length() -> None:
    nothing = TriangleMesh(np.ones((3, 3)), np.zeros((0, 3), np.int64))
    assert mean_edge_length(nothing) == diagonal(nothing) == 0.0

import numpy as np
import pytest

from quadpatch.mesh.measures import diagonal, mean_edge_length
from quadpatch.types import TriangleMesh
from tests.quadpatch.shapes import open_grid


def test_an_edge_counts_once_for_each_of_its_triangles() -> None:
    assert mean_edge_length(open_grid(5)) == pytest.approx((2 + np.sqrt(2)) / 3)


def test_the_diagonal_is_that_of_the_box_around_all_triangles() -> None:
    mesh = open_grid(5)
    assert diagonal(mesh) == pytest.approx(4 * np.sqrt(2))
    lonely = TriangleMesh(np.concatenate([mesh.vertices, [[100.0, 0, 0]]]), mesh.triangles)
    assert diagonal(lonely) == diagonal(mesh)


def test_no_triangle_has_no_length() -> None:
    nothing = TriangleMesh(np.ones((3, 3)), np.zeros((0, 3), np.int64))
    assert mean_edge_length(nothing) == diagonal(nothing) == 0.0

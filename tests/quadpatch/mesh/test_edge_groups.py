import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from quadpatch.mesh.edge_groups import group_edges
from quadpatch.types import Triangles
from tests.quadpatch.shapes import open_grid

TWO_FACES: Triangles = np.array([[0, 1, 2], [1, 0, 3]])


def test_the_edge_of_two_faces_is_one_pair() -> None:
    groups = group_edges(TWO_FACES, 4)
    assert groups.ends()[groups.count == 2].tolist() == [[0, 1]]
    (pair,) = groups.pairs.tolist()
    assert groups.edges[pair].tolist() == [[0, 1], [1, 0]]
    assert sorted(groups.count.tolist()) == [1, 1, 1, 1, 2]


@given(n=st.integers(2, 12))
def test_a_grid_has_as_many_edges_as_euler_says(n: int) -> None:
    mesh = open_grid(n)
    groups = group_edges(mesh.triangles, len(mesh.vertices))
    assert len(groups.count) == len(mesh.vertices) + len(mesh.triangles) - 1
    assert (groups.count == 1).sum() == 4 * (n - 1)
    assert (groups.edge[groups.order] == np.repeat(np.arange(len(groups.count)), groups.count)).all()

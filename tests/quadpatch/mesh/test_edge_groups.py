import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from quadpatch.mesh.edge_groups import group_edges, survey_edges
from quadpatch.types import Triangles
from tests.quadpatch.shapes import open_grid, sphere

TWO_FACES: Triangles = np.array([[0, 1, 2], [1, 0, 3]])
FIN: Triangles = np.array([[0, 1, 2], [1, 0, 3], [0, 1, 4]])
DIVIDED: Triangles = np.array([[0, 1, 2], [0, 1, 3]])


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


@pytest.mark.parametrize(
    ("triangles", "is_crowded", "is_divided"),
    [(TWO_FACES, False, False), (FIN, True, True), (DIVIDED, False, True)],
)
def test_a_survey_tells_crowded_and_divided_edges(triangles: Triangles, is_crowded: bool, is_divided: bool) -> None:
    survey = survey_edges(triangles, 5)
    assert (survey.is_crowded, survey.is_divided) == (is_crowded, is_divided)


def test_a_survey_finds_the_rim_of_a_grid_and_none_on_a_sphere() -> None:
    grid = open_grid(5)
    at_rim = np.abs(grid.vertices[:, :2] - grid.vertices[:, :2].mean(axis=0)).max(axis=1)
    assert (survey_edges(grid.triangles, 25).on_boundary == (at_rim == at_rim.max())).all()
    assert not survey_edges(sphere(2).triangles, len(sphere(2).vertices)).on_boundary.any()

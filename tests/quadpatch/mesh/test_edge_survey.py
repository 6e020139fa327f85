"""Tests `quadpatch.mesh.edge_survey` and `quadpatch.mesh.hashes`."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from quadpatch.mesh.edge_groups import group_edges
from quadpatch.mesh.edge_survey import survey_edges
from quadpatch.mesh.hashes import scattered_numbers, shared_hashes, short_numbers
from quadpatch.types import BoolArray, IntArray, Triangles
from tests.quadpatch.shapes import open_grid, sphere

TWO_FACES: Triangles = np.array([[0, 1, 2], [1, 0, 3]])
FIN: Triangles = np.array([[0, 1, 2], [1, 0, 3], [0, 1, 4]])
DIVIDED: Triangles = np.array([[0, 1, 2], [0, 1, 3]])
# Two sheets that touch along an edge: as many faces pass it in one direction as in the other.
TOUCHING: Triangles = np.array([[0, 1, 2], [1, 0, 3], [0, 1, 4], [1, 0, 5]])

FEW = st.integers(0, 12).flatmap(lambda m: arrays(np.int64, (m, 3), elements=st.integers(0, 6)))


@pytest.mark.parametrize(
    ("triangles", "is_crowded", "is_divided"),
    [(TWO_FACES, False, False), (FIN, True, True), (DIVIDED, False, True), (TOUCHING, True, True)],
)
def test_a_survey_tells_crowded_and_divided_edges(triangles: Triangles, is_crowded: bool, is_divided: bool) -> None:
    survey = survey_edges(triangles, 6)
    assert (survey.is_crowded, survey.is_divided) == (is_crowded, is_divided)


def test_a_survey_finds_the_rim_of_a_grid_and_none_on_a_sphere() -> None:
    grid = open_grid(5)
    at_rim = np.abs(grid.vertices[:, :2] - grid.vertices[:, :2].mean(axis=0)).max(axis=1)
    assert (survey_edges(grid.triangles, 25).on_boundary == (at_rim == at_rim.max())).all()
    assert not survey_edges(sphere(2).triangles, len(sphere(2).vertices)).on_boundary.any()


@given(triangles=FEW, is_mirrored=st.booleans())
def test_a_survey_says_what_sorting_all_edges_says(triangles: Triangles, is_mirrored: bool) -> None:
    """Of any triangles: with equal corners, repeated, and each with its mirror image, which leaves no boundary."""
    if is_mirrored:
        triangles = np.concatenate([triangles, triangles[:, ::-1]])
    survey, groups = survey_edges(triangles, 7), group_edges(triangles, 7)
    assert (survey.on_boundary == marked(groups.ends()[groups.count == 1])).all()
    assert (survey.on_crowded == marked(groups.ends()[groups.count > 2])).all()
    directed = groups.edges.tolist()
    assert survey.is_divided == (len({*map(tuple, directed)}) < len(directed))
    beside = np.flatnonzero((survey.on_boundary | survey.on_crowded)[triangles].any(axis=1))
    assert np.isin(beside, survey.near).all()


def marked(vertices: IntArray) -> BoolArray:
    found = np.zeros(7, bool)
    found[vertices] = True
    return found


def test_inside_a_large_sheet_no_triangle_is_near_a_boundary() -> None:
    grid = open_grid(200)
    assert len(survey_edges(grid.triangles, len(grid.vertices)).near) < 10 * 200


def test_no_two_numbers_are_scattered_to_the_same_value() -> None:
    for scattered in (scattered_numbers(100_000), short_numbers(100_000)):
        assert len(np.unique(scattered)) == 100_000


@given(values=st.lists(st.integers(0, 40)))
def test_shared_hashes_are_those_that_come_twice(values: list[int]) -> None:
    hashes = short_numbers(41)[np.array(values, np.int64)]
    assert shared_hashes(hashes).tolist() == [i for i, value in enumerate(values) if values.count(value) > 1]

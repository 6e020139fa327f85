import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from quadpatch.compression.connectivity import NAMED, Walk, decode_polygons, encode_polygons
from quadpatch.errors import ReadError
from quadpatch.types import IntArray
from tests.quadpatch.shapes import cylinder, sphere


def told(walk: Walk) -> Walk:
    """What a file holds of a walk."""
    return Walk(crossed=list(walk.crossed), kinds=list(walk.kinds), names=list(walk.names))


def back(polygons: IntArray) -> IntArray:
    walk, order, vertex = encode_polygons(polygons)
    decoded = told(walk)
    decode_polygons(decoded, len(polygons), polygons.shape[1])
    assert decoded.polygons == walk.polygons
    assert decoded.predictors == walk.predictors
    found = np.zeros_like(polygons)
    found[order] = vertex[np.array(walk.polygons, np.int64).reshape(-1, polygons.shape[1])]
    return found


def same_but_turned(one: IntArray, other: IntArray) -> bool:
    turns = [np.roll(other, k, axis=1) for k in range(other.shape[1])]
    return bool(np.any([(one == turned).all(axis=1) for turned in turns], axis=0).all())


def quad_grid(n: int) -> IntArray:
    at = np.arange(n * n).reshape(n, n)
    return np.stack([at[:-1, :-1], at[:-1, 1:], at[1:, 1:], at[1:, :-1]], axis=-1).reshape(-1, 4)


@pytest.mark.parametrize("polygons", [sphere(2).triangles, cylinder(12, 5).triangles, quad_grid(9)])
def test_polygons_come_back_but_for_their_order(polygons: IntArray) -> None:
    assert same_but_turned(back(polygons), polygons)


@given(st.lists(st.permutations(range(7)), min_size=1, max_size=12))
def test_any_soup_comes_back(rows: list[list[int]]) -> None:
    polygons = np.array(rows, np.int64)[:, :4]
    assert same_but_turned(back(polygons), polygons)


def test_a_regular_grid_names_hardly_a_vertex() -> None:
    walk, _, _ = encode_polygons(quad_grid(20))
    assert walk.kinds.count(NAMED) <= 3


def test_x_runs_on_from_quad_to_quad_of_a_regular_grid() -> None:
    walk, _, vertex = encode_polygons(quad_grid(6))
    quads = vertex[np.array(walk.polygons)]
    assert len(np.unique(quads[:, 1] - quads[:, 0])) == 1


def test_a_new_vertex_of_a_flat_grid_is_predicted_exactly() -> None:
    walk, _, vertex = encode_polygons(quad_grid(8))
    places = np.stack([vertex % 8, vertex // 8], axis=1)
    table = np.array(walk.predictors)
    off = np.abs(places - (places[table[:, 0]] + places[table[:, 1]] - places[table[:, 2]])).max(axis=1)
    # The first quad has nothing to be predicted from.
    assert (off[4:] == 0).all()


@pytest.mark.parametrize("name", ["crossed", "kinds", "names"])
def test_a_walk_that_is_cut_or_goes_on_is_refused(name: str) -> None:
    polygons = np.array([[0, 1, 2], [3, 4, 5], [0, 1, 5]])
    walk, _, _ = encode_polygons(polygons)
    assert walk.names
    for change in (lambda numbers: numbers[:-1], lambda numbers: [*numbers, 1]):
        damaged = told(walk)
        setattr(damaged, name, change(getattr(damaged, name)))
        with pytest.raises(ReadError):
            decode_polygons(damaged, len(polygons), 3)


def test_a_name_of_a_vertex_that_is_not_there_is_refused() -> None:
    with pytest.raises(ReadError, match="names a vertex"):
        decode_polygons(Walk(kinds=[NAMED, NAMED, NAMED], names=[0, 1, 2]), 1, 3)


def test_a_polygon_with_one_corner_twice_is_refused() -> None:
    with pytest.raises(ReadError, match="same corner twice"):
        decode_polygons(Walk(kinds=[0, 0, NAMED], names=[0]), 1, 3)

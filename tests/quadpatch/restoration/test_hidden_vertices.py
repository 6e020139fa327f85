import numpy as np
import pytest

from quadpatch.restoration.hidden_vertices import HIDDEN_SHARE, depths, hide
from quadpatch.types import BoolArray
from tests.quadpatch.restoration.boxes import scattered
from tests.quadpatch.shapes import open_grid

GRID = open_grid(60)


def block(half_width: float) -> BoolArray:
    return np.asarray((np.abs(GRID.vertices[:, :2]) <= half_width).all(axis=1))


def test_the_depth_of_a_vertex_is_its_count_of_edges_to_a_measured_one() -> None:
    missing = block(2.5)  # 6 x 6 vertices
    depth = depths(GRID.triangles, missing)
    assert depth[~missing].max() == 0
    assert depth[missing].min() == 1
    assert depth.max() == 3


def test_only_measured_vertices_are_hidden_and_only_a_few() -> None:
    missing = scattered(GRID, 0.5)
    hidden = hide(GRID.triangles, missing, np.random.default_rng(0))
    assert hidden is not None
    assert not missing[hidden.vertices].any()
    assert len(hidden.vertices) <= HIDDEN_SHARE * (~missing).sum()
    assert hidden.weight.sum() == pytest.approx(1)


def test_deep_gaps_are_tried_on_vertices_as_deep() -> None:
    missing = block(4.5)
    hidden = hide(GRID.triangles, missing, np.random.default_rng(0))
    assert hidden is not None
    depth = depths(GRID.triangles, hidden.with_missing(missing))[hidden.vertices]
    assert depth.max() >= 4
    # The classes of depth weigh as much as they do in the gap: 36, 28 + 20 and 12 + 4 of 100 vertices.
    assert hidden.weight[depth == 1].sum() == pytest.approx(0.36, abs=0.01)


def test_nothing_is_hidden_where_little_is_measured() -> None:
    assert hide(GRID.triangles, ~block(4.5), np.random.default_rng(0)) is None


def test_the_same_generator_hides_the_same_vertices() -> None:
    missing = scattered(GRID, 0.5)
    one, other = (hide(GRID.triangles, missing, np.random.default_rng(3)) for _ in range(2))
    assert one is not None
    assert other is not None
    np.testing.assert_array_equal(one.vertices, other.vertices)

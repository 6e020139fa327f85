"""Polygons and strips cut into triangles."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from quadpatch.formats.polygons import list_range, triangulate_polygons, triangulate_strips
from quadpatch.types import FloatArray, Triangles
from tests.quadpatch.shapes import random_rotation


def signed_areas(points: FloatArray, triangles: Triangles, normal: FloatArray) -> FloatArray:
    a, b, c = np.moveaxis(points[triangles], 1, 0)
    return np.asarray(np.cross(b - a, c - a) @ normal / 2)


@given(n=st.integers(3, 25), seed=st.integers(0, 1000))
def test_star_shaped_polygons_are_covered_once_and_keep_their_orientation(n: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    angle = np.sort(rng.permutation(200)[:n]) / 200 * 2 * np.pi
    if np.diff(np.append(angle, angle[0] + 2 * np.pi)).max() >= np.pi:
        return
    radius = rng.uniform(0.3, 1, n)
    flat = np.stack([radius * np.cos(angle), radius * np.sin(angle), np.zeros(n)], axis=1)
    area = np.cross(flat, np.roll(flat, -1, axis=0))[:, 2].sum() / 2
    rotation = random_rotation(rng)
    points = flat @ rotation.T
    triangles, owner = triangulate_polygons(points, np.array([n]), np.arange(n))
    assert len(triangles) == n - 2
    assert (owner == 0).all()
    areas = signed_areas(points, triangles, rotation[:, 2])
    assert areas.min() > -1e-9
    assert np.isclose(areas.sum(), area)


def test_polygons_of_all_sizes_keep_their_order() -> None:
    angle = np.arange(12) / 12 * 2 * np.pi
    points = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    counts = np.array([5, 3, 2, 4, 3, 0, 6])
    corners = np.concatenate([np.arange(size) + size for size in counts]) % 12
    triangles, owner = triangulate_polygons(points, counts, corners)
    assert owner.tolist() == [0, 0, 0, 1, 3, 3, 4, 6, 6, 6, 6]
    assert triangles[3].tolist() == [3, 4, 5]


@pytest.mark.parametrize("turn", range(4))
def test_a_concave_quad_is_cut_at_its_reflex_corner(turn: int) -> None:
    points = np.roll(np.array([[0.0, 0, 0], [4, 0, 0], [4, 4, 0], [3, 1, 0]]), turn, axis=0)
    triangles, _ = triangulate_polygons(points, np.array([4]), np.arange(4))
    assert (signed_areas(points, triangles, np.array([0.0, 0, 1])) > 0).all()


def test_polygons_without_area_do_no_harm() -> None:
    triangles, _ = triangulate_polygons(np.zeros((3, 3)), np.array([6, 5]), np.zeros(11, np.int64))
    assert len(triangles) == 7


def test_strips_leave_out_what_only_leads_them_on() -> None:
    triangles = triangulate_strips(np.array([6, 3]), np.array([0, 1, 2, 2, 3, 4, 5, 6, 7]))
    assert triangles.tolist() == [[0, 1, 2], [3, 2, 4], [5, 6, 7]]


def test_empty_strips_give_nothing() -> None:
    assert triangulate_strips(np.array([0, 2, 3]), np.array([0, 1, -1, 0, -1])).shape == (0, 3)


@given(st.lists(st.tuples(st.integers(0, 50), st.integers(0, 5)), max_size=20))
def test_list_ranges_are_what_a_loop_would_give(lists: list[tuple[int, int]]) -> None:
    starts, counts = (np.array(part, dtype=np.int64) for part in (zip(*lists, strict=True) if lists else ([], [])))
    expected = [start + i for start, count in lists for i in range(count)]
    assert list_range(starts, counts).tolist() == expected

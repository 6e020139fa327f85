from collections import Counter

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from quadpatch.filling.division import RimLoop, divide
from quadpatch.filling.triangulation import EdgeSet
from quadpatch.types import FloatArray, IntArray
from tests.quadpatch.shapes import random_rotation

NOTHING = EdgeSet(np.zeros((0, 2), np.int64))


def outline(*corners: tuple[float, float], step: float) -> FloatArray:
    """Vertices (n, 3) along the sides of a flat polygon, given clockwise, about `step` apart."""
    sides = zip(np.array(corners), np.roll(np.array(corners), -1, axis=0), strict=True)
    points = [
        start + (end - start) * np.linspace(0, 1, max(1, round(float(np.hypot(*(end - start))) / step)), False)[:, None]
        for start, end in sides
    ]
    return np.column_stack([np.concatenate(points), np.zeros(sum(map(len, points)))])


def ellipse(n: int, width: float = 1.0) -> FloatArray:
    angle = -2 * np.pi * np.arange(n) / n
    return np.stack([np.cos(angle), width * np.sin(angle), np.zeros(n)], axis=1)


def flower(n: int) -> FloatArray:
    angle = -2 * np.pi * np.arange(n) / n
    return (1 + 0.5 * np.cos(9 * angle))[:, None] * ellipse(n)


def comb(n_teeth: int, depth: float = 10.0) -> FloatArray:
    """A hole into which fingers of surface reach, one unit wide and one unit apart."""
    corners = [(0.0, -3.0), (0.0, depth)]
    for i in range(n_teeth):
        x = 2.0 * i + 1
        corners += [(x, depth), (x, 0.0), (x + 1, 0.0), (x + 1, depth)]
    end = 2.0 * n_teeth + 1
    return outline(*corners, (end, depth), (end, -3.0), step=0.5)


def spiral(n_turns: int) -> FloatArray:
    angle = np.linspace(0, 2 * np.pi * n_turns, 40 * n_turns)
    inner, outer = (
        (1 + angle / (2 * np.pi) + side)[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
        for side in (-0.2, 0.2)
    )
    return outline(*map(tuple, inner), *map(tuple, outer[::-1]), step=0.3)


def area(corners: FloatArray) -> float:
    """Positive for a polygon that runs clockwise, as rims of holes in a plane do."""
    x, y = corners[:, :2].T
    return float((np.roll(x, -1) * y - x * np.roll(y, -1)).sum() / 2)


SHAPES = {
    "disc": ellipse(500),
    "crack": ellipse(500, 0.01),
    "flower": flower(600),
    "comb": comb(12),
    "spiral": spiral(4),
    "L": outline((0, 0), (0, 9), (3, 9), (3, 3), (9, 3), (9, 0), step=0.1),
}


def loop_of(corners: FloatArray, vertices: IntArray | None = None) -> RimLoop:
    up = np.tile([0.0, 0, 1], (len(corners), 1))
    return RimLoop(np.arange(len(corners)) if vertices is None else vertices, up)


def edges_of(loop: RimLoop) -> list[tuple[int, int]]:
    return list(zip(loop.vertices.tolist(), np.roll(loop.vertices, -1).tolist(), strict=True))


def chords_of(parts: list[RimLoop], loop: RimLoop) -> list[tuple[int, int]]:
    rim = set(edges_of(loop))
    return [edge for part in parts for edge in edges_of(part) if edge not in rim and edge[0] < edge[1]]


def assert_divided(parts: list[RimLoop], loop: RimLoop, max_size: int) -> None:
    """Parts are small, pass every rim edge once and every chord twice, to and fro, and carry the rim's normals."""
    assert parts
    assert max(len(part.vertices) for part in parts) <= max_size
    assert min(len(part.vertices) for part in parts) >= 3
    rim = dict(zip(edges_of(loop), loop.normals.tolist(), strict=True))
    passed = Counter(edge for part in parts for edge in edges_of(part))
    assert set(passed.values()) == {1}
    assert set(rim) <= set(passed)
    chords = set(passed) - set(rim)
    assert len(chords) == 2 * (len(parts) - 1)
    assert {(end, start) for start, end in chords} == chords
    for part in parts:
        assert np.linalg.norm(part.normals, axis=1) == pytest.approx(1)
        for edge, normal in zip(edges_of(part), part.normals.tolist(), strict=True):
            assert rim.get(edge, normal) == normal


@pytest.mark.parametrize("max_size", [16, 128])
@pytest.mark.parametrize("name", SHAPES)
def test_parts_pass_the_rim_once_and_each_chord_to_and_fro(name: str, max_size: int) -> None:
    loop = loop_of(SHAPES[name])
    assert_divided(divide(loop, SHAPES[name], max_size, NOTHING.contains), loop, max_size)


@pytest.mark.parametrize("name", SHAPES)
def test_parts_of_a_flat_hole_lie_in_it_and_fill_it(name: str) -> None:
    corners = SHAPES[name]
    parts = divide(loop_of(corners), corners, 64, NOTHING.contains)
    areas = [area(corners[part.vertices]) for part in parts]
    assert min(areas) > 0
    assert sum(areas) == pytest.approx(area(corners))


@pytest.mark.parametrize("n", [130, 201, 511, 512, 513, 2000])
def test_the_first_chord_of_a_disc_is_nearly_a_diameter(n: int) -> None:
    corners = ellipse(n)
    one, other = divide(loop_of(corners), corners, n // 2 + 10, NOTHING.contains)
    ((start, end),) = chords_of([one, other], loop_of(corners))
    assert np.linalg.norm(corners[start] - corners[end]) > 1.99


@pytest.mark.parametrize("width", [0.1, 0.01, 0.001])
def test_chords_of_a_long_crack_lead_across_it(width: float) -> None:
    corners = outline((0, 0), (0, width), (10, width), (10, 0), step=0.02)
    loop = loop_of(corners)
    chords = np.array(chords_of(divide(loop, corners, 128, NOTHING.contains), loop))
    lengths = np.linalg.norm(corners[chords[:, 0]] - corners[chords[:, 1]], axis=1)
    assert len(chords) >= len(corners) // 128
    assert lengths.max() < width + 0.05


def test_a_short_loop_is_its_only_part() -> None:
    loop = loop_of(ellipse(100))
    assert divide(loop, ellipse(100), 100, NOTHING.contains) == [loop]


@given(seed=st.integers(0, 2**32 - 1), size=st.sampled_from([1e-12, 1e-6, 1e6, 1e12]))
@settings(max_examples=4)
def test_a_rim_in_another_unit_and_place_is_divided_alike(seed: int, size: float) -> None:
    rng = np.random.default_rng(seed)
    n = 300
    corners = ellipse(n) * rng.uniform(0.9, 1.1, (n, 1)) + [0, 0, 1] * rng.normal(0, 0.02, (n, 1))
    rotation = random_rotation(rng)
    moved = size * (corners @ rotation.T + rng.normal(0, 3, 3))
    here = divide(loop_of(corners), corners, 64, NOTHING.contains)
    there = divide(RimLoop(np.arange(n), loop_of(corners).normals @ rotation.T), moved, 64, NOTHING.contains)
    assert [part.vertices.tolist() for part in here] == [part.vertices.tolist() for part in there]


def test_vertices_keep_their_numbers_wherever_the_loop_starts() -> None:
    numbers = np.random.default_rng(0).permutation(1000)[:400]
    points = np.zeros((1000, 3))
    points[numbers] = ellipse(400)
    loop = loop_of(ellipse(400), numbers)
    assert_divided(divide(loop, points, 100, NOTHING.contains), loop, 100)


def test_chords_that_are_taken_are_not_used_again() -> None:
    corners = ellipse(200)
    existing_edges = EdgeSet(np.stack([np.arange(200), (np.arange(200) + 100) % 200], axis=1))
    loop = loop_of(corners)
    parts = divide(loop, corners, 101, existing_edges.contains)
    assert_divided(parts, loop, 101 - 1)
    assert not existing_edges.contains(np.array(chords_of(parts, loop))).any()


def test_a_loop_whose_chords_are_all_taken_has_no_parts() -> None:
    corners = ellipse(40)
    every = EdgeSet(np.array([(i, j) for j in range(40) for i in range(j)]))
    assert divide(loop_of(corners), corners, 20, every.contains) == []


def test_a_bridge_to_an_island_belongs_to_the_parts_on_both_of_its_sides() -> None:
    # A ring: clockwise along the outer rim, over the bridge, along the island the other way round, and back.
    outer, inner = ellipse(200), 0.5 * ellipse(200)[::-1]
    points = np.concatenate([outer, inner])
    island = 200 + np.roll(np.arange(200), -199)
    vertices = np.concatenate([[*range(200), 0], island, [island[0]]])
    loop = RimLoop(vertices, np.tile([0.0, 0, 1], (len(vertices), 1)))
    bridge = EdgeSet(np.array([[0, island[0]], [0, 0], [island[0], island[0]]]))
    parts = divide(loop, points, 64, bridge.contains)
    assert_divided(parts, loop, 64)
    areas = [area(points[part.vertices]) for part in parts]
    assert min(areas) > 0
    assert sum(areas) == pytest.approx(area(outer) + area(inner))

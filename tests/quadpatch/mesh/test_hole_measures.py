"""Also tests `quadpatch.mesh.loop_shapes`."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from quadpatch.mesh.hole_measures import Hole, find_holes
from quadpatch.mesh.loop_diameter import loop_diameter
from quadpatch.types import FloatArray, TriangleMesh
from tests.quadpatch.shapes import cylinder, open_grid, punched, random_rotation, sphere


def ring(loop: FloatArray, outward: float = 0.2) -> TriangleMesh:
    """A band of triangles around a clockwise loop (n, 3) in space, so that the loop is the rim of a hole."""
    n = len(loop)
    here, after = np.arange(n), np.roll(np.arange(n), -1)
    triangles = np.concatenate([np.stack([here, after, n + here], 1), np.stack([after, n + after, n + here], 1)])
    return TriangleMesh(np.concatenate([loop, loop * (1 + outward)]), triangles)


def circle(n: int, radius: float = 1.0) -> FloatArray:
    angle = -2 * np.pi * np.arange(n) / n
    return radius * np.stack([np.cos(angle), np.sin(angle), np.zeros(n)], axis=1)


def inner_hole(mesh: TriangleMesh) -> Hole:
    return min(find_holes(mesh), key=lambda hole: hole.perimeter)


@pytest.mark.parametrize("n", [6, 64, 400, 401, 1000, 5000])
def test_a_circle_has_the_measures_of_its_polygon(n: int) -> None:
    found = inner_hole(ring(circle(n, 2.5)))
    assert found.n_edges == n
    assert found.perimeter == pytest.approx(2.5 * n * 2 * np.sin(np.pi / n), rel=1e-12)
    assert found.area == pytest.approx(2.5**2 * n / 2 * np.sin(2 * np.pi / n), rel=1e-12)
    assert found.diameter == pytest.approx(5.0 if n % 2 == 0 else 5.0 * np.cos(np.pi / n / 2), rel=1e-9)
    assert found.planarity < 1e-15
    assert found.is_manifold
    assert not found.is_border


@given(n=st.integers(3, 900), seed=st.integers(0, 2**32 - 1), flat=st.booleans())
@settings(max_examples=40)
def test_the_diameter_is_the_largest_distance_between_two_vertices(n: int, seed: int, flat: bool) -> None:
    rng = np.random.default_rng(seed)
    loop = circle(n) * rng.uniform(0.5, 2, (n, 1)) * [1.0, 0.3, 1.0]
    loop += np.array([0, 0, 0 if flat else 1]) * rng.normal(0, 0.2, (n, 1))
    loop = loop @ random_rotation(rng)
    apart = max(float(np.linalg.norm(loop - point, axis=1).max()) for point in loop)
    assert inner_hole(ring(loop, 1.0)).diameter == pytest.approx(apart, rel=1e-9)


def test_a_long_loop_whose_every_vertex_is_extreme_is_measured() -> None:
    # On a sphere no vertex of a loop lies inside the others' hull.
    n = 5000
    angle = -2 * np.pi * np.arange(n) / n
    height = 0.3 * np.cos(40 * angle)
    loop = np.stack([np.sqrt(1 - height**2) * np.cos(angle), np.sqrt(1 - height**2) * np.sin(angle), height], axis=1)
    assert inner_hole(ring(loop)).diameter == pytest.approx(2.0, rel=1e-3)


@pytest.mark.parametrize("n_corners", [3, 5])
def test_a_long_flat_loop_of_even_width_is_measured_exactly(n_corners: int) -> None:
    # Arcs around the corners of a polygon, as wide in all directions: only exact corners give the exact width.
    corner = circle(n_corners)
    radius = max(float(np.linalg.norm(corner - point, axis=1).max()) for point in corner)
    arcs = []
    for k in range(n_corners):
        far = [(k + n_corners // 2) % n_corners, (k + n_corners // 2 + 1) % n_corners]
        start, end = (corner[i] - corner[k] for i in far)
        way = np.linspace(0, 1, 200, endpoint=False)[:, None]
        between = (1 - way) * start + way * end
        arcs.append(corner[k] + radius * between / np.linalg.norm(between, axis=1, keepdims=True))
    loop = np.concatenate(arcs)
    apart = max(float(np.linalg.norm(loop - point, axis=1).max()) for point in loop)
    assert inner_hole(ring(loop)).diameter == pytest.approx(apart, rel=1e-12)


def test_a_long_loop_on_a_line_is_as_wide_as_the_line_is_long() -> None:
    n = 500
    line = np.column_stack([np.abs(np.arange(n) - n / 2), np.zeros((n, 2))]) @ random_rotation(np.random.default_rng(0))
    found = inner_hole(ring(line + np.array([0, 0, 1]), 0.0))
    assert found.diameter == pytest.approx(n / 2)
    assert found.area == pytest.approx(0, abs=1e-9)


def test_planarity_is_the_distance_from_the_best_plane_in_diameters() -> None:
    n = 64
    saddle = circle(n) + np.stack([np.zeros(n), np.zeros(n), 0.2 * np.cos(4 * np.pi * np.arange(n) / n)], axis=1)
    found = inner_hole(ring(saddle))
    assert found.planarity == pytest.approx(0.2 / np.sqrt(2) / 2, rel=0.03)
    assert found.area == pytest.approx(n / 2 * np.sin(2 * np.pi / n), rel=1e-12)


@given(seed=st.integers(0, 2**32 - 1))
@settings(max_examples=20)
def test_measures_move_with_the_mesh(seed: int) -> None:
    rng = np.random.default_rng(seed)
    mesh = punched(sphere(3), (0, 0, 1), (0, -0.9, 0.4), radius=0.4)
    moved = TriangleMesh(mesh.vertices @ random_rotation(rng).T + rng.normal(0, 10, 3), mesh.triangles)
    holes = find_holes(mesh)
    assert len(holes) == 2
    for before, after in zip(holes, find_holes(moved), strict=True):
        assert (before.loop == after.loop).all()
        assert before.kind == after.kind
        for name in ("perimeter", "diameter", "area", "planarity"):
            assert getattr(after, name) == pytest.approx(getattr(before, name), rel=1e-9, abs=1e-12)


def test_ids_count_up_from_the_longest_perimeter() -> None:
    mesh = punched(open_grid(30), (-8, -8, 0), (8, -8, 0), (8, 8, 0), radius=1.2)
    mesh = punched(mesh, (-8, 8, 0), radius=3.2)
    found = find_holes(mesh)
    assert [one.id for one in found] == list(range(5))
    perimeters = [one.perimeter for one in found]
    assert perimeters == sorted(perimeters, reverse=True)
    # Equal ones stand in the order of their first vertex.
    assert int(found[2].loop[0]) < int(found[3].loop[0]) < int(found[4].loop[0])


def test_closed_meshes_have_no_holes() -> None:
    assert find_holes(sphere(1)) == []


def test_every_hole_says_where_it_is() -> None:
    found = inner_hole(ring(circle(40, 2.5) + np.array([7.0, -1.0, 3.0])))
    assert found.centre == pytest.approx((7.0, -1.0, 3.0))
    assert found.normal == pytest.approx((0.0, 0.0, 1.0))
    assert found.low == pytest.approx((4.5, -3.5, 3.0))
    assert found.high == pytest.approx((9.5, 1.5, 3.0))


def test_the_centre_does_not_follow_the_side_with_more_vertices() -> None:
    angle = -2 * np.pi * np.concatenate([np.arange(10) / 20, 0.5 + np.arange(500) / 1000])
    found = inner_hole(ring(np.stack([np.cos(angle), np.sin(angle), np.zeros(len(angle))], axis=1)))
    assert found.centre == pytest.approx((0.0, 0.0, 0.0), abs=0.02)


@given(seed=st.integers(0, 2**32 - 1))
@settings(max_examples=20)
def test_a_hole_faces_away_from_the_surface_around_it(seed: int) -> None:
    # On a ball the normal points outwards, and so does the plane over the end of a tube, whose own normals cancel out.
    rng = np.random.default_rng(seed)
    turn, shift = random_rotation(rng), rng.normal(0, 10, 3)
    for mesh, facing in ((punched(sphere(3), (0, 0, 1), radius=0.4), [0, 0, 1]), (cylinder(24, 12), [0, 0, -1])):
        (*_, found) = find_holes(TriangleMesh(mesh.vertices @ turn.T + shift, mesh.triangles))
        expected = turn @ np.array(facing)
        if found.kind == "open_end":
            expected *= np.sign((np.array(found.centre) - shift) @ expected)
        assert found.normal == pytest.approx(tuple(expected), abs=0.02)
        assert np.linalg.norm(found.normal) == pytest.approx(1.0)


def test_a_hole_without_any_area_has_a_unit_normal() -> None:
    line = np.column_stack([np.abs(np.arange(50) - 25.0), np.zeros((50, 2))])
    for found in find_holes(ring(line + np.array([0, 0, 1]), 0.0)):
        assert np.linalg.norm(found.normal) == pytest.approx(1.0)


@pytest.mark.parametrize("scale", [1e-50, 1.0, 1e30])
def test_measures_scale_with_the_mesh(scale: float) -> None:
    mesh = punched(sphere(3), (0, 0, 1), radius=0.4)
    (one,), (scaled,) = find_holes(mesh), find_holes(TriangleMesh(mesh.vertices * scale, mesh.triangles))
    assert scaled.planarity == pytest.approx(one.planarity, rel=1e-6)
    assert scaled.diameter == pytest.approx(one.diameter * scale, rel=1e-6)
    assert scaled.kind == one.kind


@pytest.mark.parametrize("shape", ["circle", "ball", "oval"])
def test_a_loop_of_80_000_extreme_vertices_is_measured_closely(shape: str) -> None:
    n = 80_000
    angle = -2 * np.pi * np.arange(n) / n
    height = {"circle": 0.0, "ball": 0.3, "oval": 0.0}[shape] * np.cos(40 * angle)
    radius = np.sqrt(1 - height**2)
    points = np.stack([radius * np.cos(angle), radius * np.sin(angle), height], axis=1)
    width = 2.0
    if shape == "oval":
        # An oval whose longest way lies between the directions that are tried.
        points = points * [1.0, 0.9, 1.0]
    flipped = points @ random_rotation(np.random.default_rng(5))
    assert width * 0.998 <= loop_diameter(flipped) <= width * (1 + 1e-12)

import gc

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from quadpatch.mesh.raycast import Places, RayScene
from quadpatch.types import FloatArray, TriangleMesh


def wave_mesh(n: int = 60) -> TriangleMesh:
    x, y = np.meshgrid(np.linspace(-1, 1, n), np.linspace(-1, 1, n))
    vertices = np.stack([x.ravel(), y.ravel(), 0.2 * np.sin(4 * x + 3 * y).ravel()], axis=1)
    index = np.arange(n * n).reshape(n, n)
    a, b, c, d = (part.ravel() for part in (index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]))
    return TriangleMesh(vertices, np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)]))


def down(origins: FloatArray) -> FloatArray:
    return np.tile([0.0, 0.0, -1.0], (len(origins), 1))


def test_distance_is_exact_on_a_tilted_plane() -> None:
    corners = np.array([[-3.0, -3, -1], [5, -3, 3], [-3, 5, -1]])  # z = x / 2 + 1 / 2
    scene = RayScene(TriangleMesh(corners, np.array([[0, 1, 2]])))
    rng = np.random.default_rng(1)
    xy = rng.uniform(-2.5, 0.5, size=(500, 2))
    origins = np.column_stack([xy, np.full(500, 7.0)])
    triangle, distance = scene.cast(origins, down(origins))
    assert (triangle == 0).all()
    np.testing.assert_allclose(distance, 7 - (xy[:, 0] / 2 + 0.5), rtol=1e-14)


def test_length_of_the_direction_does_not_change_the_distance() -> None:
    scene = RayScene(wave_mesh())
    origins = np.array([[0.11, 0.23, 2.0], [-0.4, 0.3, 2.0]])
    one = scene.cast(origins, down(origins))
    ten = scene.cast(origins, 10 * down(origins))
    np.testing.assert_array_equal(one[0], ten[0])
    np.testing.assert_allclose(one[1], ten[1], rtol=1e-14)


def test_no_ray_slips_through_vertices_and_edges() -> None:
    mesh = wave_mesh()
    scene = RayScene(mesh)
    is_inner = np.abs(mesh.vertices[:, :2]).max(axis=1) < 0.9
    edges = np.concatenate([mesh.triangles[:, [0, 1]], mesh.triangles[:, [1, 2]]])
    middles = mesh.vertices[edges].mean(axis=1)
    targets = np.concatenate([mesh.vertices[is_inner], middles[np.abs(middles[:, :2]).max(axis=1) < 0.9]])
    rng = np.random.default_rng(2)
    for _ in range(5):
        # Slopes of the wave stay under 1, so a ray this steep can't pass it by.
        directions = np.column_stack([rng.uniform(-0.5, 0.5, (len(targets), 2)), -np.ones(len(targets))])
        triangle, distance = scene.cast(targets - directions, directions)
        assert (triangle >= 0).all()
        np.testing.assert_allclose(distance, np.linalg.norm(directions, axis=1), atol=1e-5)


def test_details_of_a_hundredth_survive_coordinates_of_a_million() -> None:
    mesh = wave_mesh()
    here = TriangleMesh(0.01 * mesh.vertices, mesh.triangles)
    shift = np.array([1e6, -1e6, 2e6])
    there = TriangleMesh(here.vertices + shift, mesh.triangles)
    rng = np.random.default_rng(3)
    origins = np.column_stack([rng.uniform(-0.009, 0.009, (2000, 2)), np.full(2000, 0.05)])
    triangle_here, distance_here = RayScene(here).cast(origins, down(origins))
    triangle_there, distance_there = RayScene(there).cast(origins + shift, down(origins))
    assert (triangle_there >= 0).all()
    assert (triangle_here == triangle_there).mean() > 0.999
    # Coordinates themselves are rounded to 1e-10 there.
    np.testing.assert_allclose(distance_there, distance_here, atol=2e-9)


@given(height=st.floats(1.5, 1e6))
def test_far_origins_lose_no_digits(height: float) -> None:
    scene = RayScene(wave_mesh(20))
    origins = np.array([[0.131, 0.257, height]])
    near = scene.cast(np.array([[0.131, 0.257, 1.0]]), down(origins))
    triangle, distance = scene.cast(origins, down(origins))
    assert triangle[0] == near[0][0]
    assert distance[0] - (height - 1) == pytest.approx(near[1][0], abs=1e-15 * height + 1e-12)


def test_ray_on_the_surface_sees_it_when_it_starts_resolution_before_it() -> None:
    n = 20
    x, y = np.meshgrid(np.linspace(-1, 1, n), np.linspace(-1, 1, n))
    flat = wave_mesh(n).vertices * [1, 1, 0]
    tilt = np.array([[0.8, 0, -0.6], [0, 1, 0], [0.6, 0, 0.8]])
    mesh = TriangleMesh(flat @ tilt, wave_mesh(n).triangles)
    scene = RayScene(mesh)
    points = np.stack([0.9 * x.ravel(), 0.9 * y.ravel(), 0 * x.ravel()], axis=1) @ tilt
    direction = np.tile(tilt[2], (len(points), 1))
    triangle, distance = scene.cast(points - 2 * scene.resolution * direction, direction)
    assert (triangle >= 0).all()
    np.testing.assert_allclose(distance, 2 * scene.resolution, atol=1e-14)


def test_misses_are_minus_one_at_infinity() -> None:
    triangle, distance = RayScene(wave_mesh(5)).cast(np.array([[0.0, 0, 1]]), np.array([[0.0, 0, 1]]))
    assert triangle.tolist() == [-1]
    assert np.isinf(distance).all()


def test_empty_mesh_is_never_hit() -> None:
    scene = RayScene(TriangleMesh(np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int64)))
    triangle, _ = scene.cast(np.zeros((3, 3)), np.ones((3, 3)))
    assert triangle.tolist() == [-1, -1, -1]


def test_no_rays_give_no_hits() -> None:
    triangle, distance = RayScene(wave_mesh(5)).cast(np.zeros((0, 3)), np.zeros((0, 3)))
    assert triangle.shape == distance.shape == (0,)


def test_triangles_without_area_and_stray_vertices_change_nothing() -> None:
    mesh = wave_mesh(20)
    stray = TriangleMesh(
        np.concatenate([mesh.vertices, [[1e9, 0, 0]]]), np.concatenate([mesh.triangles, [[0, 0, 5], [3, 3, 3]]])
    )
    origins = np.column_stack([np.random.default_rng(4).uniform(-0.9, 0.9, (300, 2)), np.full(300, 2.0)])
    for one, other in zip(
        RayScene(mesh).cast(origins, down(origins)), RayScene(stray).cast(origins, down(origins)), strict=True
    ):
        np.testing.assert_array_equal(one, other)


def test_scene_outlives_the_mesh_it_was_built_from() -> None:
    mesh = wave_mesh(200)
    origins = np.column_stack([np.random.default_rng(5).uniform(-0.9, 0.9, (5000, 2)), np.full(5000, 2.0)])
    scene = RayScene(mesh)
    expected = scene.cast(origins, down(origins))[0]
    del mesh
    gc.collect()
    litter = [np.full((200_000, 3), 7, dtype=np.int32) for _ in range(5)]
    again = scene.cast(origins, down(origins))[0]
    assert len(litter) == 5
    assert (expected >= 0).all()
    np.testing.assert_array_equal(again, expected)


def places_on(plane: FloatArray, n: int = 50) -> tuple[Places, FloatArray]:
    """Places in a picture of n times n pixels, and the points on its plane."""
    places = np.indices((n, n), dtype=np.float32).reshape(2, -1) + np.float32(0.3)
    return places, np.column_stack([np.ones(n * n), *places]) @ plane


def test_a_view_sees_what_single_rays_hit() -> None:
    mesh = wave_mesh()
    # A tilted view of a mesh far from the origin, with room around it.
    far = TriangleMesh(1000 * mesh.vertices + [5e4, -2e4, 1e4], mesh.triangles)
    scene = RayScene(far)
    direction = np.array([0.0, 0.6, -0.8])
    plane = np.array([[5e4 - 1500, -2e4 - 2700, 1e4 + 2000], [60, 0, 0], [0, 48, 36]])
    places, origins = places_on(plane)
    seen = scene.seen_in(plane, direction, places)
    expected, _ = scene.cast(origins, np.tile(direction, (len(origins), 1)))
    assert 0.2 < (expected >= 0).mean() < 0.9
    assert (seen == expected).mean() > 0.99
    nothing = RayScene(TriangleMesh(mesh.vertices, mesh.triangles[:0]))
    assert (nothing.seen_in(plane, direction, places) == -1).all()


def test_a_view_goes_through_clear_triangles_and_sees_what_lies_behind() -> None:
    mesh = wave_mesh(12)
    n = len(mesh.triangles)
    layers = [mesh.vertices + np.array([0, 0, height]) for height in (0.0, 0.5, 1.0)]
    stack = TriangleMesh(
        np.concatenate(layers), np.concatenate([mesh.triangles + k * len(mesh.vertices) for k in range(3)])
    )
    scene = RayScene(stack)
    direction = np.array([0.0, 0.0, -1.0])
    plane = np.array([[-1.1, -1.1, 2.0], [2.2 / 50, 0, 0], [0, 2.2 / 50, 0]])
    places, _ = places_on(plane)
    top = scene.seen_in(plane, direction, places)
    assert (top[top >= 0] >= 2 * n).all()
    through = scene.seen_in(plane, direction, places, np.arange(3 * n) >= n)
    assert through.max() < n
    # A ray that meets an edge may see either of its triangles.
    assert (through == np.where(top >= 0, top - 2 * n, -1)).mean() > 0.98
    assert (scene.seen_in(plane, direction, places, np.ones(3 * n, dtype=bool)) == -1).all()


def test_a_surface_hides_points_unless_it_is_out_of_reach() -> None:
    scene = RayScene(wave_mesh())
    below = np.array([[0.1, 0.2, -2.0], [0.1, 0.2, 2.0], [5.0, 0.0, -2.0]])
    up = np.tile([0.0, 0.0, 1.0], (3, 1))
    assert scene.is_hidden(below, up).tolist() == [True, False, False]
    assert scene.is_hidden(below, up, 2.5).tolist() == [True, False, False]
    assert not scene.is_hidden(below, up, 1.5).any()
    empty = RayScene(TriangleMesh(np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int64)))
    assert not empty.is_hidden(below, up).any()

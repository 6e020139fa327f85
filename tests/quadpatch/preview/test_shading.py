"""Tests `quadpatch.preview.facets` and `quadpatch.preview.sampling` as well."""

import numpy as np
import pytest

from quadpatch.mesh.raycast import RayScene
from quadpatch.preview.camera import Camera
from quadpatch.preview.shading import BACK, BACKGROUND, CLAY, Clay
from quadpatch.types import FloatArray, TriangleMesh

FRONT = Camera(np.zeros(3), np.array([1.0, 0, 0]), np.array([0.0, 1, 0]), np.array([0.0, 0, 1]), 4.0, 5.0)
BEHIND = Camera(np.zeros(3), np.array([-1.0, 0, 0]), np.array([0.0, 1, 0]), np.array([0.0, 0, -1]), 4.0, 5.0)


def sphere(n: int = 40) -> TriangleMesh:
    """Unit sphere with its seam, where vertices are not shared, at the back."""
    u, v = np.meshgrid(np.linspace(0, np.pi, n), np.linspace(-np.pi, np.pi, 2 * n), indexing="ij")
    vertices = np.stack([np.sin(u) * np.sin(v), np.cos(u), np.sin(u) * np.cos(v)], axis=-1).reshape(-1, 3)
    index = np.arange(2 * n * n).reshape(n, 2 * n)
    a, b, c, d = (part.ravel() for part in (index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]))
    return TriangleMesh(vertices, np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)]))


def square() -> TriangleMesh:
    corners = np.array([[-1.0, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
    return TriangleMesh(corners, np.array([[0, 1, 2], [0, 2, 3]]))


def draw(mesh: TriangleMesh, camera: Camera = FRONT, size: tuple[int, int] = (80, 80)) -> FloatArray:
    return Clay(mesh, RayScene(mesh), np.tile(CLAY, (len(mesh.triangles), 1))).draw(camera, size)


def is_background(picture: FloatArray) -> FloatArray:
    return np.asarray(np.abs(picture - BACKGROUND).max(axis=2) < 1e-6)


def test_a_square_covers_its_pixels_and_no_other() -> None:
    empty = is_background(draw(square()))
    expected = np.ones((80, 80), dtype=bool)
    expected[20:60, 20:60] = False
    np.testing.assert_array_equal(empty, expected)


def test_the_outside_is_clay_and_the_inside_has_its_own_colour() -> None:
    front, back = draw(square())[40, 40], draw(square(), BEHIND)[40, 40]
    # One light on one plane: all channels are dimmed alike.
    np.testing.assert_allclose(front / CLAY, front[0] / CLAY[0])
    np.testing.assert_allclose(back / BACK, back[0] / BACK[0])
    np.testing.assert_allclose(front / CLAY, back / BACK)


def test_a_sphere_is_smooth_and_brightest_at_the_upper_left() -> None:
    picture = draw(sphere(30), size=(200, 200))
    grey = picture[:, :, 0]
    lit = np.where(is_background(picture), 0, grey)
    row, column = np.unravel_index(np.argmax(lit), lit.shape)
    assert row < 95
    assert column < 95
    # Flat shading would step by the turn of a triangle; interpolated normals don't.
    assert np.abs(np.diff(grey[100, 60:140])).max() < 0.03


def test_a_sharp_edge_stays_sharp() -> None:
    vertices = np.array([[-1.0, -1, 0], [0, -1, 0], [0, 1, 0], [-1, 1, 0], [0.2, -1, -1], [0.2, 1, -1]])
    roof = TriangleMesh(vertices, np.array([[0, 1, 2], [0, 2, 3], [1, 4, 5], [1, 5, 2]]))
    picture = draw(roof, size=(400, 400))
    np.testing.assert_allclose(picture[200, 110:195], picture[200, 110:111].repeat(85, axis=0), atol=1e-6)


def test_pixels_on_the_silhouette_are_mixed() -> None:
    tilted = TriangleMesh(square().vertices @ np.array([[0.8, 0.6, 0], [-0.6, 0.8, 0], [0, 0, 1]]), square().triangles)
    picture = draw(tilted)
    inside = picture[40, 40]
    share = (picture[:, :, 0] - inside[0]) / (BACKGROUND[0] - inside[0])
    levels = np.unique(np.round(share, 6))
    np.testing.assert_allclose(levels, [0, 0.25, 0.5, 0.75, 1], atol=1e-6)
    # The tint of the mixed pixels adds up to the area of the square.
    assert (1 - share).sum() == pytest.approx(1600, rel=0.01)


def test_repeated_vertices_are_shaded_as_one() -> None:
    mesh = sphere(20)
    apart = TriangleMesh(mesh.vertices[mesh.triangles].reshape(-1, 3), np.arange(mesh.triangles.size).reshape(-1, 3))
    np.testing.assert_allclose(draw(apart), draw(mesh), atol=1e-6)


def test_a_mesh_without_triangles_is_all_background() -> None:
    assert is_background(draw(TriangleMesh(np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int64)))).all()


def test_triangles_smaller_than_pixels_are_shaded_like_larger_ones() -> None:
    large, small = (draw(sphere(n), size=(60, 60))[20:40, 20:40] for n in (40, 150))
    np.testing.assert_allclose(small, large, atol=0.02)


@pytest.mark.parametrize("width", [0.0, 1e-9, 1e-6, 1e-3])
def test_a_sliver_in_a_plane_is_not_seen(width: float) -> None:
    strip = np.array([[-1.0, -1, 0], [1, -1, 0], [1, 0, 0], [-1, width, 0], [-1, 1, 0], [1, 1, 0]])
    plane = TriangleMesh(strip, np.array([[0, 1, 2], [0, 2, 3], [3, 2, 5], [3, 5, 4]]))
    inside = draw(plane)[22:58, 22:58]
    np.testing.assert_allclose(inside, np.broadcast_to(inside[0, 0], inside.shape), atol=1e-4)

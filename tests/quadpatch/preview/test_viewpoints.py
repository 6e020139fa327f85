import numpy as np
import pytest

from quadpatch.mesh.raycast import RayScene
from quadpatch.preview.camera import view_of
from quadpatch.preview.parts import Part, part_of
from quadpatch.preview.viewpoints import close_ups, is_inside_out, overview, spread_directions, visible_areas
from quadpatch.types import BoolArray, TriangleMesh

FRONT = view_of(np.eye(3), np.array([0.0, 0, 1]), 1.0)


def sphere(n: int = 40) -> TriangleMesh:
    """Unit sphere; the poles' triangles without area do no harm."""
    u, v = np.meshgrid(np.linspace(0, np.pi, n), np.linspace(0, 2 * np.pi, 2 * n), indexing="ij")
    vertices = np.stack([np.sin(u) * np.sin(v), np.cos(u), np.sin(u) * np.cos(v)], axis=-1).reshape(-1, 3)
    index = np.arange(2 * n * n).reshape(n, 2 * n)
    a, b, c, d = (part.ravel() for part in (index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]))
    return TriangleMesh(vertices, np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)]))


def turned(mesh: TriangleMesh) -> TriangleMesh:
    return TriangleMesh(mesh.vertices, mesh.triangles[:, ::-1])


def everything(mesh: TriangleMesh) -> Part:
    return part_of(mesh, np.arange(len(mesh.triangles)))


def near(mesh: TriangleMesh, direction: tuple[float, float, float], cosine: float) -> BoolArray:
    return np.asarray(mesh.vertices[mesh.triangles].mean(axis=1) @ np.array(direction) > cosine)


def test_directions_are_unit_and_spread() -> None:
    directions = spread_directions(96)
    np.testing.assert_allclose(np.linalg.norm(directions, axis=1), 1)
    nearest = np.sort(directions @ directions.T, axis=1)[:, -2]
    assert np.degrees(np.arccos(nearest)).min() > 12


def test_half_of_a_sphere_shows_from_everywhere_with_the_area_of_its_disk() -> None:
    mesh = sphere(20)
    areas = visible_areas(RayScene(mesh), everything(mesh), spread_directions(20))
    whole = np.linalg.norm(everything(mesh).area_vectors, axis=1).sum()
    # A disk has a quarter of the area of its sphere.
    np.testing.assert_allclose(areas / whole, 0.25, atol=0.03)


def test_what_stands_in_front_hides_unless_it_is_farther_than_the_clearance() -> None:
    wall = np.array([[-9.0, -9, 3], [9, -9, 3], [0, 9, 3]])
    mesh = TriangleMesh(np.concatenate([wall / 9 * [1, 1, 0], wall]), np.array([[0, 1, 2], [3, 4, 5]]))
    below = part_of(mesh, np.array([0]))
    straight = np.array([[0.0, 0, 1]])
    scene = RayScene(mesh)
    assert visible_areas(scene, below, straight)[0] == 0
    assert visible_areas(scene, below, straight, clearance=2.0)[0] > 0


@pytest.mark.parametrize("direction", [(0.0, 0.0, 1.0), (-1.0, 0.0, 0.0), (0.6, 0.0, -0.8)])
def test_an_overview_looks_at_the_invented_surface(direction: tuple[float, float, float]) -> None:
    mesh = sphere()
    invented = part_of(mesh, np.flatnonzero(near(mesh, direction, 0.9)))
    camera = overview(RayScene(mesh), everything(mesh), invented, 1.0)
    assert camera.towards @ np.array(direction) > 0.9


def test_an_overview_of_an_open_surface_shows_its_outside() -> None:
    mesh = sphere()
    half = TriangleMesh(mesh.vertices, mesh.triangles[near(mesh, (0.0, 0.0, 1.0), 0.2)])
    scene = RayScene(half)
    assert overview(scene, everything(half), None, 1.0).towards[2] > 0.8
    assert overview(scene, everything(turned(half)), None, 1.0).towards[2] < -0.8


def test_a_close_up_looks_straight_down_on_its_hole_with_room_around_it() -> None:
    mesh = sphere()
    hole = part_of(mesh, np.flatnonzero(near(mesh, (0.0, 0.0, 1.0), 0.95)))
    camera = close_ups(RayScene(mesh), [hole], FRONT, 3)[0]
    assert camera.towards[2] > 0.99
    width = np.ptp(hole.corners[:, 0])
    assert 2 * width < camera.width < 3.5 * width


def test_a_hole_that_hardly_shows_comes_last() -> None:
    mesh = sphere()
    band = part_of(mesh, np.flatnonzero(np.abs(mesh.vertices[mesh.triangles].mean(axis=1)[:, 1]) < 0.5))
    cap = part_of(mesh, np.flatnonzero(near(mesh, (0.0, 0.0, 1.0), 0.95)))
    shown = close_ups(RayScene(mesh), [band, cap], FRONT, 1)
    assert list(shown) == [1]
    assert shown[1].towards[2] > 0.99


def test_only_a_surface_turned_inside_out_is_one() -> None:
    mesh = sphere()
    half = TriangleMesh(mesh.vertices, mesh.triangles[near(mesh, (0.0, 0.0, 1.0), 0.5)])
    assert not is_inside_out(RayScene(mesh), everything(mesh))
    assert is_inside_out(RayScene(mesh), everything(turned(mesh)))
    assert not is_inside_out(RayScene(half), everything(half))

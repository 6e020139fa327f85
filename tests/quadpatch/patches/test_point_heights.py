import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from quadpatch.mesh.raycast import RayScene
from quadpatch.patches.height_map import sample_height_maps
from quadpatch.patches.point_heights import POINTS_PER_BIN, ball_radius, point_height_maps, sample_cloud
from quadpatch.patches.seeds import Seeds
from quadpatch.types import FloatArray, TriangleMesh
from tests.quadpatch.shapes import joined, moved, open_grid, punched, relief

LENGTH = 0.5
N = 8


def upright(*origins: tuple[float, float, float]) -> Seeds:
    n = len(origins)
    return Seeds(np.array(origins), np.tile(np.eye(3), (n, 1, 1)), np.arange(n))


def up(n: int) -> FloatArray:
    return np.tile([0.0, 0.0, 1.0], (n, 1))


@settings(max_examples=20)
@given(st.integers(0, 2**32 - 1))
def test_a_bin_holds_the_mean_height_of_the_points_that_fall_into_it(seed: int) -> None:
    points = np.random.default_rng(seed).uniform(-0.24, 0.24, (60, 3))
    patches = point_height_maps(points, up(60), upright((0, 0, 0)), LENGTH, N)
    for i in range(N):
        for j in range(N):
            low = (np.array([j, i]) / N - 0.5) * LENGTH
            inside = ((points[:, :2] >= low) & (points[:, :2] < low + LENGTH / N)).all(axis=1)
            inside &= np.linalg.norm(points, axis=1) <= ball_radius(LENGTH)
            assert patches.known[0, i, j] == inside.any()
            if inside.any():
                np.testing.assert_allclose(patches.heights[0, i, j], points[inside, 2].mean())


def test_heights_are_measured_from_the_seed_as_they_are() -> None:
    points = np.array([[0.01, 0.01, 1.2]])
    patches = point_height_maps(points, up(1), upright((0, 0, 1.1)), LENGTH, N)
    np.testing.assert_allclose(patches.heights[patches.known], 0.1)


def test_points_beyond_the_ball_or_facing_away_are_not_looked_at() -> None:
    radius = ball_radius(LENGTH)
    points = np.array([[0.0, 0.0, 0.99 * radius], [0.0, 0.0, 1.01 * radius], [0.1, 0.1, 0.0]])
    normals = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0]])
    patches = point_height_maps(points, normals, upright((0, 0, 0)), LENGTH, N)
    assert patches.known.sum() == 1
    np.testing.assert_allclose(patches.heights.sum(), 0.99 * radius)


def test_no_points_and_no_seeds_are_fine() -> None:
    nothing = np.zeros((0, 3))
    assert not point_height_maps(nothing, nothing, upright((0, 0, 0)), LENGTH, N).known.any()
    nowhere = Seeds(nothing, np.zeros((0, 3, 3)), np.zeros(0, np.int64))
    assert len(point_height_maps(up(3), up(3), nowhere, LENGTH, N)) == 0
    assert len(sample_cloud(relief(10), nowhere, LENGTH, N, np.random.default_rng(0))[0]) == 0
    empty = TriangleMesh(nothing, np.zeros((0, 3), np.int64))
    assert len(sample_cloud(empty, upright((0, 0, 0)), LENGTH, N, np.random.default_rng(0))[0]) == 0


def test_a_cloud_gives_nearly_the_heights_that_rays_see() -> None:
    mesh, seeds = relief(60), upright((0.1, 0.2, 0.0), (-0.3, 0.0, 0.02))
    cloud = sample_cloud(mesh, seeds, LENGTH, N, np.random.default_rng(0))
    drawn = point_height_maps(*cloud, seeds, LENGTH, N)
    cast = sample_height_maps(RayScene(mesh), mesh, np.zeros(len(mesh.triangles), bool), seeds, LENGTH, N)
    assert drawn.known.mean() > 0.99
    assert np.abs(drawn.heights - cast.heights)[drawn.known].mean() < 0.15 * cast.heights.std()


def test_a_cloud_is_as_dense_as_its_bins_and_leaves_far_surface_out() -> None:
    near = open_grid(30, 1.0)
    mesh = joined(near, moved(near, (100.0, 0.0, 0.0)))
    points, normals = sample_cloud(mesh, upright((0, 0, 0)), LENGTH, N, np.random.default_rng(0))
    assert (np.abs(points[:, 0]) < 1).all()
    assert (normals[:, 2] == 1).all()
    in_square = (np.abs(points[:, :2]) < LENGTH / 2).all(axis=1).sum()
    assert 0.8 < in_square / N**2 / POINTS_PER_BIN < 1.2


def test_bins_in_a_hole_are_not_known() -> None:
    mesh = punched(open_grid(60, 2.0), (0, 0, 0), radius=0.15)
    cloud = sample_cloud(mesh, upright((0, 0, 0)), LENGTH, N, np.random.default_rng(0))
    patches = point_height_maps(*cloud, upright((0, 0, 0)), LENGTH, N)
    assert not patches.known[0, 3:5, 3:5].any()
    assert patches.known[0, [0, 0, -1, -1], [0, -1, 0, -1]].all()

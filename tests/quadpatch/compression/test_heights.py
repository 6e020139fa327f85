import numpy as np

from quadpatch.compression.heights import make_grid, measure_heights
from quadpatch.mesh.distance import distance_to_mesh
from quadpatch.mesh.raycast import RayScene
from quadpatch.types import QuadMesh, TriangleMesh
from tests.quadpatch.shapes import open_grid, sphere


def cube_of_quads(half: float) -> QuadMesh:
    corners = half * np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], np.float64)
    quads = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
    return QuadMesh(corners, quads)


def test_a_grid_that_is_raised_by_the_heights_lies_on_the_surface() -> None:
    ball = sphere(4)
    grid = make_grid(cube_of_quads(1.0), 3)
    heights, known = measure_heights(grid, ball, RayScene(ball), 1.5)
    assert known.all()
    assert distance_to_mesh(grid.raised(heights), ball).max() < 0.01


def test_the_surface_lies_as_far_above_the_grid_as_below_it() -> None:
    ball = sphere(4)
    grid = make_grid(cube_of_quads(1.0), 3)
    heights, _ = measure_heights(grid, ball, RayScene(ball), 1.5)
    raised = grid.raised(heights)
    middles = raised[grid.triangles].mean(axis=1)
    inside, outside = 1.0 - np.linalg.norm(middles, axis=1).mean(), np.linalg.norm(raised, axis=1).mean() - 1.0
    assert outside > 0.0
    assert inside < 0.02


def test_a_grid_vertex_beyond_the_surface_has_no_height() -> None:
    plate = open_grid(9, width=1.0)
    low, high = plate.vertices.min(axis=0), plate.vertices.max(axis=0)
    far = high[0] + (high[0] - low[0])
    corners = np.array([[low[0], low[1], 0], [far, low[1], 0], [far, high[1], 0], [low[0], high[1], 0]])
    grid = make_grid(QuadMesh(corners, np.array([[0, 1, 2, 3]])), 3)
    _, known = measure_heights(grid, plate, RayScene(plate), 1.0)
    assert 0.3 < known.mean() < 0.7
    assert not known[grid.points[:, 0] > high[0] + 1e-9].any()


def test_a_surface_that_faces_the_other_way_does_not_count() -> None:
    plate = open_grid(9, width=1.0)
    turned = TriangleMesh(plate.vertices, plate.triangles[:, ::-1])
    low, high = plate.vertices.min(axis=0), plate.vertices.max(axis=0)
    corners = np.array([[low[0], low[1], 0.1], [high[0], low[1], 0.1], [high[0], high[1], 0.1], [low[0], high[1], 0.1]])
    grid = make_grid(QuadMesh(corners, np.array([[0, 1, 2, 3]])), 2)
    assert measure_heights(grid, plate, RayScene(plate), 1.0)[1].any()
    assert not measure_heights(grid, turned, RayScene(turned), 1.0)[1].any()

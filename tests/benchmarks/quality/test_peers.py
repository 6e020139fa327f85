import json
from pathlib import Path

import numpy as np

from benchmarks.quality.bench import Case, Shape
from benchmarks.quality.peers import close_by_meshlab, fair_fill, longest_punched_loop
from quadpatch.mesh.boundary import boundary_loops
from quadpatch.types import TriangleMesh
from tests.quadpatch.shapes import open_grid, sphere


def _without_cap(ball: TriangleMesh, height: float) -> TriangleMesh:
    """Cut the top off, and all vertices with it."""
    left = ball.triangles[(ball.vertices[ball.triangles][:, :, 2] < height).all(axis=1)]
    used, triangles = np.unique(left, return_inverse=True)
    return TriangleMesh(ball.vertices[used], triangles.reshape(-1, 3))


def test_meshlab_closes_the_hole_and_keeps_every_bit_of_the_rest() -> None:
    open_ball = _without_cap(sphere(3), 0.9)
    closed = close_by_meshlab(open_ball, 1000)
    n = len(open_ball.vertices)
    assert not boundary_loops(closed.triangles).loops
    assert len(closed.vertices) > n
    np.testing.assert_array_equal(closed.vertices[:n], open_ball.vertices)
    np.testing.assert_array_equal(closed.triangles[: len(open_ball.triangles)], open_ball.triangles)


def test_the_faired_fill_is_five_times_closer_to_the_sphere_than_the_flat_one() -> None:
    open_ball = _without_cap(sphere(3), 0.9)
    n = len(open_ball.vertices)
    closed = close_by_meshlab(open_ball, 1000)
    faired = fair_fill(closed, n)
    np.testing.assert_array_equal(faired.vertices[:n], open_ball.vertices)
    np.testing.assert_array_equal(faired.triangles, closed.triangles)
    flat, round_ = (np.abs(np.linalg.norm(mesh.vertices[n:], axis=1) - 1).mean() for mesh in (closed, faired))
    assert 5 * round_ < flat


def test_only_loops_around_punched_centres_count(tmp_path: Path) -> None:
    grid = open_grid(21, 1.0)
    centre = np.array([0.1, 0.1, 0.0])
    hit = np.linalg.norm(grid.vertices - centre, axis=1) < 0.08
    punched = TriangleMesh(grid.vertices, grid.triangles[~hit[grid.triangles].any(axis=1)])
    (tmp_path / "holes.json").write_text(json.dumps({"holes": [{"id": 0, "centre": centre.tolist()}]}))
    case = Case(Shape("grid", tmp_path / "grid.ply", {}), "0.08", tmp_path)
    border, hole = sorted((len(loop) for loop in boundary_loops(punched.triangles).loops), reverse=True)
    assert border == 80
    assert longest_punched_loop(punched, case) == hole

from pathlib import Path

import numpy as np
import pytest

from benchmarks.quality.bench import Case, Shape
from benchmarks.quality.pictures import PUNCHED, REPAIRED, TRUTH, DrawnCase, is_turned_inside_out, turned
from quadpatch.types import TriangleMesh
from tests.benchmarks.quality.small_bench import small_bench
from tests.quadpatch.shapes import sphere


def test_a_sphere_is_inside_out_only_after_it_was_turned() -> None:
    ball = sphere(2)
    assert not is_turned_inside_out(ball)
    assert is_turned_inside_out(turned(ball, is_flipped=True))
    assert turned(ball, is_flipped=False) is ball


@pytest.mark.parametrize("is_flipped", [False, True])
def test_a_hole_is_looked_at_from_outside_and_only_the_fill_has_the_tint(tmp_path: Path, is_flipped: bool) -> None:
    """The bunny of the bench is inside out."""
    bench = small_bench(tmp_path / "bench")
    ball = turned(sphere(4), is_flipped)
    is_hit = ball.vertices[ball.triangles].mean(axis=1)[:, 2] > 0.95
    truth = TriangleMesh(ball.vertices, np.concatenate([ball.triangles[~is_hit], ball.triangles[is_hit]]))
    case = Case(Shape("ball", tmp_path / "ball.ply", {}), "0.3", tmp_path)
    bench.write(case.shape.truth, truth)
    bench.write(tmp_path / "repaired.ply", truth)
    bench.write(case.punched, TriangleMesh(truth.vertices, truth.triangles[: int((~is_hit).sum())]))
    drawn = DrawnCase.of(bench, case, {REPAIRED: tmp_path / "repaired.ply"})
    tiles = drawn.tiles(np.array([0.0, 0.0, 1.0]))
    assert list(tiles) == [PUNCHED, TRUTH, REPAIRED]
    middle = {name: tile[tile.shape[0] // 2, tile.shape[1] // 2] for name, tile in tiles.items()}
    redness = {name: colour[0] - colour[2] for name, colour in middle.items()}
    assert redness[REPAIRED] > redness[TRUTH] > 0 > redness[PUNCHED]
    np.testing.assert_array_equal(tiles[TRUTH][0, 0], tiles[REPAIRED][0, 0])

from typing import Any

import numpy as np

from quadpatch.types import FloatArray, TriangleMesh
from quadpatch.views.fills import holes_of, is_added, is_behind
from tests.quadpatch.shapes import cylinder, joined, moved, open_grid, sphere


def row(id_: int, vertices: FloatArray, n_new: int = 1, bridge: list[int] | None = None) -> dict[str, Any]:
    box = {"min": vertices.min(axis=0).tolist(), "max": vertices.max(axis=0).tolist()}
    joins = None if bridge is None else {"holes": bridge}
    return {"id": id_, "new_triangles": n_new, "bounding_box": box, "bridge": joins}


def test_each_fill_lies_in_the_hole_whose_rim_has_its_border() -> None:
    patches = [moved(open_grid(n), (x, 0.0, 0.0)) for n, x in ((6, 0.0), (3, 10.0), (3, 20.0))]
    rows = [row(i, patch.vertices) for i, patch in enumerate(patches)]
    rows.insert(1, row(7, moved(open_grid(3), (10.1, 0.0, 0.0)).vertices, n_new=0))
    fills = joined(patches[2], patches[0], patches[1])
    expected = [2] * 8 + [0] * 50 + [1] * 8
    assert holes_of(fills.vertices, fills.triangles, rows).tolist() == expected


def test_a_bridge_counts_for_the_loop_that_it_starts_from() -> None:
    strip = cylinder(12, 5)
    rows = [row(0, strip.vertices[-12:], n_new=0, bridge=[1, 0]), row(1, strip.vertices[:12], bridge=[1, 0])]
    rows.append(row(2, strip.vertices[:12] * 1.1))
    assert set(holes_of(strip.vertices, strip.triangles, rows).tolist()) == {1}


def test_without_fills_there_is_nothing_to_tell() -> None:
    assert not len(holes_of(np.zeros((0, 3)), np.zeros((0, 3), np.int64), []))


def test_triangles_behind_are_as_many_as_the_report_counts() -> None:
    rows = [row(0, np.zeros((1, 3)), n_new=2), row(1, np.zeros((1, 3)), n_new=3)]
    assert is_behind(7, {"holes": rows}).tolist() == [False] * 2 + [True] * 5


def test_added_triangles_are_found_wherever_they_stand() -> None:
    ball = sphere(2)
    rng = np.random.default_rng(0)
    kept = rng.random(len(ball.triangles)) < 0.9
    source = TriangleMesh(ball.vertices.astype(np.float32).astype(np.float64), ball.triangles[kept])
    order = rng.permutation(len(ball.triangles))
    assert np.array_equal(is_added(TriangleMesh(ball.vertices, ball.triangles[order]), source), ~kept[order])

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from quadpatch.filling.facing import Rim, look_across
from quadpatch.types import FloatArray, TriangleMesh
from tests.quadpatch.filling.gaps import cut_tube, ends_of, halves, torn_sheet
from tests.quadpatch.shapes import cylinder, flipped, joined, moved, random_rotation


def circle(n: int) -> tuple[FloatArray, FloatArray]:
    """Points of the rim of a tube along z that lies below it, and the normals there."""
    angle = -np.arange(n) * 2 * np.pi / n
    ring = np.stack([np.cos(angle), np.sin(angle), np.zeros(n)], axis=1)
    return ring, ring


@given(n=st.integers(12, 60), shift=st.integers(0, 59), width=st.floats(0.0, 2.0))
def test_directions_at_a_round_rim_are_exact_wherever_its_loop_begins(n: int, shift: int, width: float) -> None:
    points, normals = (np.roll(rows, shift, axis=0) for rows in circle(n))
    rim = Rim.of(points, normals, width)
    assert np.allclose(rim.normals, normals, atol=1e-6)
    assert np.allclose(rim.outward, [0.0, 0.0, 1.0], atol=1e-6)
    assert np.allclose(rim.tangents, np.cross(normals, rim.outward), atol=1e-6)
    assert rim.perimeter == pytest.approx(2 * n * np.sin(np.pi / n))


def test_teeth_of_a_rim_do_not_turn_its_directions() -> None:
    points, normals = circle(60)
    teeth = points + np.outer(np.arange(60) % 2, [0.0, 0.0, 0.1])
    rim = Rim.of(teeth, normals, 0.4)
    assert (rim.outward[:, 2] > 0.95).all()


@pytest.mark.parametrize("n_upper", [40, 64, 25])
def test_the_rims_of_a_cut_tube_face_each_other_all_around(n_upper: int) -> None:
    gap = cut_tube(0.5, n_upper)
    first, second = ends_of(gap)
    facing = look_across(gap.mesh, first.loop, second.loop)
    assert facing.share == 1.0
    assert facing.gap == pytest.approx(0.5, rel=0.02)
    assert facing.agreement > 0.95
    assert facing.runs_opposite


def test_the_halves_of_a_sheet_face_each_other_along_the_tear_alone() -> None:
    gap = torn_sheet()
    first, second = ends_of(gap)
    facing = look_across(gap.mesh, first.loop, second.loop)
    for hole, sight in zip((first, second), facing.sights, strict=True):
        x, y = gap.mesh.vertices[hole.loop, :2].T
        at_tear = np.abs(x - 0.1 - 0.1 * np.sin(6 * y)) < 0.25
        assert not sight.faces[~at_tear].any()
        assert sight.faces[at_tear].mean() > 0.8
    assert facing.runs_opposite


def test_a_side_that_is_turned_over_runs_the_same_way() -> None:
    lower, upper = cylinder(24, 8), moved(cylinder(24, 8), (0.0, 0.0, 4.5))
    for mesh, is_opposite in ((joined(lower, upper), True), (joined(lower, flipped(upper)), False)):
        height = mesh.vertices[:, 2]
        rings = [np.flatnonzero(np.isclose(height, h)) for h in (height[: len(height) // 2].max(), height.max() - 4.0)]
        loops = [ring[np.argsort(np.arctan2(*mesh.vertices[ring, :2].T))] for ring in rings]
        upwards, downwards = loops[0], loops[1][::-1] if is_opposite else loops[1]
        assert look_across(mesh, upwards, downwards).runs_opposite == is_opposite


def test_both_sides_of_a_band_do_not_face_each_other() -> None:
    mesh = cylinder(24, 2, length=0.2)
    low = np.arange(24)
    loops = (low, (low + 24)[::-1])
    assert look_across(mesh, *loops).share == 0.0


def test_what_is_seen_does_not_depend_on_where_the_mesh_lies() -> None:
    gap = halves(0.4, 3)
    first, second = ends_of(gap)
    turn = random_rotation(np.random.default_rng(1))
    there = TriangleMesh(gap.mesh.vertices @ turn.T * 7 + 3, gap.mesh.triangles)
    one, other = (look_across(mesh, first.loop, second.loop) for mesh in (gap.mesh, there))
    assert other.gap == pytest.approx(7 * one.gap)
    assert other.share == pytest.approx(one.share)
    assert other.agreement == pytest.approx(one.agreement, rel=0.01)

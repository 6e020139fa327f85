import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from quadpatch.filling.facing import Facing, look_across
from quadpatch.filling.facing_stretches import facing_stretches
from quadpatch.mesh.holes import find_holes
from quadpatch.types import IntArray, TriangleMesh
from tests.quadpatch.filling.gaps import torn_sheet
from tests.quadpatch.shapes import joined, moved, open_grid

# The squares have 9 vertices along a side, one unit apart; their left and right edges lie at x = -4 and 4.
SIDE = 9


def facing_of(mesh: TriangleMesh, shifts: tuple[int, int] = (0, 0)) -> tuple[Facing, tuple[IntArray, IntArray]]:
    """Look across two outer borders whose loops begin somewhere else."""
    first, second = (np.roll(hole.loop, shift) for hole, shift in zip(find_holes(mesh), shifts, strict=True))
    return look_across(mesh, first, second), (first, second)


def ends_of(mesh: TriangleMesh, shifts: tuple[int, int] = (0, 0)) -> list[list[tuple[float, float]]]:
    """Places (x, y) of the first and the last vertex of both stretches."""
    facing, loops = facing_of(mesh, shifts)
    stretches = facing_stretches(facing)
    assert stretches is not None
    places = []
    for loop, stretch in zip(loops, stretches, strict=True):
        assert (np.diff(stretch) % len(loop) == 1).all()
        x, y = mesh.vertices[loop[stretch[[0, -1]]], :2].T.tolist()
        places.append(list(zip(x, y, strict=True)))
    return places


@given(shifts=st.tuples(st.integers(0, 31), st.integers(0, 31)), gap=st.sampled_from([0.5, 1.0, 2.0]))
def test_squares_side_by_side_face_each_other_along_one_side_wherever_their_loops_begin(
    shifts: tuple[int, int], gap: float
) -> None:
    mesh = joined(open_grid(SIDE), moved(open_grid(SIDE), (8.0 + gap, 0.0, 0.0)))
    right, left = ends_of(mesh, shifts)
    assert right == [(4.0, -4.0), (4.0, 4.0)]
    assert left == [(4.0 + gap, 4.0), (4.0 + gap, -4.0)]


def test_squares_of_which_one_stands_higher_face_each_other_where_they_overlap() -> None:
    mesh = joined(open_grid(SIDE), moved(open_grid(SIDE), (9.0, 4.0, 0.0)))
    right, left = ends_of(mesh)
    assert right[0] == pytest.approx((4.0, 0.0), abs=1.0)
    assert right[1] == (4.0, 4.0)
    assert left[0] == pytest.approx((5.0, 4.0), abs=1.0)
    assert left[1] == (5.0, 0.0)


def test_a_winding_tear_is_one_stretch_from_corner_to_corner() -> None:
    gap = torn_sheet()
    for places in ends_of(gap.mesh):
        assert sorted(y for _, y in places) == [-1.0, 1.0]


@pytest.mark.parametrize("shift", [(30.0, 30.0, 0.0), (20.0, 0.0, 0.0), (8.5, 7.5, 0.0)])
def test_squares_far_apart_or_corner_to_corner_have_no_stretch(shift: tuple[float, float, float]) -> None:
    facing, _ = facing_of(joined(open_grid(SIDE), moved(open_grid(SIDE), shift)))
    assert facing_stretches(facing) is None

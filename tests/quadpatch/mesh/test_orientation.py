"""Faces that are flipped against their piece."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from quadpatch.mesh.boundary import boundary_loops
from quadpatch.mesh.orientation import flipped_triangles, triangles_facing_flipped
from quadpatch.mesh.weld import weld
from tests.quadpatch.shapes import is_oriented_manifold, joined, open_grid, punched, sphere

BALLS = joined(punched(sphere(2), (0, 0, 1), radius=0.4), punched(open_grid(9), (0, 0, 0), radius=0.5))
N = len(BALLS.vertices)


@given(seed=st.integers(0, 1000), share=st.sampled_from([0.01, 0.1, 0.25]))
def test_the_minority_of_each_piece_is_found(seed: int, share: float) -> None:
    rng = np.random.default_rng(seed)
    is_flipped = rng.random(len(BALLS.triangles)) < share
    faces = np.where(is_flipped[:, np.newaxis], BALLS.triangles[:, ::-1], BALLS.triangles)
    assert (flipped_triangles(faces, N) == is_flipped).all()
    welded = weld(BALLS.vertices, faces)
    assert is_oriented_manifold(welded.mesh.triangles)
    assert (welded.is_flipped == is_flipped).all()
    assert welded.counts.turned_triangles == is_flipped.sum()
    assert all(boundary_loops(welded.mesh.triangles).is_manifold)


@pytest.mark.parametrize("direction", [1, -1])
def test_a_consistent_piece_stays_as_it_is(direction: int) -> None:
    assert not flipped_triangles(BALLS.triangles[:, ::direction], N).any()
    assert not flipped_triangles(BALLS.triangles[:0], N).any()


def test_a_moebius_strip_stays_as_it_is() -> None:
    n = 20
    rows = [(2 * i, 2 * i + 1, 2 * i + 2) for i in range(n - 1)]
    rows += [(2 * i + 1, 2 * i + 3, 2 * i + 2) for i in range(n - 1)]
    strip = np.array([*rows, (2 * n - 2, 2 * n - 1, 1), (2 * n - 1, 0, 1)])
    assert not flipped_triangles(strip, 2 * n).any()


def test_of_two_halves_that_disagree_the_first_is_right() -> None:
    assert flipped_triangles(np.array([[0, 1, 2], [0, 1, 3]]), 4).tolist() == [False, True]


def test_a_fill_faces_as_most_of_the_measured_faces_around_it() -> None:
    # Two fans over squares, each with four measured faces around it; all of the first hole's and one of the other's
    # were flipped.
    def fan(first: int, centre: int) -> list[list[int]]:
        return [[first + i, first + (i + 1) % 4, centre] for i in range(4)]

    def frame(first: int, apex: int) -> list[list[int]]:
        return [[first + (i + 1) % 4, first + i, apex + i] for i in range(4)]

    new = np.array(fan(0, 100) + fan(10, 101))
    flipped = np.array(frame(0, 50) + frame(10, 60)[:1])
    hole = np.repeat([0, 1], 4)
    assert triangles_facing_flipped(new, hole, flipped).tolist() == [True] * 4 + [False] * 4
    assert not triangles_facing_flipped(new, hole, flipped[:0]).any()

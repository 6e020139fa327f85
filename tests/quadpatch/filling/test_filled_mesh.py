from dataclasses import replace

import numpy as np
import pytest

from quadpatch.filling.fairing import THIN_PLATE, Energy
from quadpatch.filling.fill import close_flat, close_holes, fair_holes
from quadpatch.filling.filled_mesh import FilledMesh, JoinedMesh
from quadpatch.types import FloatArray, IntArray
from tests.quadpatch.filling.fills import all_loops, assert_keeps
from tests.quadpatch.filling.handmade import put_together
from tests.quadpatch.shapes import faces_per_edge, punched, sphere

MESH = punched(sphere(3), (0, 0, 1), (1, 0, 0), (0, -1, 0), radius=0.4)
LOOPS = all_loops(MESH)
PLATE = fair_holes(close_holes(MESH, LOOPS), THIN_PLATE)
FLAT = close_flat(MESH, LOOPS)


def fill_of(filled: FilledMesh, loop: int) -> tuple[FloatArray, FloatArray]:
    """New vertices of one loop, and the corners of its new triangles, in their order."""
    vertices, triangles = filled.mesh.vertices, filled.mesh.triangles[filled.n_measured_triangles :]
    new = vertices[filled.n_measured_vertices :]
    return new[filled.vertex_hole == loop], vertices[triangles[filled.triangle_hole == loop]]


def assert_same_fill(one: FilledMesh, other: FilledMesh, loop: int) -> None:
    for here, there in zip(fill_of(one, loop), fill_of(other, loop), strict=True):
        assert here.tobytes() == there.tobytes()


@pytest.mark.parametrize("opened", [[], [0], [1, 2], [0, 1, 2]])
def test_without_some_loops_the_others_keep_their_fills(opened: list[int]) -> None:
    left = PLATE.without(np.array(opened, np.int64))
    assert_keeps(left, MESH)
    assert len(left.disagreement) == 3
    for loop in range(3):
        if loop in opened:
            assert [len(part) for part in fill_of(left, loop)] == [0, 0]
        else:
            assert_same_fill(left, PLATE, loop)
    assert (faces_per_edge(left.mesh.triangles) == 1).sum() == sum(len(LOOPS[i]) for i in opened)


@pytest.mark.parametrize("taken", [[], [1], [0, 2], [0, 1, 2]])
def test_fills_taken_from_another_mesh_come_as_they_are_and_the_rest_stays(taken: list[int]) -> None:
    mixed = PLATE.with_fills(FLAT, np.array(taken, np.int64))
    assert_keeps(mixed, MESH)
    for loop in range(3):
        assert_same_fill(mixed, FLAT if loop in taken else PLATE, loop)
    assert (faces_per_edge(mixed.mesh.triangles) == 2).all()


def test_the_fill_of_some_loops_is_renumbered_as_part_of_all() -> None:
    chosen = np.array([0, 2])
    part = close_flat(MESH, [LOOPS[i] for i in chosen]).as_part_of(chosen, PLATE)
    assert_keeps(part, MESH)
    assert sorted(set(part.triangle_hole.tolist())) == [0, 2]
    assert (part.disagreement.tobytes(), part.rim_variation.tobytes()) == (
        PLATE.disagreement.tobytes(),
        PLATE.rim_variation.tobytes(),
    )
    mixed = PLATE.with_fills(part, chosen)
    for loop in range(3):
        assert_same_fill(mixed, part if loop in (0, 2) else PLATE, loop)


def test_loops_that_no_triangulation_closes_go_along() -> None:
    nothing: IntArray = np.zeros((0, 3), np.int64)
    values = {**put_together(MESH, *3 * [(np.zeros((0, 3)), nothing)]).__dict__, "unfilled": [0, 1]}
    open_ones = FilledMesh(**values)
    assert PLATE.with_fills(open_ones, np.array([1, 2])).unfilled == [1]
    assert open_ones.with_fills(PLATE, np.array([1])).unfilled == [0]
    some = FilledMesh(**{**values, "unfilled": [1]})
    assert some.as_part_of(np.array([0, 2, 1]), PLATE).unfilled == [2]


def test_moved_vertices_are_the_new_ones_alone() -> None:
    other = fair_holes(close_holes(MESH, LOOPS), Energy(membrane=1.0))
    new = other.mesh.vertices[other.n_measured_vertices :]
    moved = PLATE.with_vertices(new)
    assert_keeps(moved, MESH)
    assert moved.mesh.vertices.tobytes() == other.mesh.vertices.tobytes()


def test_a_mesh_is_joined_with_its_fills_once_that_is_asked_for() -> None:
    joined = replace(PLATE, mesh=JoinedMesh(MESH, PLATE.new_vertices, PLATE.new_triangles))
    assert joined.measured is MESH
    assert (joined.new_vertices == PLATE.new_vertices).all()
    assert (joined.new_triangles == PLATE.new_triangles).all()
    assert not {"vertices", "triangles"} & joined.mesh.__dict__.keys()
    assert (joined.mesh.vertices == PLATE.mesh.vertices).all()
    assert (joined.mesh.triangles == PLATE.mesh.triangles).all()

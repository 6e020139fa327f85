"""Loops with flat corners: see also `test_faulty_shapes` for whole repairs."""

from collections.abc import Callable

import numpy as np
import pytest

from quadpatch.filling.fairing import THIN_PLATE
from quadpatch.filling.fill import close_flat, close_holes, fair_holes
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.filling.rim_neighbourhood import RimNeighbourhood
from quadpatch.types import IntArray, TriangleMesh
from tests.quadpatch.faulty_shapes import with_triangle_at_rim
from tests.quadpatch.filling.fills import all_loops, assert_keeps
from tests.quadpatch.shapes import faces_per_edge, is_oriented_manifold, punched, sphere

BALL = punched(sphere(3), (0, 0, 1), radius=0.4)


def plate(mesh: TriangleMesh, loops: list[IntArray]) -> FilledMesh:
    return fair_holes(close_holes(mesh, loops), THIN_PLATE)


@pytest.mark.parametrize("along", [0.5, 0.1])
@pytest.mark.parametrize("fill", [plate, close_flat])
def test_a_fill_meets_a_flat_corner_in_two_triangles_beside_its_neighbours(
    fill: Callable[[TriangleMesh, list[IntArray]], FilledMesh], along: float
) -> None:
    mesh, n = BALL, len(BALL.vertices)
    for edge in (1, 6, 11):
        mesh = with_triangle_at_rim(mesh, edge, along, 0.0)
    filled = fill(mesh, all_loops(mesh))
    assert_keeps(filled, mesh)
    assert is_oriented_manifold(filled.mesh.triangles)
    assert (faces_per_edge(filled.mesh.triangles) == 2).all()
    new = filled.mesh.triangles[filled.n_measured_triangles :]
    assert len(filled.triangle_hole) == len(new)
    # A tip that carries another one is no corner any more when its turn comes.
    tips = [tip for tip in range(n, n + 3) if (mesh.triangles == tip).sum() == 1]
    assert tips
    for tip in tips:
        (flat,) = mesh.triangles[(mesh.triangles == tip).any(axis=1)]
        at_tip = new[(new == tip).any(axis=1)]
        assert len(at_tip) == 2
        assert np.isin(at_tip, np.setdiff1d(flat, tip)).sum(axis=1).tolist() == [1, 1]


def test_tips_on_tips_are_taken_out_and_put_back_in_turn() -> None:
    mesh = with_triangle_at_rim(BALL, 1, 0.5, 0.0)
    (loop,) = all_loops(mesh)
    first = len(BALL.vertices)
    at = int(np.flatnonzero(loop == first)[0])
    end = int(loop[(at + 1) % len(loop)])
    between = (mesh.vertices[first] + mesh.vertices[end]) / 2
    mesh = TriangleMesh(
        np.concatenate([mesh.vertices, between[None]]),
        np.concatenate([mesh.triangles, [[end, first, first + 1]]]),
    )
    loops = all_loops(mesh)
    near = RimNeighbourhood.of(mesh, loops)
    assert [len(loop) for loop in near.straightened().loops] == [len(loops[0]) - 2]
    filled = plate(mesh, loops)
    assert is_oriented_manifold(filled.mesh.triangles)
    assert (faces_per_edge(filled.mesh.triangles) == 2).all()


def test_corners_with_a_height_stay_in_their_loops() -> None:
    mesh = with_triangle_at_rim(BALL, 1, 0.5, 1e-3)
    near = RimNeighbourhood.of(mesh, all_loops(mesh))
    assert [loop.tolist() for loop in near.straightened().loops] == [loop.tolist() for loop in near.loops]
    # A loop keeps three vertices.
    triangle = TriangleMesh(np.array([[0.0, 0, 0], [0.5, 0, 0], [1, 0, 0]]), np.array([[0, 1, 2]]))
    near = RimNeighbourhood.of(triangle, all_loops(triangle))
    assert [len(loop) for loop in near.straightened().loops] == [3]

import numpy as np
import pytest

from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.filling.ribs import RibEnd, Ribs, make_rib
from quadpatch.mesh.boundary import boundary_loops
from quadpatch.mesh.normals import triangle_normals
from quadpatch.types import FloatArray, TriangleMesh
from tests.quadpatch.filling.fills import assert_keeps
from tests.quadpatch.shapes import is_oriented_manifold

UP = np.array([[0.0, 0.0, 1.0]] * 2)
# Two squares, side by side, z up, with a gap of 1 between them: x from 0 to 1 and from 2 to 3.
SQUARES = TriangleMesh(
    np.array([[x, y, 0.0] for x in (0, 1, 2, 3) for y in (0, 1)], np.float64),
    np.array([[0, 2, 3], [0, 3, 1], [4, 6, 7], [4, 7, 5]]),
)
# The rim edges at the gap: from 2 to 3 on the left, from 5 to 4 on the right. The open end is above, at y = 1.
LEFT, RIGHT = RibEnd(3, 2, UP), RibEnd(5, 4, UP)


@pytest.mark.parametrize(("edge", "count"), [(2.0, 0), (1.0, 0), (0.5, 1), (0.1, 9)])
def test_a_rib_joins_two_rim_edges_and_is_as_fine_as_asked_for(edge: float, count: int) -> None:
    rib = make_rib(SQUARES.vertices, (LEFT, RIGHT), edge, 8, is_forward=True)
    assert len(rib.vertices) == 2 * count
    assert len(rib.triangles) == 2 * (count + 1)
    assert rib.inner[[0, -1]].tolist() == [2, 4]
    mesh = Ribs(rib.vertices, rib.triangles, np.zeros(2 * count, np.int64), np.zeros(2 * count + 2, np.int64)).added_to(
        SQUARES
    )
    assert is_oriented_manifold(mesh.triangles)
    assert np.allclose(triangle_normals(mesh.vertices, mesh.triangles), [0, 0, 1])
    assert len(boundary_loops(mesh.triangles).loops) == 1


def test_a_rib_at_the_other_end_faces_the_same_way() -> None:
    left, right = RibEnd(2, 3, UP), RibEnd(4, 5, UP)
    rib = make_rib(SQUARES.vertices, (left, right), 0.25, 8, is_forward=False)
    mesh = TriangleMesh(np.concatenate([SQUARES.vertices, rib.vertices]), rib.triangles)
    assert np.allclose(triangle_normals(mesh.vertices, rib.triangles), [0, 0, 1])
    assert is_oriented_manifold(np.concatenate([SQUARES.triangles, rib.triangles]))


@pytest.mark.parametrize(("angle", "most"), [(0.4, 1e-7), (0.8, 5e-6)])
def test_a_rib_continues_a_round_surface(angle: float, most: float) -> None:
    """The rim edges lie on a cylinder of radius 1 around y; the curve between them is to stay on it."""

    def at(a: float) -> FloatArray:
        return np.array([np.sin(a), 0.0, np.cos(a)])

    beside = np.array([0.0, 0.1, 0.0])
    points = np.array([at(-angle / 2), at(-angle / 2) + beside, at(angle / 2), at(angle / 2) + beside])
    normals = [np.array([at(a)] * 2) for a in (-angle / 2, angle / 2)]
    rib = make_rib(points, (RibEnd(1, 0, normals[0]), RibEnd(3, 2, normals[1])), 0.02, 4, is_forward=True)
    assert np.abs(np.hypot(rib.vertices[:, 0], rib.vertices[:, 2]) - 1).max() < most


def test_ribs_count_as_invented_once_they_are_told_apart_and_go_where_there_is_no_fill() -> None:
    rib = make_rib(SQUARES.vertices, (LEFT, RIGHT), 0.25, 8, is_forward=True)
    ribs = Ribs(rib.vertices, rib.triangles, np.zeros(len(rib.vertices), int), np.zeros(len(rib.triangles), int))
    mesh = ribs.added_to(SQUARES)
    fill = np.array([[2, int(rib.inner[1]), 4]])
    for triangles, n_kept in ((fill, len(rib.triangles) + 1), (fill[:0], 0)):
        filled = FilledMesh(
            TriangleMesh(mesh.vertices, np.concatenate([mesh.triangles, triangles])),
            len(mesh.vertices),
            len(mesh.triangles),
            np.zeros(len(triangles), np.int64),
            np.zeros(0, np.int64),
            np.zeros(1),
            np.zeros(1),
            [],
        )
        told = ribs.told_apart(filled, np.array([0]))
        assert_keeps(told, SQUARES)
        assert len(told.triangle_hole) == n_kept
        assert len(told.vertex_hole) == (len(rib.vertices) if n_kept else 0)

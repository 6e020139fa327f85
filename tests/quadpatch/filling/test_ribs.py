import numpy as np
import pytest

from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.filling.ribs import RibEnd, Ribs, RibSide, make_clear_rib, make_rib
from quadpatch.mesh.boundary import boundary_loops
from quadpatch.mesh.intersections import crossing_pairs
from quadpatch.mesh.normals import triangle_normals
from quadpatch.types import FloatArray, TriangleMesh
from tests.quadpatch.filling.fills import assert_keeps
from tests.quadpatch.shapes import is_oriented_manifold, joined, moved, open_grid

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


def sides_of_a_gap(*others: TriangleMesh) -> tuple[TriangleMesh, tuple[RibSide, RibSide]]:
    """Two squares of 9 x 9 vertices with a gap from x = 4 to x = 6, whose open end is at y = 4; and other surface."""
    mesh = joined(open_grid(9), moved(open_grid(9), (10.0, 0.0, 0.0)), *others)
    sides = []
    for x in (4.0, 6.0):
        rim = np.flatnonzero((mesh.vertices[:162, 0] == x) & (np.abs(mesh.vertices[:162, 1]) <= 4))
        rim = rim[np.argsort(-mesh.vertices[rim, 1])]
        sides.append(RibSide(rim, np.repeat(UP[:1], len(rim), axis=0)))
    return mesh, (sides[0], sides[1])


def test_a_rib_lies_at_the_open_end_where_nothing_is_in_its_way() -> None:
    mesh, sides = sides_of_a_gap()
    rib, places = make_clear_rib(mesh, sides, 1.0, len(mesh.vertices), is_forward=True)
    assert places == (0, 0)
    assert sorted(rib.vertices.tolist()) == [[5.0, 3.0, 0.0], [5.0, 4.0, 0.0]]


@pytest.mark.parametrize("is_upright", [True, False])
def test_a_rib_goes_round_what_stands_at_the_open_end(is_upright: bool) -> None:
    """A wall that the rib would run through, or a scrap of surface that it would lie on."""
    flat = moved(open_grid(3, 0.8), (5.0, 3.5, 0.0))
    upright = TriangleMesh(
        (flat.vertices - [5.0, 0, 0]) @ np.array([[0, 0, 1.0], [0, 1, 0], [1, 0, 0]]), flat.triangles
    )
    other = moved(upright, (5.2, 0.0, 0.1)) if is_upright else flat
    mesh, sides = sides_of_a_gap(other)
    rib, places = make_clear_rib(mesh, sides, 1.0, len(mesh.vertices), is_forward=True)
    assert min(places) >= 1
    assert max(places) <= 2
    whole = TriangleMesh(np.concatenate([mesh.vertices, rib.vertices]), np.concatenate([rib.triangles, mesh.triangles]))
    assert not (crossing_pairs(whole) < len(rib.triangles)).any()


def test_a_rib_leaves_room_between_itself_and_a_tooth_of_the_rim() -> None:
    mesh, (left, right) = sides_of_a_gap()
    vertices = mesh.vertices.copy()
    # The third vertex of the left rim leans over into the gap, almost onto the rib at the open end.
    vertices[left.vertices[2]] = (5.6, 2.95, 0.0)
    _, places = make_clear_rib(
        TriangleMesh(vertices, mesh.triangles), (left, right), 1.0, len(vertices), is_forward=True
    )
    assert places[0] > 0

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from quadpatch.mesh.boundary import boundary_loops
from quadpatch.types import IntArray, TriangleMesh, Triangles
from tests.quadpatch.filling.fills import CLOSED, all_loops, assert_keeps, filled, short_loops
from tests.quadpatch.shapes import (
    bumpy_plate,
    euler_characteristic,
    faces_per_edge,
    is_oriented_manifold,
    joined,
    open_grid,
    punched,
    sphere,
)


@pytest.mark.parametrize("name", CLOSED)
def test_a_filled_mesh_is_watertight_and_keeps_every_measured_bit(name: str) -> None:
    mesh = CLOSED[name]
    result = filled(mesh, all_loops(mesh))
    assert_keeps(result, mesh)
    assert result.unfilled == []
    assert (faces_per_edge(result.mesh.triangles) == 2).all()
    assert is_oriented_manifold(result.mesh.triangles)
    assert euler_characteristic(result.mesh.triangles) == (4 if name == "two pieces" else 2)


def test_loops_that_were_not_chosen_stay_open() -> None:
    mesh = punched(bumpy_plate(40, 2.0), (-0.5, -0.5, 0), (0.5, 0.5, 0.05), radius=0.3)
    first, second, border = sorted(all_loops(mesh), key=len)
    result = filled(mesh, [second])
    assert_keeps(result, mesh)
    left = sorted(all_loops(result.mesh), key=len)
    assert [loop.tolist() for loop in left] == [first.tolist(), border.tolist()]
    assert set(result.triangle_hole.tolist()) == {0}


def test_holes_are_numbered_by_the_order_of_their_loops() -> None:
    mesh = CLOSED["sphere"]
    loops = all_loops(mesh)
    for order in ([0, 1, 2], [2, 0, 1]):
        result = filled(mesh, [loops[i] for i in order])
        for position, i in enumerate(order):
            corners = result.mesh.triangles[result.n_measured_triangles :][result.triangle_hole == position]
            on_rim = np.unique(corners[corners < result.n_measured_vertices])
            assert on_rim.tolist() == sorted(loops[i].tolist())


def test_no_hole_gives_the_mesh_back() -> None:
    mesh = bumpy_plate(10, 1.0)
    result = filled(mesh, [])
    assert_keeps(result, mesh)
    assert len(result.vertex_hole) == len(result.disagreement) == 0


@pytest.mark.parametrize("n", [3, 4])
def test_the_smallest_holes_are_closed(n: int) -> None:
    mesh = sphere(2)
    gone = [0] if n == 3 else np.flatnonzero(np.isin(mesh.triangles, mesh.triangles[0][:2]).sum(axis=1) == 2)
    opened = TriangleMesh(mesh.vertices, np.delete(mesh.triangles, gone, axis=0))
    (loop,) = all_loops(opened)
    assert len(loop) == n
    result = filled(opened, [loop])
    assert_keeps(result, opened)
    assert (faces_per_edge(result.mesh.triangles) == 2).all()
    assert len(result.triangle_hole) == n - 2


def test_a_single_triangle_is_closed_by_its_own_back() -> None:
    mesh = TriangleMesh(np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2]]))
    result = filled(mesh, all_loops(mesh))
    assert_keeps(result, mesh)
    assert result.mesh.triangles.shape == (2, 3)
    assert is_oriented_manifold(result.mesh.triangles)


def test_a_rim_that_can_not_be_closed_is_listed_and_others_are_filled() -> None:
    # All four corners of the rim are joined to each other already, by faces elsewhere.
    square = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    rim_faces = [(0, 1, 4), (1, 2, 5), (2, 3, 6), (3, 0, 7)]
    chords = [(0, 2, 8), (2, 0, 9), (1, 3, 10), (3, 1, 11)]
    far = np.array([[i, 3.0, 1 + 0.1 * i] for i in range(8)])
    stuck = TriangleMesh(np.concatenate([square, far]), np.array(rim_faces + chords))
    other = punched(sphere(3), (0, 0, 1), radius=0.4)
    mesh = joined(stuck, TriangleMesh(other.vertices + 10, other.triangles))
    rim = np.array([3, 2, 1, 0])
    good = [loop for loop in all_loops(mesh) if loop.min() >= len(stuck.vertices)]
    result = filled(mesh, [rim, *good])
    assert_keeps(result, mesh)
    assert result.unfilled == [0]
    assert set(result.triangle_hole.tolist()) == {1}


def checkerboard(n: int) -> TriangleMesh:
    """A bumpy sheet in which every second square is missing: each square hangs on its corners."""
    plate = bumpy_plate(n, float(n))
    row, column = np.divmod(np.arange((n - 1) ** 2), n - 1)
    keep = np.tile((row + column) % 2 == 0, 2)
    inner = np.tile((row > 1) & (row < n - 3) & (column > 1) & (column < n - 3), 2)
    return TriangleMesh(plate.vertices, plate.triangles[keep | ~inner])


@pytest.mark.parametrize("n", [7, 10, 16])
def test_holes_that_touch_in_many_corners_are_closed_without_an_edge_of_three_faces(n: int) -> None:
    mesh = checkerboard(n)
    loops = short_loops(mesh)
    assert len(loops) > 1
    result = filled(mesh, loops)
    assert_keeps(result, mesh)
    assert result.unfilled == []
    assert is_oriented_manifold(result.mesh.triangles)
    assert sorted(len(loop) for loop in all_loops(result.mesh)) == [4 * (n - 1)]


@given(seed=st.integers(0, 2**32 - 1), share=st.sampled_from([0.02, 0.1, 0.3]))
@settings(max_examples=15)
def test_whatever_is_missing_a_fill_never_makes_an_edge_of_three_faces(seed: int, share: float) -> None:
    rng = np.random.default_rng(seed)
    whole = sphere(2)
    mesh = TriangleMesh(whole.vertices, whole.triangles[rng.random(len(whole.triangles)) > share])
    boundary = boundary_loops(mesh.triangles)
    assert all(boundary.is_manifold)
    result = filled(mesh, boundary.loops)
    assert_keeps(result, mesh)
    assert is_oriented_manifold(result.mesh.triangles)
    left = [sorted(loop.tolist()) for loop in all_loops(result.mesh)]
    assert sorted(left) == sorted(sorted(boundary.loops[i].tolist()) for i in result.unfilled)


def spiky_rim(n: int, length: float) -> tuple[TriangleMesh, IntArray]:
    """A flat ring whose inner rim carries a long thin face on every edge."""
    angle = 2 * np.pi * np.arange(n) / n
    circles = [(r * np.cos(a), r * np.sin(a)) for r, a in ((1.3, angle), (1.0, angle), (1 - length, angle + np.pi / n))]
    plane = np.concatenate([np.stack(pair, axis=1) for pair in circles])
    i, j = np.arange(n), np.roll(np.arange(n), -1)
    faces = [(i, j, n + j), (i, n + j, n + i), (n + i, n + j, 2 * n + i)]
    triangles: Triangles = np.concatenate([np.stack(face, axis=1) for face in faces])
    mesh = TriangleMesh(np.column_stack([plane, np.zeros(3 * n)]), triangles)
    (loop,) = short_loops_by_start(mesh, n)
    return mesh, loop


def short_loops_by_start(mesh: TriangleMesh, first: int) -> list[IntArray]:
    return [loop for loop in all_loops(mesh) if loop[0] >= first]


@pytest.mark.parametrize("n", [40, 75, 200])
@pytest.mark.parametrize("length", [0.03, 0.1, 0.4])
def test_long_rims_full_of_spikes_are_closed_without_an_edge_of_three_faces(n: int, length: float) -> None:
    mesh, loop = spiky_rim(n, length)
    assert len(loop) == 2 * n
    result = filled(mesh, [loop])
    assert_keeps(result, mesh)
    assert result.unfilled == []
    assert is_oriented_manifold(result.mesh.triangles)
    (border,) = all_loops(result.mesh)
    assert len(border) == n
    assert np.abs(result.mesh.vertices[:, 2]).max() < 1e-12


def test_the_same_mesh_gives_the_same_bytes() -> None:
    mesh = CLOSED["tube"]
    one, other = (filled(mesh, all_loops(mesh)) for _ in range(2))
    assert one.mesh.vertices.tobytes() == other.mesh.vertices.tobytes()
    assert one.mesh.triangles.tobytes() == other.mesh.triangles.tobytes()


def test_other_positions_replace_the_invented_vertices_alone() -> None:
    mesh = CLOSED["sphere"]
    result = filled(mesh, all_loops(mesh))
    moved = result.with_vertices(np.zeros((len(result.vertex_hole), 3)))
    assert_keeps(moved, mesh)
    assert (moved.mesh.vertices[len(mesh.vertices) :] == 0).all()
    assert moved.mesh.triangles is result.mesh.triangles


def test_a_slit_of_no_area_is_closed() -> None:
    mesh = open_grid(12)
    slit = punched(mesh, (-0.5, -0.5, 0), radius=1.6)
    vertices = slit.vertices.copy()
    (loop,) = short_loops(slit)
    vertices[loop, 1] = -0.5
    flat = TriangleMesh(vertices, slit.triangles)
    result = filled(flat, [loop])
    assert_keeps(result, flat)
    assert is_oriented_manifold(result.mesh.triangles)


def test_sheets_that_lie_close_together_are_filled_one_by_one() -> None:
    top = punched(bumpy_plate(30, 2.0), (0.2, 0.1, 0), radius=0.4)
    under = TriangleMesh(top.vertices - [0, 0, 0.01], top.triangles[:, ::-1])
    mesh = joined(top, under)
    loops = sorted(all_loops(mesh), key=len)[:2]
    result = filled(mesh, loops)
    assert_keeps(result, mesh)
    assert is_oriented_manifold(result.mesh.triangles)
    alone = filled(top, short_loops(top))
    first = int(np.argmin([loop[0] for loop in loops]))
    mine = result.mesh.vertices[len(mesh.vertices) :][result.vertex_hole == first]
    assert np.abs(mine - alone.mesh.vertices[len(top.vertices) :]).max() < 1e-9

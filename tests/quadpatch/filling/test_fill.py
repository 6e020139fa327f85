import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from quadpatch.filling.fairing import THIN_PLATE, Energy, fair
from quadpatch.filling.fill import SECOND_OPINION, FilledMesh, close_flat, close_holes, fair_holes
from quadpatch.mesh.boundary import boundary_loops
from quadpatch.types import FloatArray, IntArray, TriangleMesh, Triangles
from tests.quadpatch.shapes import (
    bumpy_plate,
    cylinder,
    euler_characteristic,
    faces_per_edge,
    is_oriented_manifold,
    joined,
    open_grid,
    punched,
    random_rotation,
    sphere,
)

SMOOTH = Energy(plate=1.0, variation=20.0)


def all_loops(mesh: TriangleMesh) -> list[IntArray]:
    return boundary_loops(mesh.triangles).loops


def short_loops(mesh: TriangleMesh) -> list[IntArray]:
    """All loops but the longest."""
    return sorted(all_loops(mesh), key=len)[:-1]


def filled(mesh: TriangleMesh, loops: list[IntArray], energy: Energy = SMOOTH) -> FilledMesh:
    return fair_holes(close_holes(mesh, loops), energy)


def assert_keeps(result: FilledMesh, mesh: TriangleMesh) -> None:
    """The measured mesh is a bit-exact prefix, and every mark fits."""
    n, m = len(mesh.vertices), len(mesh.triangles)
    assert (result.n_measured_vertices, result.n_measured_triangles) == (n, m)
    assert result.mesh.vertices[:n].tobytes() == mesh.vertices.tobytes()
    assert result.mesh.triangles[:m].tobytes() == mesh.triangles.tobytes()
    assert len(result.vertex_hole) == len(result.mesh.vertices) - n == result.invented_vertices.sum()
    assert len(result.triangle_hole) == len(result.mesh.triangles) - m == result.invented_triangles.sum()
    assert np.isfinite(result.mesh.vertices).all()
    new = result.mesh.triangles[m:]
    inside = new >= n
    hole_of_corner = np.broadcast_to(result.triangle_hole[:, None], new.shape)
    assert (result.vertex_hole[new[inside] - n] == hole_of_corner[inside]).all()


CLOSED = {
    "sphere": punched(sphere(4), (0, 0, 1), (1, 0, 0), (0, -0.8, -0.6), radius=0.35),
    "tube": punched(cylinder(40, 30), (1, 0, 0), (0, -1, 1), radius=0.4),
    "two pieces": joined(punched(sphere(3), (0, 0, 1), radius=0.5), punched(sphere(3, 0.3), (0, 0.3, 0), radius=0.2)),
}


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
    assert len(result.vertex_hole) == len(result.gap) == 0


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
@settings(max_examples=15, deadline=None)
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


def test_a_flat_hole_is_filled_flat_and_covers_what_was_lost() -> None:
    whole = bumpy_plate(40, 2.0)
    flat = TriangleMesh(whole.vertices * [1, 1, 0], whole.triangles)
    mesh = punched(flat, (0.3, 0.2, 0), radius=0.4)
    result = filled(mesh, short_loops(mesh))
    assert np.abs(result.mesh.vertices[:, 2]).max() < 1e-12
    assert area(result.mesh) == pytest.approx(area(flat), rel=1e-9)


def area(mesh: TriangleMesh) -> float:
    a, b, c = (mesh.vertices[mesh.triangles[:, k]] for k in range(3))
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()) / 2


def radial_error(result: FilledMesh) -> FloatArray:
    new = result.mesh.vertices[result.n_measured_vertices :]
    return np.asarray(np.abs(np.linalg.norm(new, axis=1) - 1))


def test_the_missing_cap_of_a_sphere_comes_back() -> None:
    mesh = punched(sphere(4), (0.1, 0.2, 1), radius=0.5)
    smooth, plate = (radial_error(filled(mesh, all_loops(mesh), energy)) for energy in (SMOOTH, THIN_PLATE))
    # The cap is 0.13 high.
    assert smooth.max() < 0.01
    assert smooth.mean() < 0.25 * plate.mean()


def test_the_gap_is_the_mean_distance_between_the_thin_plate_and_a_second_opinion_whatever_was_chosen() -> None:
    mesh = CLOSED["sphere"]
    closed = close_holes(mesh, all_loops(mesh))
    plate = closed.plate
    second = fair(plate.vertices, np.concatenate([closed.around, plate.triangles]), plate.is_new, SECOND_OPINION)
    apart = np.linalg.norm(second - plate.vertices, axis=1)[len(closed.used) :]
    for energy in (SMOOTH, THIN_PLATE):
        result = fair_holes(closed, energy)
        expected = [apart[result.vertex_hole == i].mean() for i in range(3)]
        np.testing.assert_allclose(result.gap, expected, rtol=1e-9)
        assert (result.gap > 0).all()


def test_the_rim_turns_by_the_angle_between_neighbouring_normals() -> None:
    ball = CLOSED["sphere"]
    loops = all_loops(ball)
    turn = filled(ball, loops, THIN_PLATE).rim_turn
    for found, loop in zip(turn, loops, strict=True):
        # On a unit sphere normals are as far apart as the vertices themselves.
        rim = ball.vertices[loop]
        assert found == pytest.approx(np.linalg.norm(rim - np.roll(rim, 1, axis=0), axis=1).mean(), rel=0.2)
    flat = punched(open_grid(21, 2.0), (0, 0, 0), radius=0.3)
    assert filled(flat, short_loops(flat), THIN_PLATE).rim_turn.max() < 1e-12


def test_a_rough_rim_shows_in_the_signs_of_its_own_hole_only() -> None:
    mesh = punched(bumpy_plate(40, 2.0), (0, 0, 0), (0.6, 0.6, 0), radius=0.2)
    loops = short_loops(mesh)
    rough = mesh.vertices.copy()
    near = np.linalg.norm(rough - mesh.vertices[loops[0]].mean(axis=0), axis=1) < 0.3
    rough[near, 2] += np.random.default_rng(0).normal(0, 0.01, int(near.sum()))
    calm, ragged = (filled(one, loops, THIN_PLATE) for one in (mesh, TriangleMesh(rough, mesh.triangles)))
    assert ragged.rim_turn[0] > 2 * calm.rim_turn[0]
    assert ragged.gap[0] > 2 * calm.gap[0]
    assert ragged.rim_turn[1] == calm.rim_turn[1]
    # Energies have no unit: their weights go by the mean area of all new vertices.
    assert ragged.gap[1] == pytest.approx(calm.gap[1], rel=0.01)


def test_a_fill_that_runs_away_from_a_ragged_rim_is_held_by_the_thin_plate() -> None:
    mesh = punched(bumpy_plate(40, 2.0), (0, 0, 0), (0.6, 0.6, 0), radius=0.3)
    loops = short_loops(mesh)
    centre = mesh.vertices[loops[0]].mean(axis=0)
    rough = mesh.vertices.copy()
    near = np.linalg.norm(rough - centre, axis=1) < 0.45
    rough[near] += np.random.default_rng(0).normal(0, 0.03, (int(near.sum()), 3))
    ragged = TriangleMesh(rough, mesh.triangles)
    closed = close_holes(ragged, loops)
    result = fair_holes(closed, Energy(variation=1.0))
    plate = closed.plate.vertices[len(closed.used) :] + closed.centre
    is_plate = (result.mesh.vertices[result.n_measured_vertices :] == plate).all(axis=1)
    assert is_plate[result.vertex_hole == 0].all()
    assert not is_plate[result.vertex_hole == 1].any()
    assert result.gap[0] > 10 * result.gap[1]


def test_far_away_scans_lose_nothing_beyond_their_own_rounding() -> None:
    mesh = punched(bumpy_plate(40, 2.0), (0.2, -0.3, 0), radius=0.4)
    near = filled(mesh, short_loops(mesh))
    shift = np.array([1e6, -2e6, 5e5])
    moved = TriangleMesh(mesh.vertices + shift, mesh.triangles)
    far = filled(moved, short_loops(moved))
    assert (far.mesh.triangles == near.mesh.triangles).all()
    # The rounded rim itself is off by up to half a unit in the last place of 2e6.
    assert np.abs(far.mesh.vertices - shift - near.mesh.vertices).max() < 20 * np.spacing(2e6)


@given(seed=st.integers(0, 2**32 - 1), power=st.integers(-20, 20))
@settings(max_examples=15, deadline=None)
def test_a_fill_moves_turns_and_grows_with_its_mesh(seed: int, power: int) -> None:
    rng = np.random.default_rng(seed)
    mesh = punched(bumpy_plate(30, 2.0), (0.3, 0.2, 0), (-0.5, -0.4, 0), radius=0.35)
    rotation, shift, scale = random_rotation(rng), rng.normal(0, 3, 3), 2.0**power
    moved = TriangleMesh(scale * (mesh.vertices @ rotation.T + shift), mesh.triangles)
    here, there = (filled(one, short_loops(one)) for one in (mesh, moved))
    assert (here.mesh.triangles == there.mesh.triangles).all()
    expected = scale * (here.mesh.vertices @ rotation.T + shift)
    assert np.abs(there.mesh.vertices - expected).max() < 1e-9 * scale


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


def test_a_flat_closing_leaves_new_vertices_on_the_triangles_that_span_the_rim() -> None:
    """Nothing bulges: the missing cap of a sphere comes back as a lid within the convex hull of its planar rim."""
    ball = sphere(4)
    top = ball.vertices[:, 2] > 0.8
    mesh = TriangleMesh(ball.vertices, ball.triangles[~top[ball.triangles].any(axis=1)])
    (loop,) = all_loops(mesh)
    result = close_flat(mesh, [loop])
    assert_keeps(result, mesh)
    assert is_oriented_manifold(result.mesh.triangles)
    assert euler_characteristic(result.mesh.triangles) == 2
    new, rim = result.mesh.vertices[result.n_measured_vertices :], mesh.vertices[loop]
    assert len(new) > 30
    assert new[:, 2].max() <= rim[:, 2].max()
    assert new[:, 2].min() >= rim[:, 2].min()
    assert np.isnan(result.gap).all()
    assert np.isnan(result.rim_turn).all()


def test_a_flat_closing_of_a_flat_hole_is_flat_and_as_dense_as_what_was_lost() -> None:
    whole = open_grid(41, 2.0)
    mesh = punched(whole, (0, 0, 0), radius=0.4)
    result = close_flat(mesh, short_loops(mesh))
    new = result.mesh.vertices[result.n_measured_vertices :]
    lost = len(whole.vertices) - len(np.unique(mesh.triangles))
    assert (new[:, 2] == 0).all()
    assert 0.5 < len(new) / lost < 2


def test_a_flat_closing_of_no_hole_gives_the_mesh_back() -> None:
    result = close_flat(sphere(2), [])
    assert result.mesh.vertices.tobytes() == sphere(2).vertices.tobytes()
    assert result.mesh.triangles.tobytes() == sphere(2).triangles.tobytes()

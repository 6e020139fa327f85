import numpy as np
import pytest

from quadpatch.filling.checked_fill import CheckedFill, FillFunction, LoopsToFill, fill_checked
from quadpatch.filling.constrained_fill import fill_constrained
from quadpatch.filling.fairing import THIN_PLATE, Energy
from quadpatch.filling.faults import find_faults
from quadpatch.filling.fill import close_flat, close_holes, fair_holes
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.mesh.boundary import boundary_loops
from quadpatch.mesh.distance import distance_to_mesh
from quadpatch.mesh.normals import triangle_normals, vertex_normals
from quadpatch.types import FloatArray, IntArray, TriangleMesh
from tests.quadpatch.filling.fills import all_loops, assert_keeps
from tests.quadpatch.filling.handmade import as_holes
from tests.quadpatch.shapes import joined, open_grid, plate_with_disc, punched, sphere

# On a saddle, the fills of all energies and the flat one lie apart.
SADDLE = open_grid(15, 2.0)
SADDLE.vertices[:, 2] = SADDLE.vertices[:, 0] ** 2 - SADDLE.vertices[:, 1] ** 2 + 0.5 * SADDLE.vertices[:, 0] ** 3
SADDLE = punched(SADDLE, (0, 0, 0), radius=0.7)
HOLE = [min(all_loops(SADDLE), key=len)]
BALL = punched(sphere(3), (0, 0, 1), (1, 0, 0), (0, -1, 0), radius=0.4)
LOOPS = all_loops(BALL)


def smooth(mesh: TriangleMesh, loops: list[IntArray]) -> FilledMesh:
    return fair_holes(close_holes(mesh, loops), Energy(plate=1.0, variation=20.0))


def surface(filled: FilledMesh) -> TriangleMesh:
    return TriangleMesh(filled.mesh.vertices, filled.mesh.triangles[filled.n_measured_triangles :])


def blades(mesh: TriangleMesh, through: list[FillFunction], spared: FillFunction | None) -> TriangleMesh:
    """A mesh with small blades, one through each of some fills of its hole and clear of another fill."""
    near: TriangleMesh | None = surface(spared(mesh, HOLE)) if spared else None
    parts = [mesh]
    for fill in through:
        filled = fill(mesh, HOLE)
        points, normals = places(filled)
        clearance = distance_to_mesh(points, near) if near else np.full(len(points), 0.1)
        at = int(clearance.argmax())
        assert clearance[at] > 1e-3
        half = 0.4 * clearance[at]
        up = normals[at]
        aside = np.cross(up, [1.0, 0.3, 0.2])
        aside /= np.linalg.norm(aside)
        # Shifted, so that no vertex lies on the blade.
        foot = points[at] + 0.07 * half * aside
        corners = np.array([foot - half * up - half * aside, foot - half * up + half * aside, foot + half * up])
        parts.append(TriangleMesh(corners, np.array([[0, 1, 2]])))
    return joined(*parts)


def places(filled: FilledMesh) -> tuple[FloatArray, FloatArray]:
    """New vertices, or the centroids of new triangles where there are none, and the normals there."""
    vertices, n = filled.mesh.vertices, filled.n_measured_vertices
    if len(vertices) > n:
        return vertices[n:], vertex_normals(vertices, filled.mesh.triangles)[n:]
    new = filled.mesh.triangles[filled.n_measured_triangles :]
    return vertices[new].mean(axis=1), triangle_normals(vertices, new)


def plate(mesh: TriangleMesh, loops: list[IntArray]) -> FilledMesh:
    return fair_holes(close_holes(mesh, loops), THIN_PLATE)


def constrained(mesh: TriangleMesh, loops: list[IntArray]) -> FilledMesh:
    return fill_constrained(plate(mesh, loops), loops, np.arange(len(loops)))


ORDER: list[tuple[str, FillFunction]] = [("energies", smooth), ("thin_plate", plate), ("constrained", constrained)]


def obstacles_of(mesh: TriangleMesh) -> tuple[TriangleMesh, IntArray]:
    """The saddle with the vertices of the blades, and their triangles."""
    n = len(SADDLE.triangles)
    return TriangleMesh(mesh.vertices, mesh.triangles[:n]), mesh.triangles[n:]


@pytest.mark.parametrize("n_spoiled", [0, 1, 2])
@pytest.mark.parametrize("in_file", [True, False])
def test_the_first_fill_in_the_order_of_plainness_that_holds_is_taken(n_spoiled: int, in_file: bool) -> None:
    name, fill = ORDER[n_spoiled]
    mesh = blades(SADDLE, [fill for _, fill in ORDER[:n_spoiled]], fill)
    obstacles = None
    if not in_file:
        mesh, obstacles = obstacles_of(mesh)
    checked = fill_checked(mesh, as_holes(HOLE), smooth, obstacles)
    assert checked.fill == [name]
    assert checked.refused == {}
    assert checked.faults.severity.tolist() == [0]
    assert_keeps(checked.filled, mesh)
    if fill is not constrained:
        expected = surface(fill(mesh, HOLE))
        assert distance_to_mesh(checked.filled.mesh.vertices[len(mesh.vertices) :], expected).max() < 1e-9
    # How far it lies from the first fill is told where it is another one.
    distance = distance_to_mesh(checked.filled.mesh.vertices[len(mesh.vertices) :], surface(smooth(mesh, HOLE)))
    assert checked.departure[0] == pytest.approx(distance.mean() if n_spoiled else 0.0, abs=1e-12)
    assert (checked.departure[0] > 0) == (n_spoiled > 0)


def linked(mesh: TriangleMesh) -> TriangleMesh:
    """A mesh and a ribbon that runs through its hole and, far out, around its border: no disk fills that hole."""
    angle = 2 * np.pi * np.arange(24) / 24
    middle = np.stack([3 - 3 * np.cos(angle), 0 * angle, 3 * np.sin(angle)], axis=1)
    half = np.array([0, 0.05, 0])
    ribbon = np.concatenate([middle - half, middle + half])
    i, j = np.arange(24), np.roll(np.arange(24), -1)
    return joined(
        mesh, TriangleMesh(ribbon, np.concatenate([np.stack([i, j, 24 + i], 1), np.stack([j, 24 + j, 24 + i], 1)]))
    )


def test_a_hole_whose_every_fill_runs_through_something_is_refused() -> None:
    mesh = linked(SADDLE)
    checked = fill_checked(mesh, as_holes(HOLE), smooth)
    code, reason = checked.refused[0]
    assert code == "crosses_surface"
    assert "other surface" in reason
    assert_opened(checked, mesh)


def assert_opened(checked: CheckedFill, mesh: TriangleMesh) -> None:
    assert_keeps(checked.filled, mesh)
    assert len(checked.filled.mesh.vertices) == len(mesh.vertices)
    assert len(checked.filled.mesh.triangles) == len(mesh.triangles)
    assert checked.faults.severity.tolist() == [0] * len(checked.filled.disagreement)
    assert checked.departure.tolist() == [0.0] * len(checked.filled.disagreement)


def test_a_lonely_triangle_is_refused_since_its_back_lies_on_it() -> None:
    triangle = TriangleMesh(np.eye(3), np.array([[0, 1, 2]]))
    checked = fill_checked(triangle, as_holes(all_loops(triangle)), smooth)
    code, reason = checked.refused[0]
    assert code == "crosses_surface"
    assert "runs through other surface" in reason
    assert_opened(checked, triangle)


def test_the_back_of_a_flat_sheet_is_refused_since_it_doubles_its_own_surface() -> None:
    # The outer border of the plate with a hole comes last.
    for sheet in (open_grid(2), open_grid(6), plate_with_disc(12, 2)):
        checked = fill_checked(sheet, as_holes(all_loops(sheet)[-1:]), smooth)
        assert checked.refused.keys() == {0}
        assert_opened(checked, sheet)


def test_the_border_of_a_sheet_is_refused_since_its_fill_doubles_the_sheet() -> None:
    # Slightly bent, so that the fill crosses nothing.
    sheet = open_grid(8)
    bent = TriangleMesh(sheet.vertices + np.outer(0.01 * (sheet.vertices**2).sum(axis=1), [0, 0, 1]), sheet.triangles)
    loops = all_loops(bent)
    wanted = LoopsToFill(loops, np.zeros(1, bool), np.ones(1, bool))
    checked = fill_checked(bent, wanted, close_flat)
    assert checked.refused[0][0] == "doubles_surface"
    assert_opened(checked, bent)


def test_a_deep_bowl_may_be_closed_at_its_border() -> None:
    bowl = punched(sphere(3), (0, 0, 1), radius=1.3)
    wanted = LoopsToFill(all_loops(bowl), np.zeros(1, bool), np.ones(1, bool))
    checked = fill_checked(bowl, wanted, smooth)
    assert checked.refused == {}


def test_plane_patches_are_taken_where_they_are_asked_for() -> None:
    flat = np.array([True, *[False] * (len(LOOPS) - 1)])
    checked = fill_checked(BALL, LoopsToFill(LOOPS, flat, np.zeros(len(LOOPS), bool)), smooth)
    assert checked.fill[:2] == ["flat", "energies"]
    others = fill_checked(BALL, as_holes(LOOPS), smooth)
    for loop in range(1, len(LOOPS)):
        # One system holds all loops, so its rounding differs.
        np.testing.assert_allclose(fill_of(checked.filled, loop)[1], fill_of(others.filled, loop)[1], atol=1e-9)
    vertices, _ = fill_of(checked.filled, 0)
    assert np.linalg.svd(vertices - vertices.mean(axis=0), compute_uv=False)[-1] < 1e-12


def crumpled(which: int) -> FillFunction:
    """A fill that throws the new vertices of one loop about."""

    def fill(mesh: TriangleMesh, loops: list[IntArray]) -> FilledMesh:
        filled = smooth(mesh, loops)
        new = filled.mesh.vertices[filled.n_measured_vertices :]
        thrown = new + np.random.default_rng(0).normal(0, 0.2, new.shape)
        return filled.with_vertices(np.where((filled.vertex_hole == which)[:, None], thrown, new))

    return fill


def fill_of(filled: FilledMesh, loop: int) -> tuple[FloatArray, FloatArray]:
    new = filled.mesh.vertices[filled.n_measured_vertices :]
    triangles = filled.mesh.triangles[filled.n_measured_triangles :][filled.triangle_hole == loop]
    return new[filled.vertex_hole == loop], filled.mesh.vertices[triangles]


@pytest.mark.parametrize("which", [0, 1, 2])
def test_the_fills_of_other_holes_are_left_alone_when_one_is_replaced(which: int) -> None:
    first = crumpled(which)(BALL, LOOPS)
    assert find_faults(first).is_wrong.tolist() == [i == which for i in range(3)]
    checked = fill_checked(BALL, as_holes(LOOPS), crumpled(which))
    assert checked.fill == ["thin_plate" if i == which else "energies" for i in range(3)]
    assert (checked.departure > 0).tolist() == [i == which for i in range(3)]
    assert_keeps(checked.filled, BALL)
    for loop in range(3):
        same = [
            one.tobytes() == other.tobytes()
            for one, other in zip(fill_of(checked.filled, loop), fill_of(first, loop), strict=True)
        ]
        assert same == [loop != which] * 2


def test_a_good_fill_comes_back_as_it_is() -> None:
    first = smooth(BALL, LOOPS)
    checked = fill_checked(BALL, as_holes(LOOPS), smooth)
    assert checked.filled.mesh.vertices.tobytes() == first.mesh.vertices.tobytes()
    assert checked.filled.mesh.triangles.tobytes() == first.mesh.triangles.tobytes()
    assert checked.fill == ["energies"] * 3
    assert (checked.refused, checked.departure.tolist()) == ({}, [0.0] * 3)


def test_no_loop_is_no_fault() -> None:
    checked = fill_checked(BALL, as_holes([]), smooth)
    assert (checked.fill, checked.refused, checked.departure.tolist()) == ([], {}, [])
    assert_keeps(checked.filled, BALL)


@pytest.mark.parametrize("n_holes", [2, 9])
def test_one_fill_that_runs_through_those_of_all_others_is_the_only_one_refused(n_holes: int) -> None:
    # A flat sheet with small holes; closing its outer border lays a second sheet over each of them.
    sheet = open_grid(10)
    cells = 9 * np.arange(1, 9, 3)[:, None] + np.arange(1, 9, 3)[None]
    mesh = TriangleMesh(sheet.vertices, np.delete(sheet.triangles, cells.ravel()[:n_holes], axis=0))
    loops = sorted(boundary_loops(mesh.triangles).loops, key=len)[::-1]
    assert len(loops) == n_holes + 1
    checked = fill_checked(mesh, as_holes(loops), close_flat)
    assert checked.refused.keys() == {0}
    assert np.bincount(checked.filled.triangle_hole, minlength=n_holes + 1).tolist() == [0] + [1] * n_holes


def test_a_fill_that_runs_into_nothing_but_a_refused_one_stays() -> None:
    # A small ring stands upright in a wide hole: the wide lid runs into the ring, the small lid into the wide one only.
    wide, small = plate_with_disc(40), plate_with_disc(12)
    upright = TriangleMesh(0.2 * small.vertices[:, [2, 0, 1]] + [0.03, 0.02, 0.01], small.triangles)
    mesh = joined(wide, upright)
    rims = [np.arange(40)[::-1], len(wide.vertices) + np.arange(12)[::-1]]
    checked = fill_checked(mesh, as_holes(rims), close_flat)
    assert {i: code for i, (code, _) in checked.refused.items()} == {0: "crosses_surface"}
    assert checked.fill[1] == "energies"
    assert set(checked.filled.triangle_hole.tolist()) == {1}

import numpy as np
import pytest

from quadpatch.filling.checked_fill import CREASED, CheckedFill, LoopsToFill, fill_checked, with_creases
from quadpatch.filling.creases import crease_displacement, crease_share
from quadpatch.filling.fairing import THIN_PLATE
from quadpatch.filling.fill import close_holes, fair_holes
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.mesh.boundary import boundary_loops
from quadpatch.mesh.distance import distance_to_mesh
from quadpatch.types import FloatArray, IntArray, TriangleMesh
from tests.quadpatch.shapes import open_grid, punched, random_rotation, sphere


def roof(n: int) -> TriangleMesh:
    """Two planes that meet at a right angle along the y axis."""
    flat = open_grid(n, 2.0)
    x, y, _ = flat.vertices.T
    return TriangleMesh(np.stack([x, y, -np.abs(x)], axis=1), flat.triangles)


ROOF = roof(61)
PLACES = [(0.1, -0.5, -0.1), (-0.05, 0.0, -0.05), (0.5, 0.5, -0.5)]
HOLED = punched(ROOF, *PLACES, radius=0.2)


def rims(mesh: TriangleMesh) -> list[IntArray]:
    return [loop for loop in boundary_loops(mesh.triangles).loops if len(loop) < 100]


def faired(mesh: TriangleMesh) -> FilledMesh:
    return fair_holes(close_holes(mesh, rims(mesh)), THIN_PLATE)


def errors(filled: FilledMesh, truth: TriangleMesh) -> FloatArray:
    """Mean distance of the new vertices of every hole to the truth."""
    distance = distance_to_mesh(filled.mesh.vertices[filled.n_measured_vertices :], truth)
    return np.array([distance[filled.vertex_hole == i].mean() for i in range(len(filled.disagreement))])


def checked(mesh: TriangleMesh, flat: tuple[int, ...] = ()) -> CheckedFill:
    loops = rims(mesh)
    is_flat = np.isin(np.arange(len(loops)), flat)
    wanted = LoopsToFill(loops, is_flat, np.zeros(len(loops), bool))
    return fill_checked(mesh, wanted, lambda part, some: fair_holes(close_holes(part, some), THIN_PLATE))


def test_two_planes_meet_in_a_crease() -> None:
    filled = faired(HOLED)
    creased = filled.displaced(crease_displacement(filled))
    before, after = errors(filled, ROOF), errors(creased, ROOF)
    across = before > 1e-3
    assert across.sum() == 2
    assert (after[across] < 0.15 * before[across]).all()
    # A hole within one plane has nothing to gain, and loses nothing.
    assert after[~across].max() < 1e-6


def test_a_moved_mesh_gets_moved_creases() -> None:
    filled = faired(HOLED)
    rotation, shift = random_rotation(np.random.default_rng(1)), np.array([3.0, -2.0, 5.0])
    vertices = filled.mesh.vertices @ rotation.T + shift
    moved = FilledMesh(**{**vars(filled), "mesh": TriangleMesh(vertices, filled.mesh.triangles)})
    np.testing.assert_allclose(crease_displacement(moved), crease_displacement(filled) @ rotation.T, atol=1e-6)


def test_without_new_vertices_nothing_moves() -> None:
    plain = open_grid(5, 1.0)
    filled = fair_holes(close_holes(plain, []), THIN_PLATE)
    assert crease_displacement(filled).shape == (0, 3)


def test_creases_are_told_from_bends() -> None:
    assert crease_share(sphere(3)) == 0.0
    # One edge in a row of the grid, which has three edges for each cell.
    assert crease_share(ROOF) == pytest.approx(1 / (3 * 60), rel=0.05)
    assert crease_share(TriangleMesh(np.zeros((0, 3)), np.zeros((0, 3), np.int64))) == 0.0


def test_faired_fills_get_creases_and_flat_ones_stay() -> None:
    fill = checked(HOLED, flat=(1,))
    creased = with_creases(fill, 1.0)
    assert creased.fill == [CREASED, "flat", CREASED]
    same = (creased.filled.mesh.vertices == fill.filled.mesh.vertices).all(axis=1)
    assert same[: fill.filled.n_measured_vertices].all()
    new = same[fill.filled.n_measured_vertices :]
    assert new[fill.filled.vertex_hole == 1].all()
    assert not new[fill.filled.vertex_hole != 1].all()
    assert not creased.faults.is_wrong.any()
    assert with_creases(fill, 0.0) is fill


def test_a_crease_that_folds_is_taken_back_and_its_size_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    fill = checked(HOLED)
    new = fill.filled.mesh.vertices[fill.filled.n_measured_vertices :]
    inside = np.flatnonzero(fill.filled.vertex_hole == 0)
    # One vertex of the first hole is thrown beyond its neighbours, and stays there.
    thrown = np.zeros_like(new)
    thrown[inside[np.linalg.norm(new[inside] - new[inside].mean(axis=0), axis=1).argmin()]] = [0.0, 0.12, 0.0]
    monkeypatch.setattr("quadpatch.filling.checked_fill.crease_displacement", lambda filled: thrown)
    monkeypatch.setattr("quadpatch.filling.displaced_fill._MOST_ROUNDS", 0)
    creased = with_creases(fill, 1.0)
    assert creased.fill[0] == "energies"
    assert creased.filled.mesh.vertices.tobytes() == fill.filled.mesh.vertices.tobytes()
    assert creased.departure[0] == pytest.approx(0.12 / len(inside))

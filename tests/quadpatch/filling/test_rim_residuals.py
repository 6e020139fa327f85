import numpy as np
import pytest

from quadpatch.filling.fairing import THIN_PLATE, Energy
from quadpatch.filling.fill import close_holes
from quadpatch.filling.rim_residuals import rim_residuals
from quadpatch.mesh.holes import find_holes
from quadpatch.types import FloatArray, IntArray, TriangleMesh
from tests.quadpatch.shapes import bumpy_plate, open_grid, punched, sphere

PAIR = (THIN_PLATE, Energy(plate=1.0, variation=40.0))


def rims(mesh: TriangleMesh) -> list[IntArray]:
    return [hole.loop for hole in find_holes(mesh)]


def residuals(mesh: TriangleMesh, loops: list[IntArray], *, graded: bool = False) -> FloatArray:
    return rim_residuals(close_holes(mesh, loops, graded=graded), PAIR)


def test_on_a_sphere_the_smoother_energy_misses_the_rim_by_less() -> None:
    mesh = punched(sphere(4), (0, 0, 1), (1, 0, 0), radius=0.3)
    misses = residuals(mesh, rims(mesh))
    assert misses.shape == (2, 2)
    assert (misses[:, 1] < 0.7 * misses[:, 0]).all()


def test_of_a_flat_sheet_every_energy_finds_the_rim() -> None:
    mesh = punched(open_grid(41, 4.0), (0.3, 0, 0), radius=0.45)
    loops = [hole.loop for hole in find_holes(mesh) if hole.diameter < 2.0]
    assert residuals(mesh, loops) == pytest.approx(0.0, abs=1e-9)


def test_a_rim_that_was_moved_is_missed_by_as_much() -> None:
    mesh = punched(open_grid(41, 4.0), (0.3, 0, 0), radius=0.45)
    (loop,) = [hole.loop for hole in find_holes(mesh) if hole.diameter < 2.0]
    vertices = mesh.vertices.copy()
    vertices[loop, 2] += 0.02
    assert residuals(TriangleMesh(vertices, mesh.triangles), [loop]) == pytest.approx(0.02, rel=0.05)


def test_misses_have_the_unit_of_the_mesh_and_do_not_depend_on_its_place() -> None:
    mesh = punched(bumpy_plate(50, 2.0), (0.4, 0.4, 0), (-0.4, 0.2, 0), radius=0.2)
    loops = [hole.loop for hole in find_holes(mesh) if hole.diameter < 1.0]
    elsewhere = TriangleMesh(1000.0 * mesh.vertices + [5e4, -3e4, 1e4], mesh.triangles)
    assert residuals(elsewhere, loops) == pytest.approx(1000.0 * residuals(mesh, loops), rel=1e-4)


def test_a_graded_fill_misses_as_much_as_a_uniform_one() -> None:
    mesh = punched(bumpy_plate(100, 2.0), (0.4, 0.4, 0), (-0.4, 0.2, 0), radius=0.3)
    loops = [hole.loop for hole in find_holes(mesh) if hole.diameter < 1.0]
    uniform, graded = (residuals(mesh, loops, graded=graded) for graded in (False, True))
    assert graded == pytest.approx(uniform, rel=0.15)


def test_a_rim_beside_a_border_tells_nothing() -> None:
    # The disk at the left leaves one row of squares to the border of the sheet.
    mesh = punched(open_grid(41, 4.0), (-1.4, 0, 0), (0.8, 0, 0), radius=0.45)
    loops = [hole.loop for hole in find_holes(mesh) if hole.diameter < 2.0]
    known = np.asarray(np.isfinite(residuals(mesh, loops)).all(axis=1))
    at_left = np.array([mesh.vertices[loop, 0].mean() < 0 for loop in loops])
    assert sorted(known.tolist()) == [False, True]
    assert (known == ~at_left).all()


def test_rims_with_nothing_behind_them_tell_nothing() -> None:
    # One triangle: all of its vertices are on the rim.
    mesh = TriangleMesh(np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2]]))
    assert np.isnan(residuals(mesh, [np.array([2, 1, 0])])).all()

"""Vertices that rounding has torn apart."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from quadpatch.errors import OptionError
from quadpatch.mesh import near_vertices
from quadpatch.mesh.boundary import boundary_loops
from quadpatch.mesh.near_vertices import ULPS, stored_precision
from quadpatch.mesh.weld import Weld, weld
from quadpatch.types import FloatArray, TriangleMesh
from tests.quadpatch.shapes import bumpy_plate, open_grid, punched, sphere

BALL = punched(sphere(2), (0, 0, 1), (0, 1, 0), radius=0.4)


def torn(mesh: TriangleMesh, units: int, rng: np.random.Generator, number: type = np.float32) -> TriangleMesh:
    """Give every triangle vertices of its own, each coordinate off by up to some units in the last place."""
    corners: NDArray[Any] = mesh.vertices[mesh.triangles.ravel()].astype(number)
    off = rng.integers(-units, units + 1, corners.shape) * np.spacing(np.abs(corners))
    vertices = (corners + off).astype(number).astype(np.float64)
    return TriangleMesh(vertices, np.arange(mesh.triangles.size).reshape(-1, 3))


def shape(welded: Weld) -> tuple[int, int, list[int], bool]:
    boundary = boundary_loops(welded.mesh.triangles)
    loops = sorted(len(loop) for loop in boundary.loops)
    return len(np.unique(welded.mesh.triangles)), len(welded.mesh.triangles), loops, all(boundary.is_manifold)


@given(
    seed=st.integers(0, 1000),
    size=st.sampled_from([1e-6, 1.0, 98.0, 5e4]),
    number=st.sampled_from([np.float32, np.float64]),
    units=st.sampled_from([1, 2]),
)
def test_noise_in_the_last_bits_is_no_gap(seed: int, size: float, number: type, units: int) -> None:
    rng = np.random.default_rng(seed)
    sized = TriangleMesh(BALL.vertices * size, BALL.triangles)
    mesh = torn(sized, units, rng, number)
    welded = weld(mesh.vertices, mesh.triangles, "auto")
    assert shape(welded) == shape(weld(sized.vertices, sized.triangles))
    counts = welded.counts
    assert counts.near_vertices > 0
    assert counts.equal_vertices + counts.near_vertices == len(mesh.vertices) - len(welded.mesh.vertices)
    # Every vertex of the welded mesh is one of the file's, and no vertex went far.
    assert welded.mesh.vertices.tobytes() == mesh.vertices[welded.to_file].tobytes()
    moved = np.linalg.norm(welded.mesh.vertices[welded.from_file] - mesh.vertices, axis=1)
    assert moved.max() <= counts.tolerance


@given(seed=st.integers(0, 1000))
def test_the_result_does_not_depend_on_the_order_of_the_file(seed: int) -> None:
    mesh = torn(BALL, 2, np.random.default_rng(0))
    order = np.random.default_rng(seed).permutation(len(mesh.triangles))
    assert shape(weld(mesh.vertices, mesh.triangles[order], "auto")) == shape(weld(BALL.vertices, BALL.triangles))


def test_without_a_tolerance_noise_leaves_gaps() -> None:
    mesh = torn(BALL, 1, np.random.default_rng(0))
    exact = weld(mesh.vertices, mesh.triangles)
    assert exact.counts.near_vertices == 0
    assert len(exact.mesh.vertices) > 2 * len(BALL.vertices)


@pytest.mark.parametrize("seed", range(3))
def test_a_mesh_without_noise_is_the_same_with_auto(seed: int) -> None:
    plate = punched(bumpy_plate(16, 2.0, seed), (0, 0, 0), radius=0.3)
    mesh = torn(plate, 0, np.random.default_rng(0), np.float64)
    exact, auto = weld(mesh.vertices, mesh.triangles), weld(mesh.vertices, mesh.triangles, "auto")
    assert auto.counts.near_vertices == 0
    assert auto.mesh.vertices.tobytes() == exact.mesh.vertices.tobytes()
    assert (auto.mesh.triangles == exact.mesh.triangles).all()


def test_far_from_the_origin_auto_joins_nothing_that_is_as_far_apart_as_edges() -> None:
    # In single precision there are 16 numbers a unit at a million: the mesh's edges are as short as the rounding.
    grid = punched(open_grid(9, 1.0), (0, 0, 0), radius=0.05)
    vertices = (grid.vertices + 1e6).astype(np.float32).astype(np.float64)
    mesh = torn(TriangleMesh(vertices, grid.triangles), 0, np.random.default_rng(0))
    exact, auto = weld(mesh.vertices, mesh.triangles), weld(mesh.vertices, mesh.triangles, "auto")
    assert auto.counts.tolerance > 0.1
    assert auto.counts.near_vertices == 0
    assert (auto.mesh.triangles == exact.mesh.triangles).all()


def test_one_needle_elsewhere_does_not_keep_noise_from_being_joined() -> None:
    mesh = torn(BALL, 1, np.random.default_rng(0))
    for apart in (0.0, 1e-6, 1e-4):
        tip = np.array([[5.0, 0, 0], [5.0 + apart, 0, 0], [5.0, 1, 0]], np.float32).astype(np.float64)
        vertices = np.concatenate([mesh.vertices, tip])
        triangles = np.concatenate([mesh.triangles, len(mesh.vertices) + np.array([[0, 1, 2]])])
        welded = weld(vertices, triangles, "auto")
        loops = [
            loop for loop in boundary_loops(welded.mesh.triangles).loops if welded.mesh.vertices[loop, 0].max() < 2
        ]
        assert sorted(map(len, loops)) == shape(weld(BALL.vertices, BALL.triangles))[2]
        # The needle itself is not collapsed, as long as its corners are at different places.
        assert (welded.mesh.vertices[welded.mesh.triangles][:, :, 0] > 4).any() == (tip[0, 0] != tip[1, 0])


@pytest.mark.parametrize("tolerance", [0.011, 0.05, 0.3])
def test_no_tolerance_collapses_a_triangle_or_joins_along_a_row(tolerance: float) -> None:
    # Two sheets side by side, 0.01 apart along a border of fine edges.
    left = open_grid(21, 1.0)
    n, edge = len(left.vertices), 0.05
    vertices = np.concatenate([left.vertices, left.vertices + np.array([1.01, 0, 0])])
    triangles = np.concatenate([left.triangles, left.triangles + n])
    if tolerance > 0.06:
        with pytest.raises(OptionError, match="mean edge length"):
            weld(vertices, triangles, tolerance)
        return
    welded = weld(vertices, triangles, tolerance)
    assert len(welded.mesh.triangles) == len(triangles)
    assert welded.counts.near_vertices == 21
    (loop,) = boundary_loops(welded.mesh.triangles).loops
    assert len(loop) == 2 * (40 + 20)
    moved = np.linalg.norm(welded.mesh.vertices[welded.from_file] - vertices, axis=1)
    assert moved.max() <= min(tolerance, edge)


def test_a_row_of_near_vertices_is_not_drawn_together() -> None:
    # Loose triangles whose first corners lie 0.6 of the tolerance apart, all in one row.
    n, step = 50, 0.006
    x = step * np.arange(n)
    first = np.stack([x, 0 * x, 0 * x], axis=1)
    angle = 2.4 * np.arange(n)
    far = [np.stack([x, np.cos(angle + k), np.sin(angle + k)], axis=1) for k in (0.0, 1.0)]
    vertices = np.concatenate([first, *far])
    triangles = np.stack([np.arange(n), n + np.arange(n), 2 * n + np.arange(n)], axis=1)
    welded = weld(vertices, triangles, 0.01)
    moved = np.linalg.norm(welded.mesh.vertices[welded.from_file] - vertices, axis=1)
    assert 0 < moved.max() <= 0.01
    assert len(welded.mesh.triangles) == n
    # Of the nearest pairs first, at least every third vertex finds a partner.
    assert n // 3 - 1 < welded.counts.near_vertices <= n // 2


def test_too_many_pairs_are_refused_where_they_were_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(near_vertices, "MAX_PAIRS", 3)
    mesh = torn(BALL, 1, np.random.default_rng(0))
    with pytest.raises(OptionError, match="joins too much"):
        weld(mesh.vertices, mesh.triangles, 1e-5)
    assert weld(mesh.vertices, mesh.triangles, "auto").counts.near_vertices == 0


@pytest.mark.parametrize("digits", [6, 7])
@pytest.mark.parametrize("wanted", ["single", "double"])
def test_the_precision_of_text_is_told_from_its_digits(digits: int, wanted: str) -> None:
    rng = np.random.default_rng(0)
    numbers = rng.normal(size=(500, 3)) * 100
    if wanted == "single":
        points = _parsed(numbers, digits)
        ulp = np.spacing(np.float32(np.abs(points).max()))
    else:
        points = _parsed(numbers, digits + 8)
        ulp = np.spacing(np.abs(points).max())
    assert stored_precision(points) == pytest.approx(ULPS * float(ulp))


@pytest.mark.parametrize("digits", [8, 9])
def test_single_precision_is_known_by_the_digits_that_it_is_written_with(digits: int) -> None:
    rng = np.random.default_rng(0)
    single = (rng.normal(size=(500, 3)) * 100).astype(np.float32).astype(np.float64)
    ulp = float(np.spacing(np.float32(np.abs(single).max())))
    assert stored_precision(_parsed(single, digits)) == pytest.approx(ULPS * ulp)
    # As many digits of other numbers are more than single precision holds.
    others = _parsed(rng.normal(size=(500, 3)) * 100, 9)
    assert stored_precision(others) < 1e-3 * ulp


def _parsed(numbers: FloatArray, digits: int) -> FloatArray:
    """Write and read numbers with so many significant digits."""
    return np.array([float(f"{x:.{digits}g}") for x in numbers.ravel().tolist()]).reshape(numbers.shape)


@pytest.mark.parametrize("scale", [1e-300, 1e-40, 1e30, 1e300])
def test_any_size_of_coordinates_has_a_precision(scale: float) -> None:
    points = np.random.default_rng(0).normal(size=(10, 3)) * scale
    assert 0 < stored_precision(points) < 1e-12 * np.abs(points).max() + 1e-320


def test_no_coordinates_have_the_precision_of_zero() -> None:
    assert stored_precision(np.zeros((0, 3))) == ULPS * float(np.spacing(np.float32(0)))


def test_noise_in_the_last_printed_digit_is_joined_by_a_given_tolerance_only() -> None:
    rng = np.random.default_rng(0)
    mesh = torn(BALL, 0, rng)
    printed = np.round(mesh.vertices, 3) + 0.001 * rng.integers(0, 2, mesh.vertices.shape)
    assert weld(printed, mesh.triangles, "auto").counts.near_vertices == 0
    assert shape(weld(printed, mesh.triangles, 0.002)) == shape(weld(BALL.vertices, BALL.triangles))

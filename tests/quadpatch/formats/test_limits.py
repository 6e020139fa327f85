"""Coordinates that no scan has."""

import numpy as np
import pytest

from quadpatch.errors import CoordinateRangeError, EmptyMeshError, NotFiniteError, QuadpatchError
from quadpatch.formats.limits import check_vertices
from quadpatch.types import FloatArray
from tests.quadpatch.shapes import sphere

BALL = sphere(2).vertices


def refusal(vertices: FloatArray) -> str | None:
    """Return the code under which vertices are refused, None where they pass."""
    try:
        check_vertices(vertices)
    except QuadpatchError as error:
        return error.code
    return None


@pytest.mark.parametrize("number", [3e38, -3e38, 1.1e18, 1e300])
def test_one_coordinate_beyond_reason_is_enough(number: float) -> None:
    vertices = BALL.copy()
    vertices[17, 1] = number
    with pytest.raises(CoordinateRangeError, match="vertex 17 of 162"):
        check_vertices(vertices)


def test_what_is_not_finite_comes_first() -> None:
    vertices = BALL.copy()
    vertices[3, 0], vertices[9, 2] = 3e38, np.nan
    with pytest.raises(NotFiniteError, match="vertex 9 of 162"):
        check_vertices(vertices)


@pytest.mark.parametrize(
    "vertices",
    [
        1e-39 * BALL,
        np.arange(1, 31, dtype=np.uint32).view(np.float32).reshape(-1, 3).astype(np.float64),
        1e-300 * BALL,
    ],
    ids=["float32 subnormal", "integers", "float64"],
)
def test_coordinates_that_are_mostly_below_float32_are_refused(vertices: FloatArray) -> None:
    with pytest.raises(CoordinateRangeError, match=r"smaller than 1\.18e-38"):
        check_vertices(vertices)


@pytest.mark.parametrize(
    "vertices",
    [BALL, 1e17 * BALL, 1e-30 * BALL, np.zeros((3, 3)), np.column_stack([BALL[:, :2], np.full(len(BALL), 1e-40)])],
    ids=["usual", "huge", "tiny", "zero", "a plane that is zero but for rounding"],
)
def test_what_a_scan_may_have_passes(vertices: FloatArray) -> None:
    assert refusal(vertices) is None


def test_missing_vertices_pass_where_they_are_allowed_as_long_as_others_are_there() -> None:
    vertices = BALL.copy()
    vertices[:5] = np.nan
    check_vertices(vertices, allow_missing=True)
    with pytest.raises(NotFiniteError):
        check_vertices(vertices)
    with pytest.raises(EmptyMeshError, match="all 162 vertices"):
        check_vertices(np.full_like(vertices, np.nan), allow_missing=True)


@pytest.mark.parametrize(
    "row", [[np.nan, 0, 0], [np.nan, np.nan, 1], [np.inf, np.inf, np.inf], [np.nan, np.nan, np.inf]]
)
def test_a_vertex_that_is_missing_in_part_or_infinite_never_passes(row: list[float]) -> None:
    vertices = BALL.copy()
    vertices[0], vertices[7] = np.nan, row
    with pytest.raises(NotFiniteError, match="vertex 7 of 162"):
        check_vertices(vertices, allow_missing=True)

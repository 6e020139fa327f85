"""How much a reader takes in before it says no.

Counts that a header declares are held against these limits and against the bytes that are really there before any
array of that size is made, so a file of 300 bytes that claims 10**12 faces costs nothing.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quadpatch.errors import (
    CoordinateRangeError,
    EmptyMeshError,
    IndexRangeError,
    NotFiniteError,
    TooLargeError,
)
from quadpatch.mesh.passes import parts_of
from quadpatch.types import BoolArray, FloatArray, IntArray, Triangles, Vertices

# No scan is larger, in any unit: in nanometres the Earth is 1.3e16 wide. Bytes that are no coordinates, read as
# such, soon give a larger number.
LARGEST_COORDINATE = 1e18
# The smallest number that float32 holds with all its digits. Small integers, read as float32, lie below it.
SMALLEST_COORDINATE = float(np.finfo(np.float32).tiny)
# A few coordinates below it are the rounding of a zero; more than this share of those that are not zero are none.
_MOST_TOO_SMALL = 0.5
# Vertices that are looked at together.
_CHUNK = 1 << 14


@dataclass(frozen=True)
class ReadLimits:
    """Upper bounds of what is read.

    Attributes
    ----------
    max_bytes : int
        Size of the file; for zip containers also the sum of the unpacked sizes.
    max_vertices, max_triangles : int
        Counts, polygons and strips counted as the triangles they become.
    allow_missing : bool
        Whether vertices whose three coordinates are NaN pass, as missing ones; infinite ones never do.
    """

    max_bytes: int = 2 * 1024**3
    max_vertices: int = 20_000_000
    max_triangles: int = 40_000_000
    allow_missing: bool = False

    def check_bytes(self, n_bytes: int) -> None:
        """Raise TooLargeError for more bytes than allowed."""
        _check("bytes", n_bytes, self.max_bytes)

    def check_vertices(self, n_vertices: int) -> None:
        """Raise TooLargeError for more vertices than allowed."""
        _check("vertices", n_vertices, self.max_vertices)

    def check_triangles(self, n_triangles: int) -> None:
        """Raise TooLargeError for more triangles than allowed."""
        _check("triangles", n_triangles, self.max_triangles)


def _check(what: str, count: int, limit: int) -> None:
    if count > limit:
        raise TooLargeError(f"the file has {count:,} {what}; the limit is {limit:,}")


def to_float64(values: NDArray[Any]) -> FloatArray:
    """Cast stored numbers without a word on NaN: whether one matters is for the checks to say."""
    with np.errstate(invalid="ignore"):
        return np.asarray(values.astype(np.float64))


def check_vertices(vertices: Vertices, allow_missing: bool = False) -> None:
    """Refuse a mesh without vertices or with coordinates that can't be computed with.

    A bad coordinate is refused even where no face uses its vertex: it would spoil bounding boxes and search trees.

    Parameters
    ----------
    vertices : (n, 3) float64
    allow_missing : bool
        Whether vertices whose three coordinates are NaN pass, as long as there are others.

    Raises
    ------
    EmptyMeshError, NotFiniteError, CoordinateRangeError
    """
    if len(vertices) == 0:
        raise EmptyMeshError("the file has no vertex")
    if allow_missing:
        vertices = _without_missing(vertices)
    is_usable, n_too_small, n_not_zero = True, 0, 0
    for part in parts_of(len(vertices), _CHUNK):
        size = np.abs(vertices[part])
        # A NaN fails the comparison as an infinity does.
        is_usable &= bool(size.max() <= LARGEST_COORDINATE)
        n_zero = size.size - int(np.count_nonzero(size))
        n_too_small += int(np.count_nonzero(size < SMALLEST_COORDINATE)) - n_zero
        n_not_zero += size.size - n_zero
    if not is_usable:
        _refuse_large(vertices, np.asarray(~(np.abs(vertices) <= LARGEST_COORDINATE).all(axis=1)))
    if n_too_small > _MOST_TOO_SMALL * n_not_zero:
        raise CoordinateRangeError(
            f"{n_too_small:,} of {vertices.size:,} coordinates are smaller than {SMALLEST_COORDINATE:.3g} and not "
            "zero: the file does not hold what its format says"
        )


def _without_missing(vertices: Vertices) -> Vertices:
    """Put the first vertex that is there in the place of those that are missing, so that others keep their number."""
    is_missing = np.asarray(np.isnan(vertices).all(axis=1))
    if is_missing.all():
        raise EmptyMeshError(f"all {len(vertices):,} vertices of the file are missing: their coordinates are NaN")
    if not is_missing.any():
        return vertices
    return np.where(is_missing[:, np.newaxis], vertices[np.argmin(is_missing)], vertices)


def _refuse_large(vertices: Vertices, bad: BoolArray) -> None:
    """Raise the error of the first bad vertex; NaN and infinity come before what is merely too large."""
    is_infinite = ~np.isfinite(vertices).all(axis=1)
    first = int(np.argmax(is_infinite if is_infinite.any() else bad))
    where = f"vertex {first} of {len(vertices):,} has the coordinates {vertices[first].tolist()}"
    if is_infinite.any():
        raise NotFiniteError(f"{where}; {int(is_infinite.sum()):,} vertices are infinite or NaN")
    raise CoordinateRangeError(f"{where}; {int(bad.sum()):,} vertices are beyond {LARGEST_COORDINATE:g}, the limit")


def check_indices(corners: IntArray, n_vertices: int) -> None:
    """Raise IndexRangeError where a face names a vertex that is not there.

    Parameters
    ----------
    corners : (...) int64
        Zero-based vertex indices.
    n_vertices : int
    """
    if corners.size == 0:
        return
    low, high = int(corners.min()), int(corners.max())
    if low < 0 or high >= n_vertices:
        wrong = low if low < 0 else high
        raise IndexRangeError(f"a face names vertex {wrong}, but the file has the vertices 0 to {n_vertices - 1}")


def check_triangles(triangles: Triangles, limits: ReadLimits) -> None:
    """Raise EmptyMeshError or TooLargeError for no triangle or too many."""
    if len(triangles) == 0:
        raise EmptyMeshError("the file has vertices but no face")
    limits.check_triangles(len(triangles))

"""Scenes: meshes placed by transforms, read as one mesh, and what a task changes put back into the parts.

The analysis sees all parts in the coordinates of the scene. A fill goes back into the coordinates of the part that
has most of its hole's rim, so that the rim's vertices are the part's own numbers again, bit for bit.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from quadpatch.errors import StageError
from quadpatch.formats.attributes import joined_vertices
from quadpatch.formats.scan import Fill, Moved, Scan
from quadpatch.types import BoolArray, FloatArray, IntArray, Triangles, Vertices

# Condition number beyond which a transform counts as flat.
_FLATTEST = 1e12
# Roundings on the way through a transform and its inverse.
_STEPS = 16


@dataclass(frozen=True)
class Part:
    """One placed mesh.

    Attributes
    ----------
    first : int
        Its first vertex in the scan.
    vertices : (k, 3) float64
        In its own coordinates.
    matrix : (4, 4) float64
        From its own coordinates to those of the scene, for column vectors.
    """

    first: int
    vertices: Vertices
    matrix: FloatArray

    @property
    def is_mirrored(self) -> bool:
        """Whether the transform turns triangles inside out."""
        with np.errstate(all="ignore"):  # the sign of a determinant whose value may overflow
            return bool(np.linalg.slogdet(self.matrix[:3, :3]).sign < 0)


@dataclass(frozen=True)
class PartFill:
    """What a fill adds to one part.

    Attributes
    ----------
    part : int
        Number of the part.
    vertex : (k,) int64
        Vertices that the triangles use, numbered as in the scan followed by the fill.
    positions : (k, 3) float64
        The same in the part's coordinates.
    triangles : (l, 3) int64
        Into `vertex`, turned as the part's own triangles are.
    rows : (l,) int64
        Which triangles of the fill these are.
    """

    part: int
    vertex: IntArray
    positions: Vertices
    triangles: Triangles
    rows: IntArray


def place(vertices: Vertices, matrix: FloatArray) -> Vertices:
    """Move vertices (k, 3) by a transform (4, 4); the identity leaves their bits alone."""
    if (matrix == np.eye(4)).all():
        return vertices
    with np.errstate(over="ignore", invalid="ignore"):  # what overflows is refused as not finite
        return np.asarray(vertices @ matrix[:3, :3].T + matrix[:3, 3])


def split_by_part(scan: Scan, fill: Fill, parts: list[Part]) -> list[PartFill]:
    """Divide a fill among the parts of a scene, hole by hole.

    Parameters
    ----------
    scan : Scan
    fill : Fill
    parts : list of Part
        In the order of their vertices in the scan.

    Returns
    -------
    list of PartFill
        One for each part that gets something.
    """
    firsts = np.array([part.first for part in parts])
    rim = fill.triangles.ravel()
    hole = np.repeat(fill.triangle_hole_id, 3)
    is_measured = rim < len(scan.vertices)
    holes, number = np.unique(hole, return_inverse=True)
    votes = np.zeros((len(holes), len(parts)), dtype=np.int64)
    owner = np.searchsorted(firsts, rim[is_measured], side="right") - 1
    np.add.at(votes, (number.reshape(-1)[is_measured], owner), 1)
    usable = np.array([is_invertible(part.matrix) for part in parts])
    # A part that a transform flattens has no way back: its fills go to another one.
    part_of_hole = np.argmax(np.where(usable, votes, -1), axis=1)
    part_of_row = part_of_hole[number.reshape(-1, 3)[:, 0]]
    joined = joined_vertices(scan, fill)
    return [_fill_of(i, parts[i], fill, joined, part_of_row == i) for i in np.unique(part_of_row).tolist()]


def is_invertible(matrix: FloatArray) -> bool:
    """Whether a transform keeps all three dimensions, to float64's accuracy."""
    with np.errstate(all="ignore"):
        return bool(np.linalg.cond(matrix[:3, :3]) < _FLATTEST)


def _fill_of(number: int, part: Part, fill: Fill, joined: Vertices, chosen: BoolArray) -> PartFill:
    vertex, corners = np.unique(fill.triangles[chosen], return_inverse=True)
    triangles = corners.reshape(-1, 3)
    if part.is_mirrored:
        triangles = triangles[:, [0, 2, 1]]
    inverse: FloatArray = np.eye(4)
    if is_invertible(part.matrix):
        inverse = np.linalg.inv(part.matrix).astype(np.float64)
    positions = place(joined[vertex], inverse).copy()
    own = (vertex >= part.first) & (vertex < part.first + len(part.vertices))
    positions[own] = part.vertices[vertex[own] - part.first]
    return PartFill(number, vertex, positions, triangles, np.flatnonzero(chosen))


@dataclass(frozen=True)
class MovedPart:
    """One part with its vertices at other positions.

    Attributes
    ----------
    part : Part
        As it was.
    positions : (k, 3) float64
        In the part's coordinates; the part's own numbers for vertices that stay.
    is_moved : (k,) bool
    is_used : (k,) bool
        Vertices that a triangle of the scan names, or that moved: whose positions matter.
    rounding : float
        How far the way to the scene and back may have shifted positions, in the part's coordinates.
    """

    part: Part
    positions: Vertices
    is_moved: BoolArray
    is_used: BoolArray
    rounding: float = 0.0


def moved_parts(parts: list[Part], scan: Scan, moved: Moved) -> Iterator[MovedPart]:
    """Take the vertices of every part back into its own coordinates, part by part.

    Parameters
    ----------
    parts : list of Part
    scan : Scan
    moved : Moved

    Raises
    ------
    StageError
        If a transform flattens a part that moved, so that there is no way back.
    """
    is_moved, is_used = moved.is_moved(scan), used_vertices(scan, moved)
    for part in parts:
        rows = slice(part.first, part.first + len(part.vertices))
        positions, rounding = part.vertices, 0.0
        if is_moved[rows].any():
            if not is_invertible(part.matrix):
                raise StageError("a transform flattens a part of the scene, whose vertices moved")
            is_plain = bool((part.matrix == np.eye(4)).all())
            inverse: FloatArray = part.matrix if is_plain else np.asarray(np.linalg.inv(part.matrix), np.float64)
            positions = np.where(is_moved[rows, np.newaxis], place(moved.vertices[rows], inverse), positions)
            largest = float(np.nanmax(np.abs(moved.vertices[rows])))
            rounding = _STEPS * np.finfo(np.float64).eps * largest * float(np.abs(inverse).max())
        yield MovedPart(part, positions, is_moved[rows], is_used[rows], rounding)


def used_vertices(scan: Scan, moved: Moved) -> BoolArray:
    """Find the vertices that a triangle names or that moved, (n,) bool: whose positions matter."""
    is_used = moved.is_moved(scan)
    is_used[scan.triangles] = True
    return is_used

"""Scenes: meshes placed by transforms, read as one mesh, and fills put back into the part they belong to.

The analysis sees all parts in the coordinates of the scene. A fill goes back into the coordinates of the part that
has most of its hole's rim, so that the rim's vertices are the part's own numbers again, bit for bit.
"""

from dataclasses import dataclass

import numpy as np

from quadpatch.formats.attributes import joined_vertices
from quadpatch.formats.scan import Fill, Scan
from quadpatch.types import BoolArray, FloatArray, IntArray, Triangles, Vertices

# Condition number beyond which a transform counts as flat.
_FLATTEST = 1e12


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

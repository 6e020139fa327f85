"""Makes the promise of a file true: no sample of either surface farther from the other than the promised error.

What the codes miss is corrected from the cheapest to the dearest. Grid vertices are moved along their normals. Cells
that lie where there is no surface are left out, and the border vertices of the rest are moved onto the border of the
mesh. Triangles of the mesh that are still too far from all that go into the file themselves: folds, thin walls,
whatever the quads do not cover.

Tested in `tests/quadpatch/compression/test_encode.py`.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import cKDTree

from quadpatch.compression.connectivity import encode_polygons
from quadpatch.compression.content import Pieces, QpzContent
from quadpatch.compression.decoded_surface import (
    CORRECTION_STEP,
    MOVE_STEP,
    PIECE_STEP,
    border_vertices,
    decode_surface,
)
from quadpatch.compression.heights import Grid
from quadpatch.compression.lattice import to_lattice
from quadpatch.compression.proof import Samples, deviation, sample
from quadpatch.compression.sparse_codes import decoded_heights
from quadpatch.mesh.boundary import boundary_edges
from quadpatch.mesh.distance import distance_to_mesh
from quadpatch.types import BoolArray, FloatArray, IntArray, TriangleMesh, Vertices

# Heights that are off by more than this part of the promised error are corrected at once; others where samples ask.
_CORRECTED_FROM = 0.85
_CORRECTION_ROUNDS = 2
# Border vertices are moved by at most so many mean edges of the grid.
_LONGEST_MOVE = 2.0
_REMOVAL_ROUNDS = 3
# A border vertex that is farther from the surface than this part of the promised error lies beyond its border.
_BEYOND = 0.8
# Steps between points of the mesh's border, in parts of the promised error; and at most so many points.
_BORDER_SPACING = 0.3
_MOST_BORDER_POINTS = 200_000


@dataclass(frozen=True)
class Target:
    """What a file has to give back.

    Attributes
    ----------
    surface : TriangleMesh
    samples : Samples
        Of that surface.
    spacing : float
        Wanted spacing of samples, for the decoded surface as well.
    grid : Grid
    heights, known : (n,) float64, (n,) bool
        Of the grid.
    """

    surface: TriangleMesh
    samples: Samples
    spacing: float
    grid: Grid
    heights: FloatArray
    known: BoolArray


def guaranteed(content: QpzContent, atoms: FloatArray, target: Target) -> QpzContent:
    """Add corrections, omissions, moves and pieces until the promise holds."""
    content = _corrected(content, atoms, target)
    content = _trimmed(content, atoms, target)
    decoded = decode_surface(content, atoms, target.grid)
    found = deviation(target.samples, decoded.mesh)
    missed = np.unique(found.samples.triangle[found.distance > content.lengths.max_error])
    return replace(content, pieces=make_pieces(target.surface, missed, content))


def make_pieces(surface: TriangleMesh, triangles: IntArray, content: QpzContent) -> Pieces:
    """Put some triangles of a surface into the form of a file."""
    walk, _, vertex = encode_polygons(surface.triangles[triangles])
    step = PIECE_STEP * content.lengths.max_error
    return Pieces(walk, to_lattice(surface.vertices[vertex], np.array(content.lengths.origin), step))


def first_corrections(content: QpzContent, atoms: FloatArray, target: Target) -> tuple[QpzContent, IntArray]:
    """Correct the heights of grid vertices that are far off.

    Returns
    -------
    content : QpzContent
    steps : (n,) int64
        The correction that every grid vertex would take.
    """
    missing = target.heights - decoded_heights(target.grid, content.codes, atoms, content.lengths.code_step)
    missing[~target.known] = 0.0
    steps = np.rint(missing / (CORRECTION_STEP * content.lengths.max_error)).astype(np.int64)
    where = np.flatnonzero((np.abs(missing) > _CORRECTED_FROM * content.lengths.max_error) & (steps != 0))
    return replace(content, corrected=where, corrections=steps[where]), steps


def _corrected(content: QpzContent, atoms: FloatArray, target: Target) -> QpzContent:
    """Correct the heights of grid vertices that are far off, then those around samples that are too far away."""
    limit = content.lengths.max_error
    content, steps = first_corrections(content, atoms, target)
    asked: BoolArray = np.zeros(len(steps), np.bool_)
    asked[content.corrected] = True
    for _ in range(_CORRECTION_ROUNDS):
        where = np.flatnonzero(asked & (steps != 0))
        content = replace(content, corrected=where, corrections=steps[where])
        # No cell has been left out yet, so triangles of the mesh are those of the grid.
        mesh = decode_surface(content, atoms, target.grid).mesh
        forward = deviation(target.samples, mesh)
        backward = deviation(sample(mesh, target.spacing), target.surface)
        far = [forward.nearest[forward.distance > limit], backward.samples.triangle[backward.distance > limit]]
        corners = target.grid.triangles[np.unique(np.concatenate(far))]
        if asked[corners].all():
            break
        asked[corners] = True
    where = np.flatnonzero(asked & (steps != 0))
    return replace(content, corrected=where, corrections=steps[where])


def _trimmed(content: QpzContent, atoms: FloatArray, target: Target) -> QpzContent:
    """Move borders onto the surface's border, and leave out the cells that are too far from the surface."""
    border = _border_points(target.surface, _BORDER_SPACING * content.lengths.max_error)
    moves = np.zeros((len(target.grid.points), 3), np.int64)
    for round_number in range(_REMOVAL_ROUNDS):
        # The last round moves nothing, so that no cell changes any more after it was looked at.
        if round_number < _REMOVAL_ROUNDS - 1 and len(border):
            is_moved = moves.any(axis=1, keepdims=True)
            moves = np.where(is_moved, moves, _moves(content, atoms, target, border))
        content = _with_removed(_with_moves(content, target.grid, moves), atoms, target, moves)
    return content


def _with_removed(content: QpzContent, atoms: FloatArray, target: Target, moves: IntArray) -> QpzContent:
    """Leave out the cells that have a sample too far from the surface."""
    decoded = decode_surface(content, atoms, target.grid)
    found = deviation(sample(decoded.mesh, target.spacing), target.surface)
    far = found.samples.triangle[found.distance > content.lengths.max_error]
    # A vertex stands for all triangles that it belongs to.
    corner_is_far: BoolArray = np.zeros(len(decoded.mesh.vertices), np.bool_)
    n_vertices = found.samples.n_vertices
    corner_is_far[np.unique(decoded.mesh.triangles)[found.distance[:n_vertices] > content.lengths.max_error]] = True
    is_far: BoolArray = np.asarray(corner_is_far[decoded.mesh.triangles].any(axis=1))
    is_far[far] = True
    remaining = np.setdiff1d(np.arange(len(target.grid.triangles) // 2), content.removed)
    removed = np.union1d(content.removed, remaining[np.flatnonzero(is_far) // 2])
    return _with_moves(replace(content, removed=removed), target.grid, moves)


def _with_moves(content: QpzContent, grid: Grid, moves: IntArray) -> QpzContent:
    if not moves.any():
        return replace(content, border_moves=np.zeros((0, 3), np.int64))
    return replace(content, border_moves=moves[border_vertices(_remaining(content, grid), len(grid.points))])


def _remaining(content: QpzContent, grid: Grid) -> IntArray:
    remains: BoolArray = np.ones(len(grid.triangles) // 2, np.bool_)
    remains[content.removed] = False
    return grid.triangles[np.repeat(remains, 2)]


def _moves(content: QpzContent, atoms: FloatArray, target: Target, border: Vertices) -> IntArray:
    """Find steps (n_grid, 3) onto the surface's border.

    Moved are border vertices that lie beyond it, and those that points too far from the grid are nearest to.
    """
    decoded = decode_surface(content, atoms, target.grid)
    triangles = _remaining(content, target.grid)
    moves = np.zeros((len(decoded.vertices), 3), np.int64)
    where: IntArray = border_vertices(triangles, len(decoded.vertices))
    if not len(where):
        return moves
    limit = content.lengths.max_error
    found = deviation(target.samples, decoded.mesh)
    is_near_far_points: BoolArray = np.zeros(len(moves), np.bool_)
    is_near_far_points[triangles[np.unique(found.nearest[found.distance > limit])]] = True
    is_beyond = distance_to_mesh(decoded.vertices[where], target.surface) > _BEYOND * limit
    where = where[is_beyond | is_near_far_points[where]]
    edge = np.linalg.norm(decoded.vertices[triangles[:, 0]] - decoded.vertices[triangles[:, 1]], axis=1).mean()
    found_distance, found_nearest = cKDTree(border).query(decoded.vertices[where])
    nearest: IntArray = np.asarray(found_nearest, np.int64)
    near = np.flatnonzero(np.asarray(found_distance) < _LONGEST_MOVE * edge)
    way = border[nearest[near]] - decoded.vertices[where[near]]
    moves[where[near]] = np.rint(way / (MOVE_STEP * limit)).astype(np.int64)
    return moves


def _border_points(surface: TriangleMesh, spacing: float) -> Vertices:
    """Points along the border of a surface."""
    edges = boundary_edges(surface.triangles)
    start, end = surface.vertices[edges[:, 0]], surface.vertices[edges[:, 1]]
    if not len(start):
        return np.zeros((0, 3))
    length = np.linalg.norm(end - start, axis=1)
    parts = np.clip(np.ceil(length / spacing), 1, max(1, _MOST_BORDER_POINTS // len(start))).astype(np.int64)
    owner = np.repeat(np.arange(len(start)), parts)
    share = (np.arange(len(owner)) - np.repeat(np.cumsum(parts) - parts, parts)) / parts[owner]
    return np.asarray(start[owner] + share[:, np.newaxis] * (end - start)[owner])

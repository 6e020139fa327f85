"""Fills whose vertices are moved, save where that brings in folds or crossings."""

from dataclasses import dataclass

import numpy as np

from quadpatch.filling.faults import Faults, find_faults
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.mesh.smoothing import neighbour_average
from quadpatch.processes import ProcessPool
from quadpatch.types import BoolArray, FloatArray, IntArray, Triangles, Vertices

# Rounds of relaxing; a fold is gone after three, or does not go.
_MOST_ROUNDS = 10


@dataclass(frozen=True)
class DisplacedFill:
    """A fill whose vertices were moved.

    Attributes
    ----------
    filled : FilledMesh
    faults : Faults
        Those that are left.
    undone : (n_loops,) bool
        Loops whose fill is as it was.
    """

    filled: FilledMesh
    faults: Faults
    undone: BoolArray


def displace_without_faults(
    filled: FilledMesh,
    displacement: FloatArray,
    wanted: BoolArray,
    before: Faults,
    obstacles: Triangles | None,
    pool: ProcessPool | None = None,
) -> DisplacedFill:
    """Move new vertices, and take that back in loops where it brought in folds or crossings.

    Parameters
    ----------
    filled : FilledMesh
    displacement : (n_invented_vertices, 3) float64
        In mesh units.
    wanted : (n_loops,) bool
        Loops whose vertices are to be moved.
    before : Faults
        Of the fill as it is.
    obstacles : (k, 3) int64, optional
        Triangles of the file that the mesh leaves out.
    pool : ProcessPool, optional
        Its processes look for crossings.
    """
    undone = np.zeros(len(wanted), bool)
    while True:
        moved = wanted & ~undone
        displaced = filled.displaced(np.where(moved[filled.vertex_hole][:, None], displacement, 0.0))
        faults = find_faults(displaced, obstacles=obstacles, pool=pool)
        worse = moved & (faults.severity > before.severity)
        if not worse.any():
            return DisplacedFill(displaced, faults, undone)
        # Taking one hole back may make it cross the displaced fill of another.
        undone |= worse


def relax_faults(filled: FilledMesh, wanted: BoolArray, obstacles: Triangles | None) -> FilledMesh:
    """Move the vertices of new triangles that fold or cross to the means of those around them, a few times.

    Parameters
    ----------
    filled : FilledMesh
    wanted : (n_loops,) bool
        Loops whose vertices may be moved.
    obstacles : (k, 3) int64, optional
        Triangles of the file that the mesh leaves out.
    """
    looked_at = np.flatnonzero(wanted)
    for _ in range(_MOST_ROUNDS):
        faults = find_faults(filled, looked_at, obstacles)
        corners = np.unique(filled.mesh.triangles[faults.doubtful_triangles])
        movable = corners[corners >= filled.n_measured_vertices] - filled.n_measured_vertices
        movable = movable[wanted[filled.vertex_hole[movable]]]
        if not len(movable):
            break
        filled = filled.with_vertices(_relaxed(filled, movable))
        looked_at = np.unique(filled.vertex_hole[movable])
    return filled


def _relaxed(filled: FilledMesh, movable: IntArray) -> Vertices:
    """Move some new vertices (k,) to the means of those around them: all new ones (n, 3)."""
    new = filled.mesh.triangles[filled.n_measured_triangles :]
    average = neighbour_average(new, len(filled.mesh.vertices))[movable + filled.n_measured_vertices]
    vertices = filled.mesh.vertices[filled.n_measured_vertices :].copy()
    vertices[movable] = np.asarray(average @ filled.mesh.vertices)
    return vertices

"""Fills that are checked for folds and crossings.

The fill that suits the surface best is tried first. Where it folds over or runs through other surface, plainer ones
follow; where none of them holds, the loop stays open, and it is said why.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from quadpatch.filling.constrained_fill import fill_constrained
from quadpatch.filling.creases import crease_displacement
from quadpatch.filling.displaced_fill import displace_without_faults, relax_faults
from quadpatch.filling.doubling import doubles_surface
from quadpatch.filling.fairing import THIN_PLATE
from quadpatch.filling.faults import Faults, find_faults
from quadpatch.filling.fill import close_holes, fair_holes
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.filling.flat_cap import flat_caps
from quadpatch.filling.rim_relief import relieve_rims
from quadpatch.mesh.averages import mean_by
from quadpatch.mesh.distance import distance_to_mesh
from quadpatch.mesh.normals import length
from quadpatch.processes import ProcessPool
from quadpatch.types import BoolArray, FloatArray, IntArray, TriangleMesh, Triangles

# How loops of a mesh may be filled: (mesh, loops) -> filled mesh.
FillFunction = Callable[[TriangleMesh, list[IntArray]], FilledMesh]


# How some of them may be filled again: (filled mesh, all loops, positions of some, obstacles) -> mesh with their fills.
RefillFunction = Callable[[FilledMesh, list[IntArray], IntArray, Triangles | None], FilledMesh]


def _fill_by_thin_plate(
    filled: FilledMesh, loops: list[IntArray], chosen: IntArray, obstacles: Triangles | None
) -> FilledMesh:
    return fair_holes(close_holes(filled.measured, [loops[i] for i in chosen]), THIN_PLATE).as_part_of(chosen, filled)


_DOUBLED = ("doubles_surface", "a fill would lie on the back of the very surface whose border it closes")

# What a fill is called: of the energies that suit the surface, and of the same with creases.
_FAIRED = "energies"
CREASED = "creases"
# From the smoothest to the plainest.
PLAINER_FILLS: dict[str, RefillFunction] = {"thin_plate": _fill_by_thin_plate, "constrained": fill_constrained}


@dataclass(frozen=True)
class CheckedFill:
    """A fill without folds and crossings.

    Attributes
    ----------
    filled : FilledMesh
    faults : Faults
        What is left: folds that the measured surface asks for, and those of slivers.
    fill : list of str
        How each loop was filled: `energies`, `creases`, `flat` (a plane patch), or one of `PLAINER_FILLS`.
    departure : (n_loops,) float64
        Mean distance of the fill from the one that was tried first, in mesh units; 0 where that one holds.
    refused : dict of int to (str, str)
        Loops that stay open, by position: a stable code, and a sentence for people.
    """

    filled: FilledMesh
    faults: Faults
    fill: list[str]
    departure: FloatArray
    refused: dict[int, tuple[str, str]]


@dataclass(frozen=True)
class LoopsToFill:
    """Loops to be filled.

    Attributes
    ----------
    loops : list of (n_loop,) int64
        As `boundary_loops` gives them.
    flat : (n_loops,) bool
        Those that get a plane patch and nothing else.
    border : (n_loops,) bool
        Outer borders of pieces: their fills may double the piece.
    """

    loops: list[IntArray]
    flat: BoolArray
    border: BoolArray

    @property
    def curved(self) -> list[IntArray]:
        """Those that get no plane patch."""
        return [self.loops[i] for i in np.flatnonzero(~self.flat)]


def fill_checked(
    mesh: TriangleMesh,
    wanted: LoopsToFill,
    fill: FillFunction,
    obstacles: Triangles | None = None,
    pool: ProcessPool | None = None,
) -> CheckedFill:
    """Fill loops, look for faults, and fill those that have any in plainer ways.

    Parameters
    ----------
    mesh : TriangleMesh
    wanted : LoopsToFill
    fill : callable
        What is tried first, save where a plane patch is asked for.
    obstacles : (k, 3) int64, optional
        Triangles of the file that the mesh leaves out.
    pool : ProcessPool, optional
        Its processes look for crossings.
    """
    loops, flat = wanted.loops, wanted.flat
    first = _first_fill(mesh, wanted, fill)
    doubled = np.flatnonzero(doubles_surface(first, np.flatnonzero(wanted.border)))
    filled = first.without(doubled) if len(doubled) else first
    faults = find_faults(filled, obstacles=obstacles, pool=pool)
    names = np.where(flat, "flat", _FAIRED).tolist()
    for name, plainer in PLAINER_FILLS.items():
        doubtful = np.flatnonzero(faults.is_doubtful & ~flat)
        if not len(doubtful):
            break
        other = plainer(filled, loops, doubtful, obstacles)
        tried = find_faults(filled.with_fills(other, doubtful), doubtful, obstacles)
        # A fill that is wrong as well would be refused: then the first one says better what is in the way.
        is_better = (tried.severity < faults.severity) & ~tried.is_wrong
        better = np.setdiff1d(doubtful[is_better[doubtful]], other.unfilled)
        if len(better):
            filled = filled.with_fills(other, better)
            faults = find_faults(filled, obstacles=obstacles, pool=pool)
        for i in better.tolist():
            names[i] = name
    kept, refused = _without_wrong(filled, faults)
    relieved = relieve_rims(kept)
    if relieved is not filled:
        faults = find_faults(relieved, obstacles=obstacles, pool=pool)
    refused |= dict.fromkeys(doubled.tolist(), _DOUBLED)
    replaced = np.array([i for i, name in enumerate(names) if name in PLAINER_FILLS and i not in refused], np.int64)
    return CheckedFill(relieved, faults, names, _departure(relieved, first, replaced), refused)


def with_creases(
    checked: CheckedFill, share: float, obstacles: Triangles | None = None, pool: ProcessPool | None = None
) -> CheckedFill:
    """Give faired fills creases, save where these would fold or cross other surface.

    Parameters
    ----------
    checked : CheckedFill
    share : float
        Of the way to the creases, 0 to 1.
    obstacles : (k, 3) int64, optional
        Triangles of the file that the mesh leaves out.
    pool : ProcessPool, optional
        Its processes look for crossings.
    """
    wanted = np.array([name == _FAIRED and i not in checked.refused for i, name in enumerate(checked.fill)], bool)
    if not share or not wanted.any():
        return checked
    filled = checked.filled
    way = np.where(wanted[filled.vertex_hole][:, None], share * crease_displacement(filled), 0.0)
    relaxed = relax_faults(filled.displaced(way), wanted, obstacles)
    way = relaxed.mesh.vertices[filled.n_measured_vertices :] - filled.mesh.vertices[filled.n_measured_vertices :]
    creased = displace_without_faults(filled, way, wanted, checked.faults, obstacles, pool)
    names = np.where(wanted & ~creased.undone, CREASED, checked.fill).tolist()
    missing = mean_by(filled.vertex_hole, length(way), len(wanted))
    departure = np.where(creased.undone, missing, checked.departure)
    return replace(checked, filled=creased.filled, faults=creased.faults, fill=names, departure=departure)


def _first_fill(mesh: TriangleMesh, wanted: LoopsToFill, fill: FillFunction) -> FilledMesh:
    loops, curved, plane = wanted.loops, np.flatnonzero(~wanted.flat), np.flatnonzero(wanted.flat)
    faired = fill(mesh, wanted.curved)
    if not len(plane):
        return faired
    # A plane patch has no error to be guessed: it is where it was asked for.
    disagreement, rim_variation = np.zeros(len(loops)), np.zeros(len(loops))
    disagreement[curved], rim_variation[curved] = faired.disagreement, faired.rim_variation
    whole = replace(faired.as_part_of(curved, faired), disagreement=disagreement, rim_variation=rim_variation)
    if faired.energy_weights is not None:
        weights = np.zeros((len(loops), faired.energy_weights.shape[1]))
        weights[curved] = faired.energy_weights
        whole = replace(whole, energy_weights=weights)
    caps = flat_caps(mesh, [[loops[i]] for i in plane])
    return whole.with_fills(caps.as_part_of(plane, whole), plane)


def _departure(filled: FilledMesh, first: FilledMesh, loops: IntArray) -> FloatArray:
    """Mean distance (n_loops,) of the fills of some loops from the first ones; 0 for the others.

    It is that of the new vertices, or of the triangles' centroids where there are none.
    """
    vertices = filled.mesh.vertices
    bare = np.setdiff1d(loops, filled.vertex_hole)
    of_vertex, of_triangle = np.isin(filled.vertex_hole, loops), np.isin(filled.triangle_hole, bare)
    centroids = vertices[filled.mesh.triangles[filled.n_measured_triangles :][of_triangle]].mean(axis=1)
    points = np.concatenate([vertices[filled.n_measured_vertices :][of_vertex], centroids])
    hole = np.concatenate([filled.vertex_hole[of_vertex], filled.triangle_hole[of_triangle]])
    surface = first.mesh.triangles[first.n_measured_triangles :][np.isin(first.triangle_hole, loops)]
    if not len(points) or not len(surface):
        return np.zeros(len(filled.disagreement))
    distance = distance_to_mesh(points, TriangleMesh(first.mesh.vertices, surface))
    return mean_by(hole, distance, len(filled.disagreement))


def _without_wrong(filled: FilledMesh, faults: Faults) -> tuple[FilledMesh, dict[int, tuple[str, str]]]:
    """Open the loops again whose fills are wrong."""
    opened = _to_open(faults)
    refused = {i: _reason(int(faults.crossings[i])) for i in opened.tolist()}
    return filled.without(opened) if refused else filled, refused


def _to_open(faults: Faults) -> IntArray:
    """Choose loops (k,) to open: those that are wrong by themselves, and those that cross most others, until none do.

    One fill that runs through all others, such as that of an outer border, costs none of those.
    """
    opened = faults.is_wrong_alone.copy()
    crossing_fills, n_loops = faults.crossing_fills, len(faults.crossings)
    while True:
        crossing_fills = crossing_fills[~opened[crossing_fills].any(axis=1)]
        if not len(crossing_fills):
            return np.flatnonzero(opened)
        n_crossing_fills = np.bincount(crossing_fills.ravel(), minlength=n_loops)
        opened[np.lexsort((-faults.crossings, -n_crossing_fills))[0]] = True


def _reason(n_crossings: int) -> tuple[str, str]:
    if n_crossings:
        return "crosses_surface", "every fill that was tried runs through other surface"
    return "folds_over", "every fill that was tried folds over itself"

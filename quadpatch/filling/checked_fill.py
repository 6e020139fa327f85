"""Fills that are checked before they are believed.

The fill that suits the surface best is tried first. Where it folds over or runs through other surface, plainer ones
follow; where none of them holds, the loop stays open, and it is said why.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from quadpatch.filling.fairing import MEMBRANE, THIN_PLATE, Energy
from quadpatch.filling.faults import Faults, find_faults
from quadpatch.filling.fill import close_flat, close_holes, fair_holes
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.filling.rim_relief import relieve_rims
from quadpatch.mesh.averages import mean_by
from quadpatch.mesh.distance import distance_to_mesh
from quadpatch.types import FloatArray, IntArray, TriangleMesh, Triangles

# How loops of a mesh may be filled: (mesh, loops) -> filled mesh.
Fill = Callable[[TriangleMesh, list[IntArray]], FilledMesh]


def _faired_by(energy: Energy) -> Fill:
    return lambda mesh, loops: fair_holes(close_holes(mesh, loops), energy)


# From the smoothest to the plainest.
PLAINER_FILLS: dict[str, Fill] = {
    "thin_plate": _faired_by(THIN_PLATE),
    "membrane": _faired_by(MEMBRANE),
    "flat": close_flat,
}


@dataclass(frozen=True)
class CheckedFill:
    """A fill without folds and crossings.

    Attributes
    ----------
    filled : FilledMesh
    faults : Faults
        What is left: folds that the measured surface asks for, and those of slivers.
    fill : list of str
        How each loop was filled: `energies` or one of `PLAINER_FILLS`.
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


def fill_checked(
    mesh: TriangleMesh, loops: list[IntArray], fill: Fill, obstacles: Triangles | None = None
) -> CheckedFill:
    """Fill loops, look for faults, and fill those that have any in plainer ways.

    Parameters
    ----------
    mesh : TriangleMesh
    loops : list of (n_loop,) int64
        As `boundary_loops` gives them.
    fill : callable
        What is tried first.
    obstacles : (k, 3) int64, optional
        Triangles of the file that the mesh leaves out.
    """
    first = filled = fill(mesh, loops)
    faults = find_faults(filled, obstacles=obstacles)
    names = ["energies"] * len(loops)
    for name, plainer in PLAINER_FILLS.items():
        doubtful = np.flatnonzero(faults.is_doubtful)
        if not len(doubtful):
            break
        other = plainer(mesh, [loops[i] for i in doubtful]).as_part_of(doubtful, filled)
        tried = find_faults(filled.with_fills(other, doubtful), obstacles=obstacles)
        better = doubtful[tried.severity[doubtful] < faults.severity[doubtful]]
        filled = filled.with_fills(other, better)
        faults = find_faults(filled, obstacles=obstacles)
        for i in better.tolist():
            names[i] = name
    filled, refused = _without_wrong(filled, obstacles)
    filled = relieve_rims(filled)
    replaced = np.array([i for i, name in enumerate(names) if name != "energies" and i not in refused], np.int64)
    departure = _departure(filled, first, replaced)
    return CheckedFill(filled, find_faults(filled, obstacles=obstacles), names, departure, refused)


def _departure(filled: FilledMesh, first: FilledMesh, loops: IntArray) -> FloatArray:
    """Mean distance (n_loops,) of the new vertices of some loops from their first fill; 0 for the others."""
    looked_at = np.isin(filled.vertex_hole, loops)
    points = filled.mesh.vertices[filled.n_measured_vertices :][looked_at]
    surface = first.mesh.triangles[first.n_measured_triangles :][np.isin(first.triangle_hole, loops)]
    if not len(points) or not len(surface):
        return np.zeros(len(filled.gap))
    distance = distance_to_mesh(points, TriangleMesh(first.mesh.vertices, surface))
    return mean_by(filled.vertex_hole[looked_at], distance, len(filled.gap))


def _without_wrong(filled: FilledMesh, obstacles: Triangles | None) -> tuple[FilledMesh, dict[int, tuple[str, str]]]:
    """Open the loops again whose fills are wrong: the worst half first, since others may cross nothing but those."""
    refused: dict[int, tuple[str, str]] = {}
    looked_at = np.arange(len(filled.gap))
    while True:
        faults = find_faults(filled, looked_at, obstacles)
        wrong = np.flatnonzero(faults.is_wrong)
        if not len(wrong):
            return filled, refused
        worst = wrong[np.argsort(-faults.severity[wrong], kind="stable")][: -(-len(wrong) // 2)]
        filled = filled.without(worst)
        for i in worst.tolist():
            refused[i] = _reason(int(faults.crossings[i]), int(faults.n_folds[i]))
        looked_at = wrong


def _reason(n_crossings: int, n_folds: int) -> tuple[str, str]:
    if n_crossings:
        return "crosses_surface", f"every fill that was tried runs through other surface, by {n_crossings} triangles"
    return "folds_over", f"every fill that was tried folds over itself, at {n_folds} edges"

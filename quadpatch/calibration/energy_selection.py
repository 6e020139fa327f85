"""Which energy fills which hole: what calibration says of the whole surface, and what its own rim says of a hole.

Calibration ranks the energies on average. Which of them is best differs from hole to hole: a groove that runs into a
hole wants another than the flat beside it. So every hole is opened once more, one ring wider, and closed by each
energy: how far the vertices of its rim then lie from the fill says which energy carries on this very surface. The fills
of a hole are blended by weights that fall with the expected error, a product of both.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import cKDTree

from quadpatch.calibration.calibration_set import ROUNDING, CalibrationSet, choose_energy, error_per_hole
from quadpatch.calibration.synthetic_holes import new_loops
from quadpatch.filling.fairing import Energy, triangles_around
from quadpatch.filling.fill import ClosedMesh, close_holes, fair_holes
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.mesh.averages import mean_by
from quadpatch.mesh.distance import distance_to_mesh
from quadpatch.mesh.measures import used_vertices
from quadpatch.progress import Fraction, no_fraction
from quadpatch.types import FloatArray, IntArray, TriangleMesh

# Weights of fills fall with this power of their expected error: at 8, one that is 10 % worse counts half.
SHARPNESS = 8.0
# Smaller misses of a rim, in shares of the largest, are rounding.
_LEAST_MISS = 1e-6


@dataclass(frozen=True)
class EnergyBlend:
    """How to fill holes of one mesh.

    Attributes
    ----------
    energies : sequence of Energy
        One alone needs no weights.
    log_error : (n_energies,) float64
        Logarithm of each one's mean error on calibration holes.
    log_miss : (n_energies,) float64
        Logarithm of how far each one misses the rims of calibration holes on average, opened one ring wider.
    """

    energies: Sequence[Energy]
    log_error: FloatArray
    log_miss: FloatArray

    @classmethod
    def of_one(cls, energy: Energy) -> "EnergyBlend":
        """Fill every hole by the same energy."""
        return cls((energy,), np.zeros(1), np.zeros(1))

    def fill(self, mesh: TriangleMesh, loops: list[IntArray], reach: Fraction = no_fraction) -> FilledMesh:
        """Close boundary loops of a mesh, given as `boundary_loops` gives them; `reach` is told the done fraction."""
        closed = close_holes(mesh, loops)
        fills = _faired(closed, self.energies, reach)
        if len(fills) == 1 or not loops:
            return replace(fills[0], energy_weights=np.ones((len(loops), len(fills))))
        weights = self.weights(leave_one_ring_out(mesh, loops, self.energies, reach))
        return replace(_blended(fills, weights), energy_weights=weights)

    def weights(self, misses: FloatArray) -> FloatArray:
        """Turn misses (n_holes, n_energies), NaN where unknown, into weights of the fills: rows sum to 1."""
        largest = np.nanmax(misses, initial=0.0)
        log_miss = np.log(np.maximum(misses, _LEAST_MISS * largest + np.finfo(np.float64).tiny))
        own = log_miss - self.log_miss
        own = np.nan_to_num(own - own.mean(axis=1, keepdims=True))
        expected = self.log_error + own
        weights = np.exp(-SHARPNESS * (expected - expected.min(axis=1, keepdims=True)))
        return np.asarray(weights / weights.sum(axis=1, keepdims=True))


def learn_energy_blend(
    calibration: CalibrationSet, energies: Sequence[Energy], default: Energy, reach: Fraction = no_fraction
) -> tuple[EnergyBlend, FilledMesh]:
    """Learn from calibration holes how to fill: by one energy, as `choose_energy` picks it, unless weighing beats it.

    Parameters
    ----------
    calibration : CalibrationSet
    energies : sequence of Energy
    default : Energy
    reach : callable
        Told the done fraction.

    Returns
    -------
    EnergyBlend
    FilledMesh
        The calibration holes, filled by it.
    """
    fills = _faired(calibration.closed, energies, reach)
    errors = np.array([error_per_hole(calibration, fill) for fill in fills])
    misses = leave_one_ring_out(calibration.closed.mesh, calibration.loops, energies, reach)
    best = energies.index(choose_energy(errors, calibration.diameter, energies, default))
    typical = np.nanmean(misses, axis=0) if np.isfinite(misses).any() else np.ones(len(energies))
    tiny = np.finfo(np.float64).tiny
    blend = EnergyBlend(energies, np.log(errors.mean(axis=1) + tiny), np.log(typical + tiny))
    blended = _blended(fills, blend.weights(misses))
    gain = errors[best].mean() - error_per_hole(calibration, blended).mean()
    if gain > ROUNDING * calibration.diameter:
        return blend, blended
    return EnergyBlend.of_one(energies[best]), fills[best]


def _faired(closed: ClosedMesh, energies: Sequence[Energy], reach: Fraction) -> list[FilledMesh]:
    """Fair holes by each energy: the first half of the work."""
    fills = []
    for energy in energies:
        fills.append(fair_holes(closed, energy))
        reach(0.5 * len(fills) / len(energies))
    return fills


def leave_one_ring_out(
    mesh: TriangleMesh, loops: list[IntArray], energies: Sequence[Energy], reach: Fraction = no_fraction
) -> FloatArray:
    """Open holes one ring wider, close them by each energy, and measure how far it misses the vertices that were there.

    Parameters
    ----------
    mesh : TriangleMesh
        With the holes open.
    loops : list of (n_loop,) int64
    energies : sequence of Energy
    reach : callable
        Told the done fraction, from one half on.

    Returns
    -------
    (n_holes, n_energies) float64
        Mean distance, in mesh units; NaN for a hole that can't be opened wider without running into something else.
    """
    rim = np.concatenate(loops)
    hole = np.repeat(np.arange(len(loops)), [len(loop) for loop in loops])
    n_vertices = len(mesh.vertices)
    ring = np.zeros(len(mesh.triangles), bool)
    ring[triangles_around(mesh.triangles, rim, n_vertices, 1)] = True
    remaining = mesh.triangles[~ring]
    removed = np.flatnonzero(used_vertices(mesh.triangles, n_vertices) & ~used_vertices(remaining, n_vertices))
    rim_tree = cKDTree(mesh.vertices[rim])
    wider_loops = new_loops(mesh, remaining)
    closed = close_holes(TriangleMesh(mesh.vertices, remaining), wider_loops)
    opened = np.zeros(len(loops), bool)
    for number, loop in enumerate(wider_loops):
        if number not in closed.unfilled:
            opened[hole[rim_tree.query(mesh.vertices[loop])[1]]] = True
    hole_of_removed = hole[rim_tree.query(mesh.vertices[removed])[1]]
    misses = np.full((len(loops), len(energies)), np.nan)
    has_residual = np.zeros(len(loops), bool)
    has_residual[hole_of_removed] = True
    has_residual &= opened
    # A rim that is joined to an island opens into two loops, which say nothing about the ring between them.
    has_residual &= np.array([len(np.unique(loop)) == len(loop) for loop in loops])
    if has_residual.any():
        for number, energy in enumerate(energies):
            filled = fair_holes(closed, energy)
            new = TriangleMesh(filled.mesh.vertices, filled.mesh.triangles[filled.n_measured_triangles :])
            distance = distance_to_mesh(mesh.vertices[removed], new)
            misses[has_residual, number] = mean_by(hole_of_removed, distance, len(loops))[has_residual]
            reach(0.5 + 0.5 * (number + 1) / len(energies))
    return misses


def _blended(fills: list[FilledMesh], weights: FloatArray) -> FilledMesh:
    invented = np.stack([fill.mesh.vertices[fill.n_measured_vertices :] for fill in fills], axis=1)
    of_vertex = weights[fills[0].vertex_hole]
    return fills[0].with_vertices(np.einsum("vek,ve->vk", invented, of_vertex))

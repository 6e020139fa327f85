"""Which energy fills which hole: what calibration says of the whole surface, and what its own rim says of a hole.

Calibration ranks the energies on average. Which of them is best differs from hole to hole: a groove that runs into a
hole wants another than the flat beside it. So every hole is opened once more, one ring wider, and closed by each
energy: how far the vertices of its rim then lie from the fill says which energy carries on this very surface. The fills
of a hole are blended by weights that fall with the expected error, a product of both.
"""

from collections.abc import Sequence
from concurrent.futures import Future
from dataclasses import dataclass, replace
from math import erfc, sqrt

import numpy as np

from quadpatch.calibration.calibration_set import ROUNDING, CalibrationSet, choose_energy, error_per_hole
from quadpatch.filling.fairing import Energy
from quadpatch.filling.fill import ClosedMesh, close_holes, fair_by_each, fair_holes
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.filling.parts import surroundings
from quadpatch.filling.rim_residuals import rim_residuals
from quadpatch.mesh.loop_diameter import loop_diameter
from quadpatch.processes import ProcessPool
from quadpatch.progress import Fraction, no_fraction, part_of
from quadpatch.types import BoolArray, FloatArray, IntArray, TriangleMesh

# Weights of fills fall with this power of their expected error: at 8, one that is 10 % worse counts half.
SHARPNESS = 8.0
# An energy takes no part in a hole with less weight than this, and in no hole if its error is so many times the best.
_LEAST_WEIGHT = 0.01
_LOST = 2.0
# Weighing that loses by more than a standard error takes no part either.
_LEAST_BELIEF = 0.16
# A hole is as wide as calibration holes if it is at most this many times as wide.
AS_WIDE = 1.2
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
    best : int
        Position of the energy that is best for all holes alike.
    belief : float
        Probability that weighing by each hole's own rim is better than that one: 0 to 1.
    widest : float
        Holes wider than this, in mesh units, are filled without energies that have a slope: how much a fill has to
        bulge depends on its width, and calibration holes were narrower.
    """

    energies: Sequence[Energy]
    log_error: FloatArray
    log_miss: FloatArray
    best: int = 0
    belief: float = 1.0
    widest: float = 0.0

    @classmethod
    def of_one(cls, energy: Energy) -> "EnergyBlend":
        """Fill every hole by the same energy."""
        return cls((energy,), np.zeros(1), np.zeros(1))

    def fill(self, mesh: TriangleMesh, loops: list[IntArray], reach: Fraction = no_fraction) -> FilledMesh:
        """Close boundary loops of a mesh, given as `boundary_loops` gives them, and fair them as `fill_closed` does."""
        return self.fill_closed(close_holes(mesh, loops), loops, reach)

    def fill_closed(self, closed: ClosedMesh, loops: list[IntArray], reach: Fraction = no_fraction) -> FilledMesh:
        """Fair boundary loops that `close_holes` has closed; `reach` is told the done fraction."""
        if len(self.energies) == 1 or not loops:
            return replace(fair_holes(closed, self.energies[0]), energy_weights=np.ones((len(loops), 1)))
        is_wide = np.array([loop_diameter(closed.mesh.vertices[loop]) for loop in loops]) > self.widest
        misses = np.full((len(loops), len(self.energies)), np.nan)
        if self.belief:
            misses = rim_residuals(closed.coarse(), self.energies, part_of(reach, 0.0, 0.5))
        return self.fill_weighted(closed, self.weights(misses, is_wide), part_of(reach, 0.5, 1.0))

    def fill_weighted(self, closed: ClosedMesh, weights: FloatArray, reach: Fraction = no_fraction) -> FilledMesh:
        """Fair closed holes by weights (n_holes, n_energies) whose rows sum to 1."""
        weights = np.where(weights >= _LEAST_WEIGHT, weights, 0.0)
        weights /= weights.sum(axis=1, keepdims=True)
        used = np.flatnonzero(weights.any(axis=0)).tolist()
        fills = fair_by_each(closed, [self.energies[i] for i in used], weights[:, used], reach)
        return replace(_blended(fills, weights[:, used]), energy_weights=weights)

    def fair(self, closed: ClosedMesh, weights: FloatArray) -> FilledMesh:
        """Fair holes by weights (n_holes, n_energies), as `learn_energy_blend` does: the smallest count too."""
        fills = _faired(closed, self.energies, no_fraction)
        return replace(fills[0] if len(fills) == 1 else _blended(fills, weights), energy_weights=weights)

    def weights(self, misses: FloatArray, is_wide: BoolArray | None = None) -> FloatArray:
        """Turn misses (n_holes, n_energies), NaN where unknown, into weights of the fills: rows sum to 1.

        They are the mean of both ways to choose, by the belief in each: a few dozen holes often can't tell. Wide holes
        (n_holes,) are filled without energies that have a slope.
        """
        if is_wide is None:
            is_wide = np.zeros(len(misses), bool)
        largest = np.nanmax(misses, initial=0.0)
        log_miss = np.log(np.maximum(misses, _LEAST_MISS * largest + np.finfo(np.float64).tiny))
        own = log_miss - self.log_miss
        own = np.nan_to_num(own - own.mean(axis=1, keepdims=True))
        expected = np.where(is_wide[:, None] & ~_is_plain(self.energies), np.inf, self.log_error + own)
        weights = np.exp(-SHARPNESS * (expected - expected.min(axis=1, keepdims=True)))
        weights *= self.belief / weights.sum(axis=1, keepdims=True)
        best = np.where(is_wide, _best_plain(self.energies, self.log_error, self.best), self.best)
        weights[np.arange(len(weights)), best] += 1.0 - self.belief
        return np.asarray(weights)


def _is_plain(energies: Sequence[Energy]) -> BoolArray:
    """Tell the energies (n_energies,) without a slope of their own; there is one."""
    return np.array([energy.slope == 1.0 for energy in energies], bool)


def _best_plain(energies: Sequence[Energy], errors: FloatArray, best: int) -> int:
    """Find the one of these with the least error (n_energies,); the best of all energies where that is one of them."""
    is_plain = _is_plain(energies)
    return best if is_plain[best] else int(np.where(is_plain, errors, np.inf).argmin())


def learn_energy_blend(
    calibration: CalibrationSet,
    energies: Sequence[Energy],
    default: Energy,
    reach: Fraction = no_fraction,
    pool: ProcessPool | None = None,
) -> tuple[EnergyBlend, FilledMesh]:
    """Learn from calibration holes how to fill: by one energy, as `choose_energy` picks it, by weighing, or by both.

    Parameters
    ----------
    calibration : CalibrationSet
    energies : sequence of Energy
    default : Energy
    reach : callable
        Told the done fraction.
    pool : ProcessPool, optional
        A helper leaves one ring out while this process fills the holes.

    Returns
    -------
    EnergyBlend
    FilledMesh
        The calibration holes, filled by it as densely as those of `calibration` are.
    """
    residuals = _Residuals(calibration, energies, pool or ProcessPool())
    fills = _faired(calibration.closed, energies, part_of(reach, 0.0, 0.5))
    errors = np.array([error_per_hole(calibration, fill) for fill in fills])
    chosen = choose_energy(errors, calibration.diameter, energies, default)
    mean = errors.mean(axis=1)
    best = energies.index(chosen)
    wanted = {best, _best_plain(energies, mean, best)}
    kept = [i for i in range(len(energies)) if mean[i] <= _LOST * mean.min() or i in wanted]
    energies, fills, errors = [energies[i] for i in kept], [fills[i] for i in kept], errors[kept]
    misses = residuals.of(kept, part_of(reach, 0.5, 1.0))
    best = energies.index(chosen)
    typical = np.nanmean(misses, axis=0) if np.isfinite(misses).any() else np.ones(len(energies))
    tiny = np.finfo(np.float64).tiny
    blend = EnergyBlend(
        energies,
        np.log(errors.mean(axis=1) + tiny),
        np.log(typical + tiny),
        widest=float(AS_WIDE * calibration.diameter),
    )
    blended = _blended(fills, blend.weights(misses))
    gains = errors[best] - error_per_hole(calibration, blended)
    rounding = ROUNDING * calibration.diameter
    in_errors = float(gains.mean() / (gains.std() / np.sqrt(len(gains)) + rounding))
    belief = erfc(-in_errors / sqrt(2)) / 2
    blend = replace(blend, best=best, belief=belief)
    if belief < _LEAST_BELIEF or errors[best].mean() <= rounding:
        return _without_weighing(blend, fills)
    weights = blend.weights(misses)
    return blend, replace(_blended(fills, weights), energy_weights=weights)


class _Residuals:
    """What `rim_residuals` finds at calibration holes: a helper looks for it at once, by all energies.

    It is cheaper to wait until it is known which energies are worth it, and that is done where no helper has begun.
    """

    def __init__(self, calibration: CalibrationSet, energies: Sequence[Energy], pool: ProcessPool) -> None:
        self._calibration, self._energies = calibration, energies
        self._found: Future[FloatArray] | None = None
        if pool.is_shared:
            region, loops = surroundings(calibration.opened, calibration.loops)
            self._found = pool.submit(_rim_residuals_of, region.mesh, loops, energies)

    def of(self, chosen: list[int], reach: Fraction) -> FloatArray:
        """Give the residuals (n_holes, k) of some energies (k,)."""
        if self._found is not None and not self._found.cancel():
            return self._found.result()[:, chosen]
        energies = [self._energies[i] for i in chosen]
        return rim_residuals(self._calibration.closed, energies, reach)


def _without_weighing(blend: EnergyBlend, fills: list[FilledMesh]) -> tuple[EnergyBlend, FilledMesh]:
    """Fill all holes by the best energy, wide ones by the best without a slope."""
    best, plain = blend.best, _best_plain(blend.energies, blend.log_error, blend.best)
    n_holes = len(fills[best].disagreement)
    if best == plain:
        blend = EnergyBlend.of_one(blend.energies[best])
        return blend, replace(fills[best], energy_weights=np.ones((n_holes, 1)))
    both = [best, plain]
    two = [blend.energies[i] for i in both]
    blend = replace(blend, energies=two, log_error=blend.log_error[both], log_miss=blend.log_miss[both])
    filled = replace(fills[best], energy_weights=np.tile([1.0, 0.0], (n_holes, 1)))
    return replace(blend, best=0, belief=0.0), filled


def _faired(closed: ClosedMesh, energies: Sequence[Energy], reach: Fraction) -> list[FilledMesh]:
    """Fair holes by each energy alone."""
    fills = []
    for energy in energies:
        fills.append(fair_holes(closed, energy))
        reach(len(fills) / len(energies))
    return fills


def _rim_residuals_of(mesh: TriangleMesh, loops: list[IntArray], energies: Sequence[Energy]) -> FloatArray:
    """Find them in another process: closing the holes once more is cheaper than sending their equations."""
    return rim_residuals(close_holes(mesh, loops, graded=True), energies)


def _blended(fills: list[FilledMesh], weights: FloatArray) -> FilledMesh:
    invented = np.stack([fill.mesh.vertices[fill.n_measured_vertices :] for fill in fills], axis=1)
    of_vertex = weights[fills[0].vertex_hole]
    return fills[0].with_vertices(np.einsum("vek,ve->vk", invented, of_vertex))

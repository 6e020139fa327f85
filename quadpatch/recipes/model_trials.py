"""Trials of models on calibration holes, where the truth is known: which one fills the real holes, and how far.

Models that gain nothing on the first few holes are dropped: most scans want none, and are not to pay for the rest.

Tested in `tests/quadpatch/recipes/test_model_trials.py`.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from quadpatch.calibration.calibration_set import (
    ROUNDING,
    SHARES,
    CalibrationSet,
    choose_share,
    error_by_share,
    error_per_hole,
    expect,
    is_open,
)
from quadpatch.calibration.error_model import ErrorModel
from quadpatch.calibration.training_pairs import TrainingPairs, pairs_of
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.inpainters.competing import FittedCompetitors
from quadpatch.patches.layout import Sampled, seeds_near, take, together, unfolded
from quadpatch.patches.scale import PatchScale
from quadpatch.patches.seeds import Seeds
from quadpatch.processes import ProcessPool, Shared
from quadpatch.recipes.assessment import agreeing_holes, measure_agreement
from quadpatch.recipes.patch_surfaces import PatchSurface
from quadpatch.recipes.result import PatchAgreement, Trial
from quadpatch.reconstruction.displacement import displace, join_at_rim, rim_vertices
from quadpatch.types import BoolArray, FloatArray, Patches

# Calibration holes that every model is tried on, and what it must gain there, as a share of the error: half of what it
# must gain on all of them to be taken.
FIRST_HOLES = 8
_LEAST_FIRST_GAIN = 0.01
# Blend factor of a model where the mesh has no room for calibration.
PRIOR_BLEND_FACTOR = 0.0


@dataclass(frozen=True)
class Choice:
    """A model, and what calibration says of it.

    Attributes
    ----------
    model : FittedCompetitors
    blend_factor : float
    error_model : ErrorModel or None
        Of the calibration holes, completed by it; None without these.
    trials : sequence of Trial
        Of geometry alone, and of every model; empty without calibration.
    promising : sequence of str
        Names of the models that were not dropped after the first holes.
    is_open : bool
        Whether more calibration holes may well tell if one of them gains, see `calibration_set.is_open`.
    """

    model: FittedCompetitors
    blend_factor: float = PRIOR_BLEND_FACTOR
    error_model: ErrorModel | None = None
    trials: Sequence[Trial] = ()
    promising: Sequence[str] = ()
    is_open: bool = False

    def after(self, first: "Choice") -> "Choice":
        """Add to the trials on more holes the models that had been dropped on the first ones."""
        geometry = self.trials[0].error
        dropped = [
            trial for trial in first.trials if len(trial.shares) == 1 and not set(trial.shares) & {*first.promising}
        ]
        return replace(self, trials=[*self.trials, *(replace(trial, error=geometry) for trial in dropped)])


@dataclass(frozen=True)
class CalibrationPatches:
    """Patches that show the fills of calibration holes: at once those of a few holes, the others when they are needed.

    Attributes
    ----------
    holes : CalibrationSet
    filled : FilledMesh
        These holes, filled like the real ones.
    surface : PatchSurface
        What patches are cut from.
    seeds : Seeds
        Of all patches that may be cut.
    scale : PatchScale
    pool : ProcessPool
        A helper cuts them.
    """

    holes: CalibrationSet
    filled: FilledMesh
    surface: PatchSurface
    seeds: Seeds
    scale: PatchScale
    pool: ProcessPool

    @property
    def n_holes(self) -> int:
        """Count the calibration holes."""
        return len(self.filled.disagreement)

    @property
    def is_first(self) -> BoolArray:
        """Tell the holes (n_holes,) that come first: loops stand by length, so these are spread over all lengths."""
        first = np.zeros(self.n_holes, bool)
        first[np.linspace(0, self.n_holes - 1, min(FIRST_HOLES, self.n_holes)).astype(np.int64)] = True
        return first

    def begin(self) -> None:
        """Let a helper begin to cut the patches of the first holes."""
        _ = self._of_first

    @cached_property
    def first(self) -> Sampled:
        """The patches of the first holes."""
        return self._of_first.finish()[0]

    @cached_property
    def every(self) -> Sampled:
        """The patches of all holes."""
        return together(self.first, self._of_others.finish()[0])

    def pairs(self) -> TrainingPairs:
        """Give these patches as training pairs, from which nothing is learned: they judge."""
        return pairs_of(self.every, self.holes.truth)

    @cached_property
    def _of_first(self) -> "Shared[_Cutting, Sampled]":
        return self._cut(self._near_first)

    @cached_property
    def _of_others(self) -> "Shared[_Cutting, Sampled]":
        new = self.filled.mesh.vertices[self.filled.n_measured_vertices :]
        return self._cut(seeds_near(self.seeds, new, self.scale.length) & ~self._near_first)

    @cached_property
    def _near_first(self) -> BoolArray:
        new = self.filled.mesh.vertices[self.filled.n_measured_vertices :]
        return seeds_near(self.seeds, new[self.is_first[self.filled.vertex_hole]], self.scale.length)

    def _cut(self, near: BoolArray) -> "Shared[_Cutting, Sampled]":
        return self.pool.begin(_cut, [(self.surface, take(self.seeds, near), self.scale)])


_Cutting = tuple[PatchSurface, Seeds, PatchScale]


def _cut(cutting: _Cutting) -> Sampled:
    surface, seeds, scale = cutting
    return unfolded(surface.patchify(surface.smoothed(scale), seeds, scale))


def try_models(calibration: CalibrationPatches, competitors: FittedCompetitors, *, is_screened: bool = False) -> Choice:
    """Complete the calibration holes by models and by the means of several: take what leaves the least error.

    Models that gain nothing on the first few holes are dropped, unless that was looked at before (`is_screened`).
    """
    promising = list(competitors.members) if is_screened else promising_models(calibration, competitors)
    holes, filled, n_holes = calibration.holes, calibration.filled, calibration.n_holes
    geometry = Trial({}, 0.0, float(error_per_hole(holes, filled).mean()), n_holes)
    trials, best, best_fill, chosen, may_change = [geometry], geometry, filled, competitors, False
    predicted = _predict_all(calibration, competitors, promising)
    for model in competitors.mixtures():
        if set(model.shares) <= set(promising):
            displacement = _displacement(calibration, calibration.every.patches, model.mixed(predicted))
            errors = error_by_share(holes, filled, displacement)
            share = choose_share(errors)
            may_change |= is_open(errors)
            trial = Trial(dict(model.shares), SHARES[share], float(errors[share].mean()), n_holes)
            trials.append(trial)
            if trial.error < best.error:
                best, best_fill, chosen = trial, filled.displaced(trial.blend_factor * displacement), model
        elif len(model.shares) == 1:
            trials.append(replace(geometry, shares=dict(model.shares), n_holes=int(calibration.is_first.sum())))
    return Choice(chosen, best.blend_factor, expect(holes, best_fill), trials, promising, may_change)


def promising_models(calibration: CalibrationPatches, competitors: FittedCompetitors) -> list[str]:
    """Name the models of which some share gains 1 % over geometry alone in the mean of the first calibration holes."""
    patches, names = calibration.first.patches, []
    for name, model in competitors.members.items():
        displacement = _displacement(calibration, patches, model.predict(patches, calibration.first.base_heights))
        errors = error_by_share(calibration.holes, calibration.filled, displacement)[:, calibration.is_first]
        gain = float((errors[0] - errors[1:]).mean(axis=1).max())
        if gain > _LEAST_FIRST_GAIN * float(errors[0].mean()) + ROUNDING * calibration.holes.diameter:
            names.append(name)
    return names


def _predict_all(
    calibration: CalibrationPatches, competitors: FittedCompetitors, names: Sequence[str]
) -> dict[str, FloatArray]:
    """Ask some models for the patches of all calibration holes; where there is none, these are not cut."""
    asked = replace(competitors, shares=dict.fromkeys(names, 1.0))
    return asked.predict_each(calibration.every.patches, calibration.every.base_heights) if names else {}


def _displacement(calibration: CalibrationPatches, patches: Patches, predicted: FloatArray) -> FloatArray:
    """Displacements (n_invented, 3) of the calibration holes that the model may complete."""
    joined, agreement = joined_displacement(calibration.filled, patches, predicted)
    return np.where(agreeing_holes(agreement)[calibration.filled.vertex_hole][:, None], joined, 0.0)


def joined_displacement(
    filled: FilledMesh, patches: Patches, predicted: FloatArray
) -> tuple[FloatArray, PatchAgreement]:
    """Turn predicted heights (n_patches, N, N) into displacements (n_invented, 3), 0 at rims, and how patches agree."""
    rim, rim_hole = rim_vertices(filled)
    inside = displace(filled, np.flatnonzero(filled.invented_vertices), patches, predicted)
    at_rim = displace(filled, rim, patches, predicted)
    joined = join_at_rim(filled, inside.mean, rim, at_rim.mean)
    return joined, measure_agreement(filled, inside, joined, rim_hole, at_rim)

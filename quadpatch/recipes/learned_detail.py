"""What learning adds to the geometric fill (sections 3 to 5 of the paper).

Tested in `tests/quadpatch/recipes/test_default.py`.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from quadpatch.calibration.calibration_set import CalibrationSet, choose_blend_factor, error_per_hole, expect
from quadpatch.calibration.error_model import ErrorModel
from quadpatch.calibration.record import CalibrationRecord
from quadpatch.calibration.training_pairs import TrainingSurface, pairs_of
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.inpainters.competing import FittedCompetitors
from quadpatch.inpainters.inpainter import Fitting, Inpainter, TellsOfFitting, UndamagedSurface
from quadpatch.options import RepairOptions
from quadpatch.patches.folding import is_unfolded
from quadpatch.patches.layout import Sampled, lay_out, pick, seeds_near, take
from quadpatch.patches.scale import PatchScale, choose_scale
from quadpatch.patches.seeds import Seeds
from quadpatch.processes import ProcessPool, Shared
from quadpatch.recipes.assessment import agreeing_holes, measure_agreement
from quadpatch.recipes.patch_surfaces import CoarseCopy, PatchSurface, PatchSurfaces
from quadpatch.recipes.result import Completion, PatchAgreement, Trial
from quadpatch.reconstruction.displacement import displace, join_at_rim, rim_vertices
from quadpatch.stages import Stages
from quadpatch.types import BoolArray, FloatArray, Patches, Vertices

# Blend factor of a model where the mesh has no room for calibration.
PRIOR_BLEND_FACTOR = 0.0

# Patches that a self-similar dictionary is learned from.
_MAX_SEEDS_TO_LEARN_FROM = 2000


@dataclass(frozen=True)
class Calibration:
    """What calibration says of a surface.

    Attributes
    ----------
    diameters : list of float
        Of the real holes, in mesh units.
    edge_length : float
        Mean of the mesh, in mesh units.
    record : CalibrationRecord
    holes : CalibrationSet or None
        None where the surface has no room for calibration holes, or nothing but the record is asked for.
    filled : FilledMesh or None
        The calibration holes, filled like the real ones and as densely; None where that is still to be done.
    is_reused : bool
        Whether an earlier repair has found it out.
    """

    diameters: list[float]
    edge_length: float
    record: CalibrationRecord
    holes: CalibrationSet | None = None
    filled: FilledMesh | None = None
    is_reused: bool = False

    def uniform_fill(self) -> FilledMesh | None:
        """Give the calibration holes, filled like the real ones and as densely; None without any."""
        return self.filled if self.holes is None or self.filled is not None else self.record.fill(self.holes)


@dataclass(frozen=True)
class _Choice:
    """A model, and what calibration says of it.

    Attributes
    ----------
    model : FittedCompetitors
    blend_factor : float
    error_model : ErrorModel or None
        None without calibration.
    trials : list of Trial
        Of geometry alone, and of every model; empty without calibration.
    """

    model: FittedCompetitors
    blend_factor: float = PRIOR_BLEND_FACTOR
    error_model: ErrorModel | None = None
    trials: Sequence[Trial] = ()


def complete(
    filled: FilledMesh,
    coarse_copy: CoarseCopy | None,
    calibration: Calibration,
    inpainter: Inpainter,
    options: RepairOptions,
    stages: Stages,
) -> Completion | None:
    """Displace the fill of every hole by what a model makes of the patches around it.

    Parameters
    ----------
    filled : FilledMesh
    coarse_copy : CoarseCopy or None
        Patches are cut from that; None for the filled mesh itself.
    calibration : Calibration
    inpainter : Inpainter
    options : RepairOptions
    stages : Stages

    Returns
    -------
    Completion or None
        None where the mesh shows too little surface to learn from.

    Raises
    ------
    NoQuadsError
        If the base surface can't carry one quad.
    """
    scale = choose_scale(calibration.diameters, calibration.edge_length, options.patches, inpainter.resolution)
    with stages.stage("smooth"):
        fill = calibration.uniform_fill()
        surfaces = _surfaces(filled, coarse_copy, calibration, fill)
        base_surface = surfaces.filled.smoothed(scale)
    with stages.stage("quadrangulate"):
        seeds = lay_out(base_surface, scale)
    with stages.stage("patchify"):
        near = seeds_near(seeds, filled.mesh.vertices[filled.n_measured_vertices :], scale.length)
        wanted = near | _some(len(near), np.random.default_rng([options.seed, 2]))
        around_calibration = _begin_to_sample(stages.pool, surfaces.calibration, fill, seeds, scale)
        everywhere = surfaces.filled.patchify(base_surface, take(seeds, wanted), scale)
        sampled = pick(everywhere, near[wanted] & is_unfolded(everywhere.patches))
    with stages.stage("learn"):
        known_patches = _without_calibration_holes(everywhere.patches, surfaces.filled)
        training_surface = partial(_training_surface, surfaces.filled, calibration, seeds, scale)
        practice = _practice(calibration, fill, around_calibration)
        held_out = None if practice is None else partial(pairs_of, practice.sampled, practice.holes.truth)
        undamaged = UndamagedSurface(known_patches, everywhere.base_heights, training_surface, held_out)
        fitted = inpainter.fitted_to(undamaged)
        if fitted is None:
            return None
        competitors = fitted if isinstance(fitted, FittedCompetitors) else FittedCompetitors({"": fitted}, {"": 1.0})
        choice = _Choice(competitors) if practice is None else _calibrate_models(practice, competitors)
    with stages.stage("inpaint"):
        # A model with a blend factor of 0 need not be asked.
        predicted = choice.model.predict(sampled.patches, sampled.base_heights) if choice.blend_factor else None
    with stages.stage("reconstruct"):
        completion = replace(_completion(filled, sampled, predicted, choice, scale), fitting=_fitting(competitors))
    return completion if isinstance(fitted, FittedCompetitors) else replace(completion, shares={}, trials=())


def _fitting(competitors: FittedCompetitors) -> Fitting | None:
    """Find out how a network was fitted to the mesh; None where none was."""
    told = (member.fitting for member in competitors.members.values() if isinstance(member, TellsOfFitting))
    return next(told, None)


def _completion(
    filled: FilledMesh, sampled: Sampled, predicted: FloatArray | None, choice: _Choice, scale: PatchScale
) -> Completion:
    """Turn what a model predicts of the patches around the holes into a displacement of their fills."""
    n_patches, unmoved = len(sampled.patches), np.zeros((len(filled.vertex_hole), 3))
    if predicted is None:
        nowhere = np.zeros(len(filled.disagreement), bool)
        unchanged = choice.blend_factor, choice.error_model, scale, n_patches
        return Completion(unmoved, None, nowhere, *unchanged, trials=choice.trials)
    joined, agreement = _displacements(filled, sampled.patches, predicted)
    displaced_holes = agreeing_holes(agreement)
    displacement = choice.blend_factor * np.where(displaced_holes[filled.vertex_hole][:, None], joined, 0.0)
    model = choice.blend_factor, choice.error_model, scale, n_patches, dict(choice.model.shares), choice.trials
    return Completion(displacement, agreement, displaced_holes, *model)


def _surfaces(
    filled: FilledMesh, coarse_copy: CoarseCopy | None, calibration: Calibration, fill: FilledMesh | None
) -> PatchSurfaces:
    """Find what patches are cut from; `fill` is that of the calibration holes."""
    holes = calibration.holes
    if coarse_copy is not None:
        return coarse_copy.surfaces(filled, None if holes is None else holes.removed, fill)
    return PatchSurfaces.of_scan(filled, None if holes is None else holes.cut_away, fill, calibration.edge_length)


def _without_calibration_holes(patches: Patches, surface: PatchSurface) -> Patches:
    """Hide what calibration holes took, or a model would be tried on patches that it was learned from."""
    hidden = (patches.triangle >= 0) & surface.cut_away[patches.triangle]
    return replace(patches, known=patches.known & ~hidden)


def _training_surface(
    surface: PatchSurface, calibration: Calibration, seeds: Seeds, scale: PatchScale
) -> TrainingSurface:
    diameters = np.array(calibration.diameters)
    return TrainingSurface(surface.undamaged, seeds, scale, calibration.record.blend, diameters, surface.edge_length)


def _some(count: int, rng: np.random.Generator) -> BoolArray:
    """Pick seeds (count,) to learn from."""
    chosen = np.zeros(count, bool)
    chosen[rng.permutation(count)[:_MAX_SEEDS_TO_LEARN_FROM]] = True
    return chosen


# New vertices of a fill, the surface that they belong to, and the patches that may be cut from it.
_Cutting = tuple[Vertices, PatchSurface, Seeds, PatchScale]


def _begin_to_sample(
    pool: ProcessPool, surface: PatchSurface | None, fill: FilledMesh | None, seeds: Seeds, scale: PatchScale
) -> Shared[_Cutting, Sampled] | None:
    """Let a helper cut the patches that show the calibration holes, while this process cuts those of the real ones."""
    if fill is None or surface is None:
        return None
    new = fill.mesh.vertices[fill.n_measured_vertices :]
    return pool.begin(_sample_calibration, [(new, surface, seeds, scale)])


def _sample_calibration(cutting: _Cutting) -> Sampled:
    """Cut the patches that show the calibration holes."""
    new, surface, seeds, scale = cutting
    near = take(seeds, seeds_near(seeds, new, scale.length))
    sampled = surface.patchify(surface.smoothed(scale), near, scale)
    return pick(sampled, is_unfolded(sampled.patches))


@dataclass(frozen=True)
class _Practice:
    """Calibration holes, their fills, and the patches that show these."""

    holes: CalibrationSet
    filled: FilledMesh
    sampled: Sampled


def _practice(
    calibration: Calibration, filled: FilledMesh | None, cutting: Shared[_Cutting, Sampled] | None
) -> _Practice | None:
    """Wait for the patches that show the calibration holes; None without these."""
    if calibration.holes is None or filled is None or cutting is None:
        return None
    (sampled,) = cutting.finish()
    return _Practice(calibration.holes, filled, sampled)


def _calibrate_models(practice: _Practice, competitors: FittedCompetitors) -> _Choice:
    """Complete the calibration holes by each model and by the means of several: take what leaves the least error."""
    holes, filled, sampled = practice.holes, practice.filled, practice.sampled
    predicted = competitors.predict_each(sampled.patches, sampled.base_heights)
    choices, trials = [], [Trial({}, 0.0, float(error_per_hole(holes, filled).mean()))]
    for model in competitors.mixtures():
        joined, agreement = _displacements(filled, sampled.patches, model.mixed(predicted))
        joined = np.where(agreeing_holes(agreement)[filled.vertex_hole][:, None], joined, 0.0)
        factor = choose_blend_factor(holes, filled, joined)
        completed = filled.displaced(factor * joined)
        trials.append(Trial(dict(model.shares), factor, float(error_per_hole(holes, completed).mean())))
        choices.append(_Choice(model, factor, expect(holes, completed), trials))
    best = min(range(len(choices)), key=lambda number: trials[number + 1].error)
    return choices[best]


def _displacements(filled: FilledMesh, patches: Patches, predicted: FloatArray) -> tuple[FloatArray, PatchAgreement]:
    """Displacements (n_invented, 3), zero at the rims, and how far the patches agree."""
    rim, rim_hole = rim_vertices(filled)
    inside = displace(filled, np.flatnonzero(filled.invented_vertices), patches, predicted)
    at_rim = displace(filled, rim, patches, predicted)
    joined = join_at_rim(filled, inside.mean, rim, at_rim.mean)
    return joined, measure_agreement(filled, inside, joined, rim_hole, at_rim)

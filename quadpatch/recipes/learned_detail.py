"""What learning adds to the geometric fill (sections 3 to 5 of the paper).

Tested in `tests/quadpatch/recipes/test_default.py`.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from quadpatch.calibration.calibration_set import CalibrationSet
from quadpatch.calibration.record import CalibrationRecord
from quadpatch.calibration.training_pairs import TrainingSurface
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.inpainters.competing import CompetingInpainters, FittedCompetitors
from quadpatch.inpainters.inpainter import Fitting, Inpainter, TellsOfFitting, UndamagedSurface
from quadpatch.options import RepairOptions
from quadpatch.patches.layout import Sampled, lay_out, seeds_near, take, unfolded
from quadpatch.patches.scale import PatchScale, choose_scale
from quadpatch.patches.seeds import Seeds
from quadpatch.processes import ProcessPool
from quadpatch.recipes.assessment import agreeing_holes
from quadpatch.recipes.model_trials import CalibrationPatches, Choice, joined_displacement, try_models
from quadpatch.recipes.patch_surfaces import CoarseCopy, PatchSurface, PatchSurfaces
from quadpatch.recipes.result import Completion
from quadpatch.stages import Stages
from quadpatch.types import FloatArray, Patches, TriangleMesh

# Patches that a self-similar dictionary is learned from.
_MAX_SEEDS_TO_LEARN_FROM = 1000
# More calibration holes have to be so many times as many to say more.
_MORE = 1.5


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
    cut_more : callable or None
        Cuts more of them, these among them.
    filled : FilledMesh or None
        The calibration holes, filled like the real ones and as densely; None where that is still to be done.
    is_reused : bool
        Whether an earlier repair has found it out.
    """

    diameters: list[float]
    edge_length: float
    record: CalibrationRecord
    holes: CalibrationSet | None = None
    cut_more: Callable[[], CalibrationSet | None] | None = None
    filled: FilledMesh | None = None
    is_reused: bool = False

    def uniform_fill(self) -> FilledMesh | None:
        """Give the calibration holes, filled like the real ones and as densely; None without any."""
        return self.filled if self.holes is None or self.filled is not None else self.record.fill(self.holes)

    def with_more_holes(self, pool: ProcessPool) -> "Calibration | None":
        """Cut more calibration holes and fill them; None where the surface has no room for half as many again."""
        more = None if self.cut_more is None else self.cut_more()
        if self.holes is None or more is None or len(more.loops) < _MORE * len(self.holes.loops):
            return None
        return replace(self, holes=more, cut_more=None, filled=self.record.fill_others(more, pool))


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
    learned = _learn(_Learning(filled, coarse_copy, calibration, inpainter, scale), options, stages)
    if learned is None:
        return None
    if learned.choice.is_open and not learned.fits_a_network:
        learned = _learn_from_more(learned, options, stages)
    choice = learned.choice
    with stages.stage("inpaint"):
        # A model with a blend factor of 0 need not be asked: then patches that show the fills are not cut.
        sampled = predicted = None
        if choice.blend_factor:
            sampled = _around_fills(filled, learned.surface, learned.base_surface, learned.seeds, scale)
            predicted = choice.model.predict(sampled.patches, sampled.base_heights)
    with stages.stage("reconstruct"):
        completion = _completion(filled, sampled, predicted, choice, scale)
        completion = replace(completion, fitting=learned.fitting)
    return completion if learned.is_competition else replace(completion, shares={}, trials=())


@dataclass(frozen=True)
class _Learning:
    """What a model learns from, see `complete`; after a first time only models are left that may gain."""

    filled: FilledMesh
    coarse_copy: CoarseCopy | None
    calibration: Calibration
    inpainter: Inpainter
    scale: PatchScale
    first: "_Learned | None" = None

    @property
    def is_laid_out(self) -> bool:
        """Whether the patches of the first time serve again: a coarse copy depends on the calibration holes."""
        return self.first is not None and self.coarse_copy is None


@dataclass(frozen=True)
class _Learned:
    """Models that were fitted to a mesh, and which of them fills its holes.

    Attributes
    ----------
    source : _Learning
    surface : PatchSurface
        What the patches around the fills are cut from.
    base_surface : TriangleMesh
    seeds : Seeds
    shown : Sampled
        Patches that are learned from.
    choice : Choice
    is_competition : bool
        Whether there may be more than one model.
    fitting : Fitting or None
        How a network was fitted; None where none was.
    fits_a_network : bool
        Whether one that was fitted may gain: to fit it once more would take as long again.
    """

    source: _Learning
    surface: PatchSurface
    base_surface: TriangleMesh
    seeds: Seeds
    shown: Sampled
    choice: Choice
    is_competition: bool
    fitting: Fitting | None = None
    fits_a_network: bool = False


def _learn(source: _Learning, options: RepairOptions, stages: Stages) -> _Learned | None:
    """Fit a model to the mesh and try it on calibration holes; None where the mesh shows too little."""
    filled, calibration, scale = source.filled, source.calibration, source.scale
    with stages.stage("smooth"):
        fill = calibration.uniform_fill()
        surfaces = _surfaces(filled, source.coarse_copy, calibration, fill)
        kept = source.first if source.is_laid_out else None
        base_surface = kept.base_surface if kept else surfaces.filled.smoothed(scale)
    with stages.stage("quadrangulate"):
        seeds = kept.seeds if kept else lay_out(base_surface, scale)
    with stages.stage("patchify"):
        tried = _calibration_patches(calibration, fill, surfaces.calibration, seeds, scale, stages.pool)
        shown = kept.shown if kept else _shown(surfaces.filled, base_surface, seeds, scale, options.seed)
    with stages.stage("learn"):
        known_patches = _without_calibration_holes(shown.patches, surfaces.filled)
        training_surface = partial(_training_surface, surfaces.filled, calibration, seeds, scale)
        held_out = None if tried is None else tried.pairs
        undamaged = UndamagedSurface(known_patches, shown.base_heights, training_surface, held_out)
        fitted = source.inpainter.fitted_to(undamaged)
        if fitted is None:
            return None
        competitors = fitted if isinstance(fitted, FittedCompetitors) else FittedCompetitors({"": fitted}, {"": 1.0})
        screened = source.first is not None
        choice = Choice(competitors) if tried is None else try_models(tried, competitors, is_screened=screened)
    told = {name: member.fitting for name, member in competitors.members.items() if isinstance(member, TellsOfFitting)}
    fitting, may_gain = next(iter(told.values()), None), bool(told.keys() & {*choice.promising})
    is_competition = isinstance(fitted, FittedCompetitors)
    return _Learned(source, surfaces.filled, base_surface, seeds, shown, choice, is_competition, fitting, may_gain)


def _learn_from_more(first: _Learned, options: RepairOptions, stages: Stages) -> _Learned:
    """Fit the models that may gain anew, and try them on more calibration holes, where there is room for these."""
    source = first.source
    with stages.stage("learn"):
        more = source.calibration.with_more_holes(stages.pool)
    if more is None:
        return first
    inpainter, promising = source.inpainter, first.choice.promising
    if isinstance(inpainter, CompetingInpainters):
        inpainter = inpainter.limited_to(promising)
    # The further holes may have been learned from: they are hidden now.
    again = replace(source, calibration=more, inpainter=inpainter, first=first)
    second = _learn(again, options, stages)
    if second is None:
        return first
    return replace(second, choice=second.choice.after(first.choice), fitting=first.fitting)


def _around_fills(
    filled: FilledMesh, surface: PatchSurface, base_surface: TriangleMesh, seeds: Seeds, scale: PatchScale
) -> Sampled:
    """Cut the patches that show fills."""
    near = seeds_near(seeds, filled.mesh.vertices[filled.n_measured_vertices :], scale.length)
    return unfolded(surface.patchify(base_surface, take(seeds, near), scale))


def _completion(
    filled: FilledMesh, sampled: Sampled | None, predicted: FloatArray | None, choice: Choice, scale: PatchScale
) -> Completion:
    """Turn what a model predicts of the patches around the holes into a displacement of their fills."""
    unmoved = np.zeros((len(filled.vertex_hole), 3))
    if sampled is None or predicted is None:
        nowhere = np.zeros(len(filled.disagreement), bool)
        unchanged = choice.blend_factor, choice.error_model, scale, 0
        return Completion(unmoved, None, nowhere, *unchanged, trials=choice.trials)
    joined, agreement = joined_displacement(filled, sampled.patches, predicted)
    displaced_holes = agreeing_holes(agreement)
    displacement = choice.blend_factor * np.where(displaced_holes[filled.vertex_hole][:, None], joined, 0.0)
    n_patches, shares = len(sampled.patches), dict(choice.model.shares)
    model = choice.blend_factor, choice.error_model, scale, n_patches, shares, choice.trials
    return Completion(displacement, agreement, displaced_holes, *model)


def _calibration_patches(
    calibration: Calibration,
    fill: FilledMesh | None,
    surface: PatchSurface | None,
    seeds: Seeds,
    scale: PatchScale,
    pool: ProcessPool,
) -> CalibrationPatches | None:
    """Begin to cut the patches that show the first calibration holes; None without any."""
    if calibration.holes is None or fill is None or surface is None:
        return None
    patches = CalibrationPatches(calibration.holes, fill, surface, seeds, scale, pool)
    patches.begin()
    return patches


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


def _shown(surface: PatchSurface, base_surface: TriangleMesh, seeds: Seeds, scale: PatchScale, seed: int) -> Sampled:
    """Cut patches anywhere to learn from."""
    chosen = np.zeros(len(seeds), bool)
    chosen[np.random.default_rng([seed, 2]).permutation(len(seeds))[:_MAX_SEEDS_TO_LEARN_FROM]] = True
    return surface.patchify(base_surface, take(seeds, chosen), scale)

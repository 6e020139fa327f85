"""What learning adds to the geometric fill (sections 3 to 5 of the paper)."""

from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from quadpatch.calibration.calibration_set import CalibrationSet, blend_factor, expect
from quadpatch.calibration.energy_selection import EnergyBlend
from quadpatch.calibration.error_model import ErrorModel
from quadpatch.calibration.training_pairs import TrainingSurface
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.inpainters.inpainter import FittedInpainter, Inpainter, UndamagedSurface
from quadpatch.mesh.smoothing import laplacian_smooth
from quadpatch.options import RepairOptions
from quadpatch.patches.folding import is_unfolded
from quadpatch.patches.layout import lay_out, patchify, pick, seeds_near, take
from quadpatch.patches.scale import PatchScale, base_surface_iterations, choose_scale
from quadpatch.patches.seeds import Seeds
from quadpatch.recipes.assessment import measure_agreement, trusted_holes
from quadpatch.recipes.result import Completion, PatchAgreement
from quadpatch.reconstruction.displacement import displace, join_at_rim, rim_vertices
from quadpatch.stages import Stages
from quadpatch.types import BoolArray, FloatArray, Patches, TriangleMesh

# Believed of a model's displacement where the mesh has no room for calibration.
PRIOR_BLEND_FACTOR = 0.0

# Patches that a self-similar dictionary is learned from.
_MAX_SEEDS_TO_LEARN_FROM = 2000


@dataclass(frozen=True)
class CompletionInput:
    """What is to be completed.

    Attributes
    ----------
    filled : FilledMesh
    rule : EnergyBlend
        That it was faired by.
    diameters : list of float
        Of the filled holes, in mesh units.
    edge_length : float
        Mean edge length, in mesh units.
    calibration : CalibrationSet or None
    calibration_filled : FilledMesh or None
        The calibration holes, filled like the real ones.
    """

    filled: FilledMesh
    rule: EnergyBlend
    diameters: list[float]
    edge_length: float
    calibration: CalibrationSet | None
    calibration_filled: FilledMesh | None


@dataclass(frozen=True)
class _Model:
    """A model, and the layout of the patches that it is applied to."""

    inpainter: FittedInpainter
    seeds: Seeds
    scale: PatchScale


def complete(
    problem: CompletionInput,
    inpainter: Inpainter,
    options: RepairOptions,
    rng: np.random.Generator,
    stages: Stages,
) -> Completion | None:
    """Displace the fill of every hole by what a model makes of the patches around it.

    Parameters
    ----------
    problem : CompletionInput
    inpainter : Inpainter
    options : RepairOptions
    rng : numpy.random.Generator
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
    filled = problem.filled
    scale = choose_scale(problem.diameters, problem.edge_length, options.patches, inpainter.resolution)
    with stages.stage("smooth"):
        base_surface = _base_surface(filled, scale, problem.edge_length)
    with stages.stage("quadrangulate"):
        seeds = lay_out(base_surface, scale)
    with stages.stage("patchify"):
        near = seeds_near(seeds, filled.mesh.vertices[filled.n_measured_vertices :], scale.length)
        wanted = near | _some(len(near), rng)
        everywhere = patchify(filled, base_surface, take(seeds, wanted), scale)
        sampled = pick(everywhere, near[wanted] & is_unfolded(everywhere.patches))
    with stages.stage("learn"):
        known_patches = _without_calibration_holes(everywhere.patches, problem)
        training_surface = partial(_training_surface, problem, seeds, scale)
        fitted = inpainter.fitted_to(UndamagedSurface(known_patches, everywhere.base_heights, training_surface))
        if fitted is None:
            return None
        blend_factor, error_model = _calibrate(problem, _Model(fitted, seeds, scale))
    with stages.stage("inpaint"):
        # A model with a blend factor of 0 need not be asked.
        predicted = fitted.predict(sampled.patches, sampled.base_heights) if blend_factor else None
    with stages.stage("reconstruct"):
        evidence, trust = None, np.zeros(len(filled.disagreement), bool)
        if predicted is not None:
            joined, evidence = _displacements(filled, sampled.patches, predicted)
            trust = trusted_holes(evidence)
            filled = _moved(filled, blend_factor * np.where(trust[filled.vertex_hole][:, None], joined, 0.0))
    return Completion(filled, evidence, trust, blend_factor, error_model, scale, len(sampled.patches))


def _moved(filled: FilledMesh, displacement: FloatArray) -> FilledMesh:
    return filled.with_vertices(filled.mesh.vertices[filled.n_measured_vertices :] + displacement)


def _base_surface(filled: FilledMesh, scale: PatchScale, edge_length: float) -> TriangleMesh:
    return laplacian_smooth(filled.mesh, base_surface_iterations(scale.length, edge_length))


def _without_calibration_holes(patches: Patches, problem: CompletionInput) -> Patches:
    """Hide what calibration holes took, or a model would be tried on patches that it was learned from."""
    if problem.calibration is None:
        return patches
    cut_away = np.zeros(len(problem.filled.mesh.triangles), bool)
    cut_away[: len(problem.calibration.cut_away)] = problem.calibration.cut_away
    hidden = (patches.triangle >= 0) & cut_away[patches.triangle]
    return replace(patches, known=patches.known & ~hidden)


def _training_surface(problem: CompletionInput, seeds: Seeds, scale: PatchScale) -> TrainingSurface:
    """Measured surface, without what calibration holes took."""
    filled, calibration = problem.filled, problem.calibration
    measured = filled.mesh.triangles[: filled.n_measured_triangles]
    triangles = measured if calibration is None else measured[~calibration.cut_away]
    mesh = TriangleMesh(filled.mesh.vertices[: filled.n_measured_vertices], triangles)
    return TrainingSurface(mesh, seeds, scale, problem.rule, np.array(problem.diameters), problem.edge_length)


def _some(count: int, rng: np.random.Generator) -> BoolArray:
    """Pick seeds (count,) to learn from."""
    chosen = np.zeros(count, bool)
    chosen[rng.permutation(count)[:_MAX_SEEDS_TO_LEARN_FROM]] = True
    return chosen


def _calibrate(problem: CompletionInput, model: _Model) -> tuple[float, ErrorModel | None]:
    """Complete the calibration holes: the share of the displacement to believe, and the error to expect."""
    filled = problem.calibration_filled
    if problem.calibration is None or filled is None:
        return PRIOR_BLEND_FACTOR, None
    base_surface = _base_surface(filled, model.scale, problem.edge_length)
    new = filled.mesh.vertices[filled.n_measured_vertices :]
    near = take(model.seeds, seeds_near(model.seeds, new, model.scale.length))
    sampled = patchify(filled, base_surface, near, model.scale)
    sampled = pick(sampled, is_unfolded(sampled.patches))
    predicted = model.inpainter.predict(sampled.patches, sampled.base_heights)
    joined, evidence = _displacements(filled, sampled.patches, predicted)
    joined = np.where(trusted_holes(evidence)[filled.vertex_hole][:, None], joined, 0.0)
    share = blend_factor(problem.calibration, filled, joined)
    return share, expect(problem.calibration, filled.with_vertices(new + share * joined))


def _displacements(filled: FilledMesh, patches: Patches, predicted: FloatArray) -> tuple[FloatArray, PatchAgreement]:
    """Displacements (n_invented, 3), zero at the rims, and the evidence behind them."""
    rim, rim_hole = rim_vertices(filled)
    inside = displace(filled, np.flatnonzero(filled.invented_vertices), patches, predicted)
    at_rim = displace(filled, rim, patches, predicted)
    joined = join_at_rim(filled, inside.mean, rim, at_rim.mean)
    return joined, measure_agreement(filled, inside, joined, rim_hole, at_rim)

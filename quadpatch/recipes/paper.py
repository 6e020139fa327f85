"""The method exactly as in the paper: `--recipe paper`, the reference that the default recipe is measured against.

K. Sarkar, K. Varanasi, D. Stricker, "Learning Quadrangulated Patches For 3D Shape Processing", 2019. The stages stand
here in the paper's order. What the default recipe adds has no place here: no fairing, no base surface under the
heights, no calibration, no blend factor, no joining at the rim, no assessment. docs/paper.md goes through the paper and
says where each part of it lies, and what differs.
"""

from dataclasses import dataclass, replace

import numpy as np

from quadpatch.calibration.energy_selection import EnergyBlend
from quadpatch.calibration.training_pairs import TrainingSurface
from quadpatch.errors import NoQuadsError, OptionError
from quadpatch.filling.fairing import Energy
from quadpatch.filling.faults import find_faults
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.filling.meshlab_closing import close_by_meshlab
from quadpatch.inpainters.inpainter import FittedInpainter, Inpainter, UndamagedSurface
from quadpatch.inpainters.paper_dictionary import HeightsInpainter
from quadpatch.mesh.holes import Hole, Selection, find_holes, select_holes
from quadpatch.mesh.measures import diagonal, longest_side, mean_edge_length
from quadpatch.options import PatchOptions, RepairOptions
from quadpatch.patches.folding import is_unfolded
from quadpatch.patches.layout import pick_patches, seeds_near, take
from quadpatch.patches.paper_layout import learnable, measured_patches, seeds_on_surface, smooth_for_quads
from quadpatch.patches.scale import PatchScale, preset_scale
from quadpatch.patches.seeds import Seeds
from quadpatch.recipes.assessment import agreement_of, count_new, measure_agreement, with_open_holes
from quadpatch.recipes.result import Completion, HoleResult, Repair
from quadpatch.recipes.verification import with_named_faults
from quadpatch.reconstruction.displacement import rim_vertices
from quadpatch.reconstruction.placement import place, with_ring_means
from quadpatch.stages import Stages
from quadpatch.types import FloatArray, Patches, TriangleMesh, Triangles
from quadpatch_rules.coded_warnings import warning
from quadpatch_rules.hole_selection import MODEL_FILLS_ONLY

# The paper gives patch length, resolution and overlap for each of its objects. Where none are given, patches are twice
# as wide as the holes, nearly, with bins as in the paper's networks and every vertex in about nine patches.
HOLES_PER_LENGTH = 1.8
RESOLUTION = 24
OVERLAP = 2
# Bins much finer than the mesh show its triangles.
LEAST_EDGES_PER_BIN = 0.5

# Nothing is faired.
NO_FAIRING = EnergyBlend.of_one(Energy())


@dataclass(frozen=True)
class _Laid:
    """Seeds on the smoothed surface of a closed mesh, and what samples the mesh there."""

    filled: FilledMesh
    seeds: Seeds
    scale: PatchScale
    seed: int

    def patches(self, which: Seeds) -> Patches:
        """Sample the measured surface at some of the seeds; the closing is not looked at."""
        return measured_patches(self.filled.measured, which, self.scale, np.random.default_rng(self.seed))


def inpaint_as_paper(
    mesh: TriangleMesh,
    inpainter: Inpainter,
    options: RepairOptions,
    stages: Stages | None = None,
    *,
    obstacles: Triangles | None = None,
) -> Repair:
    """Repair the holes of a mesh by the method of the paper.

    Parameters
    ----------
    mesh : TriangleMesh
    inpainter : Inpainter
        Codes heights, as `HeightsInpainter` does.
    options : RepairOptions
        The recipe they name is not looked at.
    stages : Stages, optional
        Gets progress and seconds.
    obstacles : (k, 3) int64, optional
        Triangles that the mesh leaves out; crossings of these are counted too.

    Returns
    -------
    Repair
        Confidence and expected error are None: the paper has no measure of either.

    Raises
    ------
    OptionError
        If the options don't fit the mesh.
    """
    stages = stages or Stages()
    with stages.stage("holes"):
        holes = find_holes(mesh)
        selection = select_holes(holes, options.holes, diagonal(mesh))
        if selection.bridges or any(action != "model" for action in selection.actions.values()):
            raise OptionError(MODEL_FILLS_ONLY)
    with stages.stage("fill"):
        filled = close_by_meshlab(mesh, [hole.loop for hole in selection.chosen])
    completion, warnings = None, list[str]()
    if len(filled.vertex_hole):
        try:
            completion = _complete(filled, _scale(mesh, selection, options, inpainter), inpainter, options.seed, stages)
            if completion is None:
                warnings.append(warning("too_little_surface_for_paper"))
        except NoQuadsError as error:
            warnings.append(warning("no_patches_for_paper", reason=str(error)))
    placed = completion.apply(filled) if completion else filled
    with stages.stage("judge"):
        results = _results(holes, selection, filled, completion)
        # The paper checks nothing: what is wrong is named, and handed out all the same.
        results = with_named_faults(results, selection.chosen, find_faults(placed, obstacles=obstacles))
    return Repair(placed, selection.chosen, results, NO_FAIRING, completion, warnings)


def _scale(mesh: TriangleMesh, selection: Selection, options: RepairOptions, inpainter: Inpainter) -> PatchScale:
    diameters = [hole.diameter for hole in selection.chosen]
    side = longest_side(mesh)
    patches = preset_scale(options.patches, side)
    scale = paper_scale(diameters, mean_edge_length(mesh), patches, inpainter.resolution)
    share = inpainter.length_share if isinstance(inpainter, HeightsInpainter) else None
    if share is None or patches.length is not None:
        return scale
    # As wide as in training, unless that is too narrow for the holes.
    widest = HOLES_PER_LENGTH * float(np.percentile(diameters, 75))
    return replace(scale, length=max(share * side, widest))


def paper_scale(
    hole_diameters: list[float], edge_length: float, options: PatchOptions, model_resolution: int | None = None
) -> PatchScale:
    """Choose patch length, resolution and overlap where the user or the model doesn't; lengths in mesh units."""
    resolution = model_resolution or options.resolution or RESOLUTION
    # The finest networks show as much surface as the others, more finely: they were trained so.
    n_bins = min(model_resolution, RESOLUTION) if model_resolution else resolution
    least = LEAST_EDGES_PER_BIN * edge_length * n_bins
    typical = float(np.percentile(hole_diameters, 75)) if hole_diameters else 0.0
    length = options.length or max(HOLES_PER_LENGTH * typical, least)
    return PatchScale(float(length), resolution, OVERLAP if options.overlap is None else options.overlap)


def _complete(
    filled: FilledMesh, scale: PatchScale, inpainter: Inpainter, seed: int, stages: Stages
) -> Completion | None:
    """Lay patches, complete those that see a hole, and place its vertices by them (sections 3 and 4 of the paper)."""
    with stages.stage("smooth"):
        smoothed = smooth_for_quads(filled.mesh)
    with stages.stage("quadrangulate"):
        laid = _Laid(filled, seeds_on_surface(smoothed, scale), scale, seed)
    with stages.stage("patchify"):
        near = seeds_near(laid.seeds, filled.mesh.vertices[filled.n_measured_vertices :], scale.length)
        patches = laid.patches(take(laid.seeds, near))
        patches = pick_patches(patches, is_unfolded(patches))
    fitted = _fitted(inpainter, laid, patches, stages)
    if fitted is None:
        return None
    with stages.stage("inpaint"):
        predicted = fitted.predict(patches, np.zeros_like(patches.heights))
    with stages.stage("reconstruct"):
        return _reconstruct(filled, patches, predicted, scale)


def _fitted(inpainter: Inpainter, laid: _Laid, patches: Patches, stages: Stages) -> FittedInpainter | None:
    """Learn from all patches what is learned from the mesh; other models are shown those at the holes."""
    if inpainter.resolution is not None:
        return inpainter.fitted_to(_undamaged(patches))
    with stages.stage("learn"):
        return inpainter.fitted_to(_undamaged(learnable(laid.patches(laid.seeds))))


def _undamaged(patches: Patches) -> UndamagedSurface:
    def no_training_surface() -> TrainingSurface:
        raise OptionError("the recipe paper fits no network to a mesh")

    return UndamagedSurface(patches, np.zeros_like(patches.heights), no_training_surface)


def _reconstruct(filled: FilledMesh, patches: Patches, predicted: FloatArray, scale: PatchScale) -> Completion:
    """Place every new vertex; look at the rim as well, where it is known what should come out."""
    rim, rim_hole = rim_vertices(filled)
    placed = place(filled, np.flatnonzero(filled.invented_vertices), patches, predicted)
    at_rim = place(filled, rim, patches, predicted)
    moves = with_ring_means(filled, placed)
    agreement = measure_agreement(filled, placed, moves, rim_hole, at_rim)
    return Completion(moves, agreement, agreement.coverage > 0, 1.0, None, scale, len(patches))


def _results(
    holes: list[Hole], selection: Selection, filled: FilledMesh, completion: Completion | None
) -> list[HoleResult]:
    """Say of every hole what became of it, in the order of their ids. Whatever patches say is taken."""
    closed = []
    for i, (hole, n_vertices, n_triangles) in enumerate(zip(selection.chosen, *count_new(filled), strict=True)):
        verdict, code, reason = _verdict(i, n_vertices, completion)
        agreement = agreement_of(i, completion)
        closed.append(HoleResult(hole, verdict, code, reason, None, None, n_vertices, n_triangles, agreement))
    return with_open_holes(closed, holes, selection, filled)


def _verdict(i: int, n_new_vertices: int, completion: Completion | None) -> tuple[str, str, str]:
    if not n_new_vertices:
        return "filled_smooth", "no_new_vertex", "so small that its rim alone spans it: there is nothing to place"
    if completion is None:
        return "filled_smooth", "geometry", "no learned model took part"
    if not completion.displaced_holes[i]:
        return (
            "filled_smooth",
            "no_height_map",
            "no patch sees the hole: its new vertices lie where the closing put them",
        )
    return "filled", "", ""

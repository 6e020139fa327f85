"""The method: a mesh with holes in, a mesh without them out.

The stages are those of Sarkar, Varanasi and Stricker, "Learning Quadrangulated Patches For 3D Shape Processing": holes,
geometric fill, base surface, quads, patches, learning, completion, reconstruction, verdicts.
"""

import numpy as np

from quadpatch.calibration.calibration_set import CalibrationSet, cut_calibration_set, expect
from quadpatch.calibration.energy_selection import EnergyBlend, learn_energy_blend
from quadpatch.calibration.error_model import PRIOR, ErrorModel
from quadpatch.errors import NoQuadsError
from quadpatch.filling.checked_fill import CheckedFill, LoopsToFill, fill_checked
from quadpatch.filling.fairing import THIN_PLATE, Energy
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.filling.islands import JoinedRims, join_islands
from quadpatch.inpainters.inpainter import Inpainter
from quadpatch.mesh.holes import Selection, find_holes, select_holes
from quadpatch.mesh.measures import diagonal, mean_edge_length
from quadpatch.options import RepairOptions
from quadpatch.recipes.assessment import assess
from quadpatch.recipes.learned_detail import CompletionInput, complete
from quadpatch.recipes.result import Repair
from quadpatch.recipes.verification import limited_to, verified_results, without_faults
from quadpatch.stages import Stages
from quadpatch.types import BoolArray, TriangleMesh, Triangles
from shared_rules.hole_selection import HoleAction

# From rough to smooth: a noisy or sharp-edged surface is continued best by the first, a smooth one by the last.
FAIRING_ENERGIES = (
    Energy(membrane=0.3, plate=1.0),
    THIN_PLATE,
    *(Energy(plate=1.0, variation=weight) for weight in (0.4, 2.0, 40.0)),
)

# For surfaces on which calibration can't tell the energies apart.
DEFAULT_ENERGY = FAIRING_ENERGIES[2]
# For surfaces without room for calibration: they are coarse for their holes, and a rim of few edges shows no curvature
# to carry on.
PRIOR_ENERGY = THIN_PLATE


def inpaint(
    mesh: TriangleMesh,
    inpainter: Inpainter | None,
    options: RepairOptions,
    stages: Stages | None = None,
    *,
    obstacles: Triangles | None = None,
) -> Repair:
    """Repair the holes of a mesh.

    Parameters
    ----------
    mesh : TriangleMesh
    inpainter : Inpainter or None
        None fills by geometry alone.
    options : RepairOptions
    stages : Stages, optional
        Gets progress and seconds.
    obstacles : (k, 3) int64, optional
        Triangles that the mesh leaves out, such as repeated ones: a fill may not run through them either.

    Returns
    -------
    Repair

    Raises
    ------
    OptionError
        If the options don't fit the mesh.
    """
    stages = stages or Stages()
    rng = np.random.default_rng(options.seed)
    with stages.stage("holes"):
        holes = find_holes(mesh)
        selection = select_holes(holes, options.holes, diagonal(mesh))
        rims = join_islands(mesh, holes, selection.chosen)
    with stages.stage("fill"):
        problem, error_model, checked = _fill(mesh, rims, _loops_to_fill(rims, selection), obstacles, rng)
    completion, warnings = None, []
    by_model = _with_action(rims, selection, "model")
    if inpainter is not None and by_model[problem.filled.vertex_hole].any():
        try:
            completion = complete(problem, inpainter, options, rng, stages)
            if completion is None:
                warnings.append("too little undamaged surface to learn from; the holes were filled by geometry alone")
        except NoQuadsError as error:
            warnings.append(f"{error}; the holes were filled by geometry alone")
    with stages.stage("judge"):
        if completion:
            completion = limited_to(completion, checked.filled, by_model)
        verified = without_faults(completion, checked, obstacles)
        completion = verified.completion
        if completion and completion.error_model is not None:
            error_model = completion.error_model
        results = assess(holes, _filled_ones(selection, rims), problem.filled, completion, error_model)
        results = verified_results(results, rims, checked, verified.faults, diagonal(mesh))
    filled = completion.filled if completion else problem.filled
    return Repair(filled, rims.chosen, results, problem.rule, completion, warnings)


def _loops_to_fill(rims: JoinedRims, selection: Selection) -> LoopsToFill:
    border = np.array([hole.is_border for hole in rims.chosen], bool)
    return LoopsToFill(rims.loops, _with_action(rims, selection, "flat"), border)


def _with_action(rims: JoinedRims, selection: Selection, action: HoleAction) -> BoolArray:
    """Tell the rims (n_loops,) whose hole gets some action."""
    return np.array([selection.actions.get(hole.id, "model") == action for hole in rims.chosen], bool)


def _filled_ones(selection: Selection, rims: JoinedRims) -> Selection:
    """Count islands among the holes without a fill of their own."""
    joined = dict.fromkeys(rims.host_of, ("joined", ""))
    return Selection(rims.chosen, {**selection.skipped, **joined}, selection.actions)


def _fill(
    mesh: TriangleMesh, rims: JoinedRims, wanted: LoopsToFill, obstacles: Triangles | None, rng: np.random.Generator
) -> tuple[CompletionInput, ErrorModel, CheckedFill]:
    """Fill the holes as suits this surface, and check it; also the error to expect of that."""
    edge = mean_edge_length(mesh)
    diameters = [hole.diameter for hole in rims.chosen]
    curved = [diameters[i] for i in np.flatnonzero(~wanted.flat)]
    calibration = cut_calibration_set(mesh, float(np.median(curved)), edge, rng) if curved else None
    rule, filled_again = suitable_rule(calibration)
    error_model = PRIOR
    if calibration is not None and filled_again is not None:
        error_model = expect(calibration, filled_again)
    checked = fill_checked(mesh, wanted, rule.fill, obstacles)
    return CompletionInput(checked.filled, rule, diameters, edge, calibration, filled_again), error_model, checked


def suitable_rule(calibration: CalibrationSet | None) -> tuple[EnergyBlend, FilledMesh | None]:
    """Learn how this surface is continued best, as far as calibration tells; also the calibration holes, filled."""
    if calibration is None:
        return EnergyBlend.of_one(PRIOR_ENERGY), None
    return learn_energy_blend(calibration, FAIRING_ENERGIES, DEFAULT_ENERGY)

"""The method: a mesh with holes in, a mesh without them out.

The stages are those of Sarkar, Varanasi and Stricker, "Learning Quadrangulated Patches For 3D Shape Processing": holes,
geometric fill, base surface, quads, patches, learning, completion, reconstruction, verdicts.
"""

from dataclasses import replace

import numpy as np

from quadpatch.calibration.calibration_set import CalibrationSet, cut_calibration_set, expect
from quadpatch.calibration.energy_selection import EnergyBlend, learn_energy_blend
from quadpatch.calibration.error_model import PRIOR
from quadpatch.errors import NoQuadsError
from quadpatch.filling.checked_fill import LoopsToFill, fill_checked
from quadpatch.filling.fairing import THIN_PLATE, Energy
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.filling.islands import JoinedRims, join_islands
from quadpatch.inpainters.inpainter import Inpainter
from quadpatch.mesh.holes import Selection, find_holes, select_holes
from quadpatch.mesh.measures import diagonal, mean_edge_length
from quadpatch.options import RepairOptions
from quadpatch.recipes.assessment import assess
from quadpatch.recipes.learned_detail import Calibration, complete
from quadpatch.recipes.result import Repair
from quadpatch.recipes.verification import verified_results, without_faults
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
        wanted = _loops_to_fill(rims, selection)
        calibration = _calibrate(mesh, rims, wanted, rng)
        checked = fill_checked(mesh, wanted, calibration.blend.fill, obstacles)
    completion, warnings = None, []
    by_model = _with_action(rims, selection, "model")
    if inpainter is not None and by_model[checked.filled.vertex_hole].any():
        try:
            completion = complete(checked.filled, calibration, inpainter, options, rng, stages)
            if completion is None:
                warnings.append("too little undamaged surface to learn from; the holes were filled by geometry alone")
        except NoQuadsError as error:
            warnings.append(f"{error}; the holes were filled by geometry alone")
    with stages.stage("judge"):
        if completion and not by_model.all():
            completion = replace(completion.limited_to(by_model, checked.filled), left_out=~by_model)
        completion, filled, faults = without_faults(completion, checked, obstacles)
        of_model = completion.error_model if completion else None
        error_model = of_model or calibration.error_model
        results = assess(holes, _filled_ones(selection, rims), checked.filled, completion, error_model)
        results = verified_results(results, rims, checked, calibration.blend, faults, diagonal(mesh))
    return Repair(filled, rims.chosen, results, calibration.blend, completion, warnings)


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


def _calibrate(mesh: TriangleMesh, rims: JoinedRims, wanted: LoopsToFill, rng: np.random.Generator) -> Calibration:
    """Learn from calibration holes how to fill, and how large an error to expect of that."""
    edge = mean_edge_length(mesh)
    diameters = [hole.diameter for hole in rims.chosen]
    curved = [diameters[i] for i in np.flatnonzero(~wanted.flat)]
    holes = cut_calibration_set(mesh, float(np.median(curved)), edge, rng) if curved else None
    blend, filled = suitable_blend(holes)
    error_model = PRIOR if holes is None or filled is None else expect(holes, filled)
    return Calibration(diameters, edge, blend, error_model, holes, filled)


def suitable_blend(holes: CalibrationSet | None) -> tuple[EnergyBlend, FilledMesh | None]:
    """Learn how this surface is continued best, as far as calibration tells; also the calibration holes, filled."""
    if holes is None:
        return EnergyBlend.of_one(PRIOR_ENERGY), None
    return learn_energy_blend(holes, FAIRING_ENERGIES, DEFAULT_ENERGY)

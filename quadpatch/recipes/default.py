"""The method: a mesh with holes in, a mesh without them out.

The stages are those of Sarkar, Varanasi and Stricker, "Learning Quadrangulated Patches For 3D Shape Processing": holes,
geometric fill, base surface, quads, patches, learning, completion, reconstruction, verdicts.
"""

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, partial

import numpy as np

from quadpatch.calibration.calibration_set import MAX_HOLES, MORE_HOLES, CalibrationSet, cut_calibration_set, expect
from quadpatch.calibration.crease_selection import calibrate_creases
from quadpatch.calibration.error_model import PRIOR
from quadpatch.calibration.kept import KeptCalibrations, array_digest, key_of
from quadpatch.calibration.record import CalibrationRecord
from quadpatch.errors import NoQuadsError
from quadpatch.filling.bridged_rims import join_bridges
from quadpatch.filling.bridges import make_bridges, ribs_of
from quadpatch.filling.checked_fill import LoopsToFill, fill_checked, with_creases
from quadpatch.filling.islands import JoinedRims, join_islands
from quadpatch.filling.parts import FillInParts
from quadpatch.inpainters.inpainter import Inpainter
from quadpatch.mesh.edge_survey import EdgeSurvey
from quadpatch.mesh.holes import Hole, Selection, find_holes, select_holes
from quadpatch.mesh.loops import cut_at, laid_out
from quadpatch.mesh.measures import EdgeStatistics, diagonal, edge_statistics, longest_side
from quadpatch.options import RepairOptions
from quadpatch.patches.scale import choose_scale, coarse_edge_length, preset_scale
from quadpatch.processes import ProcessPool
from quadpatch.progress import Fraction
from quadpatch.recipes.assessment import assess
from quadpatch.recipes.fairing_energies import suitable_blend
from quadpatch.recipes.learned_detail import Calibration, complete
from quadpatch.recipes.repair_region import Reach, RepairRegion, repair_region
from quadpatch.recipes.result import Repair
from quadpatch.recipes.verification import verified_results, with_ribs, without_faults
from quadpatch.stages import Stages
from quadpatch.types import BoolArray, TriangleMesh, Triangles
from quadpatch_rules.coded_warnings import warning
from quadpatch_rules.hole_selection import HoleAction

# Calibration holes are at most so many mean edges wide: wider ones cost more and tell the same.
WIDEST_CALIBRATION = 24.0


def inpaint(  # noqa: PLR0913  what may be known of a scan beforehand goes by name
    mesh: TriangleMesh,
    inpainter: Inpainter | None,
    options: RepairOptions,
    stages: Stages | None = None,
    *,
    obstacles: Triangles | None = None,
    survey: EdgeSurvey | None = None,
    kept: KeptCalibrations | None = None,
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
    survey : EdgeSurvey, optional
        Of the mesh, where that was made before.
    kept : KeptCalibrations, optional
        What earlier repairs found out by calibration; what this one finds out is added.

    Returns
    -------
    Repair

    Raises
    ------
    OptionError
        If the options don't fit the mesh.
    """
    stages = stages or Stages()
    with stages.stage("holes"):
        holes = find_holes(mesh, survey)
        selection = select_holes(holes, options.holes, diagonal(mesh))
        bridges, refused = make_bridges(mesh, holes, selection.bridges)
        ribs = ribs_of(bridges)
        surface = ribs.added_to(mesh)
        bridged = {i for pair in selection.bridges for i in pair}
        rims = join_islands(mesh, holes, selection.chosen, bridged)
        rims = join_bridges(surface, holes, rims, bridges, refused)
        lengths = _with_lengths(options, mesh)
        task = _Task(surface, holes, selection, rims, edge_statistics(mesh), inpainter, lengths, obstacles, kept)
        part = repair_region(surface, rims.loops, task.reach(), obstacles, np.random.default_rng([options.seed, 1]))
    repair = _repair(task, part, stages)
    if not part.holds(repair.filled):
        part = RepairRegion.all_of(surface, len(rims.loops))
        repair = _repair(task, part, stages)
    repair = replace(repair, filled=part.region.widened(repair.filled))
    return with_ribs(repair, rims, ribs, obstacles) if len(ribs.triangles) else repair


@dataclass(frozen=True)
class _Task:
    """What is known of a scan before its holes are filled.

    Attributes
    ----------
    mesh : TriangleMesh
    holes : list of Hole
        All of them, by id.
    selection : Selection
    rims : JoinedRims
        Of the holes to be filled.
    edges : EdgeStatistics
        Of the scan.
    inpainter : Inpainter or None
    options : RepairOptions
    obstacles : (k, 3) int64 or None
        Triangles that the mesh leaves out.
    kept : KeptCalibrations or None
        Of earlier repairs.
    """

    mesh: TriangleMesh
    holes: list[Hole]
    selection: Selection
    rims: JoinedRims
    edges: EdgeStatistics
    inpainter: Inpainter | None
    options: RepairOptions
    obstacles: Triangles | None
    kept: KeptCalibrations | None

    @cached_property
    def by_model(self) -> BoolArray:
        """Rims (n_loops,) that a model may complete."""
        return _with_action(self.rims, self.selection, "model")

    @cached_property
    def wanted(self) -> LoopsToFill:
        """The rims, and how they are to be filled."""
        border = np.array([hole.is_border for hole in self.rims.chosen], bool)
        return LoopsToFill(self.rims.loops, _with_action(self.rims, self.selection, "flat"), border)

    @cached_property
    def closed(self) -> Selection:
        """What is filled and what is not, islands and the far ends of bridges among that."""
        return _filled_ones(self.selection, self.rims)

    @cached_property
    def diameters(self) -> list[float]:
        """Diameters of the rims, or widths of bridges, in mesh units."""
        return self.closed.widths

    def typical_diameter(self) -> float | None:
        """Return the diameter of calibration holes, in mesh units; None where there is nothing to calibrate for."""
        median = self.median_diameter()
        return None if median is None else min(median, WIDEST_CALIBRATION * self.edges.mean)

    def median_diameter(self) -> float | None:
        """Return the median diameter of the holes that are not filled flat, in mesh units; None without any."""
        curved = np.array(self.diameters)[~self.wanted.flat]
        return float(np.median(curved)) if len(curved) else None

    def reach(self) -> Reach:
        """Say how far around the holes this looks."""
        diameter = self.typical_diameter() or 0.0
        if self.inpainter is None or not self.by_model.any():
            return Reach(diameter, 0.0, self.edges)
        scale = choose_scale(self.diameters, self.edges.mean, self.options.patches, self.inpainter.resolution)
        return Reach(diameter, scale.length, self.edges, coarse_edge_length(scale, self.edges.mean))

    def calibration_key(self, kept: KeptCalibrations, diameter: float, part: RepairRegion) -> str:
        """Hash all that calibration in a part of this scan depends on."""
        scan = kept.scan or self._digest()
        # Ribs count as measured: calibration holes may be cut next to them.
        strips = [f"{bridge.holes[0].id}:{bridge.holes[1].id}" for bridge in self.rims.bridges.values() if bridge.ribs]
        median = self.median_diameter() or 0.0
        return key_of(scan, self.options.weld_tolerance, diameter, median, self.options.seed, part.digest(), *strips)

    def _digest(self) -> str:
        """Hash the scan."""
        left_out = [] if self.obstacles is None else [self.obstacles]
        return array_digest(self.mesh.vertices, self.mesh.triangles, *left_out)


def _with_lengths(options: RepairOptions, mesh: TriangleMesh) -> RepairOptions:
    """Write out what a preset of patches stands for on a scan."""
    return replace(options, patches=preset_scale(options.patches, longest_side(mesh)))


def _repair(task: _Task, part: RepairRegion, stages: Stages) -> Repair:
    """Repair the part of a scan that has its holes."""
    region = part.region
    mesh, rims, inpainter, obstacles = region.mesh, task.rims, task.inpainter, region.local_triangles(task.obstacles)
    with stages.stage("fill"):
        local = region.local(np.concatenate(rims.loops)) if rims.loops else np.zeros(0, np.int64)
        wanted = replace(task.wanted, loops=cut_at(local, laid_out(rims.loops)[0]))
        share = _share_of_calibration(task)
        filling = FillInParts(mesh, wanted.curved, stages.pool)
        calibration = _calibrate(task, part, filling, stages.part(0.0, share), stages.pool)
        found = calibration.record
        reach = stages.part(0.0 if calibration.is_reused else share, 1.0)
        checked = fill_checked(mesh, wanted, lambda *_: filling.finish(reach), obstacles, stages.pool)
        checked = with_creases(checked, found.crease_share, obstacles, stages.pool)
    completion, warnings, by_model = None, list[str](), task.by_model
    if inpainter is not None and by_model[checked.filled.vertex_hole].any():
        try:
            copy = part.coarse_copy(task.reach())
            completion = complete(checked.filled, copy, calibration, inpainter, task.options, stages)
            if completion is None:
                warnings.append(warning("too_little_surface"))
        except NoQuadsError as error:
            warnings.append(warning("no_patches", reason=str(error)))
    with stages.stage("judge"):
        if completion and not by_model.all():
            completion = replace(completion.limited_to(by_model, checked.filled), left_out=~by_model)
        completion, filled, faults = without_faults(completion, checked, obstacles, stages.pool)
        of_model = completion.error_model if completion else None
        error_model, size = of_model or found.error_model, diagonal(task.mesh)
        results = assess(task.holes, task.closed, checked.filled, completion, error_model, size)
        results = verified_results(results, rims, checked, found.blend, faults, size)
    return Repair(filled, rims.chosen, results, found.blend, completion, warnings, found, calibration.is_reused)


def _with_action(rims: JoinedRims, selection: Selection, action: HoleAction) -> BoolArray:
    """Tell the rims (n_loops,) whose hole gets some action."""
    return np.array([selection.actions.get(hole.id, "model") == action for hole in rims.chosen], bool)


def _filled_ones(selection: Selection, rims: JoinedRims) -> Selection:
    """Count islands and the far ends of bridges among the holes without a fill of their own."""
    far_ends = [bridge.holes[1].id for bridge in rims.bridges.values()]
    joined = dict.fromkeys([*rims.host_of, *far_ends, *rims.refused], ("joined", ""))
    widths = {first: bridge.width for first, bridge in rims.bridges.items()}
    return replace(selection, chosen=rims.chosen, skipped={**selection.skipped, **joined}, bridge_widths=widths)


def _share_of_calibration(task: _Task) -> float:
    """Estimate the share of the work of filling that calibration is: its holes are like the real ones."""
    n_calibration = 0 if task.typical_diameter() is None else MAX_HOLES
    return n_calibration / max(n_calibration + len(task.rims.loops), 1)


def _calibrate(
    task: _Task, part: RepairRegion, filling: FillInParts, reach: Fraction, pool: ProcessPool
) -> Calibration:
    """Calibrate, or take what an earlier repair of the same scan has found out; begin to fill once that is known."""
    diameter, edge, kept = task.typical_diameter(), task.edges.mean, task.kept
    cut = partial(_cut, part.region.mesh, diameter, edge, task.options.seed)
    if kept is None or diameter is None:
        return _calibrated(task, cut, filling, reach, pool)
    key = task.calibration_key(kept, diameter, part)
    record = kept.find(key)
    if record is not None:
        # Only models are tried on calibration holes again.
        holes = cut() if record.n_holes and task.inpainter is not None and task.by_model.any() else None
        if holes is None or len(holes.loops) == record.n_holes:
            filling.begin(record.blend.fill_closed)
            return Calibration(task.diameters, edge, record, holes, partial(cut, MORE_HOLES), is_reused=True)
    calibration = _calibrated(task, cut, filling, reach, pool)
    kept.add(key, calibration.record)
    return calibration


def _cut(
    mesh: TriangleMesh, diameter: float | None, edge: float, seed: int, most: int = MAX_HOLES
) -> CalibrationSet | None:
    return None if diameter is None else cut_calibration_set(mesh, diameter, edge, np.random.default_rng(seed), most)


def _calibrated(
    task: _Task,
    cut: Callable[..., CalibrationSet | None],
    filling: FillInParts,
    reach: Fraction,
    pool: ProcessPool,
) -> Calibration:
    """Learn from calibration holes how to fill, and how large an error to expect of that."""
    start, edge = time.perf_counter(), task.edges.mean
    holes = cut()
    blend, filled = suitable_blend(holes, task.median_diameter(), reach, pool)
    filling.begin(blend.fill_closed)
    if holes is None or filled is None:
        return Calibration(task.diameters, edge, CalibrationRecord(blend, PRIOR, seconds=time.perf_counter() - start))
    creases = calibrate_creases(holes, blend, filled)
    model = expect(holes, creases.filled or filled)
    seconds = time.perf_counter() - start
    record = CalibrationRecord(blend, model, creases.share, holes.is_graded, filled.energy_weights, seconds)
    # A graded fill is denser once models are tried on it.
    uniform = creases.filled or (None if holes.is_graded else filled)
    return Calibration(task.diameters, edge, record, holes, partial(cut, MORE_HOLES), uniform)

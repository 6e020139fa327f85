"""From file to file: what the command line and the worker's engine call."""

from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from quadpatch.calibration.kept import KeptCalibrations
from quadpatch.coloured_fill import colour_fill
from quadpatch.errors import EmptyMeshError, OptionError
from quadpatch.filling.bridge_proposals import propose_bridges
from quadpatch.filling.islands import hosts_of
from quadpatch.formats.marks import NUMBERED
from quadpatch.formats.precision import check_precision
from quadpatch.formats.reading import read_scan
from quadpatch.formats.scan import Fill, Scan
from quadpatch.formats.units import in_unit
from quadpatch.formats.writing import check_suffix, write_scan, written_as
from quadpatch.inpainters.inpainter import Inpainter
from quadpatch.mesh.holes import find_holes
from quadpatch.mesh.measures import diagonal
from quadpatch.mesh.near_vertices import Tolerance
from quadpatch.mesh.orientation import triangles_facing_flipped
from quadpatch.mesh.weld import Weld, weld
from quadpatch.model_choice import SELF, choose_model, sha256_of
from quadpatch.options import RepairOptions, check_weld_tolerance
from quadpatch.processes import ProcessPool
from quadpatch.progress import Progress, no_progress
from quadpatch.recipes.default import inpaint
from quadpatch.recipes.result import Repair
from quadpatch.report import (
    UNKNOWN_UNIT,
    build_report,
    describe_hole,
    describe_mesh,
    describe_redundancy,
    json_ready,
    number_holes,
)
from quadpatch.stages import Stages, harmless
from quadpatch.textured_fill import texture_fill
from quadpatch_rules.coded_warnings import described, warning
from quadpatch_rules.hole_selection import Choice, choose_holes, join_islands
from quadpatch_rules.option_words import LengthUnit

# Formats whose lengths have a unit by definition, or by the default that our writer leaves standing.
IMPLIED_UNITS = {".glb": "meter", ".gltf": "meter", ".3mf": "millimeter"}

# Areas and their squares vanish in float64 for a mesh smaller than this, in mesh units.
LEAST_DIAGONAL = 1e-60


@dataclass(frozen=True)
class RepairedFile:
    """A repair whose mesh has been written.

    Attributes
    ----------
    report : dict
        JSON-ready. Optional steps that follow add their warnings and seconds to it.
    repair : Repair
    """

    report: dict[str, Any]
    repair: Repair


def repair_file(
    source: Path,
    output: Path,
    model: str | Path | None = None,
    options: RepairOptions | None = None,
    progress: Progress = no_progress,
) -> dict[str, Any]:
    """Repair one file.

    Parameters
    ----------
    source, output : Path
        The output's suffix says its format; standard output (`-`), a device or a pipe gets that of the scan.
    model : str or Path, optional
        See `quadpatch.model_choice.choose_model`.
    options : RepairOptions, optional
    progress : callable

    Returns
    -------
    dict
        The report, JSON-ready.

    Raises
    ------
    QuadpatchError
        Its `code` says what is wrong with file, model or options.
    OSError
        If the output can't be written.
    """
    return repair_and_keep(source, output, model, options, progress).report


def repair_and_keep(  # noqa: PLR0913, PLR0917  the same arguments as every task's, and what is kept
    source: Path,
    output: Path,
    model: str | Path | None = None,
    options: RepairOptions | None = None,
    progress: Progress = no_progress,
    network_card: dict[str, Any] | None = None,
    kept: KeptCalibrations | None = None,
    pool: ProcessPool | None = None,
    learn_from: Path | None = None,
) -> RepairedFile:
    """Repair one file and keep what pictures of it are drawn from; see `repair_file`.

    A network that was published without a card in its file goes by `network_card`. What calibration found out in
    earlier repairs of the scan is taken from `kept`, and what this one finds out is added to it. The processes of a
    pool share the work; the result is the same without. The model `self` learns its dictionary from the mesh of
    `learn_from`, in the same unit of length, where that is given.
    """
    options = options or RepairOptions()
    check_suffix(output)
    progress = harmless(progress)
    stages = Stages(progress, pool or ProcessPool())
    if learn_from is None:
        inpainter, card = choose_model(model, options, progress, network_card)
    else:
        inpainter, card = _learn_from(learn_from, model, options)
    with stages.stage("read"):
        scan, welded = read_surface(source, options.weld_tolerance, options.length_unit)
        named = written_as(output, scan)
        precision = check_precision(scan, named)
    repair = _inpaint(welded, inpainter, options, stages, kept)
    coloured = colour_fill(scan, welded, repair.filled, named, options, stages)
    fill = replace(_fill(scan, welded, repair), vertex_colours=coloured.colours)
    textured = texture_fill(scan, welded, repair.filled, fill, output, options, stages)
    with stages.stage("write"):
        losses = write_scan(output, scan, replace(fill, page=textured.page), options.attributes)
    warnings = [
        *repair.warnings,
        *coloured.warnings,
        *textured.warnings,
        *describe_redundancy(welded.counts),
        *precision,
        *losses,
        *_unit_warnings(scan, named),
    ]
    repair = replace(repair, warnings=warnings)
    report = build_report(scan, welded, repair, options, card, stages)
    report["colours"], report["texture"] = coloured.described(), textured.report
    number_holes(report, scan.next_hole_id if named.suffix.lower() in NUMBERED else None)
    return RepairedFile(report, repair)


def inspect_file(source: Path, weld_tolerance: Tolerance = "auto") -> dict[str, Any]:
    """Facts and holes of a file, JSON-ready; `chosen` says what the automatic rule would fill.

    The holes are those that a repair with the same tolerance finds. `lies_in` names the holes that a loop lies in as
    the border of an island: where one of them is filled, the island is joined to the first that is. `bridges` are
    pairs of loops that face each other, which a repair joins only where it is asked to.
    """
    check_weld_tolerance(weld_tolerance)
    scan, welded = read_surface(source, weld_tolerance)
    mesh = welded.mesh
    holes = find_holes(mesh, welded.survey)
    hosts = hosts_of(mesh, holes, [hole for hole in holes if hole.is_manifold])
    lies_in = [hosts.get(hole.id, []) for hole in holes]
    choices = join_islands(lies_in, choose_holes(holes, RepairOptions().holes, diagonal(mesh)))
    facts: dict[str, Any] = json_ready(
        {
            **describe_mesh(scan, mesh),
            "length_unit": scan.unit or UNKNOWN_UNIT,
            "welded": asdict(welded.counts),
            **described(describe_redundancy(welded.counts)),
            "holes": [
                {
                    **describe_hole(hole),
                    "chosen": choice.action is not None,
                    "action": choice.action,
                    "lies_in": hosts.get(hole.id, []),
                    "reason": _reason(choice),
                }
                for hole, choice in zip(holes, choices, strict=True)
            ],
            "bridges": [asdict(proposal) for proposal in propose_bridges(mesh, holes, hosts)],
        }
    )
    return facts


def _reason(choice: Choice) -> str | None:
    return choice.reason if choice.joined_to is None else f"joined to hole {choice.joined_to}, in which it lies"


def read_surface(source: Path, weld_tolerance: Tolerance = "auto", unit: LengthUnit | None = None) -> tuple[Scan, Weld]:
    """Read a file and make one surface of it; `unit` declares that of a file that states none.

    Raises
    ------
    MeshError
        If the file can't be read, or holds no surface.
    OptionError
        If the file states another unit.
    """
    scan = in_unit(read_scan(source), unit)
    welded = weld(scan.vertices, scan.triangles, weld_tolerance)
    if not len(welded.mesh.triangles):
        raise EmptyMeshError(f"none of the {len(scan.triangles)} faces has three different corners")
    if not diagonal(welded.mesh) > LEAST_DIAGONAL:
        raise EmptyMeshError(f"the mesh is only {diagonal(welded.mesh):.3g} wide; that is no surface in float64")
    return scan, welded


def _unit_warnings(scan: Scan, output: Path) -> list[str]:
    """Say when the output's format gives the numbers a unit that the input did not state."""
    implied = IMPLIED_UNITS.get(output.suffix.lower())
    if implied is None or scan.unit is not None:
        return []
    return [warning("unit_implied", suffix=output.suffix, unit=implied)]


def _learn_from(reference: Path, model: str | Path | None, options: RepairOptions) -> tuple[Inpainter, dict[str, Any]]:
    """Learn a dictionary from another mesh."""
    if model not in (None, SELF) or options.recipe != "default":
        raise OptionError(f"learn_from goes with the model {SELF} and the recipe default")
    from quadpatch.inpainters.reference_dictionary import ReferenceDictionary  # noqa: PLC0415  few repairs need it

    mesh = read_surface(reference)[1].mesh  # which knows limits: the bytes are hashed after that
    return ReferenceDictionary(mesh, options.seed), {"name": SELF, "learned_from": sha256_of(reference)}


def _inpaint(
    welded: Weld, inpainter: Inpainter | None, options: RepairOptions, stages: Stages, kept: KeptCalibrations | None
) -> Repair:
    obstacles = welded.ignored_triangles
    if inpainter is None or options.recipe == "default":
        return inpaint(welded.mesh, inpainter, options, stages, obstacles=obstacles, survey=welded.survey, kept=kept)
    from quadpatch.recipes.paper import inpaint_as_paper  # noqa: PLC0415  the other recipe does without it

    return inpaint_as_paper(welded.mesh, inpainter, options, stages, obstacles=obstacles)


def _fill(scan: Scan, welded: Weld, repair: Repair) -> Fill:
    """Put the invented part of a repair into the file's own vertex numbers, and its holes behind those marked there.

    A hole whose rim was flipped for the repair is turned back with it.
    """
    filled = repair.filled
    new = filled.new_triangles
    flipped = triangles_facing_flipped(new, filled.triangle_hole, welded.mesh.triangles[welded.is_flipped])
    ids = np.array([hole.id for hole in repair.chosen], np.int64)
    confidence = np.array([repair.results[i].confidence or 0.0 for i in ids.tolist()])
    n_new = len(filled.vertex_hole)
    to_file = np.concatenate([welded.to_file, len(scan.vertices) + np.arange(n_new)])
    return Fill(
        filled.new_vertices,
        to_file[np.where(flipped[:, np.newaxis], new[:, ::-1], new)],
        scan.next_hole_id + ids[filled.vertex_hole],
        confidence[filled.vertex_hole],
        scan.next_hole_id + ids[filled.triangle_hole],
        confidence[filled.triangle_hole],
    )

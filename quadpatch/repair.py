"""From file to file: what the command line and the worker's engine call."""

import hashlib
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from quadpatch.errors import EmptyMeshError, OptionError, TorchMissingError
from quadpatch.filling.islands import hosts_of
from quadpatch.formats.marks import NUMBERED
from quadpatch.formats.precision import check_precision
from quadpatch.formats.reading import read_scan
from quadpatch.formats.scan import Fill, Scan
from quadpatch.formats.writing import check_suffix, write_scan, written_as
from quadpatch.inpainters.dictionary import DictionaryInpainter, SelfDictionary
from quadpatch.inpainters.inpainter import Inpainter
from quadpatch.inpainters.model_file import Model, load_model, shipped_model
from quadpatch.inpainters.paper_dictionary import HeightsInpainter, SelfHeights
from quadpatch.mesh.holes import find_holes
from quadpatch.mesh.measures import diagonal
from quadpatch.mesh.near_vertices import Tolerance
from quadpatch.mesh.orientation import triangles_facing_flipped
from quadpatch.mesh.weld import Weld, weld
from quadpatch.options import DictionaryOptions, NetworkOptions, RepairOptions, check_weld_tolerance
from quadpatch.recipes.default import inpaint
from quadpatch.recipes.paper import inpaint_as_paper
from quadpatch.recipes.result import Repair
from quadpatch.report import (
    UNKNOWN_UNIT,
    build_report,
    describe_hole,
    describe_mesh,
    describe_redundancy,
    json_ready,
    with_hole_numbers,
)
from quadpatch.stages import Stages, harmless
from quadpatch.types import Progress, no_progress
from shared_rules.hole_selection import Choice, choose_holes, join_islands

SMOOTH = "smooth"
SELF = "self"
SELF_NETWORK = "self-network"
# The same, as a job names the kind of its model.
SELF_NETWORK_KIND = "self_network"

# The network that is fitted to a mesh where `SELF_NETWORK` is asked for.
BASE_NETWORK = "general-residual"

NOTHING_TO_DO = (
    "the recipe paper is a way to use a learned model; with smooth there is none: drop the recipe or take self"
)

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
    model: str | Path = SELF,
    options: RepairOptions | None = None,
    progress: Progress = no_progress,
) -> dict[str, Any]:
    """Repair one file.

    Parameters
    ----------
    source, output : Path
        The output's suffix says its format; standard output (`-`), a device or a pipe gets that of the scan.
    model : str or Path
        `smooth` (no learning), `self` (learn a dictionary from the mesh itself), `self-network` (fit the shipped
        network to the mesh itself), the name of a shipped model (`name` or `name@version`), or a model file.
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


def repair_and_keep(
    source: Path,
    output: Path,
    model: str | Path = SELF,
    options: RepairOptions | None = None,
    progress: Progress = no_progress,
    network_card: dict[str, Any] | None = None,
) -> RepairedFile:
    """Repair one file and keep what pictures of it are drawn from; see `repair_file`.

    A network that was published without a card in its file goes by `network_card`.
    """
    options = options or RepairOptions()
    check_suffix(output)
    progress = harmless(progress)
    stages = Stages(progress)
    inpainter, card = _resolve(model, options, progress, network_card)
    with stages.stage("read"):
        scan, welded = _read(source, options.weld_tolerance)
        named = written_as(output, scan)
        precision = check_precision(scan, named)
    repair = _inpaint(welded, inpainter, options, stages)
    with stages.stage("write"):
        losses = write_scan(output, scan, _fill(scan, welded, repair))
    warnings = [
        *repair.warnings,
        *describe_redundancy(welded.counts),
        *precision,
        *losses,
        *_unit_warnings(scan, named),
    ]
    repair = replace(repair, warnings=warnings)
    report = build_report(scan, welded, repair, options, card, stages)
    report = with_hole_numbers(report, scan.next_hole_id if named.suffix.lower() in NUMBERED else None)
    return RepairedFile(report, repair)


def inspect_file(source: Path, weld_tolerance: Tolerance = "auto") -> dict[str, Any]:
    """Facts and holes of a file, JSON-ready; `chosen` says what the automatic rule would fill.

    The holes are those that a repair with the same tolerance finds. `lies_in` names the holes that a loop lies in as
    the border of an island: where one of them is filled, the island is joined to the first that is.
    """
    check_weld_tolerance(weld_tolerance)
    scan, welded = _read(source, weld_tolerance)
    mesh = welded.mesh
    holes = find_holes(mesh)
    hosts = hosts_of(mesh, holes, [hole for hole in holes if hole.is_manifold])
    lies_in = [hosts.get(hole.id, []) for hole in holes]
    choices = join_islands(lies_in, choose_holes(holes, RepairOptions().holes, diagonal(mesh)))
    facts: dict[str, Any] = json_ready(
        {
            **describe_mesh(scan, mesh),
            "length_unit": scan.unit or UNKNOWN_UNIT,
            "welded": asdict(welded.counts),
            "warnings": describe_redundancy(welded.counts),
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
        }
    )
    return facts


def _reason(choice: Choice) -> str | None:
    return choice.reason if choice.joined_to is None else f"joined to hole {choice.joined_to}, in which it lies"


def _read(source: Path, weld_tolerance: Tolerance) -> tuple[Scan, Weld]:
    scan = read_scan(source)
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
    return [f"the scan states no length unit, and {output.suffix} always means {implied}: the numbers are unchanged"]


def _resolve(
    model: str | Path, options: RepairOptions, progress: Progress, network_card: dict[str, Any] | None
) -> tuple[Inpainter | None, dict[str, Any]]:
    """Turn a model's name or path into its inpainter, and what the report says of it."""
    if model == SMOOTH and options.recipe == "paper":
        raise OptionError(NOTHING_TO_DO)
    if model in (SELF_NETWORK, SELF_NETWORK_KIND):
        return _network_to_fit(options, progress)
    if options.network != NetworkOptions():
        raise OptionError(f"network.steps and network.seconds go with the model {SELF_NETWORK} only")
    if model == SMOOTH:
        return None, {"name": SMOOTH}
    if model == SELF:
        is_paper = options.recipe == "paper"
        learned = SelfHeights(options.dictionary, options.seed, progress) if is_paper else SelfDictionary()
        return learned, {"name": SELF}
    path = Path(model)
    if not path.is_file():
        path = shipped_model(str(model))
    loaded = load_model(path)
    facts = {"name": loaded.card.get("name", path.stem), "version": loaded.card.get("version"), "kind": loaded.kind}
    facts["sha256"] = hashlib.sha256(path.read_bytes()).hexdigest()
    if loaded.dictionary is None:
        return _network(path, options, network_card), facts
    _check_recipe(loaded, options)
    inpainter = HeightsInpainter if loaded.recipe == "paper" else DictionaryInpainter
    return inpainter(loaded.dictionary), facts


def _inpaint(welded: Weld, inpainter: Inpainter | None, options: RepairOptions, stages: Stages) -> Repair:
    if inpainter is None or options.recipe == "default":
        return inpaint(welded.mesh, inpainter, options, stages, obstacles=welded.ignored_triangles)
    return inpaint_as_paper(welded.mesh, inpainter, options, stages, obstacles=welded.ignored_triangles)


def _network(path: Path, options: RepairOptions, card: dict[str, Any] | None) -> Inpainter:
    """Open a network. Those of the paper are used by either recipe, others by our own alone."""
    from quadpatch.inpainters.onnx_network import AutoencoderInpainter  # noqa: PLC0415  onnxruntime is slow to load

    network = AutoencoderInpainter.load(path, card)
    if options.recipe == "paper" and network.recipe != "paper":
        raise OptionError(
            f"{path.name} is a network for the recipe {network.recipe}, which corrects a faired fill; "
            "the recipe paper has none: drop it, or take one of the paper's networks"
        )
    if options.dictionary != DictionaryOptions():
        raise OptionError(f"dictionary.atoms and dictionary.nonzero go with the model self; {path.name} is a network")
    return network


def _network_to_fit(options: RepairOptions, progress: Progress) -> tuple[Inpainter, dict[str, Any]]:
    """Open the shipped network for training."""
    if options.recipe == "paper":
        raise OptionError(f"the recipe paper goes with dictionaries; {SELF_NETWORK} has a recipe of its own")
    path = shipped_model(BASE_NETWORK)
    try:
        from quadpatch.networks.fitting import FittingInpainter  # noqa: PLC0415  an extra, and slow to load
        from quadpatch.networks.weights import load_residual  # noqa: PLC0415
    except ModuleNotFoundError as error:
        raise TorchMissingError(
            f"fitting a network to a mesh needs {error.name}, which is not installed here: "
            f"install the extra 'networks', or take a model that is ready, such as {BASE_NETWORK}"
        ) from error
    return FittingInpainter(load_residual(path), options.network, options.seed, progress), {
        "name": SELF_NETWORK,
        "fitted_from": path.stem,
    }


def _check_recipe(model: Model, options: RepairOptions) -> None:
    """Refuse a dictionary that was learned for the other recipe, and a size for one that has a size."""
    name = model.path.name
    if model.recipe != options.recipe:
        raise OptionError(
            f"{name} was learned for the recipe {model.recipe}, not for {options.recipe}: "
            f"ask for the recipe {model.recipe}, or take the model self"
        )
    if options.dictionary != DictionaryOptions():
        raise OptionError(f"dictionary.atoms and dictionary.nonzero go with the model self; {name} has its own")


def _fill(scan: Scan, welded: Weld, repair: Repair) -> Fill:
    """Put the invented part of a repair into the file's own vertex numbers, and its holes behind those marked there.

    A hole whose rim was flipped for the repair is turned back with it.
    """
    filled = repair.filled
    new = filled.mesh.triangles[filled.n_measured_triangles :]
    flipped = triangles_facing_flipped(new, filled.triangle_hole, welded.mesh.triangles[welded.is_flipped])
    ids = np.array([hole.id for hole in repair.chosen], np.int64)
    confidence = np.array([repair.results[i].confidence or 0.0 for i in ids.tolist()])
    n_new = len(filled.vertex_hole)
    to_file = np.concatenate([welded.to_file, len(scan.vertices) + np.arange(n_new)])
    return Fill(
        filled.mesh.vertices[filled.n_measured_vertices :],
        to_file[np.where(flipped[:, np.newaxis], new[:, ::-1], new)],
        scan.next_hole_id + ids[filled.vertex_hole],
        confidence[filled.vertex_hole],
        scan.next_hole_id + ids[filled.triangle_hole],
        confidence[filled.triangle_hole],
    )

"""Denoising from file to file: what the command line and the worker's engine call."""

from dataclasses import asdict
from pathlib import Path
from typing import Any, cast

import numpy as np

from quadpatch.denoising.denoise import Denoised, PatchModel, denoise
from quadpatch.denoising.options import DenoiseOptions
from quadpatch.errors import OptionError
from quadpatch.formats.moving import write_moved
from quadpatch.formats.output_files import is_stream
from quadpatch.formats.reading import read_scan
from quadpatch.formats.scan import Moved, Scan
from quadpatch.formats.vertex_properties import vertex_mask
from quadpatch.formats.writing import check_suffix, written_as
from quadpatch.mesh.normals import length
from quadpatch.mesh.weld import Weld
from quadpatch.model_choice import SELF, SMOOTH, find_model, sha256_of
from quadpatch.progress import Progress, no_progress
from quadpatch.repair import read_surface
from quadpatch.report import describe_redundancy, describe_task, json_ready
from quadpatch.stages import Stages, harmless
from quadpatch.tasks.result import TaskResult
from quadpatch.types import BoolArray, FloatArray, TriangleMesh
from quadpatch_rules.coded_warnings import described, warning

# The vertex property that says how far each vertex moved.
SHIFT = "shift"
# Folds that a report names.
_MOST_FOLDS = 20


def denoise_file(
    source: Path,
    output: Path,
    model: str | Path = SELF,
    options: DenoiseOptions | None = None,
    progress: Progress = no_progress,
    reference: Path | None = None,
) -> TaskResult:
    """Take noise from the vertices of one file; their order, triangles and attributes stay.

    Parameters
    ----------
    source, output : Path
        The output's suffix says its format; a stream gets that of the scan. A PLY gets the vertex property `shift`.
    model : str or Path
        `self` (learn from the mesh itself, or from the reference), `smooth` (no patches), the name of a shipped
        dictionary or a dictionary file.
    options : DenoiseOptions, optional
    progress : callable
    reference : Path, optional
        A clean scan of a similar object, in the same unit of length.

    Returns
    -------
    TaskResult

    Raises
    ------
    QuadpatchError
        Its `code` says what is wrong with file, model or options.
    OSError
        If the output can't be written.
    """
    options = options or DenoiseOptions()
    check_suffix(output)
    stages = Stages(harmless(progress))
    with stages.stage("read"):
        patch_model, card = _choose_model(model, reference)
        # Vertices at equal positions are one, or the triangles of an STL would move apart.
        scan, welded = read_surface(source, 0, options.length_unit)
        movable = _movable(scan, welded, options)
    denoised = denoise(welded.mesh, options, patch_model, movable, stages)
    moved = Moved(denoised.vertices[welded.from_file], {SHIFT: denoised.shift[welded.from_file].astype(np.float32)})
    with stages.stage("write"):
        losses = write_moved(output, scan, moved)
    warnings = [*denoised.warnings, *describe_redundancy(welded.counts), *losses]
    warnings += _beyond_bound(output, scan, denoised.max_shift)
    report = _report(scan, welded, denoised, options, card, stages)
    return _result(scan, moved, denoised, {**report, **described(warnings)})


def _choose_model(model: str | Path, reference: Path | None) -> tuple[PatchModel, dict[str, Any]]:
    """Tell what patches are coded over, and what the report says of it."""
    if reference is not None:
        if model != SELF:
            raise OptionError(f"a reference takes the place of a model; drop it, or the model {str(model)[:80]}")
        mesh = read_surface(reference, 0)[1].mesh  # which knows limits: the bytes are hashed after that
        return PatchModel("reference", mesh), {"name": "reference", "sha256": sha256_of(reference)}
    if model in (SELF, SMOOTH):
        return PatchModel("self" if model == SELF else "none"), {"name": str(model)}
    loaded, facts = find_model(model)
    if loaded.dictionary is None:
        raise OptionError(f"{loaded.path.name} is a network that completes holes; denoising takes a dictionary")
    return PatchModel("dictionary", None, loaded.dictionary, loaded.recipe == "paper"), facts


def _movable(scan: Scan, welded: Weld, options: DenoiseOptions) -> BoolArray | None:
    """Welded vertices (n,) that a property of the file allows to move: those that it allows in all their copies."""
    if not isinstance(options.region, str):
        return None
    movable = np.ones(len(welded.mesh.vertices), bool)
    np.logical_and.at(movable, welded.from_file, vertex_mask(scan, options.region))
    return movable


def _beyond_bound(output: Path, scan: Scan, max_shift: float) -> list[str]:
    """Read again what was written in the scan's own format, whose numbers may be coarse."""
    if is_stream(output) or written_as(output, scan).suffix.lower() != f".{scan.format}":
        return []
    stored = read_scan(output).vertices
    if stored.shape != scan.vertices.shape:
        return []
    shift = length(stored - scan.vertices)
    n_beyond = int((shift > max_shift).sum())
    if not n_beyond:
        return []
    excess = shift.max() - max_shift
    return [warning("beyond_max_shift", vertices=n_beyond, excess=excess)]


def _report(
    scan: Scan, welded: Weld, denoised: Denoised, options: DenoiseOptions, card: dict[str, Any], stages: Stages
) -> dict[str, Any]:
    shift, scale, folds = denoised.shift[welded.from_file], denoised.scale, denoised.unfolded
    moved = shift[shift > 0]
    patches = None if scale is None else {**asdict(scale), "count": denoised.n_patches}
    return {
        **describe_task("denoise", scan, welded.mesh, card, options, stages),
        "welded": asdict(welded.counts),
        "noise": denoised.noise,
        "noise_estimated": options.noise is None,
        "max_shift": denoised.max_shift,
        "moved_vertices": len(moved),
        # Of the vertices that moved.
        "shift_mean": float(moved.mean()) if len(moved) else 0.0,
        "shift_95": float(np.percentile(moved, 95)) if len(moved) else 0.0,
        "shift_max": float(shift.max(initial=0.0)),
        "vertices_at_bound": int(denoised.at_bound[welded.from_file].sum()),
        "turned_triangles": denoised.n_turned,
        "folds": {"before": folds.n_before, "undone": folds.n_undone, "left": folds.left[:_MOST_FOLDS]},
        "shares": denoised.shares,
        "patches": patches,
    }


def _result(scan: Scan, moved: Moved, denoised: Denoised, report: dict[str, Any]) -> TaskResult:
    shift: FloatArray = moved.properties[SHIFT].astype(np.float64)[scan.triangles].mean(axis=1)
    relative = np.clip(shift / denoised.max_shift, 0.0, 1.0) if denoised.max_shift else np.zeros_like(shift)
    before, after = (TriangleMesh(vertices, scan.triangles) for vertices in (scan.vertices, moved.vertices))
    return TaskResult(cast(dict[str, Any], json_ready(report)), before, after, shift > 0, relative)

"""Restores the missing vertices of a mesh file: file in, file out."""

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quadpatch.errors import EmptyMeshError, OptionError
from quadpatch.formats.moving import write_moved
from quadpatch.formats.reading import read_scan
from quadpatch.formats.scan import Moved, Scan
from quadpatch.formats.units import in_unit
from quadpatch.formats.writing import check_suffix
from quadpatch.mesh.weld import Weld, weld
from quadpatch.model_choice import SELF, SELF_NETWORK, SELF_NETWORK_KIND, choose_model
from quadpatch.options import RepairOptions
from quadpatch.progress import Progress, no_progress
from quadpatch.report import describe_task, json_ready
from quadpatch.restoration.restore import Restoration, RestoreOptions, restore
from quadpatch.stages import Stages, harmless
from quadpatch.tasks.missing_vertices import NAN, missing_vertices
from quadpatch.tasks.result import TaskResult
from quadpatch.types import BoolArray, FloatArray, TriangleMesh, Vertices
from quadpatch_rules.coded_warnings import described, warning

RESTORED = "restored"
EXPECTED_ERROR = "expected_error"


def restore_file(  # noqa: PLR0913, PLR0917  the same arguments as every task's
    source: Path,
    output: Path,
    missing: str | Path = NAN,
    model: str | Path = SELF,
    options: RestoreOptions | None = None,
    progress: Progress = no_progress,
    network_card: dict[str, Any] | None = None,
    *,
    coarse: Path | None = None,
) -> TaskResult:
    """Restore the missing vertices of one file.

    Parameters
    ----------
    source, output : Path
        The output's suffix says its format. Everything but the missing vertices stays as it was, bit for bit, in the
        file's own format; PLY gets the vertex properties `restored` (0 or 1) and `expected_error` (in mesh units).
    missing : str or Path
        See `quadpatch.tasks.missing_vertices`.
    model : str or Path
        See `quadpatch.model_choice.choose_model`; a network can't be fitted to a mesh with missing vertices.
    options : RestoreOptions, optional
    progress : callable
    network_card : dict, optional
        Of a network that was published without a card in its file.
    coarse : Path, optional
        A coarse mesh of the same object in the same place.

    Returns
    -------
    TaskResult
        `before` has the triangles whose corners were all measured.

    Raises
    ------
    QuadpatchError
        Its `code` says what is wrong with file, list, model or options.
    OSError
        If the output can't be written.
    """
    options = options or RestoreOptions()
    check_suffix(output)
    if model in (SELF_NETWORK, SELF_NETWORK_KIND):
        raise OptionError("missing vertices are restored by dictionaries, and by networks that need no fitting")
    progress = harmless(progress)
    stages = Stages(progress)
    repair_options = RepairOptions(patches=options.patches, seed=options.seed)
    inpainter, card = choose_model(model, repair_options, progress, network_card)
    with stages.stage("read"):
        scan = in_unit(read_scan(source, allow_missing=True), options.length_unit)
        is_missing = missing_vertices(scan, missing)
        welded = _welded(scan, is_missing)
        surface = None if coarse is None else _surface(coarse)
    result = restore(welded.mesh, is_missing[welded.to_file], inpainter, options, stages, surface)
    moved, restored = _moved(scan, is_missing, welded, result)
    after = TriangleMesh(
        result.vertices, welded.mesh.triangles[~result.out_of_reach[welded.mesh.triangles].any(axis=1)]
    )
    with stages.stage("write"):
        warnings = [*result.warnings, *write_moved(output, scan, moved)]
    left = int((is_missing & ~restored).sum())
    if left:
        warnings.append(warning("vertices_unreachable", left=left))
    report = {
        **describe_task("restore", scan, after, card, options, stages),
        "vertices": {"missing": int(is_missing.sum()), "restored": int(restored.sum()), "left": left},
        **_measures(result),
        **described(warnings),
    }
    changed = np.asarray(result.restored[after.triangles].any(axis=1))
    return TaskResult(json_ready(report), TriangleMesh(after.vertices, after.triangles[~changed]), after, changed)


def _welded(scan: Scan, is_missing: BoolArray) -> Weld:
    """Weld the measured vertices of a scan; those that are missing stay apart, whatever stands in their place."""
    measured = scan.vertices[~is_missing]
    width = float(np.ptp(measured, axis=0).max()) or 1.0
    apart: Vertices = np.array(np.where(is_missing[:, None], measured.max(axis=0) + width, scan.vertices))
    n_missing = int(is_missing.sum())
    apart[is_missing, 0] += width * np.arange(1, n_missing + 1) / n_missing
    welded = weld(apart, scan.triangles)
    if not len(welded.mesh.triangles):
        raise EmptyMeshError(f"none of the {len(scan.triangles)} faces has three different corners")
    return welded


def _surface(coarse: Path) -> TriangleMesh:
    scan = read_scan(coarse)
    return TriangleMesh(scan.vertices, scan.triangles)


def _moved(scan: Scan, is_missing: BoolArray, welded: Weld, result: Restoration) -> tuple[Moved, BoolArray]:
    """Put what was restored into the file's own vertices; and which of these were restored."""
    restored = is_missing & result.restored[welded.from_file]
    vertices = np.where(restored[:, None], result.vertices[welded.from_file], scan.vertices)
    expected = np.where(restored, result.expected_error[welded.from_file], 0.0)
    properties: dict[str, NDArray[Any]] = {
        RESTORED: restored.astype(np.uint8),
        EXPECTED_ERROR: expected.astype(np.float32),
    }
    return Moved(vertices, properties), restored


def _measures(result: Restoration) -> dict[str, Any]:
    detail = result.detail
    return {
        "placement": result.placement,
        "hidden_vertices": {"count": result.n_hidden, "rms_error": result.trials},
        "patches": None
        if detail is None
        else {
            "length": detail.scale.length,
            "resolution": detail.scale.resolution,
            "overlap": detail.scale.overlap,
            "count": detail.n_patches,
            "believed_share": result.blend_factor,
        },
        "expected_error": _spread(result.expected_error[result.restored]),
    }


def _spread(errors: FloatArray) -> dict[str, float]:
    median, high = np.percentile(errors, [50, 95])
    return {"rms": float(np.sqrt((errors**2).mean())), "median": float(median), "percentile_95": float(high)}

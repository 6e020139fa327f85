"""Rebuilds a mesh file from the codes of its patches: file in, file out."""

from pathlib import Path
from typing import Any

import numpy as np

from quadpatch.errors import OptionError
from quadpatch.formats.moving import write_moved
from quadpatch.formats.scan import Moved
from quadpatch.formats.writing import check_suffix
from quadpatch.model_choice import SELF, find_model, length_share
from quadpatch.options import DictionaryOptions
from quadpatch.patches.normalisation import HEIGHTS, NORMALISATION
from quadpatch.progress import Progress, no_progress
from quadpatch.reconstruction.coding import PatchDictionary
from quadpatch.reconstruction.whole_surface import Reconstruction, ReconstructOptions, reconstruct
from quadpatch.repair import read_surface
from quadpatch.report import describe_redundancy, describe_task, json_ready
from quadpatch.stages import Stages, harmless
from quadpatch.tasks.result import TaskResult
from quadpatch.types import TriangleMesh
from quadpatch_rules.coded_warnings import described, warning

ERROR = "reconstruction_error"
OVERLAP = "overlap"


def reconstruct_file(
    source: Path,
    output: Path,
    model: str | Path = SELF,
    options: ReconstructOptions | None = None,
    progress: Progress = no_progress,
) -> TaskResult:
    """Rebuild every vertex of one file from its patches.

    Parameters
    ----------
    source, output : Path
        The output's suffix says its format. PLY gets the vertex properties `reconstruction_error` (how far the vertex
        moved, in mesh units) and `overlap` (count of patches that see it).
    model : str or Path
        `self` learns a dictionary of heights by K-SVD from the mesh itself; else the name of a shipped dictionary, or
        a dictionary's file, of either recipe.
    options : ReconstructOptions, optional
    progress : callable

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
    options = options or ReconstructOptions()
    check_suffix(output)
    stages = Stages(harmless(progress))
    dictionary, card = _dictionary(model, options)
    with stages.stage("read"):
        scan, welded = read_surface(source, 0)
    result = reconstruct(welded.mesh, dictionary, options, stages)
    moved = Moved(
        np.where(result.seen[welded.from_file][:, None], result.vertices[welded.from_file], scan.vertices),
        {
            ERROR: result.error[welded.from_file].astype(np.float32),
            OVERLAP: result.overlap[welded.from_file].astype(np.int32),
        },
    )
    with stages.stage("write"):
        losses = write_moved(output, scan, moved)
    report = {
        **describe_task("reconstruct", scan, welded.mesh, card, options, stages),
        **_measures(result),
        **described([*describe_redundancy(welded.counts), *losses, *_unseen(result)]),
    }
    after = TriangleMesh(result.vertices, welded.mesh.triangles)
    return TaskResult(json_ready(report), welded.mesh, after, np.asarray(result.seen[after.triangles].any(axis=1)))


def _dictionary(model: str | Path, options: ReconstructOptions) -> tuple[PatchDictionary | None, dict[str, Any]]:
    """Turn a model's name or path into its dictionary, and what the report says of it."""
    if model == SELF:
        return None, {"name": SELF}
    loaded, facts = find_model(model)
    if loaded.dictionary is None:
        raise OptionError(f"{loaded.path.name} is a network; meshes are rebuilt from dictionaries")
    if options.dictionary != DictionaryOptions():
        name = loaded.path.name
        raise OptionError(f"dictionary.atoms and dictionary.nonzero go with the model self; {name} has its own")
    if loaded.recipe == "paper":
        return PatchDictionary(loaded.dictionary, HEIGHTS, length_share(loaded)), facts
    return PatchDictionary(loaded.dictionary, NORMALISATION), facts


def _measures(result: Reconstruction) -> dict[str, Any]:
    coded = result.coded
    errors = result.error[result.seen]
    scale = coded.layout.scale
    return {
        "vertices": {"rebuilt": int(result.seen.sum()), "unseen": int((~result.seen).sum())},
        "error": {
            "rms": result.rms,
            "max": float(errors.max(initial=0.0)),
            "percentile_95": float(np.percentile(errors, 95)) if len(errors) else None,
        },
        "psnr": result.psnr,
        "quads": len(coded.layout.quad_mesh.quads),
        "patches": {
            "length": scale.length,
            "resolution": scale.resolution,
            "overlap": scale.overlap,
            "count": len(coded.sampled.patches),
        },
        "dictionary": {
            "atoms": coded.dictionary.dictionary.n_atoms,
            "nonzero": coded.dictionary.dictionary.n_nonzero,
        },
        "nonzero_coefficients": coded.codes.n_nonzero,
    }


def _unseen(result: Reconstruction) -> list[str]:
    n_unseen = int((~result.seen).sum())
    return [warning("vertices_unseen", vertices=n_unseen)] if n_unseen else []

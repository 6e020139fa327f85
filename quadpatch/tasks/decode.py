"""Decodes a file: `.qpz` in, mesh out."""

import json
from pathlib import Path
from typing import Any

import numpy as np

from quadpatch.compression.content import DictionaryReference
from quadpatch.compression.decode import decode_mesh
from quadpatch.errors import ModelError, ReadError
from quadpatch.formats.limits import ReadLimits
from quadpatch.formats.plain import write_mesh
from quadpatch.formats.writing import check_suffix
from quadpatch.progress import Progress, no_progress
from quadpatch.report import UNKNOWN_UNIT, describe_stages, json_ready
from quadpatch.sparse.dictionary import Dictionary
from quadpatch.stages import Stages, harmless
from quadpatch.tasks.encode import load_dictionary
from quadpatch.tasks.result import TaskResult
from quadpatch_rules.coded_warnings import described


def decode_file(
    source: Path, output: Path, model: str | Path | None = None, progress: Progress = no_progress
) -> TaskResult:
    """Decode one file.

    Parameters
    ----------
    source : Path
        A `.qpz` file; damaged or hostile bytes end in a coded error.
    output : Path
        Its suffix says the format; standard output without one gets PLY.
    model : str or Path, optional
        The dictionary that the file names, where it is no shipped one. Read only where the file names one.
    progress : callable

    Returns
    -------
    TaskResult
        `before` and `after` are the decoded mesh.

    Raises
    ------
    MeshError
        If the file can't be read, or its mesh can't be written in that format.
    ModelError
        If the file was encoded with another dictionary.
    OSError
        If the output can't be written.
    """
    check_suffix(output)
    stages = Stages(harmless(progress))
    used: dict[str, Any] = {}
    with stages.stage("read"):
        data = _read(source, ReadLimits())
    with stages.stage("reconstruct"):
        decoded = decode_mesh(data, lambda reference: _find(reference, model, used))
    with stages.stage("write"):
        warnings = write_mesh(output, decoded.mesh, decoded.content.unit or None)
    content, mesh = decoded.content, decoded.mesh
    report = {
        "schema": 1,
        "task": "decode",
        "source": {"format": "qpz", "bytes": len(data)},
        "length_unit": content.unit or UNKNOWN_UNIT,
        "model": used or {"name": content.dictionary.kind},
        "options": {},
        "max_error": content.lengths.max_error,
        "decoded": {"vertices": len(mesh.vertices), "triangles": len(mesh.triangles)},
        "keeps_connectivity": content.kept is not None,
        "patches": {"count": len(content.walk.polygons), "resolution": 2**content.levels},
        "stages": describe_stages(stages),
        **described(warnings),
    }
    plain = json.loads(json.dumps(json_ready(report)))
    return TaskResult(plain, mesh, mesh, np.zeros(len(mesh.triangles), np.bool_))


def _read(source: Path, limits: ReadLimits) -> bytes:
    try:
        limits.check_bytes(source.stat().st_size)
        return source.read_bytes()
    except OSError as error:
        raise ReadError(f"{source.name} can't be read: {error.strerror}") from error


def _find(reference: DictionaryReference, model: str | Path | None, used: dict[str, Any]) -> Dictionary:
    """Find the dictionary that a file names, and refuse any other."""
    dictionary, found = load_dictionary(reference.name if model is None else model)
    if found.sha256 != reference.sha256:
        raise ModelError(
            f"the file was encoded with {reference.name} (SHA-256 {reference.sha256.hex()[:16]}…); "
            f"{found.name} is another dictionary ({found.sha256.hex()[:16]}…)"
        )
    used.update({"name": found.name, "kind": "dictionary", "sha256": found.sha256.hex()})
    return dictionary

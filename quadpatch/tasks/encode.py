"""Encodes a mesh file: mesh in, `.qpz` out, and what was proved of it."""

from pathlib import Path
from typing import Any

import numpy as np

from quadpatch.compression.candidate import DictionaryChoice
from quadpatch.compression.collapse_estimate import estimated_collapse_bytes
from quadpatch.compression.content import COSINE, MODEL, SELF, DictionaryReference
from quadpatch.compression.decode import Decoded, decode_mesh
from quadpatch.compression.encode import EncodeOptions, Encoding, encode_mesh
from quadpatch.compression.proof import deviation, psnr, sample
from quadpatch.errors import FormatError, OptionError, StageError
from quadpatch.formats.output_files import is_stream, write_whole
from quadpatch.formats.scan import Scan
from quadpatch.mesh.measures import diagonal
from quadpatch.model_choice import find_model
from quadpatch.progress import Progress, no_progress
from quadpatch.repair import read_surface
from quadpatch.report import describe_redundancy, describe_task, json_ready
from quadpatch.sparse.dictionary import Dictionary
from quadpatch.stages import Stages, failure_of, harmless
from quadpatch.tasks.measures import corrected_patches, entities
from quadpatch.tasks.result import TaskResult
from quadpatch.types import TriangleMesh
from quadpatch_rules.coded_warnings import described, warning

SUFFIX = ".qpz"
# Rounding of distances, relative.
_ROUNDING = 1e-9


def encode_file(
    source: Path,
    output: Path,
    model: str | Path = SELF,
    options: EncodeOptions | None = None,
    progress: Progress = no_progress,
) -> TaskResult:
    """Encode one file.

    Parameters
    ----------
    source, output : Path
        A mesh of any known format; a `.qpz` file, or `-` for standard output.
    model : str or Path
        `self`: a dictionary that is learned from the mesh and stands in the file, or products of cosines where these
        take fewer bytes; `cosine`: these alone; the name of a shipped dictionary, or a dictionary's file, which the
        decoder then needs as well.
    options : EncodeOptions
        Its `max_error` has no default.
    progress : callable

    Returns
    -------
    TaskResult
        `after` is what the file decodes to.

    Raises
    ------
    QuadpatchError
        Its `code` says what is wrong with file, model or options.
    StageError
        If the decoded mesh is not as close as promised; nothing is written then.
    OSError
        If the output can't be written.
    """
    if options is None:
        raise OptionError(
            "max_error must be given: the largest distance that the decoded surface may have, in mesh units"
        )
    if output.suffix.lower() != SUFFIX and not is_stream(output):
        raise FormatError(f"an encoded mesh is written as {SUFFIX}; got {output.name}")
    stages = Stages(harmless(progress))
    choice, card = _dictionary(model)
    with stages.stage("read"):
        scan, welded = read_surface(source, unit=options.length_unit)
    original = (scan.vertices, scan.triangles)
    encoding = encode_mesh(welded.mesh, choice, options, stages, original, scan.unit or "")
    with stages.stage("judge"):
        decoded = decode_mesh(encoding.data, lambda reference: _known(choice.model))
        measures = _proved(scan, welded.mesh, encoding, decoded, options)
    with stages.stage("write"):
        write_whole(output, encoding.data)
    draco = estimated_collapse_bytes(welded.mesh, measures["rms_error"]["true_to_decoded"])
    measures["draco_estimate"] = draco
    measures["bytes_per_vertex"] = len(encoding.data) / len(scan.vertices)
    measures["ratio"] = (12 * len(scan.vertices) + 12 * len(scan.triangles)) / len(encoding.data)
    report = {
        **describe_task("encode", scan, welded.mesh, card, options, stages),
        **measures,
        **described(
            [
                *_attribute_warnings(scan),
                *describe_redundancy(welded.counts),
                *_suggestion(len(encoding.data), draco, options),
            ]
        ),
    }
    changed = np.ones(len(decoded.mesh.triangles), np.bool_)
    return TaskResult(json_ready(report), welded.mesh, decoded.mesh, changed)


def _dictionary(model: str | Path) -> tuple[DictionaryChoice, dict[str, Any]]:
    """Turn a model's name or path into the dictionaries that may be used, and what the report says of them."""
    if model == SELF:
        return DictionaryChoice((SELF, COSINE)), {"name": SELF}
    if model == COSINE:
        return DictionaryChoice((COSINE,)), {"name": COSINE}
    dictionary, reference = load_dictionary(model)
    facts = {"name": reference.name, "kind": "dictionary", "sha256": reference.sha256.hex()}
    return DictionaryChoice((MODEL,), dictionary, reference), facts


def load_dictionary(model: str | Path) -> tuple[Dictionary, DictionaryReference]:
    """Read a dictionary by name or path, with the reference that a file has to it.

    Raises
    ------
    ModelError
        If there is no such model.
    OptionError
        If it is a network.
    """
    loaded, facts = find_model(model)
    if loaded.dictionary is None:
        raise OptionError(f"{loaded.path.name} is a network; meshes are encoded over dictionaries")
    name, version = loaded.card.get("name"), loaded.card.get("version")
    named = f"{name}@{version}" if name and version and "@" not in str(name) else str(name or loaded.path.stem)
    return loaded.dictionary, DictionaryReference(MODEL, named[:200], bytes.fromhex(facts["sha256"]))


def _known(dictionary: Dictionary | None) -> Dictionary:
    if dictionary is None:
        raise StageError("the file names a model that it was not encoded with")
    return dictionary


def _proved(
    scan: Scan, mesh: TriangleMesh, encoding: Encoding, decoded: Decoded, options: EncodeOptions
) -> dict[str, Any]:
    """Measure what the file decodes to, and raise StageError where that breaks its promise."""
    content, length = encoding.content, diagonal(mesh)
    forward = deviation(sample(mesh, encoding.spacing), decoded.mesh)
    backward = deviation(sample(decoded.mesh, encoding.spacing), mesh)
    largest = max(forward.largest, backward.largest)
    measures: dict[str, Any] = {}
    if content.kept is not None:
        if not np.array_equal(decoded.mesh.triangles, scan.triangles):
            raise StageError("the decoded triangles are not those of the mesh")
        moved = np.linalg.norm(decoded.mesh.vertices - scan.vertices, axis=1)
        # Corresponding points of corresponding triangles are no farther apart than their vertices.
        largest = float(moved.max())
        measures["vertex_shift"] = {"max": largest, "rms": float(np.sqrt((moved**2).mean()))}
    if not largest <= options.max_error * (1.0 + _ROUNDING):
        raise StageError(f"the decoded mesh is {largest:.6g} away from the mesh; promised are {options.max_error:.6g}")
    return {
        **measures,
        "bytes": len(encoding.data),
        "max_error": {
            "promised": options.max_error,
            "true_to_decoded": forward.largest,
            "decoded_to_true": backward.largest,
        },
        "rms_error": {"true_to_decoded": forward.rms, "decoded_to_true": backward.rms},
        "psnr": {"true_to_decoded": psnr(length, forward.rms), "decoded_to_true": psnr(length, backward.rms)},
        "sample_spacing": max(forward.samples.spacing, backward.samples.spacing),
        "dictionary": {"kind": content.dictionary.kind, "atoms": content.codes.shape[1]},
        "decoded": {"vertices": len(decoded.mesh.vertices), "triangles": len(decoded.mesh.triangles)},
        "patches": {
            "count": len(content.walk.polygons),
            "resolution": 2**content.levels,
            "corrected": corrected_patches(content),
            "nonzero_coefficients": int(np.count_nonzero(content.codes)),
        },
        "corrections": len(content.corrected),
        "cells_left_out": len(content.removed),
        "triangles_as_they_are": len(content.pieces.walk.polygons),
        **entities(scan, content),
    }


def _suggestion(n_bytes: int, draco: float | None, options: EncodeOptions) -> list[str]:
    """Suggest edge collapse and Draco where these would take fewer bytes."""
    if options.keep_connectivity or draco is None or draco >= n_bytes:
        return []
    return [warning("larger_than_draco", draco=draco, bytes=n_bytes)]


def _attribute_warnings(scan: Scan) -> list[str]:
    """Say what the mesh carries besides its shape, which no encoded file keeps."""
    found: list[str] = []

    def look() -> None:
        if scan.source is not None:
            attributes = scan.source.vertex_attributes(scan)
            found.extend(name for name in ("colours", "normals", "texture") if getattr(attributes, name) is not None)

    failure_of(look)
    return [warning("shape_alone", names=", ".join(found))] if found else []

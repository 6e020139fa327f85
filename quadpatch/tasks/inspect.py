"""Facts of a file: of a mesh what its surface shows, of a `.qpz` file what its header says."""

from pathlib import Path
from typing import Any

from quadpatch.compression.content import MODEL
from quadpatch.compression.header import MAGIC, Header, read_header
from quadpatch.errors import ReadError
from quadpatch.formats.limits import ReadLimits
from quadpatch.repair import inspect_file
from quadpatch.report import UNKNOWN_UNIT, json_ready
from quadpatch_rules.coded_warnings import described


def inspect_any(source: Path) -> dict[str, Any]:
    """Return the facts of a file, JSON-ready.

    Parameters
    ----------
    source : Path
        A mesh in any format that is read, or a `.qpz` file, as its content says.

    Returns
    -------
    dict
        As `quadpatch.repair.inspect_file` returns it; of a `.qpz` file what `describe_encoded` says.

    Raises
    ------
    MeshError
        If the file can't be read.
    """
    try:
        with source.open("rb") as file:
            is_encoded = file.read(len(MAGIC)) == MAGIC
    except OSError as error:
        raise ReadError(f"{source.name} can't be read: {error.strerror}") from error
    return describe_encoded(source) if is_encoded else inspect_file(source)


def describe_encoded(source: Path) -> dict[str, Any]:
    """Return what the header of a `.qpz` file says; nothing is decoded.

    Returns
    -------
    dict
        `format`, `length_unit`, `vertices` and `triangles` (None where only decoding would count them), `holes` and
        `warnings`, which are empty, and `encoded`: `max_error` in mesh units, `keeps_connectivity`, and name and sha256
        of the `model` that decodes it, None where it needs none.

    Raises
    ------
    MeshError
        If the file is damaged, too large or of an unknown version.
    """
    ReadLimits().check_bytes(source.stat().st_size)
    header, _ = read_header(source.read_bytes())
    counts = header.counts
    is_kept = counts.kept_vertices > 0
    facts: dict[str, Any] = json_ready(
        {
            "format": "qpz",
            "length_unit": header.unit or UNKNOWN_UNIT,
            "vertices": counts.kept_vertices if is_kept else None,
            "triangles": counts.kept_triangles if is_kept else None,
            "encoded": {
                "max_error": header.lengths.max_error,
                "keeps_connectivity": is_kept,
                **_model(header),
            },
            "holes": [],
            **described([]),
        }
    )
    return facts


def _model(header: Header) -> dict[str, str | None]:
    if header.dictionary.kind != MODEL:
        return {"model": None, "model_sha256": None}
    return {"model": header.dictionary.name, "model_sha256": header.dictionary.sha256.hex()}

"""Where a repaired file comes from: hashes, times, version, who asked, and the surface before and after.

Hashing both files and counting both surfaces takes a noticeable part of a repair by geometry alone, so a report has
these facts only where its page is asked for.
"""

import hashlib
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from quadpatch.formats.output_files import is_stream
from quadpatch.html_report.histogram import histogram
from quadpatch.mesh.surface_facts import surface_facts
from quadpatch.recipes.result import Repair
from quadpatch.repair import RepairedFile
from quadpatch.report import json_ready
from quadpatch.tasks.result import TaskResult
from quadpatch.types import TriangleMesh


@dataclass(frozen=True)
class Start:
    """What is noted before a repair, which may overwrite its scan.

    Attributes
    ----------
    started_at : str
        RFC 3339, UTC.
    source : dict or None
        Name, size and sha256 of the scan's file.
    """

    started_at: str
    source: dict[str, Any] | None


def note_start(source: Path) -> Start:
    """Note the time, and which bytes are to be repaired; a missing file is for the repair to report."""
    return Start(_now(), _file(source) if source.is_file() else None)


def provenance(
    start: Start, repaired: RepairedFile, output: Path, request: Mapping[str, Any] | None = None
) -> dict[str, Any]:
    """Collect the facts, JSON-ready.

    Parameters
    ----------
    start : Start
    repaired : RepairedFile
    output : Path
        The repaired file. What went into a stream can't be read again, and has no sha256.
    request : mapping, optional
        Who asked: `job_id`, `tenant`, `asked_by`, the name of the key, if any, `request_id`, `label`, `metadata`,
        `rule`, `acceptance`, the limits of the result; and `mesh_name`, the name of the scan's file.
    """
    filled = repaired.repair.filled
    surfaces = (filled.measured, filled.mesh)
    return {**_facts(start, output, request, *surfaces), "displacement": json_ready(_displacement(repaired.repair))}


def provenance_of_task(
    start: Start, result: TaskResult, output: Path, request: Mapping[str, Any] | None = None
) -> dict[str, Any]:
    """Collect the facts of a task besides filling holes, as `provenance` does.

    What was decoded has no surface before.
    """
    before = None if result.report["task"] == "decode" else result.before
    return {**_facts(start, output, request, before, result.after), "displacement": None}


def _facts(
    start: Start,
    output: Path,
    request: Mapping[str, Any] | None,
    before: TriangleMesh | None,
    after: TriangleMesh,
) -> dict[str, Any]:
    asked, source = dict(request or {}), start.source
    name = asked.pop("mesh_name", None)
    if source is not None and name is not None:
        source = {**source, "name": name}
    facts: dict[str, Any] = json_ready(
        {
            "software": "quadpatch",
            "software_version": version("quadpatch"),
            "started_at": start.started_at,
            "finished_at": _now(),
            "source": source,
            "output": None if is_stream(output) else _file(output),
            "request": asked if request is not None else None,
            "before": None if before is None else asdict(surface_facts(before)),
            "after": asdict(surface_facts(after)),
        }
    )
    return facts


def _file(path: Path) -> dict[str, Any]:
    with path.open("rb") as file:
        sha256 = hashlib.file_digest(file, "sha256").hexdigest()
        return {"name": path.name, "size_bytes": file.tell(), "sha256": sha256}


def _displacement(repair: Repair) -> dict[str, Any] | None:
    """Count how far the model moved the new vertices of the holes that it took part in, in mesh units."""
    completion = repair.completion
    if completion is None or not completion.displaced_holes.any():
        return None
    moved = completion.displacement[completion.displaced_holes[repair.filled.vertex_hole]]
    return histogram(np.linalg.norm(moved, axis=1))


def _now() -> str:
    return datetime.now(UTC).isoformat(timespec="milliseconds").replace("+00:00", "Z")

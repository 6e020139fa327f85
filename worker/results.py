"""From the files that an engine left to what the contract publishes."""

import json
from pathlib import Path
from typing import Any, Literal

from jobkit.endings import Attempt
from jobkit.schema import HoleCounts, JobResult, ResultFile
from jobkit.stages import StageSeconds
from jobkit.store import ObjectStore, result_key
from worker.request import PREVIEW_NAME, REPORT_NAME, EngineRequest

_MEDIA_TYPES = {
    "stl": "model/stl",
    "obj": "model/obj",
    "glb": "model/gltf-binary",
    "3mf": "model/3mf",
    "json": "application/json",
    "png": "image/png",
}


def store_result(
    folder: Path, request: EngineRequest, attempt: Attempt, store: ObjectStore, seconds: float
) -> JobResult:
    """Copy an engine's files to where this attempt may write, and describe them; nobody sees them yet.

    Parameters
    ----------
    folder : Path
        Of the request.
    request : EngineRequest
    attempt : Attempt
    store : ObjectStore
    seconds : float
        Wall-clock time of the repair.
    """
    report = json.loads((folder / REPORT_NAME).read_text(encoding="utf-8"))
    files = [
        _store_file(folder / request.output, "result", attempt, store),
        _store_file(folder / REPORT_NAME, "report", attempt, store),
    ]
    if (folder / PREVIEW_NAME).exists():
        files.append(_store_file(folder / PREVIEW_NAME, "preview", attempt, store))
    counts = HoleCounts.model_validate(report["counts"])
    return JobResult.model_validate(
        {
            "format": Path(request.output).suffix.removeprefix("."),
            "holes": counts,
            "new_vertices": sum(hole.get("new_vertices", 0) for hole in report["holes"]),
            "new_triangles": sum(hole.get("new_triangles", 0) for hole in report["holes"]),
            "seconds": round(seconds, 3),
            "warnings": _warnings(report, counts),
            "files": files,
        }
    )


def stage_seconds(folder: Path, method: str) -> StageSeconds:
    """Read from an engine's report how long the stages took; `method` as in the spec."""
    report = json.loads((folder / REPORT_NAME).read_text(encoding="utf-8"))
    return StageSeconds(method, {str(stage["name"]): float(stage["seconds"]) for stage in report["stages"]})


def drop_result(attempt: Attempt, store: ObjectStore) -> None:
    """Remove the files of an attempt that published nothing."""
    store.delete_prefix(f"results/{attempt.job_id}/{attempt.number}")


def _store_file(
    path: Path, role: Literal["result", "report", "preview"], attempt: Attempt, store: ObjectStore
) -> ResultFile:
    stored = store.put_file(result_key(attempt.job_id, attempt.number, path.name), path)
    media_type = _MEDIA_TYPES.get(path.suffix.removeprefix("."), "application/octet-stream")
    return ResultFile(
        role=role, name=path.name, media_type=media_type, size_bytes=stored.size_bytes, sha256=stored.sha256
    )


def _warnings(report: dict[str, Any], counts: HoleCounts) -> list[str]:
    """Collect the report's warnings; a refused hole is one, whether or not the report says so in words."""
    warnings = [str(warning) for warning in report["warnings"]]
    if counts.refused and not warnings:
        noun = "hole was" if counts.refused == 1 else "holes were"
        warnings.append(f"{counts.refused} {noun} refused and left open; the report says why")
    return warnings

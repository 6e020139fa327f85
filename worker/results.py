"""The files of an engine, stored and described as the contract publishes them."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from jobkit.jobs.endings import Attempt
from jobkit.jobs.stage_seconds import StageSeconds
from jobkit.storage.base import ObjectStore, result_key
from jobkit.storage.digests import sha256_of
from quadpatch.formats.output_files import write_whole
from quadpatch.stages import failure_of
from quadpatch_client.schema import FileRole, JobResult, JobSpec, ResultFile
from quadpatch_rules import coded_warnings
from quadpatch_rules.coded_warnings import warning
from quadpatch_rules.tasks import TRAIN
from worker.engine.request import CLOSE_UPS_NAME, PAGE_NAME, PDF_NAME, PREVIEW_NAME, REPORT_NAME, EngineRequest
from worker.failures import Failure
from worker.result_facts import facts_of_fill, facts_of_task, facts_of_training

_MEDIA_TYPES = {
    "stl": "model/stl",
    "obj": "model/obj",
    "glb": "model/gltf-binary",
    "3mf": "model/3mf",
    "json": "application/json",
    "png": "image/png",
    "zip": "application/zip",
    "html": "text/html",
    "pdf": "application/pdf",
}


@dataclass(frozen=True)
class Picture:
    """A file that a repair may do without; `stage` draws it, `warning` is the code that says that it is missing."""

    role: FileRole
    name: str
    stage: str
    warning: str


_PREVIEW = Picture("preview", PREVIEW_NAME, "preview", "no_preview")
_CLOSE_UPS = Picture("closeups", CLOSE_UPS_NAME, "closeups", "no_close_ups")
_PAGE = Picture("html_report", PAGE_NAME, "html_report", "no_html_report")
_OPTIONAL = (_PREVIEW, _CLOSE_UPS, _PAGE)
# No engine draws it: `worker.pdf` prints the page.
_PDF = Picture("pdf_report", PDF_NAME, "html_report", "no_pdf_report")


@dataclass(frozen=True)
class Cost:
    """What the work took: wall-clock seconds, and the most memory of its engine, in MiB."""

    seconds: float
    peak_memory_mb: int


def store_result(folder: Path, request: EngineRequest, attempt: Attempt, store: ObjectStore, cost: Cost) -> JobResult:
    """Copy an engine's files to where this attempt may write, and describe them; no row names them yet.

    Parameters
    ----------
    folder : Path
        Of the request.
    request : EngineRequest
    attempt : Attempt
    store : ObjectStore
    cost : Cost
        Of the work.
    """
    # A learned model is published by the registry.
    files = [] if request.task == TRAIN else [_store_file(folder / request.output, "result", attempt, store)]
    pictures = [file for picture in (*_OPTIONAL, _PDF) for file in _store_picture(picture, folder, attempt, store)]
    report = _read_report(folder)
    files += [_store_file(folder / REPORT_NAME, "report", attempt, store), *pictures]
    return JobResult.model_validate(
        {
            "format": Path(request.output).suffix.removeprefix("."),
            "seconds": round(cost.seconds, 3),
            "peak_memory_mb": cost.peak_memory_mb,
            "files": files,
            **_facts(folder, request, report),
        }
    )


def _facts(folder: Path, request: EngineRequest, report: dict[str, Any]) -> dict[str, Any]:
    if request.task == TRAIN:
        return facts_of_training(report, request.options["name"], sha256_of(folder / request.output))
    return facts_of_fill(report) if request.task == "repair" else facts_of_task(report)


def stage_seconds(folder: Path, spec: JobSpec) -> StageSeconds:
    """Read from an engine's report how long the stages took."""
    stages = _read_report(folder).get("stages", [])
    seconds = {str(stage["name"]): float(stage["seconds"]) for stage in stages}
    return StageSeconds(spec.method.method, seconds, spec.task)


def missing_pictures(folder: Path, request: EngineRequest) -> list[Picture]:
    """Return the pictures that were asked for and are not there; one that is there is whole."""
    requested = (request.with_preview, request.with_close_ups, request.html_report is not None)
    pictures = [picture for picture, is_requested in zip(_OPTIONAL, requested, strict=True) if is_requested]
    return [picture for picture in pictures if not (folder / picture.name).exists()]


def note_deprecation(folder: Path, reference: str, reason: str) -> None:
    """Write into the report that the model should be used no more."""
    add_warning(
        folder,
        warning("deprecated_model_for", model=reference, reason=reason)
        if reason
        else warning("deprecated_model", model=reference),
    )


def note_lost_pictures(folder: Path, request: EngineRequest, failure: Failure) -> None:
    """Write into the report of an engine that ended while it drew why pictures are missing.

    The report has the stage of a picture already where the engine itself has said why.
    """
    drawn_stages = {stage["name"] for stage in _read_report(folder).get("stages", [])}
    for picture in missing_pictures(folder, request):
        if picture.stage not in drawn_stages:
            add_warning(folder, warning(picture.warning, reason=failure.message))


def _store_picture(picture: Picture, folder: Path, attempt: Attempt, store: ObjectStore) -> list[ResultFile]:
    """Store a picture where there is one; a repair whose picture can't be stored is still a repair."""
    stored: list[ResultFile] = []
    path = folder / picture.name
    if path.exists():
        failure = failure_of(lambda: stored.append(_store_file(path, picture.role, attempt, store)))
        if failure is not None:
            add_warning(folder, warning(picture.warning, reason="the store failed"))
    return stored


def add_warning(folder: Path, sentence: str) -> None:
    """Add a warning to the report; on a full disk the report stays as it was."""
    report = _read_report(folder)
    coded_warnings.add_warning(report, sentence)
    failure_of(lambda: write_whole(folder / REPORT_NAME, json.dumps(report).encode()))


def _read_report(folder: Path) -> dict[str, Any]:
    report: dict[str, Any] = json.loads((folder / REPORT_NAME).read_text(encoding="utf-8"))
    return report


def drop_result(attempt: Attempt, store: ObjectStore) -> None:
    """Remove the files of an attempt that published nothing."""
    store.delete_prefix(f"results/{attempt.job_id}/{attempt.number}")


def _store_file(path: Path, role: FileRole, attempt: Attempt, store: ObjectStore) -> ResultFile:
    stored = store.put_file(result_key(attempt.job_id, attempt.number, path.name), path)
    media_type = _MEDIA_TYPES.get(path.suffix.removeprefix("."), "application/octet-stream")
    return ResultFile(
        role=role, name=path.name, media_type=media_type, size_bytes=stored.size_bytes, sha256=stored.sha256
    )

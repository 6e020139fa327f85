"""What a batch has made, to be fetched at once: names of files, and a table of figures.

Tested in `tests/service/routes/test_batch_results.py`.
"""

import csv
import io
import re
import unicodedata
from collections.abc import Callable, Iterable, Iterator
from pathlib import PurePath
from typing import Any

from jobkit.jobs.jobs import Jobs
from jobkit.jobs.search import JobSearch
from quadpatch_client.schema import FileRole, Job, rfc3339
from service.content import result_name

# Name of the table in an archive.
TABLE = "figures.csv"
_PAGE = 200
# No file system of a client takes them all.
_UNSAFE = re.compile(r'[\x00-\x1f\x7f<>:"/\\|?*]')
_MOST_BYTES = 200
# A spreadsheet takes a cell that begins so for a formula.
_FORMULA = ("=", "+", "-", "@", "\t", "\r")
_SUFFIXES = {
    "report": ".json",
    "preview": ".png",
    "closeups": "-closeups.zip",
    "html_report": ".html",
    "pdf_report": ".pdf",
}


def suffix_of(job: Job, role: FileRole) -> str:
    """Return how the name of a file of a job's result ends."""
    return _SUFFIXES.get(role) or (f".{job.result.format}" if job.result else "")


class FileNames:
    """Names of results in an archive: safe on every system, and different from each other whatever the case."""

    def __init__(self) -> None:
        self._taken = {TABLE}

    def name(self, job: Job, role: FileRole = "result") -> str:
        """Name a file after the mesh's; a name that is taken gets the id of the job."""
        suffix, stem = suffix_of(job, role), _safe_stem(job.mesh_name or "")
        name = result_name(f"{stem}.x" if stem else None, job.mesh_id, suffix, job.spec.task)
        if name.casefold() in self._taken:
            name = f"{name.removesuffix(suffix)}-{job.id}{suffix}"
        self._taken.add(name.casefold())
        return name


def jobs_of(jobs: Jobs, batch_id: str) -> Iterator[Job]:
    """Yield the jobs of a batch in their order."""
    search, cursor = JobSearch(batch_id=batch_id, oldest_first=True), None
    while True:
        page = jobs.page(_PAGE, cursor, search)
        yield from page.items
        cursor = page.next_cursor
        if cursor is None:
            return


def figures(jobs: Iterable[Job]) -> Iterator[bytes]:
    """Yield the lines of the table, UTF-8 with CRLF: names of columns with their units, and a line for each job."""
    names = FileNames()
    yield _line(_COLUMNS)
    for job in jobs:
        file = names.name(job) if job.result is not None else None
        yield _line(value(job, file) for value in _COLUMNS.values())


def _safe_stem(filename: str) -> str:
    """Return the stem of a name with what no system takes replaced, and no longer than all of them take."""
    stem = _UNSAFE.sub("_", unicodedata.normalize("NFC", PurePath(filename).stem)).lstrip(". -")
    return stem.encode()[:_MOST_BYTES].decode(errors="ignore")


def _line(values: Iterable[object]) -> bytes:
    text = io.StringIO()
    csv.writer(text).writerow([_cell(value) for value in values])
    return text.getvalue().encode()


def _cell(value: object) -> object:
    if isinstance(value, str) and value.startswith(_FORMULA):
        return f"'{value}"
    return value


def _of_result(name: str) -> Callable[[Job, str | None], Any]:
    return lambda job, _: None if job.result is None else getattr(job.result, name)


def _of_holes(name: str) -> Callable[[Job, str | None], Any]:
    return lambda job, _: None if job.result is None else getattr(job.result.holes, name)


def _of_error(name: str) -> Callable[[Job, str | None], Any]:
    return lambda job, _: None if job.error is None else getattr(job.error, name)


def _model(job: Job, _: str | None) -> str:
    return job.model.kind if job.model.name is None else f"{job.model.name}@{job.model.version}"


def _file_fact(name: str) -> Callable[[Job, str | None], Any]:
    return lambda job, _: getattr(job.result.file("result"), name, None) if job.result else None


_COLUMNS: dict[str, Callable[[Job, str | None], Any]] = {
    "job_id": lambda job, _: job.id,
    "mesh_id": lambda job, _: job.mesh_id,
    "mesh_name": lambda job, _: job.mesh_name,
    "label": lambda job, _: job.spec.label,
    "task": lambda job, _: job.spec.task,
    "model": _model,
    "state": lambda job, _: job.state.value,
    "error_code": _of_error("code"),
    "error_message": _of_error("message"),
    "file": lambda _, file: file,
    "file_bytes": _file_fact("size_bytes"),
    "file_sha256": _file_fact("sha256"),
    "holes_found": _of_holes("found"),
    "holes_filled": _of_holes("filled"),
    "holes_filled_smooth": _of_holes("filled_smooth"),
    "holes_skipped": _of_holes("skipped"),
    "holes_refused": _of_holes("refused"),
    "new_vertices": _of_result("new_vertices"),
    "new_triangles": _of_result("new_triangles"),
    "restored_vertices": _of_result("restored_vertices"),
    "moved_vertices": _of_result("moved_vertices"),
    "shift_95_mesh_units": _of_result("shift_95"),
    "max_error_mesh_units": _of_result("max_error"),
    "work_seconds": _of_result("seconds"),
    "peak_memory_mib": _of_result("peak_memory_mb"),
    "warnings": lambda job, _: None if job.result is None else len(job.result.warnings),
    "cached_from": lambda job, _: job.cached_from,
    "created_at": lambda job, _: rfc3339(job.created_at),
    "finished_at": lambda job, _: None if job.finished_at is None else rfc3339(job.finished_at),
}

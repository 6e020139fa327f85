"""What a batch has made, to be fetched at once: names of files, and a table of figures.

Tested in `tests/service/routes/test_batch_results.py`.
"""

import csv
import io
import re
import unicodedata
from collections.abc import Iterable, Iterator
from pathlib import PurePath

from jobkit.jobs.jobs import Jobs
from jobkit.jobs.search import JobSearch
from quadpatch_client.schema import FIGURES, FileRole, Job, figures_of, spreadsheet_cell
from service.content import result_name

# Name of the table in an archive.
TABLE = "figures.csv"
_PAGE = 200
# No file system of a client takes them all.
_UNSAFE = re.compile(r'[\x00-\x1f\x7f<>:"/\\|?*]')
_MOST_BYTES = 200
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
    yield _line(FIGURES)
    for job in jobs:
        file = names.name(job) if job.result is not None else None
        yield _line(figures_of(job, file).values())


def _safe_stem(filename: str) -> str:
    """Return the stem of a name with what no system takes replaced, and no longer than all of them take."""
    stem = _UNSAFE.sub("_", unicodedata.normalize("NFC", PurePath(filename).stem)).lstrip(". -")
    return stem.encode()[:_MOST_BYTES].decode(errors="ignore")


def _line(values: Iterable[object]) -> bytes:
    text = io.StringIO()
    csv.writer(text).writerow([spreadsheet_cell(value) for value in values])
    return text.getvalue().encode()

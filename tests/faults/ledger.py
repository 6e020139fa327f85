"""The account at the end: what the database and the store say, next to what clients were promised."""

import hashlib
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import psutil
from sqlalchemy import select

from jobkit.database.session import Database
from jobkit.database.tables import AttemptRow, EventRow, JobRow
from jobkit.errors import ObjectNotFoundError
from jobkit.schema import JobResult, JobState
from jobkit.storage.base import ObjectStore, result_key
from tests.faults.load import Book
from tests.faults.strikes import Strike


@dataclass(frozen=True)
class Account:
    """Every promise that was broken, by its job; and what it took to keep the others.

    Attributes
    ----------
    n_accepted : int
    states : Counter
        Of accepted jobs.
    lost : list of str
        Accepted, and not there.
    stuck : list of str
        There, and not ended.
    unasked : list of str
        There, and nobody was promised them: a repeated request made a second job.
    twice : list of str
        With another number of published results than their state says: one or none.
    broken_logs : list of str
        Whose events are not numbered 1, 2, 3 and so on.
    broken_files : list of str
        Published files that are missing or have other bytes than was said.
    open_attempts : list of str
        Attempts of ended jobs that never ended.
    left_processes, left_folders : list of str
        Engines and folders of requests that nobody works in.
    unpublished : int
        Files of attempts that were killed before they could publish them; the sweep removes them.
    attempts : Counter
        Ends of attempts, by outcome and code.
    """

    n_accepted: int
    states: Counter[str]
    lost: list[str]
    stuck: list[str]
    unasked: list[str]
    twice: list[str]
    broken_logs: list[str]
    broken_files: list[str]
    open_attempts: list[str]
    left_processes: list[str]
    left_folders: list[str]
    unpublished: int
    attempts: Counter[str]

    @property
    def violations(self) -> dict[str, list[str]]:
        """Everything that must be empty."""
        names = ("lost", "stuck", "unasked", "twice", "broken_logs", "broken_files", "open_attempts")
        return {name: getattr(self, name) for name in (*names, "left_processes", "left_folders")}


def take_account(
    database: Database, store: ObjectStore, book: Book, folders: Iterable[Path], processes: Iterable[psutil.Process]
) -> Account:
    """Compare promises with rows, rows with events, and rows with files."""
    with database.read() as session:
        jobs = {row.id: row for row in session.scalars(select(JobRow))}
        attempts = list(session.scalars(select(AttemptRow)))
        events = list(session.execute(select(EventRow.job_id, EventRow.sequence, EventRow.type)))
    accepted = set(book.accepted.values())
    numbers: dict[str, list[int]] = {job_id: [] for job_id in jobs}
    published: Counter[str] = Counter()
    for job_id, sequence, kind in events:
        numbers[job_id].append(sequence)
        published[job_id] += kind == "succeeded"
    ended = {job_id for job_id, row in jobs.items() if JobState(row.state).is_terminal}
    files = {key for job_id, row in jobs.items() for key in _keys(job_id, row)}
    return Account(
        n_accepted=len(accepted),
        states=Counter(jobs[job_id].state for job_id in accepted & jobs.keys()),
        lost=sorted(accepted - jobs.keys()),
        stuck=[f"{job_id} {jobs[job_id].state}" for job_id in sorted(jobs.keys() - ended)],
        unasked=sorted(jobs.keys() - accepted),
        twice=[f"{job_id} {published[job_id]}" for job_id, row in jobs.items() if published[job_id] != _due(row)],
        broken_logs=[
            job_id for job_id, row in jobs.items() if sorted(numbers[job_id]) != [*range(1, row.revision + 1)]
        ],
        broken_files=[broken for job_id, row in jobs.items() for broken in _broken_files(store, job_id, row)],
        open_attempts=[f"{row.job_id} {row.number}" for row in attempts if row.outcome is None and row.job_id in ended],
        left_processes=[f"{process.pid} {' '.join(process.cmdline())}" for process in processes],
        left_folders=[str(path) for folder in folders for path in folder.glob("work/*/request-*")],
        unpublished=sum(listed.key not in files for listed in store.keys("results")),
        attempts=Counter(_end_of(row) for row in attempts),
    )


def recoveries_s(database: Database, strikes: Iterable[Strike]) -> dict[str, list[float]]:
    """Return for each fault the seconds until the next attempt at the job that was struck."""
    found: dict[str, list[float]] = {}
    with database.read() as session:
        for strike in strikes:
            victim = strike.victim
            if victim is None:
                continue
            row = session.get(AttemptRow, (victim.job_id, victim.attempt + 1))
            # Without another attempt the job was canceled, or had its result a moment before the fault.
            if row is not None:
                found.setdefault(strike.fault, []).append((row.started_at - strike.at).total_seconds())
    return found


def cancels_s(database: Database, book: Book) -> dict[str, list[float]]:
    """Return for each kind of cancel the seconds from the request to the end of the job."""
    found: dict[str, list[float]] = {}
    with database.read() as session:
        for cancel in book.cancels:
            row = session.get(JobRow, cancel.job_id)
            if row is not None and row.finished_at is not None:
                found.setdefault(cancel.kind, []).append((row.finished_at - cancel.at).total_seconds())
    return found


def _numbers(row: JobRow) -> list[int]:
    return list(range(1, row.revision + 1))


def _due(row: JobRow) -> int:
    return int(JobState(row.state).has_result)


def _keys(job_id: str, row: JobRow) -> list[str]:
    if row.result is None:
        return []
    result = JobResult.model_validate(row.result)
    return [result_key(job_id, row.attempt, file.name) for file in result.files]


def _broken_files(store: ObjectStore, job_id: str, row: JobRow) -> list[str]:
    if row.result is None:
        return []
    broken = []
    for file in JobResult.model_validate(row.result).files:
        key = result_key(job_id, row.attempt, file.name)
        try:
            digest = hashlib.sha256(b"".join(store.read(key))).hexdigest()
        except ObjectNotFoundError:
            broken.append(f"{key} is missing")
        else:
            broken += [] if digest == file.sha256 else [f"{key} has other bytes"]
    return broken


def _end_of(row: AttemptRow) -> str:
    code = (row.error or {}).get("code")
    return f"{row.outcome or 'open'}{f' ({code})' if code else ''}"

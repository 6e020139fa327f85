"""The check at the end: what the database and the store hold, compared with what clients were answered."""

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
from jobkit.storage.base import ObjectStore, result_key
from quadpatch_client.schema import JobResult, JobState
from tests.faults.injections import Injection
from tests.faults.load import ExpectedState


@dataclass(frozen=True)
class ConsistencyReport:
    """Violations of what clients were answered, by job, and counts.

    Attributes
    ----------
    n_accepted : int
    states : Counter
        Of accepted jobs.
    lost_jobs : list of str
        Accepted, and without a row.
    stuck_jobs : list of str
        With a row, and not ended.
    duplicate_jobs : list of str
        With a row, and in no answer to a client: a repeated request made a second job.
    wrong_result_counts : list of str
        With another number of published results, 0 or 1, than their state implies.
    event_gaps : list of str
        Whose events are not numbered 1, 2, 3 and so on.
    broken_files : list of str
        Published files that are missing or have another sha256 than their row says.
    open_attempts : list of str
        Attempts of ended jobs that never ended.
    orphan_processes, orphan_folders : list of str
        Engines without a request, and folders of requests without an engine.
    n_unpublished_files : int
        Files of attempts that were killed before they could publish them; the sweep removes them.
    attempts : Counter
        Ends of attempts, by outcome and code.
    """

    n_accepted: int
    states: Counter[str]
    lost_jobs: list[str]
    stuck_jobs: list[str]
    duplicate_jobs: list[str]
    wrong_result_counts: list[str]
    event_gaps: list[str]
    broken_files: list[str]
    open_attempts: list[str]
    orphan_processes: list[str]
    orphan_folders: list[str]
    n_unpublished_files: int
    attempts: Counter[str]

    @property
    def violations(self) -> dict[str, list[str]]:
        """Everything that must be empty."""
        names = ("lost_jobs", "stuck_jobs", "duplicate_jobs", "wrong_result_counts", "event_gaps", "broken_files")
        return {name: getattr(self, name) for name in (*names, "open_attempts", "orphan_processes", "orphan_folders")}


def check_consistency(
    database: Database,
    store: ObjectStore,
    expected: ExpectedState,
    folders: Iterable[Path],
    processes: Iterable[psutil.Process],
) -> ConsistencyReport:
    """Compare answers with rows, rows with events, and rows with files."""
    with database.read() as session:
        jobs = {row.id: row for row in session.scalars(select(JobRow))}
        attempts = list(session.scalars(select(AttemptRow)))
        events = list(session.execute(select(EventRow.job_id, EventRow.sequence, EventRow.type)))
    accepted = set(expected.accepted.values())
    numbers: dict[str, list[int]] = {job_id: [] for job_id in jobs}
    published: Counter[str] = Counter()
    for job_id, sequence, kind in events:
        numbers[job_id].append(sequence)
        published[job_id] += kind == "succeeded"
    ended = {job_id for job_id, row in jobs.items() if JobState(row.state).is_terminal}
    files = {key for job_id, row in jobs.items() for key in _keys(job_id, row)}
    return ConsistencyReport(
        n_accepted=len(accepted),
        states=Counter(jobs[job_id].state for job_id in accepted & jobs.keys()),
        lost_jobs=sorted(accepted - jobs.keys()),
        stuck_jobs=[f"{job_id} {jobs[job_id].state}" for job_id in sorted(jobs.keys() - ended)],
        duplicate_jobs=sorted(jobs.keys() - accepted),
        wrong_result_counts=[
            f"{job_id} {published[job_id]}"
            for job_id, row in jobs.items()
            if published[job_id] != _expected_results(row)
        ],
        event_gaps=[job_id for job_id, row in jobs.items() if sorted(numbers[job_id]) != [*range(1, row.revision + 1)]],
        broken_files=[broken for job_id, row in jobs.items() for broken in _broken_files(store, job_id, row)],
        open_attempts=[f"{row.job_id} {row.number}" for row in attempts if row.outcome is None and row.job_id in ended],
        orphan_processes=[f"{process.pid} {' '.join(process.cmdline())}" for process in processes],
        orphan_folders=[str(path) for folder in folders for path in folder.glob("work/*/request-*")],
        n_unpublished_files=sum(listed.key not in files for listed in store.keys("results")),
        attempts=Counter(_end_of(row) for row in attempts),
    )


def recoveries_s(database: Database, injections: Iterable[Injection]) -> dict[str, list[float]]:
    """Return for each fault the seconds until the next attempt at the job that was the target."""
    seconds: dict[str, list[float]] = {}
    with database.read() as session:
        for injection in injections:
            target = injection.target
            if target is None:
                continue
            row = session.get(AttemptRow, (target.job_id, target.attempt + 1))
            # Without another attempt the job was canceled, or had its result a moment before the fault.
            if row is not None:
                seconds.setdefault(injection.fault, []).append((row.started_at - injection.at).total_seconds())
    return seconds


def cancels_s(database: Database, expected: ExpectedState) -> dict[str, list[float]]:
    """Return for each kind of cancel the seconds from the request to the end of the job."""
    seconds: dict[str, list[float]] = {}
    with database.read() as session:
        for cancel in expected.cancels:
            row = session.get(JobRow, cancel.job_id)
            if row is not None and row.finished_at is not None:
                seconds.setdefault(cancel.kind, []).append((row.finished_at - cancel.at).total_seconds())
    return seconds


def _expected_results(row: JobRow) -> int:
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

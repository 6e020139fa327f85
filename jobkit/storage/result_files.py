"""Where the files of a job's result lie: under the job that made them, which may be another one.

Tested in `tests/jobkit/jobs/test_reuse.py`.
"""

from collections.abc import Collection

from sqlalchemy import exists, or_, select
from sqlalchemy.orm import Session

from jobkit.database.tables import JobRow
from jobkit.storage.base import result_key


def file_key(row: JobRow, name: str) -> str:
    """Return the key of a file of the job's result."""
    if row.cached_from is None or row.cached_attempt is None:
        return result_key(row.id, row.attempt, name)
    return result_key(row.cached_from, row.cached_attempt, name)


def file_keys(row: JobRow) -> dict[str, str]:
    """Return the keys of all files of the job's result, each with the sha256 of its bytes."""
    return {file_key(row, file["name"]): file["sha256"] for file in (row.result or {}).get("files", [])}


def unnamed(session: Session, job_ids: Collection[str]) -> set[str]:
    """Return those of the jobs whose files no row names: their own is gone, and no other job has taken them over."""

    def is_named(job_id: str) -> bool:
        return bool(session.scalar(select(exists().where(or_(JobRow.id == job_id, JobRow.cached_from == job_id)))))

    return {job_id for job_id in job_ids if not is_named(job_id)}

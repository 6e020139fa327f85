"""The event log of a job: append with the change itself, read from anywhere."""

from datetime import datetime
from typing import Any

from sqlalchemy import select
from sqlalchemy.orm import Session

from jobkit.schema import Event, EventType
from jobkit.tables import EventRow, JobRow


def append_event(session: Session, job_id: str, kind: EventType, at: datetime, data: dict[str, Any]) -> None:
    """Log a change; to be called right after the statement that raised the job's revision, in its transaction.

    That statement holds the job's row, so nobody else can take the same sequence number.
    """
    attempt, revision = session.execute(select(JobRow.attempt, JobRow.revision).where(JobRow.id == job_id)).one()
    session.add(EventRow(job_id=job_id, sequence=revision, type=kind, at=at, attempt=attempt, data=data))


def read_events(session: Session, job_id: str, after: int, limit: int) -> list[Event]:
    """Return up to `limit` events with a sequence number over `after`, oldest first."""
    rows = session.scalars(
        select(EventRow)
        .where(EventRow.job_id == job_id, EventRow.sequence > after)
        .order_by(EventRow.sequence)
        .limit(limit)
    )
    return [Event.model_validate(row, from_attributes=True) for row in rows]

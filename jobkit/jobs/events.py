"""The event log of a job: append with the change itself, read from anywhere.

Tested in `tests/jobkit/jobs/test_attempts.py`.
"""

import logging
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime
from typing import Any, Generic, TypeVar

from pydantic import ValidationError
from sqlalchemy import Row, select
from sqlalchemy.orm import Session

from jobkit.database.readable_rows import readable
from jobkit.database.tables import EventRow, JobRow
from quadpatch_client.schema import Event, EventType, JobState

_log = logging.getLogger("quadpatch.rows")


def append_event(session: Session, job_id: str, kind: EventType, at: datetime, data: dict[str, Any]) -> None:
    """Log a change; to be called right after the statement that raised the job's revision, in its transaction.

    That statement holds the job's row, so no other writer can take the same sequence number.
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
    return list(readable(rows, _to_event))


def _to_event(row: EventRow) -> Event:
    """Return the row as clients see it; where its data can't be read, they get its number and type all the same."""
    try:
        return Event.model_validate(row, from_attributes=True)
    except ValidationError:
        _log.error("the data of event %d of job %s can't be read", row.sequence, row.job_id)
        return Event.model_validate({"sequence": row.sequence, "type": row.type, "at": row.at, "attempt": row.attempt})


E = TypeVar("E")


@dataclass(frozen=True)
class NewEvents(Generic[E]):
    """What has happened to a job, or to a batch, since the last query.

    Attributes
    ----------
    events : list of events
        Oldest first.
    is_all : bool
        Whether these are the last that it will ever have.
    """

    events: list[E]
    is_all: bool


def read_new_events(session: Session, watched: Mapping[str, int], limit: int) -> dict[str, NewEvents[Event]]:
    """Read events of many jobs: one query for all, and one more for each job that has changed.

    Parameters
    ----------
    session : Session
    watched : mapping
        For each job the number of the last event that is known.
    limit : int
        Most events of a job; the rest comes with the next query.

    Returns
    -------
    dict
        For each job that is still there.
    """
    rows = session.execute(select(JobRow.id, JobRow.revision, JobRow.state).where(JobRow.id.in_(watched))).all()

    def read(row: Row[str, int, str]) -> tuple[str, NewEvents[Event]]:
        job_id, revision, state = row
        events = read_events(session, job_id, watched[job_id], limit) if revision > watched[job_id] else []
        return job_id, NewEvents(events, JobState(state).is_terminal and len(events) < limit)

    return dict(readable(rows, read))

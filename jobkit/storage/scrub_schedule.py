"""Which objects the scrub reads next: the one checked longest ago first, and damaged ones once an hour.

Tested in `tests/dispatcher/test_scrub.py`.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Any

from sqlalchemy import ColumnElement, Select, and_, or_, select
from sqlalchemy.orm import InstrumentedAttribute, Session

from jobkit.database.tables import DamagedRow, JobRow, MeshRow, ModelRow
from jobkit.storage.damage import NamedObject
from jobkit.storage.result_files import file_keys

RECHECK_DAMAGED_AFTER = timedelta(hours=1)
# A tenth of the period is left for the reading itself.
DUE_SHARE = 0.9
_BATCH = 100

Checked = InstrumentedAttribute[datetime | None]
Since = InstrumentedAttribute[datetime] | InstrumentedAttribute[datetime | None]


@dataclass(frozen=True)
class ScheduledRead:
    """Objects that are read together.

    Attributes
    ----------
    at : datetime
        The latest check, or when they were stored.
    objects : tuple of NamedObject
    row : condition on one row, optional
        The row of `table` that names them; None where they are read again because they are damaged.
    """

    at: datetime
    objects: tuple[NamedObject, ...]
    table: type[MeshRow | JobRow | ModelRow] | None = None
    row: ColumnElement[bool] | None = None


def due_reads(session: Session, days: float, now: datetime) -> list[ScheduledRead]:
    """Return what is due, the longest overdue first; at most a hundred of each kind.

    Parameters
    ----------
    session : Session
    days : float
        All objects are read once within so many days.
    now : datetime
    """
    before = now - DUE_SHARE * timedelta(days=days)
    reads = [*_damaged(session, now), *_meshes(session, before), *_models(session, before), *_jobs(session, before)]
    return sorted(reads, key=lambda scheduled: scheduled.at)


def oldest_check(session: Session) -> datetime | None:
    """Return when the object was checked, or else stored, that was checked longest ago; None: there is none."""
    has_result = JobRow.result.is_not(None)
    queries = [
        *_oldest(MeshRow.checked_at, MeshRow.created_at),
        *_oldest(ModelRow.checked_at, ModelRow.created_at),
        *_oldest(JobRow.checked_at, JobRow.finished_at, has_result),
    ]
    return min((moment for query in queries if (moment := session.scalar(query)) is not None), default=None)


def _oldest(checked_at: Checked, since: Since, *conditions: ColumnElement[bool]) -> list[Select[Any]]:
    """Ask for the oldest check and for the oldest row without one, so that an index can answer either."""
    first = select(checked_at).where(checked_at.is_not(None), *conditions).order_by(checked_at).limit(1)
    never_checked = select(since).where(checked_at.is_(None), since.is_not(None), *conditions).order_by(since).limit(1)
    return [first, never_checked]


def _damaged(session: Session, now: datetime) -> Iterator[ScheduledRead]:
    query = select(DamagedRow).where(DamagedRow.checked_at < now - RECHECK_DAMAGED_AFTER)
    for row in session.scalars(query.order_by(DamagedRow.checked_at).limit(_BATCH)):
        yield ScheduledRead(row.checked_at, (NamedObject(row.kind, row.key, row.sha256),))


def _meshes(session: Session, before: datetime) -> Iterator[ScheduledRead]:
    for row in _rows(session, MeshRow, MeshRow.created_at, before):
        named_object = NamedObject("mesh", row.key, row.sha256)
        yield ScheduledRead(row.checked_at or row.created_at, (named_object,), MeshRow, MeshRow.id == row.id)


def _models(session: Session, before: datetime) -> Iterator[ScheduledRead]:
    for row in _rows(session, ModelRow, ModelRow.created_at, before):
        same = and_(ModelRow.name == row.name, ModelRow.version == row.version)
        named_object = NamedObject("model", row.key, row.sha256)
        yield ScheduledRead(row.checked_at or row.created_at, (named_object,), ModelRow, same)


def _jobs(session: Session, before: datetime) -> Iterator[ScheduledRead]:
    for row in _rows(session, JobRow, JobRow.finished_at, before, JobRow.result.is_not(None)):
        named_object = [NamedObject("result", key, sha256) for key, sha256 in file_keys(row).items()]
        yield ScheduledRead(
            row.checked_at or row.finished_at or before, tuple(named_object), JobRow, JobRow.id == row.id
        )


def _rows(session: Session, table: Any, since: Since, before: datetime, *conditions: ColumnElement[bool]) -> list[Any]:
    query = select(table).where(
        or_(table.checked_at < before, and_(table.checked_at.is_(None), since < before)), *conditions
    )
    return list(session.scalars(query.order_by(table.checked_at, since).limit(_BATCH)))

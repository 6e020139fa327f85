"""The event log of a batch: append with the change itself, read from anywhere.

Tested in `tests/jobkit/batches/test_batches.py`.
"""

from collections.abc import Mapping
from datetime import datetime
from typing import Any

from sqlalchemy import Row, select
from sqlalchemy.orm import Session

from jobkit.database.batch_tables import BatchEventRow, BatchRow
from jobkit.database.readable_rows import readable
from jobkit.jobs.events import NewEvents
from quadpatch_client.schema import BatchEvent, BatchEventType


def append_batch_event(
    session: Session, row: BatchRow, kind: BatchEventType, at: datetime, data: dict[str, Any]
) -> None:
    """Log a change of a batch whose row is locked; raises its revision."""
    row.revision += 1
    session.add(BatchEventRow(batch_id=row.id, sequence=row.revision, type=kind, at=at, data=data))


def read_batch_events(session: Session, batch_id: str, after: int, limit: int) -> list[BatchEvent]:
    """Return up to `limit` events with a sequence number over `after`, oldest first."""
    query = select(BatchEventRow).where(BatchEventRow.batch_id == batch_id, BatchEventRow.sequence > after)
    rows = session.scalars(query.order_by(BatchEventRow.sequence).limit(limit))
    return list(readable(rows, lambda row: BatchEvent.model_validate(row, from_attributes=True)))


def read_new_batch_events(session: Session, watched: Mapping[str, int], limit: int) -> dict[str, NewEvents[BatchEvent]]:
    """Read events of many batches, as `jobkit.jobs.events.read_new_events` does of jobs."""
    query = select(BatchRow.id, BatchRow.revision, BatchRow.finished_at).where(BatchRow.id.in_(watched))

    def read(row: Row[str, int, datetime | None]) -> tuple[str, NewEvents[BatchEvent]]:
        batch_id, revision, finished_at = row
        after = watched[batch_id]
        events = read_batch_events(session, batch_id, after, limit) if revision > after else []
        return batch_id, NewEvents(events, finished_at is not None and len(events) < limit)

    return dict(readable(session.execute(query).all(), read))

"""What the dispatcher does for batches: count their jobs, cancel them where asked, end and remove batches.

The counts of an open batch are compared with those that were seen last, about once a second. A change is an event, and
the last one is the end. Each is written under a lock on the batch's row, so that of two dispatchers one writes it.

Tested in `tests/jobkit/batches/test_batches.py`.
"""

from collections.abc import Callable, Sequence
from datetime import datetime, timedelta

from sqlalchemy import delete, exists, select
from sqlalchemy.orm import Session

from jobkit.batches.events import append_batch_event
from jobkit.database.batch_rows import count_jobs, existing_batch, is_over
from jobkit.database.batch_tables import BatchEventRow, BatchRow
from jobkit.database.clock import shared_now
from jobkit.database.idempotency import forget_made
from jobkit.database.session import Database
from jobkit.database.tables import JobRow
from jobkit.errors import BatchNotFinishedError, BatchNotFoundError
from jobkit.jobs.transitions import Transition, make_transition
from jobkit.retention import BATCH, delete_rows, drop_files
from jobkit.storage.base import ObjectStore
from jobkit.webhooks.outbox import write_end_of_batch
from quadpatch_client.schema import JobState

IsOver = Callable[[], bool]
_CANCELS = (
    Transition(JobState.QUEUED, JobState.CANCELED, "canceled"),
    Transition(JobState.RUNNING, JobState.CANCELING, "cancel_requested"),
)
_TO_CANCEL = (JobState.QUEUED.value, JobState.RUNNING.value)
# Jobs of one transaction.
_CHUNK = 50


def note_progress(database: Database, is_stopped: IsOver = lambda: False) -> int:
    """Cancel, count and end open batches; return how many ended."""
    with database.read() as session:
        query = select(BatchRow.id).where(BatchRow.finished_at.is_(None)).order_by(BatchRow.id)
        open_ids = list(session.scalars(query))
    n_ended = 0
    for batch_id in open_ids:
        if is_stopped():
            break
        _cancel_jobs(database, batch_id, is_stopped)
        n_ended += _note_counts(database, batch_id)
    return n_ended


def delete_batch(database: Database, store: ObjectStore, batch_id: str) -> None:
    """Remove a batch for good that has ended, with all of its jobs, pinned or not.

    Its jobs go first, some at a time: a deletion that breaks off is finished by another one.

    Raises
    ------
    BatchNotFoundError
        If there is no such batch, or no longer.
    BatchNotFinishedError
        If it has not ended.
    """
    has_jobs = True
    while has_jobs:
        with database.write() as session:
            batch = existing_batch(session, batch_id, locked=True)
            if batch.finished_at is None:
                raise BatchNotFinishedError(f"batch {batch_id} is under way; cancel it first")
            query = select(JobRow).where(JobRow.batch_id == batch_id).order_by(JobRow.id).limit(BATCH)
            rows = list(session.scalars(query.with_for_update()))
            unnamed_ids = delete_rows(session, rows)
            has_jobs = bool(rows)
            if not has_jobs:
                _delete(session, [batch_id])
        drop_files(store, unnamed_ids)


def expire_batches(database: Database, days: float, now: datetime) -> int:
    """Remove batches that ended more than `days` ago, 0: none, and whose jobs are gone; return how many."""
    if days == 0:
        return 0
    has_job = exists().where(JobRow.batch_id == BatchRow.id)
    is_expired = BatchRow.finished_at < now - timedelta(days=days)
    with database.write() as session:
        ids = list(session.scalars(select(BatchRow.id).where(is_expired, ~has_job).limit(BATCH)))
        _delete(session, ids)
        return len(ids)


def _delete(session: Session, batch_ids: Sequence[str]) -> None:
    for batch_id in batch_ids:
        forget_made(session, batch_id)
    session.execute(delete(BatchEventRow).where(BatchEventRow.batch_id.in_(batch_ids)))
    session.execute(delete(BatchRow).where(BatchRow.id.in_(batch_ids)))


def _cancel_jobs(database: Database, batch_id: str, is_stopped: IsOver) -> None:
    """Cancel what waits, and ask what runs to stop, where that was asked for of the batch."""
    is_asked = exists().where(BatchRow.id == batch_id, BatchRow.cancel_requested_at.is_not(None))
    query = select(JobRow.id).where(JobRow.batch_id == batch_id, JobRow.state.in_(_TO_CANCEL), is_asked)
    n_canceled = _CHUNK
    while n_canceled == _CHUNK and not is_stopped():
        with database.write() as session:
            now = shared_now(session)
            ids = list(session.scalars(query.order_by(JobRow.id).limit(_CHUNK).with_for_update()))
            for job_id in ids:
                any(make_transition(session, job_id, step, now) for step in _CANCELS)
        n_canceled = len(ids)


def _note_counts(database: Database, batch_id: str) -> bool:
    """Log the counts of a batch where they have changed; return whether it ended."""
    with database.read() as session:
        counts = count_jobs(session, batch_id)
        if counts == session.scalar(select(BatchRow.counts).where(BatchRow.id == batch_id)) and not is_over(counts):
            return False
    with database.write() as session:
        now = shared_now(session)
        try:
            row = existing_batch(session, batch_id, locked=True)
        except BatchNotFoundError:
            return False
        counts = count_jobs(session, batch_id)
        has_ended = is_over(counts)
        if row.finished_at is not None or (counts == row.counts and not has_ended):
            return False
        row.counts = counts
        row.finished_at = now if has_ended else None
        append_batch_event(session, row, "ended" if has_ended else "progress", now, {"counts": counts})
        session.flush()
        if has_ended:
            write_end_of_batch(session, row, now)
        return has_ended

"""Rows of batches, found, counted and turned into what clients see.

Tested in `tests/jobkit/batches/test_batches.py`.
"""

from collections.abc import Mapping

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from jobkit.database.batch_tables import BatchRow
from jobkit.database.expiry import expiry
from jobkit.database.tables import JobRow
from jobkit.errors import BatchNotFoundError
from quadpatch_client.schema import Batch, BatchLinks, BatchState, JobState


def existing_batch(session: Session, batch_id: str, *, locked: bool = False) -> BatchRow:
    """Return the row of a batch as it stands now, and until the session ends if `locked`; raise BatchNotFoundError."""
    query = select(BatchRow).where(BatchRow.id == batch_id).execution_options(populate_existing=True)
    row = session.scalars(query.with_for_update() if locked else query).one_or_none()
    if row is None:
        raise BatchNotFoundError(f"there is no batch {batch_id}")
    return row


def count_jobs(session: Session, batch_id: str) -> dict[str, int]:
    """Count the jobs of a batch by state; states without one are left out."""
    query = select(JobRow.state, func.count()).where(JobRow.batch_id == batch_id).group_by(JobRow.state)
    return {state: int(count) for state, count in session.execute(query.order_by(JobRow.state))}


def is_over(counts: Mapping[str, int]) -> bool:
    """Tell whether all jobs have ended."""
    return all(JobState(state).is_terminal for state, count in counts.items() if count)


def state_of(row: BatchRow) -> BatchState:
    """Return where a batch stands."""
    if row.finished_at is not None:
        return "ended"
    return "running" if row.cancel_requested_at is None else "canceling"


def to_batch(row: BatchRow, counts: Mapping[str, int] | None = None, retention_days: float = 0) -> Batch:
    """Return the row as clients see it.

    Parameters
    ----------
    row : BatchRow
    counts : mapping, optional
        Its jobs by state; None: as they were seen last.
    retention_days : float
        How long its jobs are kept after their end; 0: for ever.
    """
    path = f"/v1/batches/{row.id}"
    has_ended = row.finished_at is not None
    links = BatchLinks(
        self=path,
        jobs=f"/v1/jobs?batch_id={row.id}",
        events=f"{path}/events",
        figures=f"{path}/figures.csv",
        rerun=f"{path}/rerun",
        cancel=None if has_ended else f"{path}/cancel",
        results=f"{path}/results.zip" if has_ended else None,
    )
    names = Batch.model_fields.keys() - {"state", "counts", "eta_s", "metadata", "expires_at", "links"}
    values = {name: getattr(row, name) for name in names} | {"metadata": row.batch_metadata, "state": state_of(row)}
    values |= {"counts": row.counts if counts is None else counts, "links": links}
    return Batch.model_validate(values | {"expires_at": expiry(row.finished_at, retention_days, is_pinned=False)})

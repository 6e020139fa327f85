"""Tables of batches. Their jobs name them; the dispatcher writes what changes (`jobkit/batches/progress.py`).

Tested in `tests/jobkit/batches/test_batches.py`.
"""

from datetime import datetime
from typing import Any

from sqlalchemy import ForeignKey, Index, String
from sqlalchemy.orm import Mapped, mapped_column

from jobkit.database.table_base import Base
from jobkit.database.tenancy import Owned


class BatchRow(Owned, Base):
    """Jobs that were started by one request.

    `counts` are the jobs by state as they were seen last; `revision` is the number of the latest event. A batch ends
    when all of its jobs have. `batch_metadata` is what the sender calls `metadata`.
    """

    __tablename__ = "batches"
    id: Mapped[str] = mapped_column(String(40), primary_key=True)
    n_jobs: Mapped[int]
    counts: Mapped[dict[str, Any]]
    revision: Mapped[int] = mapped_column(default=1)
    label: Mapped[str | None] = mapped_column(String(200))
    batch_metadata: Mapped[dict[str, Any]]
    callback_url: Mapped[str | None] = mapped_column(String(2048))
    rerun_of: Mapped[str | None] = mapped_column(String(40))
    cancel_requested_at: Mapped[datetime | None]
    created_at: Mapped[datetime]
    finished_at: Mapped[datetime | None]
    __table_args__ = (Index(None, "finished_at"), Index(None, "tenant", "id"))


class BatchEventRow(Base):
    """One change of a batch, written in the transaction that made it."""

    __tablename__ = "batch_events"
    batch_id: Mapped[str] = mapped_column(String(40), ForeignKey("batches.id", ondelete="CASCADE"), primary_key=True)
    sequence: Mapped[int] = mapped_column(primary_key=True, autoincrement=False)
    type: Mapped[str] = mapped_column(String(32))
    at: Mapped[datetime]
    data: Mapped[dict[str, Any]]

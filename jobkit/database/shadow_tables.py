"""Shadows and their runs.

Tested in `tests/jobkit/shadows/test_runs.py`.
"""

from datetime import datetime

from sqlalchemy import ForeignKey, Index, String
from sqlalchemy.orm import Mapped, mapped_column

from jobkit.database.table_base import Base
from jobkit.database.tenancy import Owned


class ShadowRow(Owned, Base):
    """The candidate that runs beside what jobs of a tenant ask for by a name, on a share of these jobs.

    `name` is among those of all tenants (`own_name`); the candidate is as its tenant knows it.
    """

    __tablename__ = "shadows"
    name: Mapped[str] = mapped_column(String(128), primary_key=True)
    candidate: Mapped[str] = mapped_column(String(128))
    version: Mapped[int]
    share: Mapped[float]
    created_at: Mapped[datetime]


class ShadowRunRow(Owned, Base):
    """A run of the candidate on the mesh of a job that has its result; figures outlive the job.

    `attempt` fences and `forgiven` forgives as in an analysis. `baseline` is what the job's own result was made by.
    """

    __tablename__ = "shadow_runs"
    job_id: Mapped[str] = mapped_column(String(40), primary_key=True)
    shadow: Mapped[str] = mapped_column(String(128), ForeignKey("shadows.name", ondelete="CASCADE"))
    candidate: Mapped[str] = mapped_column(String(160))
    baseline: Mapped[str] = mapped_column(String(160))
    state: Mapped[str] = mapped_column(String(32))
    attempt: Mapped[int] = mapped_column(default=0)
    forgiven: Mapped[int] = mapped_column(default=0)
    worker: Mapped[str | None] = mapped_column(String(128))
    lease_until: Mapped[datetime | None]
    enqueued_at: Mapped[datetime | None]
    not_before: Mapped[datetime | None]
    holes: Mapped[int | None]
    ratio: Mapped[float | None]
    code: Mapped[str | None] = mapped_column(String(64))
    message: Mapped[str | None] = mapped_column(String(1000))
    created_at: Mapped[datetime]
    finished_at: Mapped[datetime | None]
    __table_args__ = (Index(None, "state", "created_at"), Index(None, "shadow", "state"))

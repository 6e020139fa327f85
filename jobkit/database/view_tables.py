"""The table of views: what a viewer shows of a mesh, a job or a model, made when it is first asked for.

Tested in `tests/jobkit/test_views.py`.
"""

from datetime import datetime
from typing import Any

from sqlalchemy import BigInteger, ForeignKey, ForeignKeyConstraint, Index, String
from sqlalchemy.orm import Mapped, mapped_column

from jobkit.database.table_base import Base
from jobkit.database.tenancy import Owned


class ViewRow(Owned, Base):
    """One view, and the attempts at making it: `attempt` fences and `forgiven` forgives as in an analysis.

    `id` follows from what the view shows, so that there is one of each. It goes with what it shows, and with the mesh
    that it is compared with. A view that is made lies under `key`.
    """

    __tablename__ = "views"
    id: Mapped[str] = mapped_column(String(64), primary_key=True)
    kind: Mapped[str] = mapped_column(String(16))
    level: Mapped[str | None] = mapped_column(String(16))
    mesh_id: Mapped[str | None] = mapped_column(String(64), ForeignKey("meshes.id", ondelete="CASCADE"))
    job_id: Mapped[str | None] = mapped_column(String(40), ForeignKey("jobs.id", ondelete="CASCADE"))
    reference_id: Mapped[str | None] = mapped_column(String(64), ForeignKey("meshes.id", ondelete="CASCADE"))
    model_name: Mapped[str | None] = mapped_column(String(128))
    model_version: Mapped[int | None]
    state: Mapped[str] = mapped_column(String(16))
    attempt: Mapped[int] = mapped_column(default=0)
    forgiven: Mapped[int] = mapped_column(default=0)
    worker: Mapped[str | None] = mapped_column(String(128))
    lease_until: Mapped[datetime | None]
    enqueued_at: Mapped[datetime | None]
    key: Mapped[str | None] = mapped_column(String(200))
    sha256: Mapped[str | None] = mapped_column(String(64))
    size_bytes: Mapped[int] = mapped_column(BigInteger, default=0)
    problem: Mapped[dict[str, Any] | None]
    created_at: Mapped[datetime]
    __table_args__ = (
        ForeignKeyConstraint(["model_name", "model_version"], ["models.name", "models.version"], ondelete="CASCADE"),
        Index(None, "mesh_id"),
        Index(None, "job_id"),
        Index(None, "reference_id"),
        Index(None, "model_name", "model_version"),
        Index(None, "key"),
        Index(None, "tenant", "size_bytes"),
    )

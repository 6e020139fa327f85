"""Tables of tenants, of keys, of open event streams, and of the audit log.

Tested in `tests/service/routes/test_keys.py`.
"""

from datetime import datetime

from sqlalchemy import JSON, BigInteger, Index, String
from sqlalchemy.orm import Mapped, mapped_column

from jobkit.database.table_base import Base
from jobkit.database.tenancy import Owned


class TenantRow(Base):
    """A tenant, and what was set for it: of each quota null is the default of the service, and 0 no limit.

    The row is locked while something of the tenant is admitted; see `jobkit/database/quotas.py`.
    """

    __tablename__ = "tenants"
    name: Mapped[str] = mapped_column(String(64), primary_key=True)
    stored_bytes: Mapped[int | None] = mapped_column(BigInteger)
    jobs_waiting: Mapped[int | None] = mapped_column(BigInteger)
    jobs_at_once: Mapped[int | None] = mapped_column(BigInteger)
    streams: Mapped[int | None] = mapped_column(BigInteger)
    requests_per_minute: Mapped[int | None] = mapped_column(BigInteger)
    disabled: Mapped[bool] = mapped_column(default=False)
    created_at: Mapped[datetime]


class StreamRow(Owned, Base):
    """An event stream that is open; that of a killed process counts until `until`."""

    __tablename__ = "streams"
    id: Mapped[str] = mapped_column(String(40), primary_key=True)
    process: Mapped[str] = mapped_column(String(40))
    until: Mapped[datetime]
    __table_args__ = (Index(None, "tenant"), Index(None, "process"))


class KeyRow(Owned, Base):
    """A key of a client: its digest, never the key itself.

    For a while after a rotation the key of before, `old_sha256`, is taken as well. A key that is revoked stays here, so
    that the audit log can name it.
    """

    __tablename__ = "keys"
    id: Mapped[str] = mapped_column(String(40), primary_key=True)
    name: Mapped[str] = mapped_column(String(64))
    scopes: Mapped[list[str]] = mapped_column(JSON(none_as_null=True))
    requests_per_minute: Mapped[int | None] = mapped_column(BigInteger)
    sha256: Mapped[str] = mapped_column(String(64))
    old_sha256: Mapped[str | None] = mapped_column(String(64))
    old_until: Mapped[datetime | None]
    expires_at: Mapped[datetime | None]
    revoked_at: Mapped[datetime | None]
    used_at: Mapped[datetime | None]
    created_at: Mapped[datetime]
    __table_args__ = (Index(None, "sha256", unique=True), Index(None, "old_sha256", unique=True))


class AuditRow(Owned, Base):
    """A request that changed something, or was refused: who, what, when, from where."""

    __tablename__ = "audit"
    id: Mapped[str] = mapped_column(String(40), primary_key=True)
    at: Mapped[datetime]
    principal: Mapped[str] = mapped_column(String(64))
    name: Mapped[str | None] = mapped_column(String(64))
    operation: Mapped[str] = mapped_column(String(64))
    path: Mapped[str] = mapped_column(String(512))
    status: Mapped[int]
    address: Mapped[str | None] = mapped_column(String(64))
    request_id: Mapped[str | None] = mapped_column(String(64))
    __table_args__ = (Index(None, "at"), Index(None, "tenant", "id"))

"""Tables of resumable uploads. The row of an upload is authoritative for what has arrived; see `jobkit/uploads.py`."""

from datetime import datetime
from typing import Any

from sqlalchemy import BigInteger, ForeignKey, Index, String, Text
from sqlalchemy.orm import Mapped, mapped_column

from jobkit.database.table_base import Base
from jobkit.database.tenancy import Owned


class UploadRow(Owned, Base):
    """A resumable upload. `offset_bytes` of its `size_bytes` have been acknowledged, and lie in its parts.

    `upload_metadata` and `upload_concat` are the headers of its creation, to be sent back. `sha256` is what the client
    says that the bytes have.
    """

    __tablename__ = "uploads"
    id: Mapped[str] = mapped_column(String(40), primary_key=True)
    kind: Mapped[str] = mapped_column(String(16))
    state: Mapped[str] = mapped_column(String(16))
    size_bytes: Mapped[int] = mapped_column(BigInteger)
    offset_bytes: Mapped[int] = mapped_column(BigInteger)
    upload_metadata: Mapped[str | None] = mapped_column(Text)
    upload_concat: Mapped[str | None] = mapped_column(Text)
    filename: Mapped[str | None] = mapped_column(String(255))
    format: Mapped[str | None] = mapped_column(String(16))
    sha256: Mapped[str | None] = mapped_column(String(64))
    mesh_id: Mapped[str | None] = mapped_column(String(64))
    problem: Mapped[dict[str, Any] | None]
    created_at: Mapped[datetime]
    updated_at: Mapped[datetime]
    expires_at: Mapped[datetime]
    __table_args__ = (Index(None, "state"), Index(None, "expires_at"), Index(None, "tenant"))


class UploadPartRow(Base):
    """Acknowledged bytes of an upload from `start` on, and the object that holds them; uploads may share objects."""

    __tablename__ = "upload_parts"
    upload_id: Mapped[str] = mapped_column(String(40), ForeignKey("uploads.id"), primary_key=True)
    start: Mapped[int] = mapped_column(BigInteger, primary_key=True, autoincrement=False)
    size_bytes: Mapped[int] = mapped_column(BigInteger)
    key: Mapped[str] = mapped_column(String(200))
    sha256: Mapped[str] = mapped_column(String(64))
    __table_args__ = (Index(None, "key"),)

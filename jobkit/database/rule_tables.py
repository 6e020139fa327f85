"""The table of rules.

Tested in `tests/jobkit/test_rules.py`.
"""

from datetime import datetime
from typing import Any

from sqlalchemy import Index, String
from sqlalchemy.orm import Mapped, mapped_column

from jobkit.database.table_base import Base
from jobkit.database.tenancy import Owned


class RuleRow(Owned, Base):
    """One version of a rule. Deleted ones stay, so that their numbers never come back: jobs name them."""

    __tablename__ = "rules"
    name: Mapped[str] = mapped_column(String(128), primary_key=True)
    version: Mapped[int] = mapped_column(primary_key=True, autoincrement=False)
    content: Mapped[dict[str, Any]]
    created_at: Mapped[datetime]
    deleted_at: Mapped[datetime | None]
    __table_args__ = (Index(None, "tenant", "name"),)

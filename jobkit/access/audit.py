"""The audit log: requests that changed something, or were refused for want of a right.

Tested in `tests/service/routes/test_keys.py`.
"""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from datetime import datetime

from sqlalchemy import CursorResult, delete, insert, select

from jobkit.database.access_tables import AuditRow
from jobkit.database.readable_rows import readable
from jobkit.database.session import Database
from quadpatch_client.schema import AuditEntry, AuditPage
from quadpatch_rules.ids import new_audit_id


@dataclass(frozen=True)
class Deed:
    """A request, and how it was answered: what an entry of the log says."""

    at: datetime
    tenant: str
    principal: str
    name: str | None
    operation: str
    path: str
    status: int
    address: str | None
    request_id: str | None


class AuditLog:
    """The audit log of a database; through that of a tenant, the tenant's own part."""

    def __init__(self, database: Database) -> None:
        self._database = database

    def add(self, deeds: Sequence[Deed]) -> None:
        """Write entries, in one transaction."""
        # Of those that are made in one millisecond, ids sort as their deeds do.
        ids = sorted(new_audit_id() for _ in deeds)
        rows = [{"id": id_, **asdict(deed)} for id_, deed in zip(ids, deeds, strict=True)]
        with self._database.write() as session:
            session.execute(insert(AuditRow), rows)

    def page(self, limit: int, cursor: str | None = None) -> AuditPage:
        """Return entries, newest first.

        Parameters
        ----------
        limit : int
            Most entries on the page.
        cursor : str, optional
            `next_cursor` of the page before.
        """
        query = select(AuditRow).order_by(AuditRow.id.desc()).limit(limit + 1)
        if cursor is not None:
            query = query.where(AuditRow.id < cursor)
        with self._database.read() as session:
            rows = list(session.scalars(query))
        items = readable(rows[:limit], lambda row: AuditEntry.model_validate(row, from_attributes=True))
        return AuditPage(items=list(items), next_cursor=rows[limit - 1].id if len(rows) > limit else None)

    def forget_before(self, moment: datetime, most: int = 10_000) -> int:
        """Remove entries from before a moment; return how many, of at most `most`."""
        with self._database.write() as session:
            ids = select(AuditRow.id).where(AuditRow.at < moment).limit(most)
            result = session.execute(delete(AuditRow).where(AuditRow.id.in_(ids)))
            return result.rowcount if isinstance(result, CursorResult) else 0

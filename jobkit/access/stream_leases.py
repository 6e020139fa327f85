"""Open event streams of tenants whose number of streams has a limit, counted over all processes.

Each has a row with a lease that its process renews; those of a killed process count until their lease is over.

Tested in `tests/jobkit/database/test_quotas.py`.
"""

import secrets
from datetime import timedelta

from sqlalchemy import delete, func, select, update

from jobkit.database.access_tables import StreamRow
from jobkit.database.clock import shared_now
from jobkit.database.quotas import locked_quotas, quotas_of
from jobkit.database.session import Database
from jobkit.errors import StreamQuotaError

LEASE_S = 60.0
RENEW_S = 15.0


class StreamLeases:
    """The streams of one process."""

    def __init__(self, database: Database) -> None:
        self._database = database
        self._process = secrets.token_hex(16)

    def take(self, tenant: str) -> str | None:
        """Count a stream of a tenant; return what gives it back, None where there is no limit.

        Raises
        ------
        StreamQuotaError
            If the tenant has as many as it may.
        """
        with self._database.read() as session:
            if not quotas_of(session, tenant).streams:
                return None
        lease = secrets.token_hex(16)
        with self._database.write() as session:
            limit, now = locked_quotas(session, tenant).streams, shared_now(session)
            session.execute(delete(StreamRow).where(StreamRow.tenant == tenant, StreamRow.until < now))
            query = select(func.count()).select_from(StreamRow).where(StreamRow.tenant == tenant)
            n_open = session.scalar(query) or 0
            if 0 < limit <= n_open:
                raise StreamQuotaError(
                    f"{n_open} event streams of tenant {tenant} are open; the limit is {limit}", limit, n_open
                )
            until = now + timedelta(seconds=LEASE_S)
            session.add(StreamRow(id=lease, tenant=tenant, process=self._process, until=until))
        return lease

    def renew(self) -> None:
        """Prolong all of this process."""
        with self._database.write() as session:
            until = shared_now(session) + timedelta(seconds=LEASE_S)
            session.execute(update(StreamRow).where(StreamRow.process == self._process).values(until=until))

    def give_back(self, lease: str) -> None:
        """Count a stream no more."""
        with self._database.write() as session:
            session.execute(delete(StreamRow).where(StreamRow.id == lease))

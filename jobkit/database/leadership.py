"""One leader among many processes: a row with a lease, taken and renewed under a lock on that row.

Any number of dispatchers may run; the others stand by until the leader's lease runs out. A leader that was delayed may
act on a lease that has just run out, so what leaders do has to be harmless when it is done twice.
"""

import time
from dataclasses import dataclass
from datetime import datetime, timedelta

from sqlalchemy import delete, select

from jobkit.database.clock import shared_now
from jobkit.database.session import Database
from jobkit.database.tables import LeaderRow
from jobkit.errors import RowConflictError

# What dispatchers lead.
DISPATCHER = "dispatcher"

# Of a lease, from the last renewal of one leader to the next one's first: it runs out, and others look now and then.
_LONGEST_HANDOVER = 1.5


@dataclass(frozen=True)
class Leader:
    """Who leads, since when, and how many seconds the lease still lasts; negative where it has run out."""

    holder: str
    since: datetime
    left_s: float


class Leadership:
    """A candidate for the lead.

    Parameters
    ----------
    database : Database
    name : str
        Of what is led.
    holder : str
        Name of the candidate; no two may have the same.
    lease_s : float
        Seconds without a renewal until another candidate may lead.

    Attributes
    ----------
    found_leaderless_at : float
        When, by the monotonic clock, this candidate last found that none had led for longer than a handover takes:
        no dispatcher ran, or the database was unavailable. Minus infinity before that.
    """

    def __init__(self, database: Database, name: str, holder: str, lease_s: float) -> None:
        self._database = database
        self._name = name
        self._holder = holder
        self._lease_s = lease_s
        self.found_leaderless_at = float("-inf")

    def lead(self) -> bool:
        """Take the lead if it is vacant, or renew it; return whether this candidate leads now."""
        with self._database.write() as session:
            now = shared_now(session)
            until = now + timedelta(seconds=self._lease_s)
            row = session.scalars(select(LeaderRow).where(LeaderRow.name == self._name).with_for_update()).one_or_none()
            if row is not None:
                return self._take(row, now, until)
        return self._insert_first(until, now)

    def _take(self, row: LeaderRow, now: datetime, until: datetime) -> bool:
        if row.holder != self._holder and row.until >= now:
            return False
        leaderless_s = (now - row.until).total_seconds() + self._lease_s
        if leaderless_s > _LONGEST_HANDOVER * self._lease_s:
            self.found_leaderless_at = time.monotonic()
        if row.holder != self._holder:
            row.holder, row.since = self._holder, now
        row.until = until
        return True

    def resign(self) -> None:
        """Let another candidate lead at once; nothing happens where this candidate does not."""
        with self._database.write() as session:
            session.execute(delete(LeaderRow).where(LeaderRow.name == self._name, LeaderRow.holder == self._holder))

    def _insert_first(self, until: datetime, now: datetime) -> bool:
        """Insert the first row; of several candidates at once one succeeds."""
        try:
            with self._database.write() as session:
                session.add(LeaderRow(name=self._name, holder=self._holder, until=until, since=now))
        except RowConflictError:
            return False
        return True


def current_leader(database: Database, name: str) -> Leader | None:
    """Return who led last; None where none ever did, or the last one resigned."""
    with database.read() as session:
        row = session.scalars(select(LeaderRow).where(LeaderRow.name == name)).one_or_none()
        if row is None:
            return None
        return Leader(row.holder, row.since, (row.until - shared_now(session)).total_seconds())

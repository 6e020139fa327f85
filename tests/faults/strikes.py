"""What a fault leaves on record: when it struck, whom, and what shows that it did."""

import threading
from dataclasses import dataclass, field
from datetime import datetime

from sqlalchemy import select

from jobkit.database.session import Database
from jobkit.database.tables import JobRow, LeaderRow
from jobkit.schema import JobState
from tests.faults.cluster import WORKERS, Cluster


@dataclass(frozen=True)
class Victim:
    """An attempt at work, and the worker that it runs on."""

    job_id: str
    attempt: int
    stage: str | None
    worker: str


@dataclass(frozen=True)
class Strike:
    """One fault that happened."""

    fault: str
    at: datetime
    evidence: str
    victim: Victim | None = None


@dataclass
class Record:
    """All strikes; written by two threads."""

    strikes: list[Strike] = field(default_factory=list)
    missed: list[str] = field(default_factory=list)
    lock: threading.Lock = field(default_factory=threading.Lock)

    def note(self, strike: Strike) -> None:
        """Keep a strike."""
        with self.lock:
            self.strikes.append(strike)

    def note_missed(self, fault: str) -> None:
        """Keep in mind that a fault found nothing to strike."""
        with self.lock:
            self.missed.append(fault)


def victims(database: Database, cluster: Cluster) -> list[Victim]:
    """Return the attempts at work that may be struck: a job's last attempt is spared, or it would fail by rule."""
    with database.read() as session:
        rows = session.scalars(select(JobRow).where(JobRow.state == JobState.RUNNING.value)).all()
    found = []
    for row in rows:
        if row.worker is None or row.attempt - row.forgiven >= row.max_attempts:
            continue
        name = cluster.name_of(pid_in(row.worker))
        if name in WORKERS:
            found.append(Victim(row.id, row.attempt, row.stage, name))
    return found


def leader_name(database: Database, cluster: Cluster) -> str | None:
    """Return which dispatcher leads."""
    holder = leader_holder(database)
    return None if holder is None else cluster.name_of(pid_in(holder))


def leader_holder(database: Database) -> str | None:
    """Return the name that the leading dispatcher has given itself."""
    with database.read() as session:
        return session.scalars(select(LeaderRow.holder)).one_or_none()


def pid_in(name: str) -> int:
    """Return the process id in the name of a worker or a dispatcher."""
    return int(name.rsplit("-", 2)[1])

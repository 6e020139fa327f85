"""What is recorded of a fault: when it was injected, into which attempt, and the evidence of its effect."""

import threading
from dataclasses import dataclass, field
from datetime import datetime

from sqlalchemy import select

from jobkit.database.session import Database
from jobkit.database.tables import JobRow, LeaderRow
from quadpatch_client.schema import JobState
from tests.faults.cluster import WORKERS, Cluster


@dataclass(frozen=True)
class Target:
    """A running attempt, and the worker that it runs on."""

    job_id: str
    attempt: int
    stage: str | None
    worker: str


@dataclass(frozen=True)
class Injection:
    """One fault that was injected."""

    fault: str
    at: datetime
    evidence: str
    target: Target | None = None


@dataclass
class InjectionLog:
    """All injections, and the faults that found no target; written by two threads."""

    injections: list[Injection] = field(default_factory=list)
    skipped: list[str] = field(default_factory=list)
    lock: threading.Lock = field(default_factory=threading.Lock)

    def note(self, injection: Injection) -> None:
        """Add an injection."""
        with self.lock:
            self.injections.append(injection)

    def note_skipped(self, fault: str) -> None:
        """Add a fault that found no target."""
        with self.lock:
            self.skipped.append(fault)


def targets(database: Database, cluster: Cluster) -> list[Target]:
    """Return the running attempts that may be interrupted: not the last one of a job, or the job would have to fail."""
    with database.read() as session:
        rows = session.scalars(select(JobRow).where(JobRow.state == JobState.RUNNING.value)).all()
    candidates = []
    for row in rows:
        if row.worker is None or row.attempt - row.forgiven >= row.max_attempts:
            continue
        name = cluster.name_of(pid_in(row.worker))
        if name in WORKERS:
            candidates.append(Target(row.id, row.attempt, row.stage, name))
    return candidates


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

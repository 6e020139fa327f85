"""Memory of machines: what their workers' engines are expected to need, and what is left.

Each worker has one row while it has an engine, with the lease of its task: the memory of a killed worker is given back
when its lease is over. Each decision about the memory of a machine is made with its row locked.

Tested in `tests/jobkit/jobs/test_admission.py`.
"""

from collections.abc import Callable
from dataclasses import asdict, dataclass
from datetime import datetime, timedelta
from typing import Any

from sqlalchemy import CursorResult, delete, select, update
from sqlalchemy.dialects import postgresql, sqlite
from sqlalchemy.orm import Session

from jobkit.database.clock import shared_now
from jobkit.database.tables import MachineRow, ReservationRow

# Of machines and workers that are there no more.
_FORGOTTEN_AFTER = timedelta(days=1)
# A machine at work is heard of with every heartbeat.
SEEN_WITHIN = timedelta(seconds=60)


@dataclass(frozen=True)
class MachineMemory:
    """The memory of a machine in MiB: what engines may take in all, and what is free now."""

    limit_mb: int
    free_mb: int


@dataclass(frozen=True)
class Machine:
    """A machine as a worker sees it: its name, and what measures its memory."""

    name: str
    measure: Callable[[], MachineMemory]


@dataclass(frozen=True)
class Reservation:
    """What an engine is expected to need, and had at its last heartbeat, in MiB; `is_job`: it is that of a job."""

    reserved_mb: int
    used_mb: int
    is_job: bool = True


@dataclass(frozen=True)
class Room:
    """What a machine has left, in MiB.

    Attributes
    ----------
    memory : MachineMemory
    reservations : tuple of Reservation
        Of the engines there.
    """

    memory: MachineMemory
    reservations: tuple[Reservation, ...] = ()

    @property
    def left_mb(self) -> int:
        """What no engine has or is expected to take; negative where they may take more than there is."""
        still_to_take = sum(max(r.reserved_mb - r.used_mb, 0) for r in self.reservations)
        taken = sum(max(r.reserved_mb, r.used_mb) for r in self.reservations)
        return min(self.memory.free_mb - still_to_take, self.memory.limit_mb - taken)

    @property
    def has_job(self) -> bool:
        """Whether the engine of a job runs there."""
        return any(r.is_job for r in self.reservations)


def locked_room(session: Session, machine: Machine, worker: str, now: datetime) -> Room:
    """Hold the row of a machine until the session ends, and return what it has left without the worker's own engine."""
    if not _note(session, machine, now):
        _insert_machine(session, machine.name, now)
        _note(session, machine, now)
    # Measured behind the lock, and heartbeats are older still: an engine's growth in between counts twice, never not.
    return room_of(session, machine, worker, now)


def room_of(session: Session, machine: Machine, worker: str, now: datetime) -> Room:
    """Return the same without holding anything; it may be over when it is read."""
    return Room(machine.measure(), _reservations(session, machine.name, worker, now))


def reserve(session: Session, machine: str, worker: str, reservation: Reservation, until: datetime) -> None:
    """Write what the engine of a worker is about to need."""
    values = {**asdict(reservation), "machine": machine, "until": until}
    statement = _insert(session)(ReservationRow).values(worker=worker, **values)
    session.execute(statement.on_conflict_do_update(index_elements=["worker"], set_=values))


def renew_reservation(session: Session, machine: Machine, worker: str, lease_s: float, used_mb: int) -> None:
    """Prolong what a worker has reserved, and note what its engine has now; nothing happens where it has nothing."""
    now = shared_now(session)
    _note(session, machine, now)
    renewed = {"used_mb": used_mb, "until": now + timedelta(seconds=lease_s)}
    session.execute(update(ReservationRow).where(ReservationRow.worker == worker).values(renewed))


def release(session: Session, worker: str) -> None:
    """Give back what a worker has reserved."""
    session.execute(delete(ReservationRow).where(ReservationRow.worker == worker))


def _note(session: Session, machine: Machine, now: datetime) -> bool:
    """Write what a machine has into its row, which that holds; return whether there is one."""
    memory = machine.measure()
    figures = {"limit_mb": memory.limit_mb, "free_mb": memory.free_mb, "seen_at": now}
    result = session.execute(update(MachineRow).where(MachineRow.name == machine.name).values(figures))
    return isinstance(result, CursorResult) and result.rowcount == 1


def _insert(session: Session) -> Any:
    return sqlite.insert if session.get_bind().dialect.name == "sqlite" else postgresql.insert


def _insert_machine(session: Session, name: str, now: datetime) -> None:
    """Insert a machine; forget machines, and their workers, that are there no more."""
    session.execute(delete(MachineRow).where(MachineRow.seen_at < now - _FORGOTTEN_AFTER))
    session.execute(delete(ReservationRow).where(ReservationRow.until < now - _FORGOTTEN_AFTER))
    # Of two workers that do so at once, one waits here for the other.
    session.execute(
        _insert(session)(MachineRow).values(name=name, limit_mb=0, free_mb=0, seen_at=now).on_conflict_do_nothing()
    )


def _reservations(session: Session, machine: str, worker: str, now: datetime) -> tuple[Reservation, ...]:
    rows = session.execute(
        select(ReservationRow.reserved_mb, ReservationRow.used_mb, ReservationRow.is_job).where(
            ReservationRow.machine == machine, ReservationRow.worker != worker, ReservationRow.until >= now
        )
    )
    return tuple(Reservation(row.reserved_mb, row.used_mb, row.is_job) for row in rows)

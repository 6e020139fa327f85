"""Whether a job fits into the memory of a worker's machine now, and what becomes of one that does not.

A job that does not fit waits in the database and not in the queue, so that smaller ones behind it start. A worker that
frees memory puts those that fit then to the front of the queue. Once a job has waited for long, its machine starts
others only beside it, not before it. A job that is larger than its machine, or for which other programs leave no room,
runs when no other job runs there, with what is left as its limit.
"""

from dataclasses import dataclass
from datetime import datetime, timedelta

from sqlalchemy import ColumnElement, exists, select
from sqlalchemy.orm import Session

from jobkit.database.clock import shared_now
from jobkit.database.session import Database
from jobkit.database.tables import JobRow, MachineRow, MeshRow
from jobkit.errors import StaleAttemptError
from jobkit.jobs.events import append_event
from jobkit.jobs.memory_needs import MemoryNeeds
from jobkit.jobs.past_jobs import kind_of
from jobkit.jobs.reservations import (
    SEEN_WITHIN,
    Machine,
    Reservation,
    Room,
    locked_room,
    release,
    renew_reservation,
    reserve,
    room_of,
)
from jobkit.jobs.transitions import update_job
from jobkit.jobs.turns import busy_tenants
from quadpatch_client.schema import JobState

# A job that did not fit is not tried again sooner.
_PAUSE_S = 1.0
# An engine gets no less, whatever is left.
_LEAST_MB = 256
# Of one turn; the rest follows when these have started.
_MOST_FITTING = 8


@dataclass(frozen=True)
class AdmissionRules:
    """What holds for all jobs.

    Attributes
    ----------
    attempt_mb : int
        Most memory of one attempt, in MiB; no job is expected to need more.
    wait_s : float
        Seconds that a job waits until its machine holds back others for it.
    """

    attempt_mb: int
    wait_s: float


@dataclass(frozen=True)
class Grant:
    """Leave to start; `limit_mb` is the most memory, in MiB, of an engine that may not get what it needs."""

    limit_mb: int | None = None


class Admission:
    """The memory of one worker's tasks.

    Parameters
    ----------
    database : Database
    needs : MemoryNeeds
    worker : str
        Name of the worker.
    machine : Machine
    rules : AdmissionRules
    """

    def __init__(
        self, database: Database, needs: MemoryNeeds, worker: str, machine: Machine, rules: AdmissionRules
    ) -> None:
        self._database = database
        self._needs = needs
        self._worker = worker
        self._machine = machine
        self._rules = rules

    def admit(self, session: Session, row: JobRow, lease_s: float, now: datetime) -> Grant | None:
        """Reserve what a queued job needs; None where it has to wait, which is written down.

        Parameters
        ----------
        session : Session
            That starts the attempt if it may start: the reservation and the start are one transaction.
        row : JobRow
        lease_s : float
            Seconds until the reservation ends unless it is renewed.
        now : datetime

        Raises
        ------
        StaleAttemptError
            If the job has to wait, and has been started, canceled or ended meanwhile.
        """
        room = locked_room(session, self._machine, self._worker, now)
        needed_mb = self._needed_mb(session, row)
        held = self._held(session, now)
        held_mb = 0 if held is None or held.id == row.id else held.needed_mb
        grant = decide(needed_mb, room, held_mb, may_run_alone=self._may_run_alone(session, row, needed_mb, room, now))
        if grant is None:
            self._wait(session, row, needed_mb, now)
        else:
            until = now + timedelta(seconds=lease_s)
            # One that runs alone takes all: nothing may start beside it.
            alone_mb = 0 if grant.limit_mb is None else room.memory.limit_mb
            reserve(session, self._machine.name, self._worker, Reservation(max(needed_mb, alone_mb), 0), until)
        return grant

    def reserve(self, needed_mb: int, lease_s: float) -> None:
        """Reserve what a task needs that is not held up: an analysis or a proof."""
        with self._database.write() as session:
            now = shared_now(session)
            locked_room(session, self._machine, self._worker, now)
            reservation = Reservation(needed_mb, 0, is_job=False)
            reserve(session, self._machine.name, self._worker, reservation, now + timedelta(seconds=lease_s))

    def has_room(self, kind: str, size_bytes: int) -> int | None:
        """Return what a task of that kind is expected to need, in MiB, if the machine has it to spare; else None."""
        needed_mb = min(self._needs.expected_mb(kind, size_bytes), self._rules.attempt_mb)
        with self._database.read() as session:
            room = room_of(session, self._machine, self._worker, shared_now(session))
        return needed_mb if needed_mb <= room.left_mb else None

    def renew(self, lease_s: float, used_mb: int) -> None:
        """Prolong the reservation of the task at work; `used_mb` is the present memory of its engine."""
        with self._database.write() as session:
            renew_reservation(session, self._machine, self._worker, lease_s, used_mb)

    def release(self) -> None:
        """Give back what is reserved, when the engine has ended."""
        with self._database.write() as session:
            release(session, self._worker)

    def refresh(self) -> None:
        """Learn what past jobs needed, if that was last done over a minute ago."""
        self._needs.refresh()

    def fitting(self) -> list[tuple[str, int]]:
        """Return the jobs that wait for memory and would start now, with their attempts so far, the oldest first."""
        with self._database.read() as session:
            now = shared_now(session)
            if not session.scalar(select(exists().where(*_is_waiting(now)))):
                return []
            room, held = room_of(session, self._machine, self._worker, now), self._held(session, now)
            left_mb = room.left_mb
            found: list[_Waiting] = []
            has_turn = _has_turn(session)
            # Where no job runs the first one starts, whatever it needs.
            first = held or (None if room.has_job else next(iter(_waiting(session, now, 1, has_turn)), None))
            if first is not None:
                left_mb -= first.needed_mb
                found += [first] if left_mb >= 0 or not room.has_job else []
            for waiting in _waiting(session, now, _MOST_FITTING, has_turn, JobRow.needed_memory_mb <= left_mb):
                if waiting.needed_mb <= left_mb and waiting != first:
                    left_mb -= waiting.needed_mb
                    found.append(waiting)
            return [(waiting.id, waiting.attempt) for waiting in found if waiting.not_before <= now]

    def _needed_mb(self, session: Session, row: JobRow) -> int:
        size_bytes = session.scalars(select(MeshRow.size_bytes).where(MeshRow.id == row.mesh_id)).one()
        effort = (row.spec.get("method") or {}).get("effort")
        expected_mb = self._needs.expected_mb(kind_of(row.task, row.model["kind"], effort), size_bytes)
        own_limit_mb = (row.spec.get("limits") or {}).get("memory_mb")
        return min(expected_mb, self._rules.attempt_mb, own_limit_mb or expected_mb)

    def _held(self, session: Session, now: datetime) -> "_Waiting | None":
        """Return the job for which this machine holds back others."""
        latest = now - timedelta(seconds=self._rules.wait_s)
        is_here = JobRow.memory_wait_at == self._machine.name
        return next(iter(_waiting(session, latest, 1, is_here, _has_turn(session))), None)

    def _may_run_alone(self, session: Session, row: JobRow, needed_mb: int, room: Room, now: datetime) -> bool:
        """Tell whether the job may start without the memory that it needs, if no other job runs."""
        if room.has_job or needed_mb <= room.left_mb:
            return False
        if needed_mb > room.memory.limit_mb:
            is_larger = (MachineRow.limit_mb >= needed_mb) & (MachineRow.seen_at > now - SEEN_WITHIN)
            return not session.scalar(select(exists().where(is_larger)))
        # Other programs have the memory: they may be done with it soon.
        waits_since = row.memory_wait_since or now
        return waits_since <= now - timedelta(seconds=self._rules.wait_s)

    def _wait(self, session: Session, row: JobRow, needed_mb: int, now: datetime) -> None:
        """Write that the job waits; that is an event the first time. Raise StaleAttemptError."""
        values = {
            "needed_memory_mb": needed_mb,
            "memory_wait_since": row.memory_wait_since or now,
            "memory_wait_at": self._place(session, row, needed_mb, now),
            "not_before": now + timedelta(seconds=_PAUSE_S),
        }
        is_new = row.memory_wait_since is None
        if is_new:
            values |= {"revision": JobRow.revision + 1, "updated_at": now}
        fences = JobRow.state == JobState.QUEUED.value, JobRow.attempt == row.attempt, JobRow.revision == row.revision
        if not update_job(session, row.id, values, *fences):
            raise StaleAttemptError(f"job {row.id} was taken by another worker")
        if is_new:
            data = {"state": row.state, "waits_for": "memory", "memory_mb": needed_mb}
            append_event(session, row.id, "queued", now, data)

    def _place(self, session: Session, row: JobRow, needed_mb: int, now: datetime) -> str | None:
        """Return the machine that is to hold back others for the job: one that can, and the same as long as it is seen.

        A job that none can hold waits at the machine where it will run alone.
        """
        query = select(MachineRow.name, MachineRow.limit_mb).where(MachineRow.seen_at > now - SEEN_WITHIN)
        machines = session.execute(query).all()
        names = {name for name, limit_mb in machines if limit_mb >= needed_mb} or {name for name, _ in machines}
        if row.memory_wait_at in names:
            return row.memory_wait_at
        return self._machine.name if self._machine.name in names else None


def decide(needed_mb: int, room: Room, held_mb: int, *, may_run_alone: bool) -> Grant | None:
    """Decide about a job.

    Parameters
    ----------
    needed_mb : int
        What it is expected to need, in MiB.
    room : Room
        Of the machine.
    held_mb : int
        What a job needs that has waited for long and is next, in MiB.
    may_run_alone : bool
        Whether it may start with less than it needs where no other job runs.

    Returns
    -------
    Grant or None
        None: it has to wait.
    """
    left_mb = room.left_mb - held_mb
    if needed_mb <= left_mb:
        return Grant()
    if may_run_alone and not room.has_job and not held_mb:
        # Analyses and proofs that run give back within seconds what they have reserved.
        return Grant(max(min(room.memory.free_mb, room.memory.limit_mb), _LEAST_MB))
    return None


@dataclass(frozen=True)
class _Waiting:
    id: str
    attempt: int
    needed_mb: int
    not_before: datetime


def _has_turn(session: Session) -> ColumnElement[bool]:
    """Return the condition on jobs whose tenants may run another one; the memory of others is not kept free."""
    return JobRow.tenant.not_in(busy_tenants(session))


def _is_waiting(latest: datetime) -> tuple[ColumnElement[bool], ...]:
    return JobRow.memory_wait_since <= latest, JobRow.state == JobState.QUEUED.value


def _waiting(session: Session, latest: datetime, limit: int, *conditions: ColumnElement[bool]) -> list[_Waiting]:
    """Return jobs that have waited for memory since `latest` or longer, those that wait longest first."""
    rows = session.execute(
        select(JobRow.id, JobRow.attempt, JobRow.needed_memory_mb, JobRow.not_before)
        .where(*_is_waiting(latest), *conditions)
        .order_by(JobRow.memory_wait_since, JobRow.id)
        .limit(limit)
    )
    return [_Waiting(row.id, row.attempt, row.needed_memory_mb or 0, row.not_before or latest) for row in rows]

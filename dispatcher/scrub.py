"""The scrub: every object that a row names is read within a set number of days, and held against its sha256.

Disks lose bits without an error, and in an object that is not read the damage stays unknown until the object is
needed. An object that differs is read a second time, since a transfer may lose bits as well, and then remembered in
the database. A damaged mesh is rejected with the code `mesh_damaged`; jobs that wait for it fail with the same, and it
is analysed again once its bytes are right again, by an upload or from a backup. Other damaged objects are answered with
`object_damaged`, or end a job with `model_damaged`. Objects that are gone are left to `dispatcher.missing_objects`.
"""

import hashlib
import logging
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from datetime import datetime
from enum import Enum

from sqlalchemy import select, update
from sqlalchemy.orm import Session

from jobkit.database.clock import shared_now
from jobkit.database.counters import add_up
from jobkit.database.session import Database
from jobkit.database.tables import MeshRow, ScrubRow
from jobkit.errors import ObjectNotFoundError, StoreUnavailableError
from jobkit.meshes import MESH_DAMAGED, is_damaged, restart
from jobkit.schema import MeshProblem, MeshState
from jobkit.storage.base import ObjectStore
from jobkit.storage.damage import NamedObject, forget_damaged, note_damaged
from jobkit.storage.scrub_due import Due, due_objects

# Of one round; the next one comes as long after it.
ROUND_S = 60.0
_TRIES = 2
_PROBLEM = MeshProblem(
    code=MESH_DAMAGED, message="the bytes of the mesh in the store are not those that were uploaded; upload it again"
)
IsOver = Callable[[], bool]

_log = logging.getLogger("quadpatch.scrub")


class Verdict(Enum):
    """What reading an object tells."""

    SOUND = "sound"
    DAMAGED = "damaged"
    UNREADABLE = "unreadable"
    GONE = "gone"


@dataclass(frozen=True)
class Scrubbed:
    """What one round read, and how many objects it found to be damaged that were not known to be."""

    objects: int = 0
    size_bytes: int = 0
    damaged: int = 0


@dataclass(frozen=True)
class ScrubLimits:
    """All objects are read within so many days, 0: never; at most so many bytes a second for `round_s` seconds."""

    days: float
    bytes_per_s: float
    round_s: float = ROUND_S


@dataclass(frozen=True)
class _Reading:
    """`used_at` is that of the mesh before it was read."""

    named: NamedObject
    verdict: Verdict
    size_bytes: int
    used_at: datetime | None


class _BrokenOffError(Exception):
    """The process has to end, or leads no more."""


class Scrub:
    """Reads what is due, a round at a time; the database remembers how far it came.

    Parameters
    ----------
    database : Database
    store : ObjectStore
    limits : ScrubLimits
    pause : callable
        Waits for so many seconds.
    """

    def __init__(
        self, database: Database, store: ObjectStore, limits: ScrubLimits, pause: Callable[[float], object] = time.sleep
    ) -> None:
        self._database = database
        self._store = store
        self._limits = limits
        self._pause = pause

    def round(self, is_over: IsOver = lambda: False) -> Scrubbed:
        """Read what is due, up to the limits; an object that was begun is read to its end.

        Parameters
        ----------
        is_over : callable
            Whether to break off; asked before each chunk.

        Raises
        ------
        StoreUnavailableError
            If the store does not work: then nothing is known to be damaged.
        """
        objects = size_bytes = damaged = 0
        if self._limits.days > 0:
            pace = _Pace(self._limits, self._pause)
            for due in self._due(pace, is_over):
                try:
                    readings = [self._read(named, pace, is_over) for named in due.objects]
                except _BrokenOffError:
                    break
                damaged += self._note(due, readings)
                objects += len(readings)
                size_bytes += sum(reading.size_bytes for reading in readings)
        return Scrubbed(objects, size_bytes, damaged)

    def _due(self, pace: "_Pace", is_over: IsOver) -> Iterator[Due]:
        while True:
            with self._database.read() as session:
                batch = due_objects(session, self._limits.days, shared_now(session))
            for due in batch:
                if is_over() or pace.is_used_up:
                    return
                yield due
            if not batch:
                return

    def _read(self, named: NamedObject, pace: "_Pace", is_over: IsOver) -> _Reading:
        verdict, size_bytes, used_at = Verdict.SOUND, 0, self._used_at(named)
        for _ in range(_TRIES):
            verdict, read_bytes = self._read_once(named, pace, is_over)
            size_bytes += read_bytes
            if verdict in (Verdict.SOUND, Verdict.GONE):
                break
        return _Reading(named, verdict, size_bytes, used_at)

    def _used_at(self, named: NamedObject) -> datetime | None:
        if named.kind != "mesh":
            return None
        with self._database.read() as session:
            return session.scalar(select(MeshRow.used_at).where(MeshRow.id == named.sha256))

    def _read_once(self, named: NamedObject, pace: "_Pace", is_over: IsOver) -> tuple[Verdict, int]:
        digest, size_bytes = hashlib.sha256(), 0
        try:
            for chunk in self._store.read(named.key):
                if is_over():
                    raise _BrokenOffError
                digest.update(chunk)
                size_bytes += len(chunk)
                pace.spend(len(chunk))
        except ObjectNotFoundError:
            return Verdict.GONE, size_bytes
        except StoreUnavailableError as error:
            # Is it the store, or a sector of the disk under this object?
            self._store.check()
            _log.warning("%s can't be read: %s", named.key, error)
            return Verdict.UNREADABLE, size_bytes
        return Verdict.SOUND if digest.hexdigest() == named.sha256 else Verdict.DAMAGED, size_bytes

    def _note(self, due: Due, readings: list[_Reading]) -> int:
        """Write down what was found; return how many objects are damaged that were not known to be."""
        with self._database.write() as session:
            now = shared_now(session)
            if due.table is not None and due.row is not None:
                session.execute(update(due.table).where(due.row).values(checked_at=now))
            damaged = sum(_note_one(session, reading, now) for reading in readings)
            if readings:
                kinds = {"kind": readings[0].named.kind, "objects": len(readings)}
                add_up(session, ScrubRow, [kinds | {"size_bytes": sum(reading.size_bytes for reading in readings)}])
        return damaged


class _Pace:
    """Lets a round read no faster, and no more, than the limits allow."""

    def __init__(self, limits: ScrubLimits, pause: Callable[[float], object]) -> None:
        self._limits = limits
        self._pause = pause
        self._began = time.monotonic()
        self._spent = 0

    @property
    def is_used_up(self) -> bool:
        """Whether the round has read as much as it may."""
        return self._spent >= self._limits.bytes_per_s * self._limits.round_s

    def spend(self, n_bytes: int) -> None:
        """Count bytes that were read, and wait until so many may be."""
        self._spent += n_bytes
        ahead_s = self._spent / self._limits.bytes_per_s - (time.monotonic() - self._began)
        if ahead_s > 0:
            self._pause(ahead_s)


def _note_one(session: Session, reading: _Reading, now: datetime) -> bool:
    named, mesh = reading.named, None
    if named.kind == "mesh":
        mesh = session.get(MeshRow, named.sha256, with_for_update=True)
        if mesh is not None and mesh.used_at != reading.used_at:
            return False  # its bytes came again meanwhile
    if reading.verdict in (Verdict.SOUND, Verdict.GONE):
        forget_damaged(session, named.key)
        if mesh is not None and reading.verdict is Verdict.SOUND and is_damaged(mesh):
            restart(mesh, mesh.filename, mesh.format)
        return False
    if mesh is not None and reading.verdict is Verdict.DAMAGED and not is_damaged(mesh):
        mesh.state, mesh.problem = MeshState.REJECTED.value, _PROBLEM.model_dump(mode="json")
        mesh.lease_until, mesh.updated_at = None, now
    is_new = note_damaged(session, named, now)
    if is_new:
        _log.error("%s is %s: its sha256 was %s when it was stored", named.key, reading.verdict.value, named.sha256)
    return is_new

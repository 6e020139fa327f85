"""The scrub: every object that a row names is read within a set number of days and checked against its sha256.

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

from sqlalchemy import func, select, update
from sqlalchemy.orm import Session

from jobkit.database.clock import shared_now
from jobkit.database.counters import add_up
from jobkit.database.session import Database
from jobkit.database.tables import MeshRow, ScrubRow
from jobkit.errors import ObjectNotFoundError, StoreUnavailableError
from jobkit.meshes import MESH_DAMAGED, is_damaged, restart
from jobkit.settings import Settings
from jobkit.storage.base import ObjectStore
from jobkit.storage.damage import NamedObject, forget_damaged, note_damaged
from jobkit.storage.scrub_schedule import ScheduledRead, due_reads
from quadpatch_client.schema import MeshProblem, MeshState

# Of one round; the next one comes as long after it.
ROUND_S = 60.0
_MB = 1 << 20
_TRIES = 2
_PROBLEM = MeshProblem(
    code=MESH_DAMAGED, message="the bytes of the mesh in the store are not those that were uploaded; upload it again"
)
IsOver = Callable[[], bool]

_log = logging.getLogger("quadpatch.scrub")


class ObjectState(Enum):
    """The state of an object after it was read."""

    SOUND = "sound"
    DAMAGED = "damaged"
    UNREADABLE = "unreadable"
    MISSING = "missing"


@dataclass(frozen=True)
class ScrubCounts:
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

    named_object: NamedObject
    state: ObjectState
    size_bytes: int
    used_at: datetime | None


class _StoppedError(Exception):
    """The round has to stop: the process ends, or leads no longer."""


class Scrub:
    """Reads the objects that are due, one round at a time; the database records which were read.

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

    def round(self, is_over: IsOver = lambda: False) -> ScrubCounts:
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
            for scheduled in self._due(pace, is_over):
                try:
                    readings = [self._read(named_object, pace, is_over) for named_object in scheduled.objects]
                except _StoppedError:
                    break
                damaged += self._note(scheduled, readings)
                objects += len(readings)
                size_bytes += sum(reading.size_bytes for reading in readings)
        return ScrubCounts(objects, size_bytes, damaged)

    def _due(self, pace: "_Pace", is_over: IsOver) -> Iterator[ScheduledRead]:
        while True:
            with self._database.read() as session:
                batch = due_reads(session, self._limits.days, shared_now(session))
            for scheduled in batch:
                if is_over() or pace.is_used_up:
                    return
                yield scheduled
            if not batch:
                return

    def _read(self, named_object: NamedObject, pace: "_Pace", is_over: IsOver) -> _Reading:
        state, size_bytes, used_at = ObjectState.SOUND, 0, self._used_at(named_object)
        for _ in range(_TRIES):
            state, read_bytes = self._read_once(named_object, pace, is_over)
            size_bytes += read_bytes
            if state in (ObjectState.SOUND, ObjectState.MISSING):
                break
        return _Reading(named_object, state, size_bytes, used_at)

    def _used_at(self, named_object: NamedObject) -> datetime | None:
        if named_object.kind != "mesh":
            return None
        with self._database.read() as session:
            return session.scalar(select(func.max(MeshRow.used_at)).where(MeshRow.key == named_object.key))

    def _read_once(self, named_object: NamedObject, pace: "_Pace", is_over: IsOver) -> tuple[ObjectState, int]:
        digest, size_bytes = hashlib.sha256(), 0
        try:
            for chunk in self._store.read(named_object.key):
                if is_over():
                    raise _StoppedError
                digest.update(chunk)
                size_bytes += len(chunk)
                pace.count(len(chunk))
        except ObjectNotFoundError:
            return ObjectState.MISSING, size_bytes
        except StoreUnavailableError as error:
            # Raises where the whole store fails; otherwise only this object is unreadable.
            self._store.check()
            _log.warning("%s can't be read: %s", named_object.key, error)
            return ObjectState.UNREADABLE, size_bytes
        return ObjectState.SOUND if digest.hexdigest() == named_object.sha256 else ObjectState.DAMAGED, size_bytes

    def _note(self, scheduled: ScheduledRead, readings: list[_Reading]) -> int:
        """Record the results; return how many objects are damaged that were not known to be."""
        with self._database.write() as session:
            now = shared_now(session)
            if scheduled.table is not None and scheduled.row is not None:
                session.execute(update(scheduled.table).where(scheduled.row).values(checked_at=now))
            damaged = sum(_note_one(session, reading, now) for reading in readings)
            if readings:
                kinds = {"kind": readings[0].named_object.kind, "objects": len(readings)}
                add_up(session, ScrubRow, [kinds | {"size_bytes": sum(reading.size_bytes for reading in readings)}])
        return damaged


def scrub_task(settings: Settings, database: Database, store: ObjectStore) -> Callable[[IsOver], str]:
    """Return the periodic task that runs one round of the scrub and says in words what it read.

    Parameters
    ----------
    settings : Settings
    database : Database
    store : ObjectStore
    """
    scrub = Scrub(database, store, ScrubLimits(settings.scrub_days, settings.scrub_mb_s * _MB))

    def run_round(is_over: IsOver) -> str:
        counts = scrub.round(is_over)
        if not counts.objects:
            return ""
        return f"checked {counts.objects} objects, {counts.size_bytes} bytes; {counts.damaged} more are damaged"

    return run_round


class _Pace:
    """Lets a round read no faster, and no more, than the limits allow."""

    def __init__(self, limits: ScrubLimits, pause: Callable[[float], object]) -> None:
        self._limits = limits
        self._pause = pause
        self._started_at = time.monotonic()
        self._n_bytes = 0

    @property
    def is_used_up(self) -> bool:
        """Whether the round has read as much as it may."""
        return self._n_bytes >= self._limits.bytes_per_s * self._limits.round_s

    def count(self, n_bytes: int) -> None:
        """Count bytes that were read, and wait until so many may be."""
        self._n_bytes += n_bytes
        ahead_s = self._n_bytes / self._limits.bytes_per_s - (time.monotonic() - self._started_at)
        if ahead_s > 0:
            self._pause(ahead_s)


def _note_one(session: Session, reading: _Reading, now: datetime) -> bool:
    named_object, meshes = reading.named_object, _locked_meshes(session, reading.named_object)
    if meshes and max(mesh.used_at for mesh in meshes) != reading.used_at:
        return False  # its bytes were uploaded again meanwhile
    if reading.state in (ObjectState.SOUND, ObjectState.MISSING):
        forget_damaged(session, named_object.key)
        for mesh in filter(is_damaged, meshes if reading.state is ObjectState.SOUND else []):
            restart(mesh, mesh.filename, mesh.format)
        return False
    for mesh in meshes if reading.state is ObjectState.DAMAGED else []:
        if not is_damaged(mesh):
            mesh.state, mesh.problem = MeshState.REJECTED.value, _PROBLEM.model_dump(mode="json")
            mesh.lease_until, mesh.updated_at = None, now
    is_new = note_damaged(session, named_object, now)
    if is_new:
        _log.error(
            "%s is %s: its sha256 was %s when it was stored", named_object.key, reading.state.value, named_object.sha256
        )
    return is_new


def _locked_meshes(session: Session, named_object: NamedObject) -> list[MeshRow]:
    """Lock the meshes of an object: several tenants may have uploaded the same bytes."""
    if named_object.kind != "mesh":
        return []
    return list(session.scalars(select(MeshRow).where(MeshRow.key == named_object.key).with_for_update()))

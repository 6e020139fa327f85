"""Rows and objects for tests of retention and sweeps, and a store whose objects age and whose user can be killed."""

import contextlib
import hashlib
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager
from datetime import datetime, timedelta
from pathlib import Path

from sqlalchemy import delete, inspect, select, update

from dispatcher.unreferenced_objects import CONTENT_PREFIXES, RESULT_PREFIX
from jobkit.database.session import Database
from jobkit.database.tables import (
    AttemptRow,
    DamagedRow,
    EventRow,
    IdempotencyRow,
    JobRow,
    MeshRow,
    ModelRow,
    RemovalRow,
)
from jobkit.jobs.attempts import Attempts
from jobkit.jobs.jobs import Jobs
from jobkit.jobs.new_jobs import NewJob
from jobkit.meshes import Meshes
from jobkit.storage.base import ListedObject, ObjectStore, ObjectWriter, StoredObject, result_key
from jobkit.storage.removals import assure
from quadpatch_client.schema import Job, JobError, JobResult, JobSpec, Mesh, ResolvedModel, ResultFile

DAY = timedelta(days=1)


def put(store: ObjectStore, data: bytes, prefix: str = "meshes", key: str | None = None) -> StoredObject:
    """Write an object that no row names yet."""
    with store.writer(prefix) as writer:
        writer.write(data)
        return writer.commit(key)


def upload(database: Database, store: ObjectStore, data: bytes) -> Mesh:
    """Do what the service does with an upload."""
    stored = put(store, data)
    assure(database, store, stored.key, claim_wait_s=0)
    return Meshes(database).add(stored, "scan.ply", "ply")[0]


def new_job(mesh: Mesh) -> NewJob:
    return NewJob(JobSpec(mesh_id=mesh.id), ResolvedModel(requested="self", kind="self"), max_attempts=3)


def finish(database: Database, store: ObjectStore, job_id: str) -> Job:
    """Do what a worker does with a job that succeeds."""
    attempts = Attempts(database)
    attempt = attempts.start(job_id, "w", 60).attempt
    data = b"repaired"
    stored = put(store, data, key=result_key(job_id, attempt.number, "repaired.ply"))
    file = ResultFile(
        role="result", name="repaired.ply", media_type="model/ply", size_bytes=len(data), sha256=stored.sha256
    )
    attempts.publish(attempt, JobResult(format="ply", files=[file]))
    return Jobs(database).get(job_id)


def fail(database: Database, store: ObjectStore, job_id: str) -> None:
    """Do what a worker does that is killed after it wrote its files, and whose job is then given up."""
    attempts = Attempts(database)
    attempt = attempts.start(job_id, "w", 60).attempt
    put(store, b"never published", key=result_key(job_id, attempt.number, "repaired.ply"))
    attempts.fail(attempt, JobError(code="worker_lost", message="lost"))


def keys_in(store: ObjectStore) -> set[str]:
    return {found.key for found in store.keys("")}


def clear(database: Database, store: ObjectStore) -> None:
    """Remove all rows and objects."""
    with database.write() as session:
        for table in (IdempotencyRow, EventRow, AttemptRow, JobRow, MeshRow, ModelRow, RemovalRow):
            session.execute(delete(table))
    for prefix in (*CONTENT_PREFIXES, RESULT_PREFIX):
        store.delete_prefix(prefix)


def age_rows(database: Database, by: timedelta) -> None:
    """Set all moments in the database back."""
    columns = [
        (MeshRow, MeshRow.used_at),
        (MeshRow, MeshRow.created_at),
        (MeshRow, MeshRow.checked_at),
        (JobRow, JobRow.finished_at),
        (JobRow, JobRow.checked_at),
        (ModelRow, ModelRow.created_at),
        (ModelRow, ModelRow.checked_at),
        (DamagedRow, DamagedRow.checked_at),
        (RemovalRow, RemovalRow.until),
    ]
    with database.write() as session:
        for table, column in columns:
            keys_of = list(inspect(table).primary_key)
            for *identity, moment in session.execute(select(*keys_of, column).where(column.is_not(None))).all():
                same = [name == value for name, value in zip(keys_of, identity, strict=True)]
                session.execute(update(table).where(*same).values({column.key: moment - by}))


class KilledError(Exception):
    """Stands for the end of the process at that moment."""


class AgingStore:
    """A real store with a clock that can be set forward, and that can end its user.

    Its user is killed at the `kill_countdown`-th deletion or listing from now: before it, or right after it where
    `kills_after`. `on_delete` and `on_list` are called before a deletion and at the beginning of a listing.
    """

    def __init__(self, store: ObjectStore) -> None:
        self._store = store
        self._elapsed = timedelta(0)
        self._put_at: dict[str, timedelta] = {}
        self.kill_countdown: int | None = None
        self.kills_after = False
        self.on_delete: Callable[[str], object] = lambda key: None
        self.on_list: Callable[[str], object] = lambda prefix: None

    def wait(self, by: timedelta) -> None:
        self._elapsed += by

    def writer(self, prefix: str, max_bytes: int | None = None) -> ObjectWriter:
        return _RecordingWriter(self._store.writer(prefix, max_bytes), self._note)

    def put_file(self, key: str, path: Path) -> StoredObject:
        self._note(key)
        return self._store.put_file(key, path)

    def size(self, key: str) -> int:
        return self._store.size(key)

    def read(self, key: str, start: int = 0, length: int | None = None) -> Iterator[bytes]:
        return self._store.read(key, start, length)

    def local_file(self, key: str) -> AbstractContextManager[Path]:
        return self._store.local_file(key)

    def keys(self, prefix: str = "") -> Iterator[ListedObject]:
        self.on_list(prefix)
        with self._killing():
            listed = list(self._store.keys(prefix))
        yield from (found._replace(modified_at=self._aged(found)) for found in listed)

    def check(self) -> None:
        self._store.check()

    @property
    def is_local(self) -> bool:
        return self._store.is_local

    def free_bytes(self) -> int:
        return self._store.free_bytes()

    def delete(self, key: str) -> None:
        self.on_delete(key)
        with self._killing():
            self._store.delete(key)

    def delete_prefix(self, prefix: str) -> None:
        with self._killing():
            self._store.delete_prefix(prefix)

    def _note(self, key: str) -> None:
        self._put_at[key] = self._elapsed

    def _aged(self, found: ListedObject) -> datetime:
        return found.modified_at - (self._elapsed - self._put_at.get(found.key, timedelta(0)))

    @contextlib.contextmanager
    def _killing(self) -> Iterator[None]:
        is_killed = self.kill_countdown == 0
        self.kill_countdown = None if self.kill_countdown in (None, 0) else self.kill_countdown - 1
        if is_killed and not self.kills_after:
            raise KilledError
        yield
        if is_killed:
            raise KilledError


class _RecordingWriter:
    def __init__(self, writer: ObjectWriter, note: Callable[[str], None]) -> None:
        self._writer = writer
        self._note = note

    def write(self, chunk: bytes) -> None:
        self._writer.write(chunk)

    @property
    def sha256(self) -> str:
        return self._writer.sha256

    def commit(self, key: str | None = None) -> StoredObject:
        stored = self._writer.commit(key)
        self._note(stored.key)
        return stored

    def __enter__(self) -> "_RecordingWriter":
        self._writer.__enter__()
        return self

    def __exit__(self, *failure: object) -> None:
        self._writer.__exit__(*failure)  # type: ignore[arg-type]


def damage(store: ObjectStore, key: str, folder: Path) -> None:
    """Flip four bits of an object, as a disk may."""
    data = bytearray(b"".join(store.read(key)))
    for place in range(len(data) // 2, min(len(data), len(data) // 2 + 4)):
        data[place] ^= 0x10
    path = folder / "damaged"
    path.write_bytes(data)
    store.put_file(key, path)


def sha256(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()

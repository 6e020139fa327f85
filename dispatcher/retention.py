"""Periodic tasks that remove what is past its retention, and compare database and store."""

import logging
from collections.abc import Callable
from datetime import datetime, timedelta

from dispatcher.missing_objects import MissingCounts, MissingObjects
from dispatcher.unreferenced_objects import SweepResult, sweep_objects
from jobkit.access.audit import AuditLog
from jobkit.batches.progress import expire_batches
from jobkit.database.clock import shared_now
from jobkit.database.idempotency import forget_keys
from jobkit.database.session import Database
from jobkit.errors import StoreUnavailableError
from jobkit.retention import expire_jobs, expire_meshes
from jobkit.settings import Settings
from jobkit.storage.base import ObjectStore
from jobkit.uploads.uploads import EXPIRED_AT_ONCE, expire_uploads

_log = logging.getLogger("quadpatch.retention")


def remove_expired(settings: Settings, database: Database, store: ObjectStore, is_over: Callable[[], bool]) -> str:
    """Remove what is past its retention: jobs, batches, meshes, resumable uploads; return how many, in words."""
    with database.read() as session:
        now = shared_now(session)
    jobs = expire_jobs(database, store, settings.job_retention_days, now, is_over)
    batches = expire_batches(database, settings.job_retention_days, now)
    # After the jobs: a mesh is kept as long as a job names it.
    meshes = expire_meshes(database, settings.mesh_retention_days, now, is_over)
    uploads = _remove_uploads(database, store, now, is_over)
    forget_keys(database, now)
    removed = {"jobs": jobs, "batches": batches, "meshes": meshes, "uploads": uploads}
    words = ", ".join(f"{count} {name}" for name, count in removed.items() if count)
    return f"removed {words}" if words else ""


def _remove_uploads(database: Database, store: ObjectStore, now: datetime, is_over: Callable[[], bool]) -> int:
    n_removed, n_last = 0, EXPIRED_AT_ONCE
    while n_last == EXPIRED_AT_ONCE and not is_over():
        n_last, keys = expire_uploads(database, now)
        n_removed += n_last
        try:
            for key in keys:
                store.delete(key)
        except StoreUnavailableError as error:
            _log.warning("parts of uploads are left to the sweep: %s", error)
    return n_removed


def forget_audit(database: Database, days: float, is_over: Callable[[], bool]) -> str:
    """Remove entries of the audit log that are older than `days`; return how many were removed, in words."""
    log, n_removed = AuditLog(database), 0
    with database.read() as session:
        moment = shared_now(session) - timedelta(days=days)
    while not is_over():
        n_batch = log.forget_before(moment)
        n_removed += n_batch
        if n_batch == 0:
            break
    return f"removed {n_removed} entries of the audit log" if n_removed else ""


class Sweeper:
    """Deletes objects without a row, and marks rows without an object.

    Parameters
    ----------
    database : Database
    store : ObjectStore
    """

    def __init__(self, database: Database, store: ObjectStore) -> None:
        self._database = database
        self._store = store
        self._missing = MissingObjects(database, store)

    def sweep(self, is_over: Callable[[], bool]) -> str:
        """Sweep objects and rows; return what was found, in words."""
        with self._database.read() as session:
            now = shared_now(session)
        deleted = sweep_objects(self._database, self._store, now, is_over)
        missing = self._missing.look(is_over)
        return "; ".join(_describe(deleted, missing))


def _describe(deleted: SweepResult, missing: MissingCounts) -> list[str]:
    counts = [
        (deleted.objects, f"deleted {deleted.objects} objects without a row, {deleted.size_bytes} bytes"),
        (missing.meshes, f"{missing.meshes} meshes are gone from the store and were marked"),
        (missing.found_again, f"{missing.found_again} meshes are in the store again"),
        (missing.results, f"{missing.results} finished jobs lack files of their result"),
        (missing.models, f"{missing.models} models lack their file"),
    ]
    return [words for count, words in counts if count]

"""Objects that no row names: left behind by crashes, deletions and uploads that were broken off.

Only an object that has not changed for GRACE is deleted: the writer of an object lets a row name it soon after. And a
database that is younger than that deletes nothing at all: one that was just set up, by a slip of a setting or before
its backup was restored, knows nothing of what the store holds. (What tells its age are its models and meshes: the
models that ship are registered at the first start, and stay.)

A store belongs to one database. Where two share one, each takes the objects of the other for unreferenced.
"""

import contextlib
import logging
import time
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from datetime import datetime, timedelta
from itertools import islice

from sqlalchemy import func, select

from jobkit.database.session import Database
from jobkit.database.tables import JobRow, MeshRow, ModelRow
from jobkit.errors import ObjectNotFoundError
from jobkit.schema import JobState
from jobkit.storage.base import ListedObject, ObjectStore, result_key
from jobkit.storage.removals import START_S, claim, named_keys, release

GRACE = timedelta(hours=24)
CONTENT_PREFIXES = ("meshes", "models")
RESULT_PREFIX = "results"
# Objects of one question to the database, and claims of one turn.
_BATCH = 500
_CLAIMS = 50

_log = logging.getLogger("quadpatch.sweep")


@dataclass(frozen=True)
class SweepResult:
    """What a sweep deleted."""

    objects: int = 0
    size_bytes: int = 0

    def __add__(self, other: "SweepResult") -> "SweepResult":
        return SweepResult(self.objects + other.objects, self.size_bytes + other.size_bytes)


def sweep_objects(
    database: Database, store: ObjectStore, now: datetime, is_over: Callable[[], bool] = lambda: False
) -> SweepResult:
    """Delete objects that no row names and that did not change for GRACE.

    Parameters
    ----------
    database : Database
    store : ObjectStore
    now : datetime
    is_over : callable
        Whether to break off; asked before each batch.

    Raises
    ------
    StoreUnavailableError
        If the store can't be listed or written.
    """
    before = now - GRACE
    if not _is_older(database, before):
        _log.info("nothing is swept: the oldest row of the database is younger than %s", GRACE)
        return SweepResult()
    swept = SweepResult()
    for batch in _old_objects(store, RESULT_PREFIX, before):
        if is_over():
            return swept
        swept += _sweep_results(database, store, batch)
    for prefix in CONTENT_PREFIXES:
        for batch in _old_objects(store, prefix, before):
            if is_over():
                return swept
            swept += _sweep_contents(database, store, batch, before)
    return swept


def _is_older(database: Database, moment: datetime) -> bool:
    with database.read() as session:
        births = [session.scalar(select(func.min(table.created_at))) for table in (ModelRow, MeshRow)]
    return any(birth is not None and birth < moment for birth in births)


def _old_objects(store: ObjectStore, prefix: str, before: datetime) -> Iterator[list[ListedObject]]:
    old = (found for found in store.keys(prefix) if found.modified_at < before)
    while batch := list(islice(old, _BATCH)):
        yield batch


def _sweep_results(database: Database, store: ObjectStore, batch: list[ListedObject]) -> SweepResult:
    """Delete results of jobs that are gone, of attempts that published nothing, and of names that were never given."""
    wanted = _wanted_results(database, {_job_of(found.key) for found in batch})
    return _delete(store, (found for found in batch if not _is_wanted(found.key, wanted)))


def _job_of(key: str) -> str:
    return key.split("/")[1]


def _wanted_results(database: Database, job_ids: set[str]) -> dict[str, set[str]]:
    """Return, for each job that is there, the keys that it names; those of an attempt at work as `results/…/1/`."""
    wanted: dict[str, set[str]] = {}
    with database.read() as session:
        query = select(JobRow.id, JobRow.state, JobRow.attempt, JobRow.result).where(JobRow.id.in_(job_ids))
        for job_id, state, attempt, result in session.execute(query):
            files = [file["name"] for file in (result or {}).get("files", [])]
            names = files if JobState(state).is_terminal else [""]
            wanted[job_id] = {result_key(job_id, attempt, name) for name in names}
    return wanted


def _is_wanted(key: str, wanted: dict[str, set[str]]) -> bool:
    names = wanted.get(_job_of(key), set())
    return key in names or key.rpartition("/")[0] + "/" in names


def _sweep_contents(database: Database, store: ObjectStore, batch: list[ListedObject], before: datetime) -> SweepResult:
    """Delete meshes and models that no row names; `jobkit.storage.removals` handles uploads of the same bytes."""
    keys = {found.key for found in batch}
    with database.read() as session:
        keys -= named_keys(session, keys)
    folders: defaultdict[str, list[str]] = defaultdict(list)
    for key in sorted(keys):
        folders[key.rpartition("/")[0]].append(key)
    swept = SweepResult()
    for folder, orphans in folders.items():
        for start in range(0, len(orphans), _CLAIMS):
            swept += _remove(database, store, folder, orphans[start : start + _CLAIMS], before)
    return swept


def _remove(database: Database, store: ObjectStore, folder: str, keys: list[str], before: datetime) -> SweepResult:
    deadline = time.monotonic() + START_S
    claimed = claim(database, keys)
    if not claimed:
        return SweepResult()
    # The last look at their age, now that they are claimed.
    found = [found for found in store.keys(folder) if found.key in claimed and found.modified_at < before]
    # A deletion that failed may still take effect, so an error leaves the claims to run out.
    swept = _delete(store, (orphan for orphan in found if time.monotonic() < deadline))
    release(database, claimed)
    return swept


def _delete(store: ObjectStore, orphans: Iterable[ListedObject]) -> SweepResult:
    swept = SweepResult()
    for orphan in orphans:
        # A file that was put there under no name of ours stays.
        with contextlib.suppress(ObjectNotFoundError):
            store.delete(orphan.key)
            swept += SweepResult(1, orphan.size_bytes)
    return swept

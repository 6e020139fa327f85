"""Objects that no row names: left behind by crashes, deletions and uploads that were broken off.

Only an object that has not changed for GRACE is deleted: the writer of an object lets a row name it soon after. And a
database that is younger than that deletes nothing at all: one that was just set up, by a wrong setting or before
its backup was restored, has no rows for the objects of the store. (Its age is that of its oldest model or mesh: the
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
from functools import partial
from itertools import islice

from sqlalchemy import func, or_, select

from jobkit.database.session import Database
from jobkit.database.tables import JobRow, MeshRow, ModelRow
from jobkit.errors import ObjectNotFoundError
from jobkit.storage.base import ListedObject, ObjectStore, result_key
from jobkit.storage.removals import START_S, claim, named_keys, release
from jobkit.storage.result_files import file_keys
from jobkit.uploads.parts import PART_PREFIX, named_parts
from quadpatch_client.schema import JobState

GRACE = timedelta(hours=24)
CONTENT_PREFIXES = ("meshes", "models", "views")
RESULT_PREFIX = "results"
# Objects of one query, and claims of one transaction.
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


_Sweep = Callable[[Database, ObjectStore, list[ListedObject]], SweepResult]


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
    deleted = SweepResult()
    sweeps: dict[str, Callable[[Database, ObjectStore, list[ListedObject]], SweepResult]] = {
        RESULT_PREFIX: _sweep_results,
        PART_PREFIX: _sweep_parts,
    }
    sweeps |= dict.fromkeys(CONTENT_PREFIXES, partial(_sweep_contents, before=before))
    for prefix, sweep in sweeps.items():
        for batch in _old_objects(store, prefix, before):
            if is_over():
                return deleted
            deleted += sweep(database, store, batch)
    return deleted


def _is_older(database: Database, moment: datetime) -> bool:
    with database.read() as session:
        oldest_rows = [session.scalar(select(func.min(table.created_at))) for table in (ModelRow, MeshRow)]
    return any(created_at is not None and created_at < moment for created_at in oldest_rows)


def _old_objects(store: ObjectStore, prefix: str, before: datetime) -> Iterator[list[ListedObject]]:
    old = (listed for listed in store.keys(prefix) if listed.modified_at < before)
    while batch := list(islice(old, _BATCH)):
        yield batch


def _sweep_results(database: Database, store: ObjectStore, batch: list[ListedObject]) -> SweepResult:
    """Delete results of jobs that are gone, of attempts that published nothing, and under names that no result has."""
    wanted = _wanted_results(database, {_job_of(listed.key) for listed in batch})
    return _delete(store, (listed for listed in batch if not _is_wanted(listed.key, wanted)))


def _job_of(key: str) -> str:
    return key.split("/")[1]


def _wanted_results(database: Database, job_ids: set[str]) -> dict[str, set[str]]:
    """Return, for each job, the keys that rows name of it; those of an attempt at work as `results/…/1/`."""
    wanted: dict[str, set[str]] = {}
    with database.read() as session:
        query = select(JobRow).where(or_(JobRow.id.in_(job_ids), JobRow.cached_from.in_(job_ids)))
        for row in session.scalars(query):
            is_over = JobState(row.state).is_terminal
            keys = set(file_keys(row)) if is_over else {result_key(row.id, row.attempt, "")}
            wanted.setdefault(row.cached_from or row.id, set()).update(keys)
    return wanted


def _is_wanted(key: str, wanted: dict[str, set[str]]) -> bool:
    names = wanted.get(_job_of(key), set())
    return key in names or key.rpartition("/")[0] + "/" in names


def _sweep_parts(database: Database, store: ObjectStore, batch: list[ListedObject]) -> SweepResult:
    """Delete parts that no resumable upload names. They need no claims: the key of a part is never written again."""
    named = named_parts(database, {listed.key for listed in batch})
    return _delete(store, (listed for listed in batch if listed.key not in named))


def _sweep_contents(database: Database, store: ObjectStore, batch: list[ListedObject], before: datetime) -> SweepResult:
    """Delete meshes, models, views that no row names; `jobkit.storage.removals` handles uploads of the same bytes."""
    keys = {listed.key for listed in batch}
    with database.read() as session:
        keys -= named_keys(session, keys)
    folders: defaultdict[str, list[str]] = defaultdict(list)
    for key in sorted(keys):
        folders[key.rpartition("/")[0]].append(key)
    deleted = SweepResult()
    for folder, orphans in folders.items():
        for start in range(0, len(orphans), _CLAIMS):
            deleted += _remove(database, store, folder, orphans[start : start + _CLAIMS], before)
    return deleted


def _remove(database: Database, store: ObjectStore, folder: str, keys: list[str], before: datetime) -> SweepResult:
    deadline = time.monotonic() + START_S
    claimed = claim(database, keys)
    if not claimed:
        return SweepResult()
    # Their age is checked again, now that they are claimed.
    unreferenced = [listed for listed in store.keys(folder) if listed.key in claimed and listed.modified_at < before]
    # A deletion that failed may still take effect, so an error leaves the claims to run out.
    deleted = _delete(store, (orphan for orphan in unreferenced if time.monotonic() < deadline))
    release(database, claimed)
    return deleted


def _delete(store: ObjectStore, orphans: Iterable[ListedObject]) -> SweepResult:
    deleted = SweepResult()
    for orphan in orphans:
        # A file whose name is no key of the store is not deleted.
        with contextlib.suppress(ObjectNotFoundError):
            store.delete(orphan.key)
            deleted += SweepResult(1, orphan.size_bytes)
    return deleted

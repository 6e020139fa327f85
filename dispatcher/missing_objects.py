"""Rows whose object is gone from the store: after a partial restore, or a deletion by hand.

A mesh is marked as rejected with the code `mesh_missing`, and jobs that still wait for it fail with the same; it is
analysed again once the store has its bytes again. A finished job keeps its row
and its events, and what was lost of its result is answered with `result_missing`. Each look asks the store for some
objects only, and continues after the last one.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from sqlalchemy import select, update

from jobkit.database.clock import utc_now
from jobkit.database.session import Database
from jobkit.database.tables import JobRow, MeshRow, ModelRow
from jobkit.errors import ObjectNotFoundError
from jobkit.meshes import MESH_MISSING, is_missing, restart
from jobkit.storage.base import ObjectStore
from jobkit.storage.result_files import file_keys
from quadpatch_client.schema import JobState, MeshProblem, MeshState

# Rows of one kind in one look: a request each to a remote store.
MOST = 1000
_WITH_RESULT = tuple(state.value for state in JobState if state.has_result)
_PROBLEM = MeshProblem(code=MESH_MISSING, message="the bytes of the mesh are gone from the store; upload them again")


@dataclass(frozen=True)
class MissingCounts:
    """What one look found: meshes that were marked or found again, results and models without their files."""

    meshes: int = 0
    found_again: int = 0
    results: int = 0
    models: int = 0


class MissingObjects:
    """Looks for rows without their object.

    Parameters
    ----------
    database : Database
    store : ObjectStore
    most : int
        Rows of one kind in one look.
    """

    def __init__(self, database: Database, store: ObjectStore, most: int = MOST) -> None:
        self._database = database
        self._store = store
        self._most = most
        self._last_mesh = ""
        self._last_job = ""

    def look(self, is_over: Callable[[], bool] = lambda: False) -> MissingCounts:
        """Look at the next rows, and mark what is missing.

        Parameters
        ----------
        is_over : callable
            Whether to break off; asked before each row.

        Raises
        ------
        StoreUnavailableError
            If the store does not answer: then nothing is known to be missing.
        """
        meshes = [self._check_mesh(row) for row in _until(is_over, self._next_meshes())]
        results = sum(self._lacks_files(row) for row in _until(is_over, self._next_jobs()))
        models = sum(not self._is_there(key) for key in _until(is_over, self._model_keys()))
        return MissingCounts(meshes.count("missing"), meshes.count("found again"), results, models)

    def _next_meshes(self) -> list[MeshRow]:
        with self._database.read() as session:
            query = select(MeshRow).where(MeshRow.id > self._last_mesh).order_by(MeshRow.id).limit(self._most)
            rows = list(session.scalars(query))
        self._last_mesh = rows[-1].id if len(rows) == self._most else ""
        return rows

    def _next_jobs(self) -> list[JobRow]:
        with self._database.read() as session:
            query = select(JobRow).where(JobRow.state.in_(_WITH_RESULT), JobRow.id > self._last_job)
            rows = list(session.scalars(query.order_by(JobRow.id).limit(self._most)))
        self._last_job = rows[-1].id if len(rows) == self._most else ""
        return rows

    def _model_keys(self) -> list[str]:
        with self._database.read() as session:
            return list(session.scalars(select(ModelRow.key).distinct()))

    def _check_mesh(self, row: MeshRow) -> str:
        """Compare a mesh with the store; an upload in between changes `used_at`, and nothing is marked then."""
        is_there = self._is_there(row.key)
        if is_there != is_missing(row):
            return ""
        with self._database.write() as session:
            if is_there:
                again = session.get(MeshRow, row.id, with_for_update=True)
                if again is None or not is_missing(again):
                    return ""
                restart(again, again.filename, again.format)
                return "found again"
            values = {"state": MeshState.REJECTED.value, "problem": _PROBLEM.model_dump(mode="json")}
            unchanged = update(MeshRow).where(MeshRow.id == row.id, MeshRow.used_at == row.used_at)
            result: Any = session.execute(unchanged.values(**values, lease_until=None, updated_at=utc_now()))
            return "missing" if result.rowcount else ""

    def _lacks_files(self, row: JobRow) -> bool:
        if all(map(self._is_there, file_keys(row))):
            return False
        with self._database.write() as session:
            # No files are missing where the job was deleted meanwhile. No other job takes over what is left.
            result: Any = session.execute(update(JobRow).where(JobRow.id == row.id).values(fingerprint=None))
            return bool(result.rowcount)

    def _is_there(self, key: str) -> bool:
        try:
            self._store.size(key)
        except ObjectNotFoundError:
            return False
        return True


def _until(is_over: Callable[[], bool], items: list[Any]) -> Iterator[Any]:
    for item in items:
        if is_over():
            return
        yield item

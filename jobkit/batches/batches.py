"""Batches as clients know them: create, look up, list, cancel, delete.

A batch and all of its jobs are written in one transaction. So there is no half of one, whenever a process is killed,
and all of its jobs exist once the request is answered. It holds the lock of SQLite for about a second for ten thousand
jobs, and none of PostgreSQL.
"""

from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import dataclass, field
from itertools import islice
from typing import Any

from sqlalchemy import insert, select
from sqlalchemy.orm import Session

from jobkit.batches.events import append_batch_event, read_batch_events
from jobkit.database.batch_rows import count_jobs, existing_batch, to_batch
from jobkit.database.batch_tables import BatchEventRow, BatchRow
from jobkit.database.clock import shared_now, utc_now
from jobkit.database.idempotency import Idempotency, make_once
from jobkit.database.quotas import admit_jobs
from jobkit.database.readable_rows import readable
from jobkit.database.session import Database
from jobkit.database.tables import EventRow, JobRow, MeshRow
from jobkit.database.tenancy import DEFAULT_TENANT, mesh_id_of, tenant_of
from jobkit.errors import BatchFinishedError, BatchSizeError, MeshNotFoundError
from jobkit.jobs.new_jobs import NamedMesh, NewJob, lock_model, mesh_ids_of, values_of
from quadpatch_client.schema import MOST_JOBS, Batch, BatchEventPage, BatchPage, JobState, ResolvedModel
from quadpatch_rules.ids import new_batch_id, new_job_id

# Rows of one statement.
_CHUNK = 500


@dataclass(frozen=True)
class BatchFacts:
    """What a sender says of a batch besides its jobs; `rerun_of` names the batch that it repeats."""

    label: str | None = None
    metadata: dict[str, str] = field(default_factory=dict)
    callback_url: str | None = None
    rerun_of: str | None = None


class Batches:
    """All batches of a database.

    Parameters
    ----------
    database : Database
    retention_days : float
        How long finished jobs are kept, for what clients are told; 0: for ever.
    """

    def __init__(self, database: Database, retention_days: float = 0) -> None:
        self._database = database
        self._retention_days = retention_days

    def create(
        self, facts: BatchFacts, make_jobs: Callable[[], Iterable[NewJob]], idempotency: Idempotency | None = None
    ) -> tuple[Batch, bool]:
        """Write a batch with its jobs, and with them the idempotency key.

        Parameters
        ----------
        facts : BatchFacts
        make_jobs : callable
            Returns the jobs in their order; called again where another request with the same key wins a race.
        idempotency : Idempotency, optional

        Returns
        -------
        Batch, bool
            The batch, and whether it is new: a repeated key gives the batch of the first time.

        Raises
        ------
        IdempotencyError
            If the key came before with another request.
        BatchSizeError
            If there is no job, or there are too many.
        MeshNotFoundError, ModelNotFoundError
            If a mesh, a reference or a version of a model is not there.
        JobQuotaError
            If more jobs of the tenant would wait than may.
        """

        def make(session: Session) -> tuple[Batch, str]:
            row = self._write(session, facts, make_jobs())
            return self._show(session, row), row.id

        return make_once(self._database, idempotency, make, self._show_one)

    def get(self, batch_id: str) -> Batch:
        """Return a batch; raise BatchNotFoundError."""
        with self._database.read() as session:
            return self._show_one(session, batch_id)

    def page(self, limit: int, cursor: str | None = None) -> BatchPage:
        """Return batches, newest first, with their counts as they were seen last.

        Parameters
        ----------
        limit : int
            Most batches on the page.
        cursor : str, optional
            `next_cursor` of the page before.
        """
        query = select(BatchRow).order_by(BatchRow.id.desc()).limit(limit + 1)
        if cursor is not None:
            query = query.where(BatchRow.id < cursor)
        with self._database.read() as session:
            rows = list(session.scalars(query))
        next_cursor = rows[limit - 1].id if len(rows) > limit else None
        items = readable(rows[:limit], lambda row: to_batch(row, None, self._retention_days))
        return BatchPage(items=list(items), next_cursor=next_cursor)

    def events(self, batch_id: str, after: int = 0, limit: int = 200) -> BatchEventPage:
        """Return events of a batch with a sequence number over `after`, oldest first; raise BatchNotFoundError."""
        with self._database.read() as session:
            existing_batch(session, batch_id)
            events = read_batch_events(session, batch_id, after, limit + 1)
        next_after = events[limit - 1].sequence if len(events) > limit else None
        return BatchEventPage(items=events[:limit], next_after=next_after)

    def request_cancel(self, batch_id: str) -> Batch:
        """Have all jobs canceled that have not ended; the dispatcher does it. A second call changes nothing.

        Raises
        ------
        BatchNotFoundError
            If there is no such batch.
        BatchFinishedError
            If it has ended.
        """
        with self._database.write() as session:
            now = shared_now(session)
            row = existing_batch(session, batch_id, locked=True)
            if row.finished_at is not None:
                raise BatchFinishedError(f"batch {batch_id} has already ended")
            if row.cancel_requested_at is None:
                row.cancel_requested_at = now
                append_batch_event(session, row, "cancel_requested", now, {"counts": row.counts})
                session.flush()
            return self._show(session, row)

    def job_ids(self, batch_id: str, states: Collection[JobState] | None = None) -> list[str]:
        """Return the jobs of a batch in their order, of any of the states; raise BatchNotFoundError."""
        query = select(JobRow.id).where(JobRow.batch_id == batch_id).order_by(JobRow.id)
        if states is not None:
            query = query.where(JobRow.state.in_([state.value for state in states]))
        with self._database.read() as session:
            existing_batch(session, batch_id)
            return list(session.scalars(query))

    def _show_one(self, session: Session, batch_id: str) -> Batch:
        return self._show(session, existing_batch(session, batch_id))

    def _show(self, session: Session, row: BatchRow) -> Batch:
        counts = None if row.finished_at is not None else count_jobs(session, row.id)
        return to_batch(row, counts, self._retention_days)

    def _write(self, session: Session, facts: BatchFacts, jobs: Iterable[NewJob]) -> BatchRow:
        tenant, now = tenant_of(session) or DEFAULT_TENANT, utc_now()
        row = BatchRow(
            id=new_batch_id(),
            n_jobs=0,
            counts={},
            revision=1,
            label=facts.label,
            batch_metadata=facts.metadata,
            callback_url=facts.callback_url,
            rerun_of=facts.rerun_of,
            created_at=now,
            tenant=tenant,
        )
        session.add(row)
        session.flush()
        last_id, remaining = "", iter(jobs)
        while chunk := list(islice(remaining, _CHUNK)):
            row.n_jobs += len(chunk)
            if row.n_jobs > MOST_JOBS:
                raise BatchSizeError(f"a batch takes at most {MOST_JOBS} jobs")
            for model in {_key(new.model): new.model for new in chunk}.values():
                lock_model(session, model)
            ids = _ids_after(last_id, len(chunk))
            last_id = ids[-1]
            _write_jobs(session, row, chunk, ids)
        if not row.n_jobs:
            raise BatchSizeError("a batch needs a job at least")
        row.counts = {JobState.QUEUED.value: row.n_jobs}
        data = {"counts": row.counts}
        session.add(BatchEventRow(batch_id=row.id, sequence=1, type="started", at=now, data=data))
        session.flush()
        admit_jobs(session, row.n_jobs)
        return row


def _key(model: ResolvedModel) -> tuple[str | None, int | None]:
    return model.name, model.version


def _ids_after(last_id: str, n_ids: int) -> list[str]:
    """Return fresh ids in ascending order, all of them after one: jobs of a batch keep their order by their ids."""
    ids: list[str] = []
    while len(ids) < n_ids:
        ids += [job_id for job_id in (new_job_id() for _ in range(n_ids - len(ids))) if job_id > last_id]
    return sorted(ids)


def _write_jobs(session: Session, batch: BatchRow, jobs: Sequence[NewJob], ids: Sequence[str]) -> None:
    meshes = _locked_meshes(session, batch.tenant, jobs)
    rows = [
        {**values_of(new, meshes), "id": job_id, "batch_id": batch.id, "tenant": batch.tenant}
        for new, job_id in zip(jobs, ids, strict=True)
    ]
    session.execute(insert(JobRow), rows)
    events: list[dict[str, Any]] = [
        {
            "job_id": row["id"],
            "sequence": 1,
            "type": "queued",
            "at": row["created_at"],
            "attempt": 0,
            "data": {"state": row["state"], "task": row["task"]},
        }
        for row in rows
    ]
    session.execute(insert(EventRow), events)


def _locked_meshes(session: Session, tenant: str, jobs: Sequence[NewJob]) -> dict[str, NamedMesh]:
    """Return the meshes of jobs by the ids that clients know, locked so that they are not deleted meanwhile.

    Raises
    ------
    MeshNotFoundError
        If one of them is not there.
    """
    asked = {sha256 for new in jobs for sha256 in mesh_ids_of(new.spec)}
    own_ids = [mesh_id_of(tenant, sha256) for sha256 in asked]
    query = select(MeshRow.id, MeshRow.sha256, MeshRow.filename).where(MeshRow.id.in_(own_ids)).order_by(MeshRow.id)
    rows = session.execute(query.with_for_update(read=True, key_share=True))
    found: dict[str, NamedMesh] = {row.sha256: row for row in rows}
    missing = next((sha256 for sha256 in asked if sha256 not in found), None)
    if missing is not None:
        raise MeshNotFoundError(f"there is no mesh {missing}")
    return found

"""Jobs as clients know them: create, look up, list, cancel."""

from collections.abc import Collection
from dataclasses import dataclass
from typing import Any

from sqlalchemy import Row, bindparam, select
from sqlalchemy.orm import Session

from jobkit.database.clock import shared_now
from jobkit.database.idempotency import Idempotency, earlier_row, remember
from jobkit.database.job_rows import existing_job, to_job
from jobkit.database.quotas import admit_jobs
from jobkit.database.readable_rows import readable
from jobkit.database.session import Database
from jobkit.database.tables import JobRow, MeshRow
from jobkit.database.tenancy import DEFAULT_TENANT, mesh_id_of, tenant_of
from jobkit.database.training_tables import TrainingMeshRow
from jobkit.errors import JobFinishedError, JobNotFoundError, MeshNotFoundError, RowConflictError
from jobkit.jobs.events import append_event, read_events
from jobkit.jobs.fingerprints import fingerprint_of
from jobkit.jobs.new_jobs import NewJob, lock_model, mesh_ids_of, values_of
from jobkit.jobs.reuse import reuse_result, source_of
from jobkit.jobs.search import JobSearch
from jobkit.jobs.transitions import Transition, make_transition
from jobkit.storage.result_files import file_key, file_keys
from quadpatch_client.schema import EventPage, Job, JobPage, JobState
from quadpatch_rules.ids import new_job_id


@dataclass(frozen=True)
class JobStatus:
    """What shows whether a job has changed."""

    revision: int
    state: JobState
    is_pinned: bool
    tenant: str


# Built once: to build it takes longer than to run it.
_STATUS_QUERY = select(JobRow.id, JobRow.revision, JobRow.state, JobRow.pinned, JobRow.tenant).where(
    JobRow.id.in_(bindparam("ids", expanding=True))
)


class Jobs:
    """All jobs of a database.

    Parameters
    ----------
    database : Database
    retention_days : float
        How long finished jobs are kept, for what clients are told; 0: for ever.
    """

    def __init__(self, database: Database, retention_days: float = 0) -> None:
        self._database = database
        self._retention_days = retention_days

    def create(self, new: NewJob, idempotency: Idempotency | None = None) -> tuple[Job, bool]:
        """Write a queued job, and with it the idempotency key.

        Returns
        -------
        Job, bool
            The job, and whether it is new: a repeated key gives the job of the first time.

        Raises
        ------
        IdempotencyError
            If the key came before with another request.
        MeshNotFoundError, ModelNotFoundError
            If the mesh, its reference or the version of the model is not there.
        JobQuotaError
            If as many jobs of the tenant wait as may.
        """
        try:
            return self._create(new, idempotency)
        except RowConflictError:
            # Two requests with one key at the same moment: the other one was first, so its job is the answer.
            return self._create(new, idempotency)

    def earlier(self, idempotency: Idempotency) -> Job | None:
        """Return the job that the request with the key made, None where the key is new; raise IdempotencyError."""
        with self._database.read() as session:
            return self._earlier_job(session, idempotency)

    def get(self, job_id: str) -> Job:
        """Return a job; raise JobNotFoundError."""
        with self._database.read() as session:
            return self._show(existing_job(session, job_id))

    def with_files(self, job_id: str) -> tuple[Job, dict[str, str]]:
        """Return a job, and the key of each file of its result by its name; raise JobNotFoundError."""
        with self._database.read() as session:
            row = existing_job(session, job_id)
            job = self._show(row)
            files = job.result.files if job.result else []
            return job, {file.name: file_key(row, file.name) for file in files}

    def files_to_reuse(self, new: NewJob) -> list[str]:
        """Return the keys of the files that a job would take over from an equal one; none where it would run."""
        with self._database.read() as session:
            fingerprint = fingerprint_of(new.spec, new.model, new.asked_by)
            row = JobRow(fingerprint=fingerprint, tenant=tenant_of(session) or DEFAULT_TENANT)
            source = source_of(session, row, shared_now(session), self._retention_days, is_locked=False)
            return [] if source is None else list(file_keys(source))

    def status(self, job_id: str) -> JobStatus:
        """Return what shows whether a job has changed, at a fraction of the cost of `get`; raise JobNotFoundError."""
        statuses = self.statuses([job_id])
        if job_id not in statuses:
            raise JobNotFoundError(f"there is no job {job_id}")
        return statuses[job_id]

    def statuses(self, job_ids: Collection[str]) -> dict[str, JobStatus]:
        """Return the same for many jobs; those that are not there, or can't be read, are left out."""
        with self._database.read() as session:
            rows = session.execute(_STATUS_QUERY, {"ids": list(job_ids)}).all()
        return dict(readable(rows, _to_status))

    def unfinished(self, job_ids: Collection[str]) -> set[str]:
        """Return those of the jobs that have not ended."""
        return {job_id for job_id, status in self.statuses(job_ids).items() if not status.state.is_terminal}

    def get_many(self, job_ids: Collection[str]) -> dict[str, Job]:
        """Return jobs by their ids; those that are not there, or can't be read, are left out."""
        if not job_ids:
            return {}
        with self._database.read() as session:
            rows = session.scalars(select(JobRow).where(JobRow.id.in_(job_ids)))
            return {job.id: job for job in readable(rows, self._show)}

    def page(self, limit: int, cursor: str | None = None, search: JobSearch | None = None) -> JobPage:
        """Return jobs by age.

        Parameters
        ----------
        limit : int
            Most jobs on the page.
        cursor : str, optional
            `next_cursor` of the page before. Jobs that came later don't shift the pages.
        search : JobSearch, optional
            Only jobs of that kind, and in that order; None: all, newest first.
        """
        search = search or JobSearch()
        query = select(JobRow).order_by(JobRow.id if search.oldest_first else JobRow.id.desc()).limit(limit + 1)
        if cursor is not None:
            query = query.where(JobRow.id > cursor if search.oldest_first else JobRow.id < cursor)
        with self._database.read() as session:
            query = query.where(*search.conditions(tenant_of(session)))
            rows = list(session.scalars(query))
        next_cursor = rows[limit - 1].id if len(rows) > limit else None
        return JobPage(items=list(readable(rows[:limit], self._show)), next_cursor=next_cursor)

    def request_cancel(self, job_id: str) -> Job:
        """Cancel a queued job at once, ask a running one to stop; a second call changes nothing.

        Raises
        ------
        JobFinishedError
            If the job has ended otherwise.
        """
        with self._database.write() as session:
            now = shared_now(session)
            # Locked: it might start between the two transitions, and fit neither.
            existing_job(session, job_id, locked=True)
            transitions = (
                Transition(JobState.QUEUED, JobState.CANCELED, "canceled"),
                Transition(JobState.RUNNING, JobState.CANCELING, "cancel_requested"),
            )
            any(make_transition(session, job_id, transition, now) for transition in transitions)
            job = self._show(existing_job(session, job_id))
        if job.state not in (JobState.CANCELED, JobState.CANCELING):
            raise JobFinishedError(f"job {job_id} has already ended as {job.state.value}")
        return job

    def events(self, job_id: str, after: int = 0, limit: int = 200) -> EventPage:
        """Return events of a job with a sequence number over `after`, oldest first; raise JobNotFoundError."""
        with self._database.read() as session:
            existing_job(session, job_id)
            events = read_events(session, job_id, after, limit + 1)
        next_after = events[limit - 1].sequence if len(events) > limit else None
        return EventPage(items=events[:limit], next_after=next_after)

    def _create(self, new: NewJob, idempotency: Idempotency | None) -> tuple[Job, bool]:
        with self._database.write() as session:
            if idempotency is not None and (earlier := self._earlier_job(session, idempotency)) is not None:
                return earlier, False
            meshes = {mesh_id: _existing_mesh(session, mesh_id) for mesh_id in mesh_ids_of(new.spec)}
            lock_model(session, new.model)
            row = JobRow(id=new_job_id(), **values_of(new, meshes))
            session.add(row)
            session.flush()
            if new.spec.train is not None:
                ids = [_existing_mesh(session, mesh_id).id for mesh_id in new.spec.train.meshes]
                session.add_all(TrainingMeshRow(job_id=row.id, mesh_id=mesh_id) for mesh_id in ids)
            append_event(session, row.id, "queued", row.created_at, {"state": row.state, "task": row.task})
            remember(session, idempotency, job_id=row.id)
            if row.may_reuse and reuse_result(session, row, shared_now(session), self._retention_days):
                row = existing_job(session, row.id)
            else:
                session.flush()
                admit_jobs(session)
            return self._show(row), True

    def _show(self, row: JobRow) -> Job:
        return to_job(row, self._retention_days)

    def _earlier_job(self, session: Session, idempotency: Idempotency) -> Job | None:
        earlier = earlier_row(session, idempotency)
        if earlier is None or earlier.job_id is None:
            return None
        return self._show(existing_job(session, earlier.job_id))


def _to_status(row: Row[*tuple[Any, ...]]) -> tuple[str, JobStatus]:
    return row.id, JobStatus(row.revision, JobState(row.state), row.pinned, row.tenant)


def _existing_mesh(session: Session, mesh_id: str) -> MeshRow:
    mesh = session.get(MeshRow, mesh_id_of(tenant_of(session), mesh_id))
    if mesh is None:
        raise MeshNotFoundError(f"there is no mesh {mesh_id}")
    return mesh

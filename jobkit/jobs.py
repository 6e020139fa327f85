"""Jobs as clients know them: create, look up, list, cancel."""

from dataclasses import dataclass

from sqlalchemy import select
from sqlalchemy.exc import IntegrityError
from sqlalchemy.orm import Session

from jobkit.clock import utc_now
from jobkit.database import Database
from jobkit.errors import IdempotencyError, JobFinishedError, JobNotFoundError, MeshNotFoundError
from jobkit.events import append_event, read_events
from jobkit.ids import new_job_id
from jobkit.schema import EventPage, Job, JobLinks, JobPage, JobSpec, JobState, ResolvedModel
from jobkit.tables import IdempotencyRow, JobRow, MeshRow
from jobkit.transitions import Move, make_move


@dataclass(frozen=True)
class Idempotency:
    """A key that a client sent so that a repeated request starts nothing twice.

    Attributes
    ----------
    principal : str
        Whose key it is: two clients may use the same one.
    key : str
    request_sha256 : str
        Of the request, to tell a repetition from a mix-up.
    """

    principal: str
    key: str
    request_sha256: str


@dataclass(frozen=True)
class NewJob:
    """What a job is created from; `model` is already resolved, and stays."""

    spec: JobSpec
    model: ResolvedModel
    max_attempts: int
    rerun_of: str | None = None


class Jobs:
    """All jobs of a database."""

    def __init__(self, database: Database) -> None:
        self._database = database

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
        MeshNotFoundError
            If the mesh is not there.
        """
        try:
            return self._create(new, idempotency)
        except IntegrityError:
            # Two requests with one key at the same moment: the other one has won, so its job is the answer.
            return self._create(new, idempotency)

    def earlier(self, idempotency: Idempotency) -> Job | None:
        """Return the job that came of the key, None where it is new; raise IdempotencyError."""
        with self._database.read() as session:
            return _earlier_job(session, idempotency)

    def get(self, job_id: str) -> Job:
        """Return a job; raise JobNotFoundError."""
        with self._database.read() as session:
            return to_job(existing_job(session, job_id))

    def page(self, limit: int, cursor: str | None = None, state: JobState | None = None) -> JobPage:
        """Return jobs, newest first.

        Parameters
        ----------
        limit : int
            Most jobs on the page.
        cursor : str, optional
            `next_cursor` of the page before. Jobs that came later don't shift the pages.
        state : JobState, optional
            Only jobs that are in it now.
        """
        query = select(JobRow).order_by(JobRow.id.desc()).limit(limit + 1)
        if cursor is not None:
            query = query.where(JobRow.id < cursor)
        if state is not None:
            query = query.where(JobRow.state == state.value)
        with self._database.read() as session:
            rows = list(session.scalars(query))
        next_cursor = rows[limit - 1].id if len(rows) > limit else None
        return JobPage(items=[to_job(row) for row in rows[:limit]], next_cursor=next_cursor)

    def request_cancel(self, job_id: str) -> Job:
        """Cancel a queued job at once, ask a running one to stop; a second call changes nothing.

        Raises
        ------
        JobFinishedError
            If the job has ended otherwise.
        """
        now = utc_now()
        with self._database.write() as session:
            _ = make_move(session, job_id, Move(JobState.QUEUED, JobState.CANCELED, "canceled"), now) or make_move(
                session, job_id, Move(JobState.RUNNING, JobState.CANCELING, "cancel_requested"), now
            )
            job = to_job(existing_job(session, job_id))
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
            if idempotency is not None and (earlier := _earlier_job(session, idempotency)) is not None:
                return earlier, False
            if session.get(MeshRow, new.spec.mesh_id) is None:
                raise MeshNotFoundError(f"there is no mesh {new.spec.mesh_id}")
            row = _new_row(new)
            session.add(row)
            session.flush()
            append_event(session, row.id, "queued", row.created_at, {"state": row.state})
            if idempotency is not None:
                session.add(
                    IdempotencyRow(
                        principal=idempotency.principal,
                        key=idempotency.key,
                        request_sha256=idempotency.request_sha256,
                        job_id=row.id,
                        created_at=row.created_at,
                    )
                )
            return to_job(row), True


def existing_job(session: Session, job_id: str) -> JobRow:
    """Return the row of a job as it stands now; raise JobNotFoundError."""
    row = session.scalars(
        select(JobRow).where(JobRow.id == job_id).execution_options(populate_existing=True)
    ).one_or_none()
    if row is None:
        raise JobNotFoundError(f"there is no job {job_id}")
    return row


def to_job(row: JobRow) -> Job:
    """Return the row as clients see it."""
    names = Job.model_fields.keys() - {"links"}
    values = {name: getattr(row, name) for name in names}
    return Job.model_validate(values | {"links": _links(row)})


def _links(row: JobRow) -> JobLinks:
    path = f"/v1/jobs/{row.id}"
    state = JobState(row.state)
    roles = {file["role"] for file in (row.result or {}).get("files", [])}
    return JobLinks(
        self=path,
        events=f"{path}/events",
        mesh=f"/v1/meshes/{row.mesh_id}",
        rerun=f"{path}/rerun",
        cancel=None if state.is_terminal else f"{path}/cancel",
        result=f"{path}/result" if "result" in roles else None,
        report=f"{path}/report" if "report" in roles else None,
        preview=f"{path}/preview.png" if "preview" in roles else None,
    )


def _new_row(new: NewJob) -> JobRow:
    now = utc_now()
    return JobRow(
        id=new_job_id(),
        mesh_id=new.spec.mesh_id,
        state=JobState.QUEUED.value,
        attempt=0,
        max_attempts=new.max_attempts,
        revision=1,
        percent=0.0,
        spec=new.spec.model_dump(mode="json"),
        model=new.model.model_dump(mode="json"),
        rerun_of=new.rerun_of,
        queued_at=now,
        created_at=now,
        updated_at=now,
    )


def _earlier_job(session: Session, idempotency: Idempotency) -> Job | None:
    earlier = session.get(IdempotencyRow, (idempotency.principal, idempotency.key))
    if earlier is None:
        return None
    if earlier.request_sha256 != idempotency.request_sha256:
        raise IdempotencyError(f"the idempotency key {idempotency.key!r} came before with another request")
    return to_job(existing_job(session, earlier.job_id))

"""Runs of candidates, as workers do them: after the job has its result, and while no job, analysis or proof waits.

A run is fenced like an analysis: starting it raises `attempt`, and only the latest attempt may write. It is no job: it
counts to no quota, makes no event, sends no message, and its mesh is not delivered.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime, timedelta

from sqlalchemy import ColumnElement, CursorResult, exists, func, or_, select, update
from sqlalchemy.orm import InstrumentedAttribute, Session

from jobkit.database.clock import shared_now, utc_now
from jobkit.database.session import Database
from jobkit.database.shadow_tables import ShadowRow, ShadowRunRow
from jobkit.database.tables import JobRow, MeshRow, ModelRow
from jobkit.database.tenancy import own_name
from jobkit.database.view_tables import ViewRow
from jobkit.errors import ConflictError, ModelNotFoundError, StaleAttemptError
from jobkit.jobs.turns import busy_tenants
from jobkit.models.proofs import reference_of
from jobkit.models.registry import Registry
from jobkit.shadows.choice import is_chosen, is_comparable, made_by, pinned_beside
from jobkit.views import MAKING
from quadpatch_client.schema import Job, JobState, MeshState, ModelState

# Of one candidate: enough to decide by.
MOST_RUNS = 1000
# Before it is given up: attempts that were lost, and time without a worker that is free.
MAX_ATTEMPTS = 3
LONGEST_WAIT = timedelta(days=1)
# A view that was lost is made when it is asked for again, and holds nothing up meanwhile.
_ASKED_FOR = timedelta(seconds=60)


@dataclass(frozen=True)
class StartedRun:
    """A run that a worker has; `attempt` fences, and a failure of the last one settles it."""

    job_id: str
    tenant: str
    candidate: str
    attempt: int
    is_last: bool


@dataclass(frozen=True)
class Comparison:
    """How the holes of a job compare: how many, and the mean error of the candidate over that of the result."""

    holes: int
    ratio: float


class ShadowRuns:
    """The runs of a database that sees all tenants."""

    def __init__(self, database: Database) -> None:
        self._database = database

    def add(self, registry: Registry, job: Job, tenant: str) -> bool:
        """Let the candidate run on a job that has its result, if that is among the share; return whether it is.

        Parameters
        ----------
        registry : Registry
            As the tenant of the job sees it.
        job : Job
        tenant : str
        """
        if not is_comparable(job):
            return False
        name = own_name(tenant, job.model.requested)
        with self._database.read() as session:
            shadow = session.get(ShadowRow, name)
            if shadow is None or not is_chosen(name, job.id, shadow.share) or _n_runs(session, name) >= MOST_RUNS:
                return False
        reference = reference_of(shadow.candidate, shadow.version)
        try:
            _, candidate = pinned_beside(registry, job.spec.method, reference)
        except (ModelNotFoundError, ConflictError):
            return False  # it was deleted, or does not go with the method of this job
        if made_by(candidate) == made_by(job.model):
            return False
        row = ShadowRunRow(
            job_id=job.id,
            tenant=tenant,
            shadow=name,
            candidate=reference,
            baseline=made_by(job.model),
            state="waiting",
            created_at=utc_now(),
        )
        with self._database.write() as session:
            session.add(row)
        return True

    def start(self, job_id: str, worker: str, lease_s: float) -> StartedRun:
        """Take a run.

        Raises
        ------
        StaleAttemptError
            If there is none to be taken now: something else waits for a worker, or another one has it.
        """
        with self._database.write() as session:
            now = shared_now(session)
            row = session.get(ShadowRunRow, job_id, with_for_update=True, populate_existing=True)
            if row is None or row.state != "waiting" or (row.not_before is not None and row.not_before > now):
                raise StaleAttemptError(f"no candidate is to run on job {job_id} now")
            if is_anything_waiting(session, now):
                raise StaleAttemptError(f"the candidate on job {job_id} waits, since others wait for a worker")
            row.state, row.attempt, row.worker = "running", row.attempt + 1, worker
            row.lease_until = now + timedelta(seconds=lease_s)
            is_last = row.attempt - row.forgiven >= MAX_ATTEMPTS
            return StartedRun(job_id, row.tenant, row.candidate, row.attempt, is_last)

    def renew(self, run: StartedRun, lease_s: float) -> None:
        """Prolong the lease; raise StaleAttemptError where the run was taken away or cleared."""
        with self._database.write() as session:
            _write(session, run, {"lease_until": shared_now(session) + timedelta(seconds=lease_s)})

    def gives_way(self) -> bool:
        """Tell whether something waits for a worker, which comes first."""
        with self._database.read() as session:
            return is_anything_waiting(session, shared_now(session))

    def measure(self, run: StartedRun, comparison: Comparison) -> None:
        """Write how the candidate compares; raise StaleAttemptError."""
        self._end(run, "measured", {"holes": comparison.holes, "ratio": comparison.ratio})

    def fail(self, run: StartedRun, code: str, message: str) -> None:
        """Write why the candidate made no result; raise StaleAttemptError."""
        self._end(run, "failed", {"code": code[:64], "message": message[:1000]})

    def drop(self, run: StartedRun, code: str, message: str) -> None:
        """Give a run up; raise StaleAttemptError."""
        self._end(run, "dropped", {"code": code, "message": message})

    def hand_back(self, run: StartedRun, delay_s: float = 0.0, *, is_forgiven: bool = True) -> None:
        """Let it be done later, in so many seconds; raise StaleAttemptError. What lies outside of it is forgiven."""
        with self._database.write() as session:
            not_before = shared_now(session) + timedelta(seconds=delay_s)
            forgiven = ShadowRunRow.forgiven + (1 if is_forgiven else 0)
            values = {"state": "waiting", "lease_until": None, "enqueued_at": None, "not_before": not_before}
            _write(session, run, {**values, "forgiven": forgiven})

    def _end(self, run: StartedRun, state: str, values: Mapping[str, object]) -> None:
        with self._database.write() as session:
            ended = {"state": state, "finished_at": shared_now(session), "lease_until": None, "worker": None}
            _write(session, run, {**ended, **values})


def is_anything_waiting(session: Session, now: datetime) -> bool:
    """Tell whether a job, an analysis, a proof or a view waits for a worker that could take it up."""
    is_due = or_(JobRow.not_before.is_(None), JobRow.not_before <= now, JobRow.memory_wait_since.is_not(None))
    job = exists().where(JobRow.state == JobState.QUEUED.value, is_due, JobRow.tenant.not_in(busy_tenants(session)))
    mesh = exists().where(MeshRow.state == MeshState.ANALYSING.value, _is_free(MeshRow.lease_until, now))
    model = exists().where(ModelRow.state == ModelState.PROVING.value, _is_free(ModelRow.lease_until, now))
    is_asked_for = ViewRow.enqueued_at > now - _ASKED_FOR
    view = exists().where(ViewRow.state == MAKING, _is_free(ViewRow.lease_until, now), is_asked_for)
    return bool(session.scalar(select(or_(job, mesh, model, view))))


def next_run(session: Session, now: datetime) -> tuple[str, int, datetime | None] | None:
    """Return the run that is next, with its attempts so far and when it was put into the queue; one runs at a time."""
    if session.scalar(select(exists().where(ShadowRunRow.state == "running"))):
        return None
    is_due = or_(ShadowRunRow.not_before.is_(None), ShadowRunRow.not_before <= now)
    query = select(ShadowRunRow.job_id, ShadowRunRow.attempt, ShadowRunRow.enqueued_at)
    query = query.where(ShadowRunRow.state == "waiting", is_due).order_by(ShadowRunRow.created_at).limit(1)
    row = session.execute(query).first()
    if row is None or is_anything_waiting(session, now):
        return None
    return row.job_id, row.attempt, row.enqueued_at


def note_enqueued(session: Session, job_id: str) -> None:
    """Write that a run was put into the queue."""
    session.execute(update(ShadowRunRow).where(ShadowRunRow.job_id == job_id).values(enqueued_at=shared_now(session)))


def take_back_runs(session: Session, now: datetime) -> None:
    """Take runs back whose worker is gone, and give up those that were lost often or have waited for long."""
    is_lost = (ShadowRunRow.state == "running") & (ShadowRunRow.lease_until < now)
    is_last = ShadowRunRow.attempt - ShadowRunRow.forgiven >= MAX_ATTEMPTS
    message = f"its worker was lost {MAX_ATTEMPTS} times"
    _give_up(session, is_lost & is_last, ("worker_lost", message), now)
    back = {"state": "waiting", "lease_until": None, "enqueued_at": None}
    session.execute(update(ShadowRunRow).where(is_lost).values(back))
    is_old = (ShadowRunRow.state == "waiting") & (ShadowRunRow.created_at < now - LONGEST_WAIT)
    _give_up(session, is_old, ("busy", "no worker was free for it within a day"), now)


def _give_up(session: Session, condition: ColumnElement[bool], why: tuple[str, str], now: datetime) -> None:
    values = {"state": "dropped", "code": why[0], "message": why[1], "finished_at": now, "lease_until": None}
    session.execute(update(ShadowRunRow).where(condition).values(values))


def _n_runs(session: Session, name: str) -> int:
    """Count the runs that came, or may come, to figures."""
    is_one = (ShadowRunRow.shadow == name) & ShadowRunRow.state.in_(("waiting", "running", "measured"))
    return session.scalar(select(func.count()).select_from(ShadowRunRow).where(is_one)) or 0


def _is_free(lease_until: InstrumentedAttribute[datetime | None], now: datetime) -> ColumnElement[bool]:
    return or_(lease_until.is_(None), lease_until < now)


def _write(session: Session, run: StartedRun, values: Mapping[str, object]) -> None:
    is_mine = (ShadowRunRow.job_id == run.job_id) & (ShadowRunRow.attempt == run.attempt)
    result = session.execute(
        update(ShadowRunRow)
        .where(is_mine, ShadowRunRow.state == "running")
        .values(**values)
        .execution_options(synchronize_session=False)
    )
    if not (isinstance(result, CursorResult) and result.rowcount == 1):
        raise StaleAttemptError(f"the run of {run.candidate} on job {run.job_id} may write no more")

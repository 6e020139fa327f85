"""Make the queue follow the database again.

The queue may lose entries: a Valkey without its log, a worker killed right after the pop. So what waits in the
database and is not in the queue is put there again; a second entry is harmless, since only one can start an attempt.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Any

from sqlalchemy import Row, exists, or_, select, update

from jobkit.database.clock import shared_now
from jobkit.database.quotas import free_places, quotas_of
from jobkit.database.session import Database
from jobkit.database.shadow_tables import ShadowRunRow
from jobkit.database.tables import JobRow, MeshRow, ModelRow
from jobkit.database.tenancy import mesh_id_of, own_name
from jobkit.jobs.timeouts import TimeLimits, end_overdue
from jobkit.jobs.turns import is_startable
from jobkit.meshes import MAX_ANALYSES
from jobkit.models.proofs import give_up_proofs, parts_of, reference_of
from jobkit.queue import TaskQueue, job_entry, mesh_entry, model_entry, shadow_entry
from jobkit.shadows.runs import next_run, note_enqueued, take_back_runs
from quadpatch_client.schema import JobState, MeshProblem, MeshState, ModelState

# Of jobs that have not ended.
_OPEN_STATES = tuple(state.value for state in JobState if not state.is_terminal)
# Between the pop and the start of the attempt an entry is in neither place.
GRACE_S = 10.0
# Jobs of a tenant that are looked at for one that has no entry in the queue.
_MOST_NEXT = 32
# Of jobs, at one time.
MOST_ENQUEUED = 500


@dataclass(frozen=True)
class Reconciled:
    """What one run did."""

    ended: int
    enqueued_jobs: int
    enqueued_meshes: int
    enqueued_models: int = 0
    enqueued_shadows: int = 0


def reconcile(
    database: Database, queue: TaskQueue, limits: TimeLimits, now: datetime | None = None, *, takes_leases: bool = True
) -> Reconciled:
    """End what is overdue and refill the queue; without `takes_leases`, leases that ran out are not taken back.

    Where no job, no analysis, no proof and no run of a candidate is open, one query says so, and no other runs: an
    idle dispatcher does this every second.

    Raises
    ------
    QueueUnavailableError
        If Redis does not answer; leases have been taken back even so.
    """
    if not _is_anything_open(database):
        return Reconciled(0, 0, 0)
    moment = now or _shared_moment(database)
    ended = end_overdue(database, limits, moment, takes_leases=takes_leases)
    _give_up_analyses(database, moment)
    with database.write() as session:
        give_up_proofs(session, moment)
        take_back_runs(session, moment)
    entries = queue.entries()
    jobs = _enqueue_jobs(database, queue, entries, moment)
    meshes = _enqueue_meshes(database, queue, entries, moment)
    models = _enqueue_models(database, queue, entries, moment)
    shadows = _enqueue_shadow(database, queue, entries, moment)
    return Reconciled(ended, jobs, meshes, models, shadows)


def submit_job(database: Database, queue: TaskQueue, job_id: str, attempt: int, *, at_front: bool = False) -> None:
    """Put a queued job into the queue and note when.

    Parameters
    ----------
    database : Database
    queue : TaskQueue
    job_id : str
    attempt : int
        The number it has now.
    at_front : bool
        Whether it goes to the front, as one whose attempt was lost does: it has waited, or is urgent.

    Raises
    ------
    QueueUnavailableError
        If Redis does not answer; the row stays queued, and `reconcile` picks it up later.
    """
    queue.enqueue_job(job_id, attempt + 1, at_front=at_front)
    with database.write() as session:
        session.execute(
            update(JobRow)
            .where(JobRow.id == job_id, JobRow.state == JobState.QUEUED.value, JobRow.attempt == attempt)
            .values(enqueued_at=shared_now(session))
        )


def submit_next(database: Database, queue: TaskQueue, tenant: str) -> None:
    """Put the next job of a tenant into the queue, where its jobs at once have a limit and leave room for one.

    Raises
    ------
    QueueUnavailableError
        If Redis does not answer; `reconcile` picks the job up later.
    """
    with database.read() as session:
        if not quotas_of(session, tenant).jobs_at_once or free_places(session).get(tenant) == 0:
            return
        query = select(JobRow.id, JobRow.attempt).where(JobRow.tenant == tenant, is_startable(shared_now(session)))
        rows = session.execute(query.order_by(JobRow.priority, JobRow.id).limit(_MOST_NEXT)).all()
    entries = queue.entries() if rows else set()
    row = next((row for row in rows if _entry(row) not in entries), None)
    if row is not None:
        submit_job(database, queue, row.id, row.attempt)


def submit_jobs(database: Database, queue: TaskQueue, jobs: Sequence[tuple[str, int]]) -> None:
    """Put many queued jobs into the queue and note when; raises as `submit_job`.

    Parameters
    ----------
    database : Database
    queue : TaskQueue
    jobs : sequence of (str, int)
        The id of each, and the attempt that it has now.
    """
    queue.enqueue_jobs((job_id, attempt + 1) for job_id, attempt in jobs)
    is_waiting = JobRow.state == JobState.QUEUED.value
    ids = [job_id for job_id, _ in jobs]
    with database.write() as session:
        session.execute(update(JobRow).where(JobRow.id.in_(ids), is_waiting).values(enqueued_at=shared_now(session)))


def submit_analysis(database: Database, queue: TaskQueue, mesh_id: str) -> None:
    """Put a mesh that waits for its analysis into the queue; nothing happens where none is due. Raises like above."""
    mesh_id = mesh_id_of(database.tenant, mesh_id)
    with database.read() as session:
        query = select(MeshRow.attempt).where(MeshRow.id == mesh_id, MeshRow.state == MeshState.ANALYSING.value)
        attempt = session.scalars(query).one_or_none()
    if attempt is None:
        return
    queue.enqueue_inspection(mesh_id, attempt + 1)
    with database.write() as session:
        session.execute(update(MeshRow).where(MeshRow.id == mesh_id).values(enqueued_at=shared_now(session)))


def submit_proof(database: Database, queue: TaskQueue, reference: str) -> None:
    """Put a version that waits for its proof into the queue; nothing happens where none is due. Raises like above."""
    name, version = parts_of(reference)
    name = own_name(database.tenant, name)
    is_version = (ModelRow.name == name) & (ModelRow.version == version)
    with database.read() as session:
        query = select(ModelRow.attempt).where(is_version, ModelRow.state == ModelState.PROVING.value)
        attempt = session.scalars(query).one_or_none()
    if attempt is None:
        return
    queue.enqueue_proof(reference_of(name, version), attempt + 1)
    with database.write() as session:
        session.execute(update(ModelRow).where(is_version).values(enqueued_at=shared_now(session)))


def _is_anything_open(database: Database) -> bool:
    job = exists().where(JobRow.state.in_(_OPEN_STATES))
    mesh = exists().where(MeshRow.state == MeshState.ANALYSING.value)
    model = exists().where(ModelRow.state == ModelState.PROVING.value)
    shadow = exists().where(ShadowRunRow.finished_at.is_(None))
    with database.read() as session:
        return bool(session.scalar(select(or_(job, mesh, model, shadow))))


def _enqueue_jobs(database: Database, queue: TaskQueue, entries: set[str], now: datetime) -> int:
    with database.read() as session:
        is_due = or_(JobRow.not_before.is_(None), JobRow.not_before <= now)
        query = select(JobRow.id, JobRow.attempt, JobRow.tenant, JobRow.enqueued_at, JobRow.memory_wait_since)
        rows = session.execute(query.where(JobRow.state == JobState.QUEUED.value, is_due).order_by(JobRow.id)).all()
        places = free_places(session)
    waiting_jobs = sorted(
        (row for row in rows if row.memory_wait_since is not None), key=lambda row: row.memory_wait_since
    )
    missing_jobs = [row for row in rows if row.memory_wait_since is None and _is_overdue(row.enqueued_at, now)]
    if not any(_entry(row) in entries for row in waiting_jobs):
        # One is enough: the worker that takes it looks which of them fit.
        missing_jobs = [*waiting_jobs[:1], *missing_jobs]
    missing_jobs = [row for row in missing_jobs if _entry(row) not in entries]
    for entry_row in rows:
        if _entry(entry_row) in entries and entry_row.tenant in places:
            places[entry_row.tenant] -= 1
    # The rest follows within seconds: an entry is a turn, and few of them keep all workers busy.
    missing_jobs = _with_a_place(missing_jobs, places)[:MOST_ENQUEUED]
    waiting = [row for row in missing_jobs if row.memory_wait_since is not None]
    for row in waiting:
        submit_job(database, queue, row.id, row.attempt, at_front=True)
    others = [(row.id, row.attempt) for row in missing_jobs if row.memory_wait_since is None]
    if others:
        submit_jobs(database, queue, others)
    return len(missing_jobs)


def _with_a_place(rows: list[Row[*tuple[Any, ...]]], places: dict[str, int]) -> list[Row[*tuple[Any, ...]]]:
    """Leave out jobs of tenants that run as many as they may: each entry of theirs would start nothing."""
    found = []
    for row in rows:
        if row.tenant in places:
            places[row.tenant] -= 1
        if places.get(row.tenant, 0) >= 0:
            found.append(row)
    return found


def _entry(row: Row[*tuple[Any, ...]]) -> str:
    return job_entry(row.id, row.attempt + 1)


def _enqueue_meshes(database: Database, queue: TaskQueue, entries: set[str], now: datetime) -> int:
    with database.read() as session:
        query = select(MeshRow.id, MeshRow.attempt, MeshRow.enqueued_at, MeshRow.lease_until)
        rows = session.execute(query.where(MeshRow.state == MeshState.ANALYSING.value)).all()
    missing_ids = [
        mesh_id
        for mesh_id, attempt, enqueued_at, lease_until in rows
        if mesh_entry(mesh_id, attempt + 1) not in entries
        and _is_overdue(enqueued_at, now)
        and (lease_until is None or lease_until < now)
    ]
    for mesh_id in missing_ids:
        submit_analysis(database, queue, mesh_id)
    return len(missing_ids)


def _enqueue_models(database: Database, queue: TaskQueue, entries: set[str], now: datetime) -> int:
    with database.read() as session:
        query = select(ModelRow).where(ModelRow.state == ModelState.PROVING.value)
        rows = list(session.scalars(query))
    missing_references = [
        reference_of(row.name, row.version)
        for row in rows
        if model_entry(reference_of(row.name, row.version), row.attempt + 1) not in entries
        and _is_overdue(row.enqueued_at, now)
        and (row.lease_until is None or row.lease_until < now)
    ]
    for reference in missing_references:
        submit_proof(database, queue, reference)
    return len(missing_references)


def _enqueue_shadow(database: Database, queue: TaskQueue, entries: set[str], now: datetime) -> int:
    """Put a run of a candidate into the queue where a worker has nothing else to do."""
    with database.read() as session:
        found = next_run(session, now)
    if found is None:
        return 0
    job_id, attempt, enqueued_at = found
    if shadow_entry(job_id, attempt + 1) in entries or not _is_overdue(enqueued_at, now):
        return 0
    queue.enqueue_shadow(job_id, attempt + 1)
    with database.write() as session:
        note_enqueued(session, job_id)
    return 1


def _give_up_analyses(database: Database, now: datetime) -> None:
    problem = MeshProblem(code="analysis_failed", message=f"the analysis was lost {MAX_ANALYSES} times")
    with database.write() as session:
        session.execute(
            update(MeshRow)
            .where(
                MeshRow.state == MeshState.ANALYSING.value,
                MeshRow.attempt - MeshRow.forgiven >= MAX_ANALYSES,
                MeshRow.lease_until < now,
            )
            .values(state=MeshState.REJECTED.value, problem=problem.model_dump(mode="json"), updated_at=now)
        )


def _is_overdue(enqueued_at: datetime | None, now: datetime) -> bool:
    return enqueued_at is None or enqueued_at < now - timedelta(seconds=GRACE_S)


def _shared_moment(database: Database) -> datetime:
    with database.read() as session:
        return shared_now(session)

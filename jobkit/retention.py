"""How long jobs and meshes are kept: pins, deletion on request, and expiry.

Rows go first, objects after them. A crash in between leaves objects that no row names, which the sweep removes
(`dispatcher/unreferenced_objects.py`), and never a row whose file is gone. Files of a job lie under its own id, which
is never used again, so they are removed at once, unless an equal job has taken them over. The key of a mesh follows
from its bytes, and the same bytes may be uploaded again at that moment: those objects are left to the sweep.
"""

import logging
from collections.abc import Callable, Iterable, Sequence
from datetime import datetime, timedelta

from sqlalchemy import CursorResult, delete, exists, func, select, update
from sqlalchemy.orm import Session

from jobkit.database.clock import utc_now
from jobkit.database.job_rows import names_mesh
from jobkit.database.session import Database
from jobkit.database.shadow_tables import ShadowRunRow
from jobkit.database.tables import AttemptRow, EventRow, IdempotencyRow, JobRow, MeshRow
from jobkit.database.tenancy import mesh_id_of
from jobkit.database.training_tables import TrainingMeshRow
from jobkit.errors import (
    JobNotFinishedError,
    JobNotFoundError,
    MeshInUseError,
    MeshNotFoundError,
    RowConflictError,
    StoreUnavailableError,
)
from jobkit.storage.base import ObjectStore
from jobkit.storage.result_files import unnamed
from quadpatch_client.schema import JobState

# Of one transaction: enough to be fast, few enough to delay no other transaction.
BATCH = 50
ENDED = tuple(state.value for state in JobState if state.is_terminal)

_log = logging.getLogger("quadpatch.retention")


def pin_job(database: Database, job_id: str, is_pinned: bool) -> None:
    """Keep a job whatever its age, or no longer; raise JobNotFoundError."""
    with database.write() as session:
        if not _has_matched(session.execute(update(JobRow).where(JobRow.id == job_id).values(pinned=is_pinned))):
            raise JobNotFoundError(f"there is no job {job_id}")


def pin_mesh(database: Database, mesh_id: str, is_pinned: bool) -> None:
    """Keep a mesh whatever its age, or no longer; raise MeshNotFoundError."""
    own_id = mesh_id_of(database.tenant, mesh_id)
    with database.write() as session:
        if not _has_matched(session.execute(update(MeshRow).where(MeshRow.id == own_id).values(pinned=is_pinned))):
            raise MeshNotFoundError(f"there is no mesh {mesh_id}")


def delete_job(database: Database, store: ObjectStore, job_id: str) -> None:
    """Remove a finished job for good, pinned or not: its rows and its files.

    Raises
    ------
    JobNotFoundError
        If there is no such job, or no longer.
    JobNotFinishedError
        If it has not ended.
    """
    with database.write() as session:
        row = session.scalars(select(JobRow).where(JobRow.id == job_id).with_for_update()).one_or_none()
        if row is None:
            raise JobNotFoundError(f"there is no job {job_id}")
        if row.state not in ENDED:
            raise JobNotFinishedError(f"job {job_id} is {row.state}; cancel it first, and delete it once it has ended")
        unnamed_ids = delete_rows(session, [row])
    drop_files(store, unnamed_ids)


def delete_mesh(database: Database, mesh_id: str) -> None:
    """Remove a mesh for good, pinned or not; its bytes are left to the sweep.

    Raises
    ------
    MeshNotFoundError
        If there is no such mesh, or no longer.
    MeshInUseError
        If jobs name it.
    """
    own_id = mesh_id_of(database.tenant, mesh_id)
    try:
        with database.write() as session:
            n_jobs = session.scalar(select(func.count()).select_from(JobRow).where(names_mesh(own_id)))
            if n_jobs:
                noun = "job names" if n_jobs == 1 else "jobs name"
                raise MeshInUseError(f"{n_jobs} {noun} mesh {mesh_id}; delete them first")
            if not _has_matched(session.execute(delete(MeshRow).where(MeshRow.id == own_id))):
                raise MeshNotFoundError(f"there is no mesh {mesh_id}")
    except RowConflictError as error:
        raise MeshInUseError(f"1 job came to name mesh {mesh_id} at this moment") from error


def expire_jobs(
    database: Database, store: ObjectStore, days: float, now: datetime, is_over: Callable[[], bool] = lambda: False
) -> int:
    """Remove finished jobs that are not pinned and that ended long ago.

    Parameters
    ----------
    database : Database
    store : ObjectStore
    days : float
        How long they are kept after their end; 0: for ever.
    now : datetime
    is_over : callable
        Whether to break off; asked before each batch.

    Returns
    -------
    int
        How many were removed.
    """
    if days == 0:
        return 0
    is_expired = JobRow.state.in_(ENDED) & JobRow.pinned.is_(False) & (JobRow.finished_at < now - timedelta(days=days))
    query = select(JobRow).where(is_expired).order_by(JobRow.finished_at).limit(BATCH).with_for_update(skip_locked=True)
    n_removed = 0
    while not is_over():
        with database.write() as session:
            rows = list(session.scalars(query))
            unnamed_ids = delete_rows(session, rows)
        drop_files(store, unnamed_ids)
        n_removed += len(rows)
        if len(rows) < BATCH:
            break
    return n_removed


def expire_meshes(database: Database, days: float, now: datetime, is_over: Callable[[], bool] = lambda: False) -> int:
    """Remove meshes that are not pinned, that no job names, and that came out of use long ago.

    Parameters
    ----------
    database : Database
    days : float
        How long they are kept after their upload and after the end of the last job on them; 0: for ever.
    now : datetime
    is_over : callable
        Whether to break off; asked before each mesh.

    Returns
    -------
    int
        How many were removed. Their bytes are left to the sweep.
    """
    if days == 0:
        return 0
    is_free = ~exists().where(names_mesh(MeshRow.id))
    is_expired = MeshRow.pinned.is_(False) & (MeshRow.used_at < now - timedelta(days=days)) & is_free
    with database.read() as session:
        ids = list(session.scalars(select(MeshRow.id).where(is_expired).order_by(MeshRow.used_at)))
    n_removed = 0
    for mesh_id in ids:
        if is_over():
            break
        try:
            with database.write() as session:
                # An upload or a job may have come in between: the condition is checked again.
                n_removed += _has_matched(session.execute(delete(MeshRow).where(MeshRow.id == mesh_id, is_expired)))
        except RowConflictError:
            continue  # a job came to name it while it was being deleted
    return n_removed


def delete_rows(session: Session, rows: Sequence[JobRow]) -> set[str]:
    """Delete jobs with all that names them, and note on their meshes until when these were in use.

    Returns
    -------
    set of str
        Ids of the jobs, these or others, whose files no row names any more.
    """
    ids = [row.id for row in rows]
    # In one order everywhere, so that two transactions can't deadlock.
    ended = {row.id: row.finished_at or utc_now() for row in rows}
    uses = [(mesh_id, ended[row.id]) for row in rows for mesh_id in (row.mesh_id, row.reference_id)]
    of_trainings = session.scalars(select(TrainingMeshRow).where(TrainingMeshRow.job_id.in_(ids)))
    uses += [(row.mesh_id, ended[row.job_id]) for row in of_trainings]
    for mesh_id, ended_at in sorted((mesh_id, ended_at) for mesh_id, ended_at in uses if mesh_id is not None):
        session.execute(
            update(MeshRow).where(MeshRow.id == mesh_id, MeshRow.used_at < ended_at).values(used_at=ended_at)
        )
    for table in (IdempotencyRow, EventRow, AttemptRow, TrainingMeshRow):
        session.execute(delete(table).where(table.job_id.in_(ids)))
    # Of candidates, what is still to come; figures of finished runs stay.
    is_open = ShadowRunRow.job_id.in_(ids) & ShadowRunRow.finished_at.is_(None)
    session.execute(delete(ShadowRunRow).where(is_open))
    session.execute(delete(JobRow).where(JobRow.id.in_(ids)))
    _hand_bytes_on(session, rows)
    return unnamed(session, {row.cached_from or row.id for row in rows})


def _hand_bytes_on(session: Session, rows: Sequence[JobRow]) -> None:
    """Let the oldest job that has taken over the result of a deleted one count its bytes: the files are there still."""
    for row in rows:
        if row.result_bytes:
            has_taken_over = JobRow.cached_from == (row.cached_from or row.id)
            heir = select(func.min(JobRow.id)).where(has_taken_over).scalar_subquery()
            session.execute(update(JobRow).where(JobRow.id == heir).values(result_bytes=row.result_bytes))


def drop_files(store: ObjectStore, job_ids: Iterable[str]) -> None:
    """Remove what jobs have made, once their rows are deleted."""
    for job_id in job_ids:
        try:
            store.delete_prefix(f"results/{job_id}")
        except StoreUnavailableError as error:
            _log.warning("files of job %s are left to the sweep: %s", job_id, error)


def _has_matched(result: object) -> bool:
    return isinstance(result, CursorResult) and result.rowcount > 0

"""Views: what a viewer shows of a mesh, a job or a model, made by a worker when it is first asked for.

The row of a view is written by the first request, and says where it stands. Making one is fenced like an analysis:
starting it raises `attempt`, and only the latest attempt may write. The dispatcher knows nothing of views: a client
that still waits for one asks again, and that request puts it into the queue again where the queue has lost it.
"""

import hashlib
import json
from collections.abc import Collection, Mapping
from dataclasses import asdict, dataclass
from datetime import datetime, timedelta
from typing import Literal

from sqlalchemy import select, update
from sqlalchemy.orm import Session

from jobkit.database.clock import shared_now
from jobkit.database.quotas import check_bytes
from jobkit.database.session import Database
from jobkit.database.tables import JobRow, MeshRow, ModelRow
from jobkit.database.tenancy import DEFAULT_TENANT, mesh_id_of, names_of, tenant_of
from jobkit.database.view_tables import ViewRow
from jobkit.errors import (
    JobNotFoundError,
    MeshNotFoundError,
    ModelNotFoundError,
    RowConflictError,
    StaleAttemptError,
)
from jobkit.queue import TaskQueue, view_entry
from jobkit.storage.base import StoredObject

ViewKind = Literal["mesh", "outlines", "job", "model"]
MAKING, MADE, FAILED = "making", "made", "failed"
VIEW_PREFIX = "views"
# Of one view, about.
MOST_BYTES = 20_000_000
# Attempts before a view is given up.
MAX_TRIES = 3
# Raised where views of earlier versions are no longer what viewers expect: they are made again.
_VERSION = 1
# After so long, an entry of the queue is looked for that no worker has taken.
_GRACE = timedelta(seconds=10)


@dataclass(frozen=True)
class ViewOrder:
    """What a view shows; meshes are named as their tenant names them.

    Attributes
    ----------
    kind : str
    mesh_id : str or None
        Of the mesh that is shown, or whose holes are.
    job_id : str or None
    reference_id : str or None
        Of the mesh that a job's result is compared with.
    model_name, model_version : str, int or None
    level : str or None
        `coarse` or `fine`.
    """

    kind: ViewKind
    mesh_id: str | None = None
    job_id: str | None = None
    reference_id: str | None = None
    model_name: str | None = None
    model_version: int | None = None
    level: str | None = None


@dataclass(frozen=True)
class View:
    """Where a view stands; `stored` once it is made, `problem` in words where it can't be, with the code in front."""

    id: str
    state: str
    attempt: int
    is_due: bool
    stored: StoredObject | None = None
    problem: str | None = None


@dataclass(frozen=True)
class ViewAttempt:
    """One try at making a view; `is_last` where a failure of it is final. Ids are those of rows."""

    view_id: str
    order: ViewOrder
    attempt: int
    is_last: bool = False


class Views:
    """The views of all meshes, jobs and models of a database."""

    def __init__(self, database: Database) -> None:
        self._database = database

    def order(self, order: ViewOrder) -> View:
        """Return a view, and note it as one to be made where it is new.

        Raises
        ------
        MeshNotFoundError, JobNotFoundError, ModelNotFoundError
            If what it shows is not there.
        StorageQuotaError
            If it is a new comparison with a reference, of which there may be any number, and the tenant has no room.
        """
        try:
            return self._order(order)
        except RowConflictError:
            return self._order(order)  # it was ordered twice at the same moment

    def submit(self, queue: TaskQueue, view: View) -> None:
        """Put a view that is due into the queue, in front of all else; raise QueueUnavailableError."""
        if view_entry(view.id, view.attempt + 1) not in queue.entries():
            queue.enqueue_view(view.id, view.attempt + 1)
        with self._database.write() as session:
            session.execute(update(ViewRow).where(ViewRow.id == view.id).values(enqueued_at=shared_now(session)))

    def remake(self, view: View) -> None:
        """Note a view as one to be made again, whose bytes the store has lost."""
        values = {"state": MAKING, "key": None, "sha256": None, "size_bytes": 0, "enqueued_at": None}
        with self._database.write() as session:
            session.execute(update(ViewRow).where(ViewRow.id == view.id, ViewRow.state == MADE).values(**values))

    def unfinished(self, view_ids: Collection[str]) -> set[str]:
        """Return those of the views that are still to be made."""
        query = select(ViewRow.id).where(ViewRow.id.in_(view_ids), ViewRow.state == MAKING)
        with self._database.read() as session:
            return set(session.scalars(query))

    def start(self, view_id: str, worker: str, lease_s: float) -> ViewAttempt:
        """Take a view to be made; raise StaleAttemptError where another worker has it or nothing is to be done."""
        with self._database.write() as session:
            now = shared_now(session)
            row = session.get(ViewRow, view_id, with_for_update=True)
            if row is None or row.state != MAKING or (row.lease_until is not None and row.lease_until > now):
                raise StaleAttemptError(f"view {view_id} is not to be made now")
            tries = row.attempt - row.forgiven
            if tries < MAX_TRIES:
                row.attempt += 1
                row.worker, row.lease_until = worker, now + timedelta(seconds=lease_s)
                session.flush()
                return ViewAttempt(row.id, _order_of(row), row.attempt, tries + 1 == MAX_TRIES)
            row.state, row.problem = FAILED, _problem("worker_lost", f"the view was lost {MAX_TRIES} times")
        raise StaleAttemptError(f"view {view_id} was lost as often as it may be")

    def renew(self, attempt: ViewAttempt, lease_s: float) -> None:
        """Prolong the lease; raise StaleAttemptError where the view was taken away."""
        self._write(attempt, {}, lease_s)

    def publish(self, attempt: ViewAttempt, stored: StoredObject) -> None:
        """Note where the view lies; raise StaleAttemptError."""
        made = {"key": stored.key, "sha256": stored.sha256, "size_bytes": stored.size_bytes}
        self._write(attempt, {"state": MADE, **made, "lease_until": None})

    def refuse(self, attempt: ViewAttempt, code: str, message: str) -> None:
        """Write why there is no such view; raise StaleAttemptError."""
        self._write(attempt, {"state": FAILED, "problem": _problem(code, message), "lease_until": None})

    def release(self, attempt: ViewAttempt) -> None:
        """Hand a view back undone; raise StaleAttemptError."""
        self._write(attempt, {"lease_until": None, "enqueued_at": None})

    def forgive(self, attempt: ViewAttempt, delay_s: float = 0.0) -> None:
        """Hand a view back, and don't count the attempt; no worker takes it for `delay_s` seconds."""
        values = {"lease_until": None, "enqueued_at": None, "forgiven": ViewRow.forgiven + 1}
        self._write(attempt, values, delay_s)

    def resubmit(self, queue: TaskQueue, attempt: ViewAttempt) -> None:
        """Put a view that was handed back into the queue again; raise QueueUnavailableError."""
        with self._database.read() as session:
            row = session.get(ViewRow, attempt.view_id)
            view = None if row is None else _shown(row, shared_now(session))
        if view is not None and view.is_due:
            self.submit(queue, view)

    def _order(self, order: ViewOrder) -> View:
        with self._database.read() as session:
            values = _named(session, order)
            view_id = _id_of(tenant_of(session), values)
            row = session.get(ViewRow, view_id)
            if row is not None:
                return _shown(row, shared_now(session))
        with self._database.write() as session:
            now = shared_now(session)
            row = ViewRow(id=view_id, **values, state=MAKING, attempt=0, forgiven=0, size_bytes=0, created_at=now)
            session.add(row)
            if order.reference_id is not None:
                check_bytes(session, MOST_BYTES)
            session.flush()
            return _shown(row, now)

    def _write(self, attempt: ViewAttempt, values: Mapping[str, object], lease_s: float = 0.0) -> None:
        with self._database.write() as session:
            if lease_s:
                values = {**values, "lease_until": shared_now(session) + timedelta(seconds=lease_s)}
            is_latest = (ViewRow.attempt == attempt.attempt) & (ViewRow.state == MAKING)
            statement = update(ViewRow).where(ViewRow.id == attempt.view_id, is_latest)
            result = session.execute(statement.values(values or {"state": MAKING}))
            if result.rowcount != 1:  # type: ignore[attr-defined]
                raise StaleAttemptError(f"attempt {attempt.attempt} at view {attempt.view_id} is no longer the latest")


def _named(session: Session, order: ViewOrder) -> dict[str, str | int | None]:
    """Return the order by the ids of rows, all of which are there."""
    tenant = tenant_of(session)
    values = asdict(order)
    for name in ("mesh_id", "reference_id"):
        if values[name] is not None:
            own_id = mesh_id_of(tenant, values[name])
            if session.get(MeshRow, own_id) is None:
                raise MeshNotFoundError(f"there is no mesh {values[name]}")
            values[name] = own_id
    if order.job_id is not None and session.get(JobRow, order.job_id) is None:
        raise JobNotFoundError(f"there is no job {order.job_id}")
    if order.model_name is not None:
        names = names_of(tenant, order.model_name)
        there = [name for name in names if session.get(ModelRow, (name, order.model_version)) is not None]
        if not there:
            raise ModelNotFoundError(f"there is no model {order.model_name}@{order.model_version}")
        values["model_name"] = there[0]
    return values


def _id_of(tenant: str | None, values: Mapping[str, str | int | None]) -> str:
    return hashlib.sha256(json.dumps([_VERSION, tenant or DEFAULT_TENANT, values]).encode()).hexdigest()


def _order_of(row: ViewRow) -> ViewOrder:
    names = ViewOrder.__dataclass_fields__
    return ViewOrder(**{name: getattr(row, name) for name in names})


def _shown(row: ViewRow, now: datetime) -> View:
    stored = None
    if row.key is not None and row.sha256 is not None:
        stored = StoredObject(row.key, row.size_bytes, row.sha256)
    is_taken = row.lease_until is not None and row.lease_until > now
    is_waiting = row.enqueued_at is not None and row.enqueued_at > now - _GRACE
    problem = None if row.problem is None else f"{row.problem['code']}: {row.problem['message']}"
    is_due = row.state == MAKING and not is_taken and not is_waiting
    return View(row.id, row.state, row.attempt, is_due, stored, problem)


def _problem(code: str, message: str) -> dict[str, str]:
    return {"code": code, "message": message}

"""Uploaded meshes and their analysis.

An analysis is fenced like a job: starting it raises `attempt`, and only the latest attempt may write.
"""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from datetime import timedelta

from sqlalchemy import ColumnElement, exists, select, update
from sqlalchemy.orm import Session

from jobkit.database.clock import shared_now, utc_now
from jobkit.database.expiry import expiry
from jobkit.database.job_rows import names_mesh
from jobkit.database.quotas import admit_bytes
from jobkit.database.readable_rows import readable
from jobkit.database.searching import ALWAYS, Period, cursor_of, matches, older_than
from jobkit.database.session import Database
from jobkit.database.tables import MeshRow
from jobkit.database.tenancy import mesh_id_of, tenant_of
from jobkit.errors import MeshNotFoundError, RowConflictError, StaleAttemptError
from jobkit.storage.base import StoredObject
from quadpatch_client.schema import Format, Mesh, MeshFacts, MeshLinks, MeshPage, MeshProblem, MeshState, MeshSummary

# Code of the problem of a mesh whose bytes are gone from the store.
MESH_MISSING = "mesh_missing"
# The same of one whose bytes have changed there.
MESH_DAMAGED = "mesh_damaged"
# Analyses before a mesh is given up.
MAX_ANALYSES = 3


@dataclass(frozen=True)
class MeshSource:
    """Where the bytes of a mesh lie, and as what they are to be read."""

    mesh_id: str
    sha256: str
    key: str
    filename: str | None
    format: Format | None


@dataclass(frozen=True)
class Analysis:
    """One try at analysing a mesh of `size_bytes`; `is_last` where a failure of it rejects the mesh."""

    source: MeshSource
    size_bytes: int
    attempt: int
    is_last: bool = False


@dataclass(frozen=True)
class MeshSearch:
    """Which meshes are looked for; what is left out does not matter. `*` in a text stands for any characters."""

    states: Collection[MeshState] = ()
    filename: str | None = None
    format: Format | None = None
    created: Period = ALWAYS

    def conditions(self) -> list[ColumnElement[bool]]:
        """Return the conditions on the row."""
        found = [
            MeshRow.state.in_([state.value for state in self.states]) if self.states else None,
            None if self.filename is None else matches(MeshRow.filename, self.filename),
            None if self.format is None else MeshRow.format == self.format,
            self.created.condition(MeshRow.created_at),
        ]
        return [condition for condition in found if condition is not None]


class Meshes:
    """All meshes of a database.

    Parameters
    ----------
    database : Database
    retention_days : float
        How long meshes are kept that no job uses, for what clients are told; 0: for ever.
    """

    def __init__(self, database: Database, retention_days: float = 0) -> None:
        self._database = database
        self._retention_days = retention_days

    def add(
        self,
        stored: StoredObject,
        filename: str | None,
        mesh_format: Format | None,
        *,
        is_counted: bool = False,
    ) -> tuple[Mesh, bool]:
        """Record an upload; the same bytes are the same mesh, which has its latest name.

        A mesh that was rejected is analysed again when it comes back under another format, or its bytes were missing.

        Parameters
        ----------
        stored : StoredObject
        filename : str, optional
        mesh_format : str, optional
        is_counted : bool
            Whether the quota of the tenant counts these bytes already, as those of a resumable upload.

        Returns
        -------
        Mesh, bool
            The mesh, and whether it is new.

        Raises
        ------
        StorageQuotaError
            If it is new, and the tenant would store more than it may.
        """
        try:
            return self._add(stored, filename, mesh_format, is_counted)
        except RowConflictError:
            # The same bytes arrived twice at the same moment; the other upload has written the row.
            return self._add(stored, filename, mesh_format, is_counted)

    def get(self, mesh_id: str) -> Mesh:
        """Return a mesh; raise MeshNotFoundError."""
        with self._database.read() as session:
            return self._show(session, _existing(session, mesh_id))

    def page(self, limit: int, cursor: str | None = None, search: MeshSearch | None = None) -> MeshPage:
        """Return meshes, those that were uploaded last first.

        Parameters
        ----------
        limit : int
            Most meshes on the page.
        cursor : str, optional
            `next_cursor` of the page before. Meshes that came later don't shift the pages.
        search : MeshSearch, optional
            Only meshes of that kind.
        """
        query = select(MeshRow).order_by(MeshRow.created_at.desc(), MeshRow.id.desc()).limit(limit + 1)
        query = query.where(*(search or MeshSearch()).conditions())
        if cursor is not None:
            query = query.where(older_than(MeshRow.created_at, MeshRow.id, cursor))
        with self._database.read() as session:
            rows = list(session.scalars(query))
            items = list(readable(rows[:limit], lambda row: MeshSummary.of(self._show(session, row))))
        last = rows[limit - 1] if len(rows) > limit else None
        return MeshPage(items=items, next_cursor=None if last is None else cursor_of(last.created_at, last.id))

    def source(self, mesh_id: str) -> MeshSource:
        """Return where the bytes lie; raise MeshNotFoundError."""
        with self._database.read() as session:
            return _to_source(_existing(session, mesh_id))

    def calibrations(self, mesh_id: str) -> str | None:
        """Return what repairs of a mesh have kept, as it was given; None where that is nothing."""
        with self._database.read() as session:
            own_id = mesh_id_of(tenant_of(session), mesh_id)
            return session.scalar(select(MeshRow.calibrations).where(MeshRow.id == own_id))

    def keep_calibrations(self, mesh_id: str, calibrations: str) -> None:
        """Keep what a repair found out about a mesh, in place of what was kept; of a mesh that is gone nothing is."""
        with self._database.write() as session:
            own_id = mesh_id_of(tenant_of(session), mesh_id)
            session.execute(update(MeshRow).where(MeshRow.id == own_id).values(calibrations=calibrations))

    def start_analysis(self, mesh_id: str, worker: str, lease_s: float) -> Analysis:
        """Take a mesh for analysis; raise StaleAttemptError where another worker has it or nothing is to be done."""
        with self._database.write() as session:
            now = shared_now(session)
            row = _existing(session, mesh_id)
            is_leased = row.lease_until is not None and row.lease_until > now
            if row.state != MeshState.ANALYSING or is_leased:
                raise StaleAttemptError(f"mesh {mesh_id} is {row.state} and not to be analysed now")
            result = session.execute(
                update(MeshRow)
                .where(
                    MeshRow.id == mesh_id, MeshRow.attempt == row.attempt, MeshRow.state == MeshState.ANALYSING.value
                )
                .values(
                    attempt=MeshRow.attempt + 1,
                    worker=worker,
                    lease_until=now + timedelta(seconds=lease_s),
                    updated_at=now,
                )
                .execution_options(synchronize_session=False)
            )
            if result.rowcount != 1:  # type: ignore[attr-defined]
                raise StaleAttemptError(f"mesh {mesh_id} was taken by another worker")
            number = row.attempt + 1
            return Analysis(_to_source(row), row.size_bytes, number, number - row.forgiven >= MAX_ANALYSES)

    def unfinished(self, mesh_ids: Collection[str]) -> set[str]:
        """Return those of the meshes whose analysis is still to come."""
        query = select(MeshRow.id).where(MeshRow.id.in_(mesh_ids), MeshRow.state == MeshState.ANALYSING.value)
        with self._database.read() as session:
            return set(session.scalars(query))

    def renew(self, analysis: Analysis, lease_s: float) -> None:
        """Prolong the lease; raise StaleAttemptError where the analysis was taken away."""
        self._write(analysis, {}, lease_s)

    def publish(self, analysis: Analysis, facts: MeshFacts) -> None:
        """Write what the analysis found; raise StaleAttemptError."""
        state = {"state": MeshState.READY.value, "facts": facts.model_dump(mode="json"), "format": facts.format}
        self._write(analysis, {**state, "lease_until": None})

    def reject(self, analysis: Analysis, problem: MeshProblem) -> None:
        """Write why the file is no usable mesh; raise StaleAttemptError."""
        state = {"state": MeshState.REJECTED.value, "problem": problem.model_dump(mode="json")}
        self._write(analysis, {**state, "lease_until": None})

    def release(self, analysis: Analysis) -> None:
        """Hand an analysis back undone; raise StaleAttemptError."""
        self._write(analysis, {"lease_until": None, "enqueued_at": None})

    def forgive(self, analysis: Analysis, delay_s: float = 0.0) -> None:
        """Hand an analysis back, and don't count it: the reason lies outside of the mesh.

        No worker takes the mesh for `delay_s` seconds. Raises StaleAttemptError.
        """
        values = {"lease_until": None, "enqueued_at": None, "forgiven": MeshRow.forgiven + 1}
        self._write(analysis, values, delay_s)

    def _add(
        self, stored: StoredObject, filename: str | None, mesh_format: Format | None, is_counted: bool
    ) -> tuple[Mesh, bool]:
        now = utc_now()
        with self._database.write() as session:
            mesh_id = mesh_id_of(self._database.tenant, stored.sha256)
            row = session.get(MeshRow, mesh_id, with_for_update=True)
            is_new = row is None
            if row is None:
                named = {"id": mesh_id, "sha256": stored.sha256, "key": stored.key}
                row = MeshRow(**named, size_bytes=stored.size_bytes, created_at=now, attempt=0)
                session.add(row)
                restart(row, filename, mesh_format)
            elif is_missing(row) or is_damaged(row):
                restart(row, filename or row.filename, row.format)
            elif row.state == MeshState.REJECTED and mesh_format not in (None, row.format):
                restart(row, filename, mesh_format)
            elif filename is not None:
                row.filename = filename
            row.updated_at = row.used_at = now
            session.flush()
            if is_new and not is_counted:
                admit_bytes(session, stored.size_bytes)
            return self._show(session, row), is_new

    def _show(self, session: Session, row: MeshRow) -> Mesh:
        """Return the row as clients see it."""
        is_used = session.scalar(select(exists().where(names_mesh(row.id))))
        expires_at = expiry(None if is_used else row.used_at, self._retention_days, row.pinned)
        path = f"/v1/meshes/{row.sha256}"
        names = Mesh.model_fields.keys() - {"id", "links", "expires_at"}
        values = {name: getattr(row, name) for name in names} | {"id": row.sha256}
        links = MeshLinks(self=path, content=f"{path}/content")
        return Mesh.model_validate(values | {"links": links, "expires_at": expires_at})

    def _write(self, analysis: Analysis, values: Mapping[str, object], lease_s: float = 0.0) -> None:
        with self._database.write() as session:
            if lease_s:
                values = {**values, "lease_until": shared_now(session) + timedelta(seconds=lease_s)}
            result = session.execute(
                update(MeshRow)
                .where(
                    MeshRow.id == analysis.source.mesh_id,
                    MeshRow.attempt == analysis.attempt,
                    MeshRow.state == MeshState.ANALYSING.value,
                )
                .values(**values, updated_at=utc_now())
            )
            if result.rowcount != 1:  # type: ignore[attr-defined]
                raise StaleAttemptError(
                    f"analysis {analysis.attempt} of mesh {analysis.source.mesh_id} is no longer the latest"
                )


def is_missing(row: MeshRow) -> bool:
    """Tell whether a sweep found that the bytes of the mesh are gone."""
    return row.problem is not None and row.problem.get("code") == MESH_MISSING


def is_damaged(row: MeshRow) -> bool:
    """Tell whether the bytes of the mesh were found to be others than those that were uploaded."""
    return row.problem is not None and row.problem.get("code") == MESH_DAMAGED


def restart(row: MeshRow, filename: str | None, mesh_format: str | None) -> None:
    """Let the mesh be analysed again, under that name and format."""
    row.filename, row.format = filename, mesh_format
    row.state, row.facts, row.problem = MeshState.ANALYSING.value, None, None
    row.lease_until = row.enqueued_at = None
    # As many tries as a new one.
    row.forgiven = row.attempt


def _existing(session: Session, mesh_id: str) -> MeshRow:
    row = session.get(MeshRow, mesh_id_of(tenant_of(session), mesh_id), populate_existing=True)
    if row is None:
        raise MeshNotFoundError(f"there is no mesh {mesh_id}")
    return row


def _to_source(row: MeshRow) -> MeshSource:
    return MeshSource(row.id, row.sha256, row.key, row.filename, row.format)  # type: ignore[arg-type]

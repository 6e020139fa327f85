"""Uploaded meshes and the life of their analysis.

An analysis is fenced like a job: starting it raises `attempt`, and only the latest attempt may write.
"""

from dataclasses import dataclass
from datetime import timedelta

from sqlalchemy import select, update
from sqlalchemy.exc import IntegrityError
from sqlalchemy.orm import Session

from jobkit.clock import utc_now
from jobkit.database import Database
from jobkit.errors import MeshNotFoundError, StaleAttemptError
from jobkit.schema import Format, Mesh, MeshFacts, MeshLinks, MeshProblem, MeshState
from jobkit.store import StoredObject
from jobkit.tables import MeshRow


@dataclass(frozen=True)
class MeshSource:
    """Where the bytes of a mesh lie, and as what they are to be read."""

    mesh_id: str
    key: str
    filename: str | None
    format: Format | None


@dataclass(frozen=True)
class Analysis:
    """One try at analysing a mesh."""

    source: MeshSource
    attempt: int


class Meshes:
    """All meshes of a database."""

    def __init__(self, database: Database) -> None:
        self._database = database

    def add(self, stored: StoredObject, filename: str | None, mesh_format: Format | None) -> tuple[Mesh, bool]:
        """Note an upload; the same bytes are the same mesh.

        A mesh that was rejected is analysed again when it comes back under another format.

        Returns
        -------
        Mesh, bool
            The mesh, and whether it is new.
        """
        try:
            return self._add(stored, filename, mesh_format)
        except IntegrityError:
            # The same bytes arrived twice at the same moment; the other upload has written the row.
            return self._add(stored, filename, mesh_format)

    def get(self, mesh_id: str) -> Mesh:
        """Return a mesh; raise MeshNotFoundError."""
        with self._database.read() as session:
            return _to_mesh(_existing(session, mesh_id))

    def source(self, mesh_id: str) -> MeshSource:
        """Return where the bytes lie; raise MeshNotFoundError."""
        with self._database.read() as session:
            return _to_source(_existing(session, mesh_id))

    def start_analysis(self, mesh_id: str, worker: str, lease_s: float) -> Analysis:
        """Take a mesh for analysis; raise StaleAttemptError where another worker has it or nothing is to be done."""
        now = utc_now()
        with self._database.write() as session:
            row = _existing(session, mesh_id)
            is_taken = row.lease_until is not None and row.lease_until > now
            if row.state != MeshState.ANALYSING or is_taken:
                raise StaleAttemptError(f"mesh {mesh_id} is {row.state} and not to be analysed now")
            changed = session.execute(
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
            if changed.rowcount != 1:  # type: ignore[attr-defined]
                raise StaleAttemptError(f"mesh {mesh_id} was taken by another worker")
            return Analysis(_to_source(row), row.attempt + 1)

    def renew(self, analysis: Analysis, lease_s: float) -> None:
        """Prolong the lease; raise StaleAttemptError where the analysis was taken away."""
        self._write(analysis, {"lease_until": utc_now() + timedelta(seconds=lease_s)})

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

    def _add(self, stored: StoredObject, filename: str | None, mesh_format: Format | None) -> tuple[Mesh, bool]:
        now = utc_now()
        with self._database.write() as session:
            row = session.get(MeshRow, stored.sha256, with_for_update=True)
            is_new = row is None
            if row is None:
                row = MeshRow(id=stored.sha256, key=stored.key, size_bytes=stored.size_bytes, created_at=now, attempt=0)
                session.add(row)
                _restart(row, filename, mesh_format)
            elif row.state == MeshState.REJECTED and mesh_format not in (None, row.format):
                _restart(row, filename, mesh_format)
            row.updated_at = now
            return _to_mesh(row), is_new

    def _write(self, analysis: Analysis, values: dict[str, object]) -> None:
        with self._database.write() as session:
            changed = session.execute(
                update(MeshRow)
                .where(
                    MeshRow.id == analysis.source.mesh_id,
                    MeshRow.attempt == analysis.attempt,
                    MeshRow.state == MeshState.ANALYSING.value,
                )
                .values(**values, updated_at=utc_now())
            )
            if changed.rowcount != 1:  # type: ignore[attr-defined]
                raise StaleAttemptError(
                    f"analysis {analysis.attempt} of mesh {analysis.source.mesh_id} is no longer the latest"
                )


def _restart(row: MeshRow, filename: str | None, mesh_format: Format | None) -> None:
    row.filename, row.format = filename, mesh_format
    row.state, row.facts, row.problem = MeshState.ANALYSING.value, None, None
    row.lease_until = row.enqueued_at = None


def _existing(session: Session, mesh_id: str) -> MeshRow:
    row = session.scalars(select(MeshRow).where(MeshRow.id == mesh_id)).one_or_none()
    if row is None:
        raise MeshNotFoundError(f"there is no mesh {mesh_id}")
    return row


def _to_source(row: MeshRow) -> MeshSource:
    return MeshSource(row.id, row.key, row.filename, row.format)  # type: ignore[arg-type]


def _to_mesh(row: MeshRow) -> Mesh:
    path = f"/v1/meshes/{row.id}"
    return Mesh.model_validate(
        {
            "id": row.id,
            "state": row.state,
            "filename": row.filename,
            "format": row.format,
            "size_bytes": row.size_bytes,
            "created_at": row.created_at,
            "facts": row.facts,
            "problem": row.problem,
            "links": MeshLinks(self=path, content=f"{path}/content"),
        }
    )

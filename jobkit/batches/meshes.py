"""Meshes of a batch: which fit a search, and what of them decides whether a job can work on them.

Tested in `tests/service/routes/test_batches.py`.
"""

from collections.abc import Collection
from dataclasses import dataclass
from typing import Self

from sqlalchemy import select

from jobkit.database.session import Database
from jobkit.database.tables import MeshRow
from jobkit.database.tenancy import mesh_id_of
from jobkit.meshes import MeshSearch
from quadpatch_client.schema import Mesh, MeshProblem, MeshState

# Ids of one statement.
_CHUNK = 500


@dataclass(frozen=True)
class MeshOutline:
    """A mesh without its holes: why it was rejected, and its format; None: that is not known yet."""

    id: str
    problem: MeshProblem | None
    format: str | None

    @classmethod
    def of(cls, mesh: Mesh) -> Self:
        """Return the outline of a mesh."""
        return cls(mesh.id, mesh.problem, None if mesh.facts is None else mesh.facts.format)


def outlines(database: Database, mesh_ids: Collection[str]) -> dict[str, MeshOutline]:
    """Return meshes by the ids that clients know; those that are not there are left out."""
    own_ids = [mesh_id_of(database.tenant, mesh_id) for mesh_id in mesh_ids]
    columns = (MeshRow.sha256, MeshRow.state, MeshRow.format, MeshRow.problem)
    found = {}
    with database.read() as session:
        for start in range(0, len(own_ids), _CHUNK):
            rows = session.execute(select(*columns).where(MeshRow.id.in_(own_ids[start : start + _CHUNK])))
            for sha256, state, mesh_format, problem in rows:
                reason = None if problem is None else MeshProblem.model_validate(problem)
                found[sha256] = MeshOutline(sha256, reason, mesh_format if state == MeshState.READY else None)
    return found


def matching(database: Database, search: MeshSearch, most: int) -> list[str]:
    """Return the ids, as clients know them, of up to `most` meshes that fit, the latest first."""
    query = select(MeshRow.sha256).where(*search.conditions())
    with database.read() as session:
        return list(session.scalars(query.order_by(MeshRow.created_at.desc(), MeshRow.id.desc()).limit(most)))

"""Deprecation of versions, and deletion of versions and aliases.

The bytes of a deleted version are left to the sweep: they may belong to another one, or be uploaded again. Its
number is never used again, since finished jobs name it.

Tested in `tests/jobkit/test_races_of_models.py`.
"""

from sqlalchemy import select
from sqlalchemy.orm import Session

from jobkit.database.clock import utc_now
from jobkit.database.session import Database
from jobkit.database.tables import AliasRow, DeletedModelRow, JobRow, ModelRow
from jobkit.database.tenancy import shown_name
from jobkit.errors import ModelNotFoundError, RowConflictError
from jobkit.models.default_aliases import DEFAULT_KINDS
from jobkit.models.errors import AliasInUseError, ModelInUseError
from jobkit.models.rows import alias_row, check_owner, to_version, version_row
from quadpatch_client.schema import JobState, ModelVersion

_OPEN_STATES = tuple(state.value for state in JobState if not state.is_terminal)


def deprecate_version(database: Database, name: str, version: int, reason: str) -> ModelVersion:
    """Mark a version as one that should be used no more; a second time changes the reason only.

    Raises
    ------
    ModelNotFoundError
        If there is no such version.
    ModelInUseError
        If an alias points to it that jobs mean which name no model.
    """
    with database.write() as session:
        row = version_row(session, name, version, lock=True)
        check_owner(session, row)
        defaults = [alias for alias in _aliases(session, row) if alias in DEFAULT_KINDS]
        if defaults:
            raise ModelInUseError(f"the alias {defaults[0]} points to {name}@{version}; point it to another one first")
        row.deprecated_at, row.deprecation = row.deprecated_at or utc_now(), reason
        session.flush()
        return to_version(session, row)


def restore_version(database: Database, name: str, version: int) -> None:
    """Take the mark of a deprecated version away; raise ModelNotFoundError."""
    with database.write() as session:
        row = version_row(session, name, version, lock=True)
        check_owner(session, row)
        row.deprecated_at = row.deprecation = None


def delete_version(database: Database, name: str, version: int) -> None:
    """Remove a version for good; its bytes are left to the sweep.

    Raises
    ------
    ModelNotFoundError
        If there is no such version, or no longer.
    ModelInUseError
        If an alias points to it, or a job is pinned to it that has not ended.
    """
    try:
        _delete_version(database, name, version)
    except RowConflictError:
        # Another version of the name was deleted at the same moment, or an alias was set: the second try sees that.
        _delete_version(database, name, version)


def delete_alias(database: Database, alias: str) -> None:
    """Remove an alias; jobs that are accepted keep the version that it meant.

    Raises
    ------
    ModelNotFoundError
        If there is no such alias, or no longer.
    AliasInUseError
        If jobs that name no model mean it.
    """
    with database.write() as session:
        row = alias_row(session, alias, lock=True)
        if row is None:
            raise ModelNotFoundError(f"there is no alias {alias!r}")
        check_owner(session, row)
        if row.alias in DEFAULT_KINDS:
            raise AliasInUseError(f"jobs that name no model mean {alias!r}; it can be moved, but not deleted")
        session.delete(row)


def _delete_version(database: Database, name: str, version: int) -> None:
    with database.write() as session:
        # Locked: a job that is being accepted holds the row until it is written, and is seen below.
        row = version_row(session, name, version, lock=True)
        check_owner(session, row)
        aliases = _aliases(session, row)
        if aliases:
            raise ModelInUseError(f"the alias {aliases[0]} points to {name}@{version}; move or delete it first")
        job_id = _open_job(session, row)
        if job_id is not None:
            raise ModelInUseError(f"job {job_id} needs {name}@{version}; cancel it, or wait for its end")
        deleted = session.get(DeletedModelRow, row.name, with_for_update=True)
        deleted = deleted or DeletedModelRow(name=row.name, version=0)
        deleted.version = max(deleted.version, version)
        session.add(deleted)
        session.delete(row)


def _aliases(session: Session, row: ModelRow) -> list[str]:
    query = select(AliasRow.alias).where(AliasRow.name == row.name, AliasRow.version == row.version)
    # Those of other tenants as well: each of them needs the version.
    everywhere = query.order_by(AliasRow.alias).execution_options(all_tenants=True)
    return [shown_name(alias) for alias in session.scalars(everywhere)]


def _open_job(session: Session, row: ModelRow) -> str | None:
    """Return a job that is pinned to the version and has not ended."""
    name, version = JobRow.model["name"].as_string(), JobRow.model["version"].as_integer()
    is_pinned = (name == shown_name(row.name)) & (version == row.version)
    query = select(JobRow.id).where(JobRow.state.in_(_OPEN_STATES), is_pinned)
    if not row.shared:
        query = query.where(JobRow.tenant == row.tenant)
    return session.scalars(query.limit(1).execution_options(all_tenants=True)).first()

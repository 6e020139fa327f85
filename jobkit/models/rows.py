"""Rows of models, found and turned into what clients see.

Tested in `tests/jobkit/models/test_registry.py`.
"""

from sqlalchemy import case, select
from sqlalchemy.orm import Session

from jobkit.database.readable_rows import readable
from jobkit.database.tables import AliasRow, ModelRow
from jobkit.errors import ModelNotFoundError
from jobkit.models.errors import ModelNotProvenError, ModelRefusedError
from jobkit.schema import Alias, Deprecation, Model, ModelLinks, ModelState, ModelVersion

# What clients get of a row as it stands there.
_COPIED_FIELDS = ModelVersion.model_fields.keys() - {"aliases", "links", "deprecated"}


def version_row(session: Session, name: str, version: int, *, locked: bool = False) -> ModelRow:
    """Return the row of a version, and until the session ends if `locked`; raise ModelNotFoundError."""
    row = session.get(ModelRow, (name, version), populate_existing=locked, with_for_update=locked or None)
    if row is None:
        raise ModelNotFoundError(f"there is no model {name}@{version}")
    return row


def resolved_row(session: Session, reference: str) -> ModelRow:
    """Return the row that `name@version`, `name` or an alias means now; raise ModelNotFoundError.

    A name alone means its highest version that is ready and not deprecated; where there is none, the highest that is
    ready; and where there is none of those either, the highest.
    """
    name, _, number = reference.partition("@")
    if number:
        return version_row(session, name, int(number))
    alias = session.get(AliasRow, name)
    if alias is not None:
        return version_row(session, alias.name, alias.version)
    is_ready = ModelRow.state == ModelState.READY.value
    rank = case((is_ready & ModelRow.deprecated_at.is_(None), 2), (is_ready, 1), else_=0)
    query = select(ModelRow).where(ModelRow.name == name).order_by(rank.desc(), ModelRow.version.desc()).limit(1)
    row = session.scalars(query).first()
    if row is None:
        raise ModelNotFoundError(f"there is no model and no alias {name!r}")
    return row


def row_of_bytes(session: Session, sha256: str, name: str) -> ModelRow:
    """Return a version of these bytes: one that is ready, where there are several.

    Raises
    ------
    ModelNotFoundError
        If none is registered; `name` says what they were called elsewhere.
    """
    is_ready = case((ModelRow.state == ModelState.READY.value, 1), else_=0)
    query = select(ModelRow).where(ModelRow.sha256 == sha256)
    row = session.scalars(query.order_by(is_ready.desc(), ModelRow.name, ModelRow.version.desc()).limit(1)).first()
    if row is None:
        raise ModelNotFoundError(f"no model here has the bytes of {name}, sha256 {sha256}")
    return row


def check_proven(row: ModelRow) -> None:
    """Raise ModelNotProvenError or ModelRefusedError where the version may not be used."""
    reference = f"{row.name}@{row.version}"
    if row.state == ModelState.PROVING.value:
        raise ModelNotProvenError(f"{reference} is still being proven by a worker; ask again")
    if row.state == ModelState.REFUSED.value:
        problem = row.problem or {}
        raise ModelRefusedError(f"{reference} was refused ({problem.get('code')}): {problem.get('message')}")


def to_model(session: Session, name: str, most: int, below: int | None = None) -> Model:
    """Return a model with its newest `most` versions, of those below a number; raise ModelNotFoundError."""
    if session.scalars(select(ModelRow.version).where(ModelRow.name == name).limit(1)).first() is None:
        raise ModelNotFoundError(f"there is no model {name!r}")
    query = select(ModelRow).where(ModelRow.name == name).order_by(ModelRow.version.desc()).limit(most + 1)
    rows = list(session.scalars(query if below is None else query.where(ModelRow.version < below)))
    return Model(
        name=name,
        latest=resolved_row(session, name).version,
        versions=list(readable(rows[:most], lambda row: to_version(session, row))),
        next_cursor=rows[most - 1].version if len(rows) > most else None,
    )


def to_version(session: Session, row: ModelRow) -> ModelVersion:
    """Return a version as clients see it."""
    path = f"/v1/models/{row.name}/versions/{row.version}"
    query = select(AliasRow.alias).where(AliasRow.name == row.name, AliasRow.version == row.version)
    aliases = session.scalars(query.order_by(AliasRow.alias)).all()
    values = {name: getattr(row, name) for name in _COPIED_FIELDS}
    since = row.deprecated_at
    deprecated = None if since is None else Deprecation(at=since, reason=row.deprecation or "")
    links = ModelLinks(self=path, artifact=f"{path}/artifact")
    return ModelVersion.model_validate({**values, "aliases": list(aliases), "links": links, "deprecated": deprecated})


def to_alias(row: AliasRow) -> Alias:
    """Return an alias as clients see it."""
    return Alias(alias=row.alias, name=row.name, version=row.version, updated_at=row.updated_at)

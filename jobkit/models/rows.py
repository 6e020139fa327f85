"""Rows of models, found and turned into what clients see.

Tested in `tests/jobkit/models/test_registry.py`.
"""

from typing import Literal

from sqlalchemy import case, select
from sqlalchemy.orm import Session

from jobkit.database.readable_rows import readable
from jobkit.database.tables import AliasRow, ModelRow
from jobkit.database.tenancy import names_of, shown_name, tenant_of
from jobkit.errors import ModelNotFoundError
from jobkit.models.errors import ModelNotProvenError, ModelRefusedError, SharedModelError
from quadpatch_client.schema import Alias, Deprecation, Model, ModelLinks, ModelState, ModelVersion

# `with_for_update` of SQLAlchemy: True, or the kind of the lock.
Lock = dict[str, bool] | Literal[True] | None
# What clients get of a row as it stands there.
_COPIED_FIELDS = ModelVersion.model_fields.keys() - {"aliases", "links", "deprecated"}


def version_row(session: Session, name: str, version: int, *, lock: Lock = None) -> ModelRow:
    """Return the row of a version, locked until the session ends if asked for; raise ModelNotFoundError."""
    for owned in names_of(tenant_of(session), name):
        row = session.get(ModelRow, (owned, version), populate_existing=lock is not None, with_for_update=lock)
        if row is not None:
            return row
    raise ModelNotFoundError(f"there is no model {shown_name(name)}@{version}")


def alias_row(session: Session, alias: str, *, lock: Lock = None) -> AliasRow | None:
    """Return what an alias means, locked if asked for: the tenant's own one, else a shared one."""
    rows = (session.get(AliasRow, name, with_for_update=lock) for name in names_of(tenant_of(session), alias))
    return next((row for row in rows if row is not None), None)


def check_owner(session: Session, row: ModelRow | AliasRow) -> None:
    """Raise SharedModelError where a row is another tenant's, which shares it."""
    if tenant_of(session) not in (None, row.tenant):
        name = shown_name(row.alias if isinstance(row, AliasRow) else row.name)
        raise SharedModelError(f"{name} is shared by the operator, who alone may change it")


def resolved_row(session: Session, reference: str) -> ModelRow:
    """Return the row that `name@version`, `name` or an alias means now; raise ModelNotFoundError.

    A name alone means its highest version that is ready and not deprecated; where there is none, the highest that is
    ready; and where there is none of those either, the highest.
    """
    name, _, number = reference.partition("@")
    if number:
        return version_row(session, name, int(number))
    alias = alias_row(session, name)
    if alias is not None:
        return version_row(session, alias.name, alias.version)
    is_ready = ModelRow.state == ModelState.READY.value
    rank = case((is_ready & ModelRow.deprecated_at.is_(None), 2), (is_ready, 1), else_=0)
    for owned in names_of(tenant_of(session), name):
        query = select(ModelRow).where(ModelRow.name == owned).order_by(rank.desc(), ModelRow.version.desc()).limit(1)
        row = session.scalars(query).first()
        if row is not None:
            return row
    raise ModelNotFoundError(f"there is no model and no alias {name!r}")


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
    reference = f"{shown_name(row.name)}@{row.version}"
    if row.state == ModelState.PROVING.value:
        raise ModelNotProvenError(f"{reference} is still being proven by a worker; ask again")
    if row.state == ModelState.REFUSED.value:
        problem = row.problem or {}
        raise ModelRefusedError(f"{reference} was refused ({problem.get('code')}): {problem.get('message')}")


def to_model(session: Session, name: str, most: int, below: int | None = None) -> Model:
    """Return a model with its newest `most` versions, of those below a number; raise ModelNotFoundError."""
    names = names_of(tenant_of(session), name)
    there = set(session.scalars(select(ModelRow.name).where(ModelRow.name.in_(names)).distinct()))
    owned = next((owned for owned in names if owned in there), None)
    if owned is None:
        raise ModelNotFoundError(f"there is no model {name!r}")
    query = select(ModelRow).where(ModelRow.name == owned).order_by(ModelRow.version.desc()).limit(most + 1)
    rows = list(session.scalars(query if below is None else query.where(ModelRow.version < below)))
    return Model(
        name=shown_name(owned),
        latest=resolved_row(session, name).version,
        versions=list(readable(rows[:most], lambda row: to_version(session, row))),
        next_cursor=rows[most - 1].version if len(rows) > most else None,
    )


def to_version(session: Session, row: ModelRow) -> ModelVersion:
    """Return a version as clients see it."""
    path = f"/v1/models/{shown_name(row.name)}/versions/{row.version}"
    query = select(AliasRow.alias).where(AliasRow.name == row.name, AliasRow.version == row.version)
    aliases = sorted({shown_name(alias) for alias in session.scalars(query)})
    values = {name: getattr(row, name) for name in _COPIED_FIELDS} | {"name": shown_name(row.name)}
    since = row.deprecated_at
    deprecated = None if since is None else Deprecation(at=since, reason=row.deprecation or "")
    links = ModelLinks(self=path, artifact=f"{path}/artifact")
    return ModelVersion.model_validate({**values, "aliases": aliases, "links": links, "deprecated": deprecated})


def to_alias(row: AliasRow) -> Alias:
    """Return an alias as clients see it."""
    return Alias(
        alias=shown_name(row.alias),
        name=shown_name(row.name),
        version=row.version,
        shared=row.shared,
        updated_at=row.updated_at,
    )

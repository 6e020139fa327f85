"""Aliases: names that are pointed to versions of models.

Tested in `tests/jobkit/jobs/test_trainings.py`.
"""

from sqlalchemy import select
from sqlalchemy.orm import Session

from jobkit.database.clock import utc_now
from jobkit.database.tables import AliasRow, ModelRow
from jobkit.database.tenancy import names_of, own_name, shown_name, tenant_of
from jobkit.errors import ModelKindError, NameTakenError
from jobkit.models.default_aliases import DEFAULT_KINDS
from jobkit.models.errors import ModelDeprecatedError
from jobkit.models.rows import check_proven, resolved_row, to_alias, version_row
from quadpatch_client.schema import SELF, Alias

RESERVED_NAMES = frozenset({SELF, "auto", "smooth", "none", "latest"})


def point_alias(session: Session, alias: str, reference: str) -> Alias:
    """Point an alias to a version; see `jobkit.models.registry.Registry.set_alias`. Nothing is written if it raises."""
    resolved = resolved_row(session, reference)
    # Locked: it may be deprecated or deleted at the same moment.
    target = version_row(session, resolved.name, resolved.version, lock=True)
    check_proven(target)
    if target.deprecated_at is not None:
        shown = f"{shown_name(target.name)}@{target.version}"
        raise ModelDeprecatedError(f"{shown} is deprecated; no alias may point to it")
    tenant = tenant_of(session)
    names = names_of(tenant, alias)
    if alias in RESERVED_NAMES or session.scalars(select(ModelRow).where(ModelRow.name.in_(names))).first():
        raise NameTakenError(f"{alias!r} is the name of a model, or reserved")
    own = own_name(tenant, alias)
    row = session.get(AliasRow, own, with_for_update=True) or AliasRow(alias=own, shared=False)
    if tenant is None:
        row.shared = True
    kind = _kind_of_alias(session, row)
    if kind not in (None, target.kind):
        raise ModelKindError(f"{alias!r} means models of the kind {kind}; {reference} is of the kind {target.kind}")
    row.name, row.version, row.updated_at = target.name, target.version, utc_now()
    # Jobs of all tenants mean a shared alias: they have to see what it points to.
    target.shared |= row.shared
    session.add(row)
    return to_alias(row)


def _kind_of_alias(session: Session, row: AliasRow) -> str | None:
    """Return the kind of model that an alias keeps to: that of its first target; None where it is free."""
    if row.name is None:
        return DEFAULT_KINDS.get(shown_name(row.alias))
    return version_row(session, row.name, row.version).kind

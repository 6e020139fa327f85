"""Tenants: rows that belong to one, and sessions that see no others.

A session that is opened for a tenant adds the condition on the owner to every statement by itself
(`with_loader_criteria` of SQLAlchemy), so that no query can forget it. Sessions of workers and of the dispatcher are
opened for none, and see everything, as do statements with the execution option `all_tenants`.

Tested in `tests/attacks/test_m_tenants.py`.
"""

import hashlib
from functools import lru_cache

from sqlalchemy import ColumnElement, String, event, or_
from sqlalchemy.orm import Mapped, ORMExecuteState, Session, mapped_column, with_loader_criteria
from sqlalchemy.sql.base import ExecutableOption

# The tenant of the operator: of requests without keys, of keys in the settings, and of all that was there before
# tenants were. What it shares, such as the models that ship, others see as well.
DEFAULT_TENANT = "default"


class Owned:
    """A table whose rows belong to a tenant."""

    tenant: Mapped[str] = mapped_column(String(64), server_default=DEFAULT_TENANT)


class Shareable(Owned):
    """A table whose rows belong to a tenant, and some of them may be used by all."""

    shared: Mapped[bool] = mapped_column(default=False, server_default="0")


class TenantSession(Session):
    """A session for the rows of `info["tenant"]` alone; for all without one."""


def tenant_of(session: Session) -> str | None:
    """Return the tenant whose rows a session sees; None: it sees all."""
    tenant: str | None = session.info.get("tenant")
    return tenant


def _owned_tables() -> tuple[type[Owned], ...]:
    """Find all tables with an owner, those of modules among them that were loaded just now."""
    # Mixins have no columns of their own.
    found = (cls for mixin in (Owned, Shareable) for cls in mixin.__subclasses__())
    return tuple(cls for cls in found if hasattr(cls, "__table__"))


@lru_cache(maxsize=1024)
def _conditions(tenant: str, tables: tuple[type[Owned], ...]) -> tuple[ExecutableOption, ...]:
    return tuple(with_loader_criteria(cls, _is_seen(cls, tenant), include_aliases=True) for cls in tables)


def _is_seen(cls: type[Owned], tenant: str) -> ColumnElement[bool]:
    is_own = cls.tenant == tenant
    return or_(is_own, cls.shared) if issubclass(cls, Shareable) else is_own


@event.listens_for(TenantSession, "do_orm_execute")
def _add_conditions(state: ORMExecuteState) -> None:
    tenant = tenant_of(state.session)
    if tenant is not None and not state.execution_options.get("all_tenants", False):
        state.statement = state.statement.options(*_conditions(tenant, _owned_tables()))


@event.listens_for(TenantSession, "before_flush")
def _add_owner(session: Session, _context: object, _instances: object) -> None:
    tenant = tenant_of(session)
    for row in session.new:
        if isinstance(row, Owned) and row.tenant is None:
            row.tenant = tenant or DEFAULT_TENANT


def own_name(tenant: str | None, name: str) -> str:
    """Name a model or an alias of a tenant among those of all: `tenant/name`; the default tenant's as it is."""
    return name if tenant in (None, DEFAULT_TENANT) else f"{tenant}/{name}"


def names_of(tenant: str | None, name: str) -> list[str]:
    """List what a name may stand for: what is the tenant's own, and after that what is shared."""
    return list(dict.fromkeys([own_name(tenant, name), name]))


def shown_name(name: str) -> str:
    """Return a name as its tenant knows it."""
    return name.rpartition("/")[2]


def mesh_id_of(tenant: str | None, sha256: str) -> str:
    """Name the row of the mesh that a tenant makes of some bytes; to the tenant, its id is their sha256.

    The rows of the default tenant have that id, too. Those of others differ from tenant to tenant: two of them may
    upload the same bytes, and neither learns of it.
    """
    if tenant in (None, DEFAULT_TENANT):
        return sha256
    return hashlib.sha256(f"{tenant}\n{sha256}".encode()).hexdigest()

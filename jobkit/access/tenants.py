"""Tenants: which there are, what was set for them, what they have.

Tested in `tests/service/routes/test_tenants.py`.
"""

from typing import Any

from sqlalchemy import select
from sqlalchemy.orm import Session

from jobkit.database.access_tables import TenantRow
from jobkit.database.quotas import effective_quotas, note_tenant, own_quotas, usage_of
from jobkit.database.session import Database
from jobkit.database.tenancy import DEFAULT_TENANT
from jobkit.errors import OperatorTenantError, TenantNotFoundError
from quadpatch_client.schema import Quotas, Tenant, TenantChanges, TenantList, TenantWithUse, Usage


class Tenants:
    """The tenants of a database."""

    def __init__(self, database: Database) -> None:
        self._database = database

    def list_all(self) -> TenantList:
        """Return all tenants by name."""
        with self._database.read() as session:
            rows = session.scalars(select(TenantRow).order_by(TenantRow.name))
            return TenantList(items=[Tenant.model_validate(_wire(session, row)) for row in rows])

    def get(self, name: str) -> TenantWithUse:
        """Return a tenant with what it has; raise TenantNotFoundError."""
        with self._database.read() as session:
            return _with_use(session, _existing(session, name))

    def change(self, name: str, changes: TenantChanges) -> TenantWithUse:
        """Set what is named in the changes; a tenant that is not there is made.

        Raises
        ------
        OperatorTenantError
            If the operator's own tenant is to be disabled.
        """
        if name == DEFAULT_TENANT and changes.disabled:
            raise OperatorTenantError(f"tenant {name} is the operator's own and can't be disabled")
        with self._database.write() as session:
            note_tenant(session, name)
            query = select(TenantRow).where(TenantRow.name == name).with_for_update()
            row = session.scalars(query).one()
            for field in changes.model_fields_set:
                setattr(row, field, getattr(changes, field))
            session.flush()
            return _with_use(session, row)

    def state(self, name: str) -> tuple[Quotas, bool]:
        """Return what holds for a tenant, and whether it is disabled."""
        with self._database.read() as session:
            row = session.get(TenantRow, name)
            return effective_quotas(session, name, row), row is not None and row.disabled

    def usage(self, name: str) -> tuple[Quotas, Usage]:
        """Return what holds for a tenant, and what it has."""
        with self._database.read() as session:
            return effective_quotas(session, name, session.get(TenantRow, name)), usage_of(session, name)


def _existing(session: Session, name: str) -> TenantRow:
    row = session.get(TenantRow, name)
    if row is None:
        raise TenantNotFoundError(f"there is no tenant {name}")
    return row


def _with_use(session: Session, row: TenantRow) -> TenantWithUse:
    return TenantWithUse.model_validate({**_wire(session, row), "use": usage_of(session, row.name)})


def _wire(session: Session, row: TenantRow) -> dict[str, Any]:
    own = own_quotas(row)
    quotas = effective_quotas(session, row.name, row)
    values = {name: getattr(row, name) for name in ("name", "disabled", "created_at")}
    return {**values, "quotas": quotas, "own_quotas": list(own)}

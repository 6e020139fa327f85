"""Tenants: list, look at, set quotas, disable; of the operator alone."""

from http import HTTPStatus
from typing import Annotated

from fastapi import APIRouter, Depends, Path

from jobkit.access.tenants import Tenants
from jobkit.database.tenancy import DEFAULT_TENANT
from quadpatch_client.schema import TenantChanges, TenantList, TenantWithUse
from quadpatch_rules.ids import TENANT_PATTERN
from service.problems import ProblemError
from service.routes.common import problems
from service.services import AllServicesDep, PrincipalDep
from service.strict_validation import StrictRoute

router = APIRouter(tags=["access"], route_class=StrictRoute)
TenantPath = Annotated[str, Path(pattern=TENANT_PATTERN, description="Name of a tenant.", examples=["plant-north"])]


async def _get_tenants(services: AllServicesDep, principal: PrincipalDep) -> Tenants:
    """Give the tenants to the operator; raise ProblemError, 403, for others."""
    if principal.tenant != DEFAULT_TENANT:
        raise ProblemError(HTTPStatus.FORBIDDEN, "foreign_tenant", "tenants and their quotas are the operator's")
    return Tenants(services.database)


TenantsDep = Annotated[Tenants, Depends(_get_tenants)]


@router.get("/v1/tenants", response_model=TenantList, responses=problems())
def list_tenants(tenants: TenantsDep) -> TenantList:
    """List tenants by name: those that keys name, and those for which something was set."""
    return tenants.list_all()


@router.get("/v1/tenants/{tenant}", response_model=TenantWithUse, responses=problems(404))
def get_tenant(tenants: TenantsDep, tenant: TenantPath) -> TenantWithUse:
    """Show a tenant: what it may have, and what it has."""
    return tenants.get(tenant)


@router.patch("/v1/tenants/{tenant}", response_model=TenantWithUse, responses=problems(400, 409, 413, 415))
def change_tenant(tenants: TenantsDep, tenant: TenantPath, changes: TenantChanges) -> TenantWithUse:
    """Set quotas of a tenant, disable it or let it in again; one that is not there is made.

    Processes of the API know it within two seconds. A quota below what a tenant has takes nothing away from it.
    """
    return tenants.change(tenant, changes)

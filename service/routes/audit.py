"""The audit log."""

from typing import Annotated

from fastapi import APIRouter, Query

from jobkit.access.audit import AuditLog
from jobkit.database.tenancy import DEFAULT_TENANT
from quadpatch_client.schema import AuditPage
from quadpatch_rules.ids import AUDIT_ID_PATTERN
from service.routes.common import problems
from service.services import AllServicesDep, PrincipalDep
from service.strict_validation import StrictRoute

router = APIRouter(tags=["access"], route_class=StrictRoute)
Limit = Annotated[int, Query(ge=1, le=500, description="Most entries on the page.")]
Cursor = Annotated[
    str | None, Query(pattern=AUDIT_ID_PATTERN, description="`next_cursor` of the page before this one.")
]


@router.get("/v1/audit", response_model=AuditPage, responses=problems())
def list_audit(
    services: AllServicesDep, principal: PrincipalDep, limit: Limit = 100, cursor: Cursor = None
) -> AuditPage:
    """List what was changed, and what was refused for want of a key or a right, newest first.

    Keys of the tenant `default` see the whole log, others the part of their tenant. An entry is written within a second
    of the answer.
    """
    is_operator = principal.tenant == DEFAULT_TENANT
    log = AuditLog(services.database if is_operator else services.database.of(principal.tenant))
    return log.page(limit, cursor)

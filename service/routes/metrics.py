"""Figures for Prometheus."""

from http import HTTPStatus
from typing import Any

from fastapi import APIRouter, Request
from prometheus_client import CONTENT_TYPE_PLAIN_0_0_4, generate_latest
from starlette.responses import Response

from jobkit.database.tenancy import DEFAULT_TENANT
from service.auth import METRICS_PATH
from service.problems import ProblemError
from service.routes.common import problems
from service.services import PrincipalDep
from service.strict_validation import StrictRoute

router = APIRouter(tags=["service"], route_class=StrictRoute)
_TEXT: dict[int | str, dict[str, Any]] = {
    200: {"description": "The figures.", "content": {"text/plain": {"schema": {"type": "string"}}}}
}


@router.get(METRICS_PATH, response_class=Response, responses={**_TEXT, **problems()})
def metrics(request: Request, principal: PrincipalDep) -> Response:
    """Return figures of this process, and of the database that all processes share, in the text format of Prometheus.

    They are named in `docs/operations.md`. A key of the tenant `default` with the scope `admin` is asked for, since
    they count the jobs of all tenants, unless the service was told to do without (`QUADPATCH_METRICS_OPEN`).
    """
    if principal.tenant != DEFAULT_TENANT:
        raise ProblemError(HTTPStatus.FORBIDDEN, "foreign_tenant", "metrics count all tenants: they are the operator's")
    return Response(generate_latest(request.app.state.registry), media_type=CONTENT_TYPE_PLAIN_0_0_4)

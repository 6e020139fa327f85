"""Figures for Prometheus."""

from typing import Any

from fastapi import APIRouter, Request
from prometheus_client import CONTENT_TYPE_PLAIN_0_0_4, generate_latest
from starlette.responses import Response

from service.auth import METRICS_PATH
from service.routes.common import problems
from service.strict_validation import StrictRoute

router = APIRouter(tags=["service"], route_class=StrictRoute)
_TEXT: dict[int | str, dict[str, Any]] = {
    200: {"description": "The figures.", "content": {"text/plain": {"schema": {"type": "string"}}}}
}


@router.get(METRICS_PATH, response_class=Response, responses={**_TEXT, **problems()})
def metrics(request: Request) -> Response:
    """Return figures of this process, and of the database that all processes share, in the text format of Prometheus.

    They are named in `docs/operations.md`. A key is asked for, as for any other request, unless the service was told
    to do without (`QUADPATCH_METRICS_OPEN`).
    """
    return Response(generate_latest(request.app.state.registry), media_type=CONTENT_TYPE_PLAIN_0_0_4)

"""Shadows: set, list, look at, read run by run, clear."""

from http import HTTPStatus
from typing import Annotated, Any

from fastapi import APIRouter, Depends, Path, Query
from starlette.responses import Response

from jobkit.shadows.shadows import Shadows
from quadpatch_client.schema import NewShadow, Shadow, ShadowList, ShadowRunPage
from quadpatch_client.schema.base import NAME_PATTERN
from quadpatch_rules.ids import JOB_ID_PATTERN
from service.finding import Limit
from service.routes.common import problems
from service.services import ServicesDep
from service.strict_validation import StrictRoute

router = APIRouter(tags=["shadows"], route_class=StrictRoute)

ShadowPath = Annotated[
    str, Path(pattern=NAME_PATTERN, description="An alias, a model, or `auto`.", examples=["default"])
]
Cursor = Annotated[str | None, Query(pattern=JOB_ID_PATTERN, description="`next_cursor` of the page before this one.")]
_EXAMPLES: dict[str, Any] = {
    "requestBody": {
        "content": {
            "application/json": {
                "examples": {
                    "castings": {
                        "summary": "A learned dictionary beside the default one, on a tenth of the jobs",
                        "value": {"candidate": "castings@3", "share": 0.1},
                    }
                }
            }
        }
    }
}


async def _get_shadows(services: ServicesDep) -> Shadows:
    return Shadows(services.database, services.registry)


ShadowsDep = Annotated[Shadows, Depends(_get_shadows)]


@router.put(
    "/v1/shadows/{name}",
    response_model=Shadow,
    responses=problems(400, 404, 409, 413, 415),
    openapi_extra=_EXAMPLES,
)
def set_shadow(shadows: ShadowsDep, name: ShadowPath, new: NewShadow) -> Shadow:
    """Let a candidate run beside what your jobs ask for by a name, on a share of them.

    It runs after a job has its result, while no job waits, and is never delivered. Another candidate begins anew;
    another share goes on.
    """
    return shadows.put(name, new)


@router.get("/v1/shadows", response_model=ShadowList, responses=problems())
def list_shadows(shadows: ShadowsDep) -> ShadowList:
    """List candidates that run beside others, by name, with what their runs say."""
    return shadows.list_all()


@router.get("/v1/shadows/{name}", response_model=Shadow, responses=problems(404))
def get_shadow(shadows: ShadowsDep, name: ShadowPath) -> Shadow:
    """Show a candidate that runs beside others: what its runs say, all together."""
    return shadows.get(name)


@router.get("/v1/shadows/{name}/runs", response_model=ShadowRunPage, responses=problems(404))
def list_shadow_runs(shadows: ShadowsDep, name: ShadowPath, limit: Limit = 20, cursor: Cursor = None) -> ShadowRunPage:
    """List runs of a candidate job by job, those of the newest jobs first."""
    return shadows.runs(name, limit, cursor)


@router.delete("/v1/shadows/{name}", status_code=204, response_class=Response, responses=problems(404))
def clear_shadow(shadows: ShadowsDep, name: ShadowPath) -> Response:
    """Let the candidate run no more, and forget its runs."""
    shadows.clear(name)
    return Response(status_code=HTTPStatus.NO_CONTENT)

"""Liveness and readiness of the service."""

from http import HTTPStatus
from typing import Literal, cast

from fastapi import APIRouter, Request
from pydantic import BaseModel, Field

from service.problems import RETRY_AFTER_S, ProblemError
from service.readiness import Readiness, find_failures, read_readiness
from service.routes.common import problems
from service.services import AllServicesDep, Services
from service.strict_validation import StrictRoute

router = APIRouter(tags=["service"], route_class=StrictRoute)


class Health(BaseModel):
    """A sign of life."""

    status: Literal["ok"] = Field(default="ok", description="Always `ok`: else there is no answer.", examples=["ok"])


@router.get("/healthz", response_model=Health, responses=problems())
async def healthz() -> Health:
    """Tell whether the process lives."""
    return Health()


@router.get("/readyz", response_model=Readiness, responses=problems())
async def readyz(request: Request, services: AllServicesDep) -> Readiness:
    """Tell whether jobs can be taken, which needs database and object store, and whether they are worked on.

    The answer is up to a second old.
    """
    return cast(Readiness, await request.app.state.readiness.get(lambda: _read_readiness(services)))


def _read_readiness(services: Services) -> Readiness:
    failures = find_failures(services)
    if failures:
        names = ", ".join(item.pointer for item in failures)
        detail = f"not ready: {names}"
        status = HTTPStatus.SERVICE_UNAVAILABLE
        raise ProblemError(status, "not_ready", detail, {"Retry-After": RETRY_AFTER_S}, failures)
    return read_readiness(services)

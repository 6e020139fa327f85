"""Liveness and readiness of the service, and its first page."""

from http import HTTPStatus
from typing import Literal, cast

from fastapi import APIRouter, Request
from pydantic import BaseModel, Field
from starlette.responses import HTMLResponse, Response

from service.problems import RETRY_AFTER_S, ProblemError
from service.readiness import Readiness, find_failures, read_readiness
from service.routes.common import problems
from service.services import AllServicesDep, Services
from service.strict_validation import StrictRoute

router = APIRouter(tags=["service"], route_class=StrictRoute)
_PAGE = """<!doctype html>
<html lang="en"><meta charset="utf-8"><title>Quadpatch</title>
<style>body{font:16px/1.5 system-ui,sans-serif;max-width:42rem;margin:4rem auto;padding:0 1rem}
code,pre{background:#8882;border-radius:4px;padding:.1em .3em}pre{padding:1em;overflow:auto}
:root{color-scheme:light dark}</style>
<h1>Quadpatch</h1>
<p>Repairs holes in 3D scans. This is its HTTP service; <a href="/docs">its page of documentation</a> shows it all.</p>
<pre>curl -F mesh=@scan.ply URL/v1/repairs        # upload, get a job
curl URL/v1/jobs/JOB -H 'Prefer: wait=30'    # look until it has ended
curl -fOJ URL/v1/jobs/JOB/result             # fetch the repaired mesh</pre>
<p><a href="/v1/jobs">Jobs</a> · <a href="/v1/models">models</a> · <a href="/readyz">state</a></p>
</html>
"""


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


@router.get("/", include_in_schema=False)
def page() -> Response:
    """Say what this is to a person who opens it in a browser."""
    policy = "default-src 'none'; style-src 'unsafe-inline'; frame-ancestors 'none'"
    return HTMLResponse(_PAGE, headers={"Content-Security-Policy": policy})

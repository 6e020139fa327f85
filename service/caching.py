"""Results of equal jobs as a cache (RFC 9111): what a request asks of it, and how it was answered (RFC 9211).

Tested in `tests/service/routes/test_reuse.py`.
"""

from typing import Annotated, Any

from fastapi import Header
from starlette.responses import Response

from quadpatch_client.schema import Job

CacheControl = Annotated[
    str | None,
    Header(
        alias="Cache-Control",
        description="`no-cache`: run the job, although an equal one has left a result. Other directives are ignored.",
        examples=["no-cache"],
    ),
]
_NAME = "quadpatch"
CACHE_STATUS: dict[str, Any] = {
    "Cache-Status": {
        "description": "Of a new job (RFC 9211): `quadpatch; hit` where it took over the result of an equal one, "
        "`quadpatch; fwd=miss` where there is none, `quadpatch; fwd=request` where the request says `no-cache`, "
        "`quadpatch; fwd=bypass` where it runs in any case.",
        "schema": {"type": "string"},
    }
}


def asks_anew(cache_control: str | None) -> bool:
    """Tell whether a request wants no result that is there already."""
    return "no-cache" in [directive.strip().lower() for directive in (cache_control or "").split(",")]


def note_cache(response: Response, job: Job, *, reason: str) -> Response:
    """Say in the response whether the job took over a result; `reason` says why it would run otherwise."""
    status = "hit" if job.cached_from else f"fwd={reason}"
    response.headers["Cache-Status"] = f"{_NAME}; {status}"
    return response

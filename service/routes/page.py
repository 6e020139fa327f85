"""The page of the service: what a person works with in a browser.

It is built from `web/` by `make web`; the built files lie in `service/page`, so that an installed wheel has them. They
need no key: the page asks for one, and sends it with each request for data.
"""

import hashlib
from functools import cache
from http import HTTPStatus
from importlib.resources import files

from fastapi import APIRouter, Request
from starlette.responses import Response

from service.content import etag_matches
from service.problems import ProblemError
from service.strict_validation import StrictRoute

router = APIRouter(tags=["service"], route_class=StrictRoute)

# Meshes and pictures come by requests that carry the key, so they are shown from memory (`blob:`).
POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; connect-src 'self' blob:; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
_MEDIA_TYPES = {
    "index.html": "text/html; charset=utf-8",
    "page.js": "text/javascript; charset=utf-8",
    "page.css": "text/css; charset=utf-8",
    "icon.svg": "image/svg+xml",
    "licences.txt": "text/plain; charset=utf-8",
}
_INDEX = "index.html"
ASSETS = tuple(name for name in _MEDIA_TYPES if name != _INDEX)


@router.get("/", include_in_schema=False)
def page() -> Response:
    """Show the page."""
    content, _ = _read(_INDEX)
    return Response(content, media_type=_MEDIA_TYPES[_INDEX], headers={"Content-Security-Policy": POLICY})


@router.get("/page/{name}", include_in_schema=False)
def page_asset(request: Request, name: str) -> Response:
    """Hand out a script, a style sheet or another file of the page."""
    if name not in ASSETS:
        raise ProblemError(HTTPStatus.NOT_FOUND, "route_not_found", "there is nothing at this path")
    content, tag = _read(name)
    # A browser asks again each time: a newer service may bring another page.
    headers = {"Cache-Control": "no-cache", "ETag": tag}
    if etag_matches(request.headers.get("if-none-match"), tag):
        return Response(status_code=HTTPStatus.NOT_MODIFIED, headers=headers)
    return Response(content, media_type=_MEDIA_TYPES[name], headers=headers)


@cache
def _read(name: str) -> tuple[bytes, str]:
    content = (files("service") / "page" / name).read_bytes()
    return content, f'"{hashlib.sha256(content).hexdigest()}"'

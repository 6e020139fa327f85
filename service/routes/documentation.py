"""The description of the service: the OpenAPI document, and a page that shows it without any other machine."""

import json
import math
from collections.abc import Callable
from importlib.resources import files
from typing import Any, Literal

from fastapi import APIRouter, Request
from starlette.responses import HTMLResponse, Response

from service.cached_answer import CachedAnswer
from service.contract.document import to_yaml
from service.strict_validation import StrictRoute

router = APIRouter(tags=["service"], route_class=StrictRoute)

# Swagger UI sets styles of elements, and draws its arrows from data URLs.
_POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data:; "
    "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
_OURS = files("service") / "contract"
_SWAGGER_UI = files("fastapi_offline") / "static"
Asset = Literal["docs.js", "swagger-ui-bundle.js", "swagger-ui.css"]
_ASSETS = {
    "docs.js": (_OURS, "text/javascript"),
    "swagger-ui-bundle.js": (_SWAGGER_UI, "text/javascript"),
    "swagger-ui.css": (_SWAGGER_UI, "text/css"),
}


@router.get("/openapi.yaml", include_in_schema=False)
async def openapi_yaml(request: Request) -> Response:
    """Hand out the description of this service."""
    return await _document(request, "application/yaml", to_yaml)


@router.get("/openapi.json", include_in_schema=False)
async def openapi_json(request: Request) -> Response:
    """Hand out the same as JSON."""
    return await _document(request, "application/json", json.dumps)


@router.get("/docs", include_in_schema=False)
def docs() -> Response:
    """Show the description as a page, on which requests can be tried."""
    return HTMLResponse((_OURS / "docs.html").read_bytes(), headers={"Content-Security-Policy": _POLICY})


@router.get("/docs/{name}", include_in_schema=False)
def docs_asset(name: Asset) -> Response:
    """Hand out a script or a style sheet of the page."""
    folder, media_type = _ASSETS[name]
    # It stays the same as long as the service runs; a newer one may bring another.
    return Response((folder / name).read_bytes(), media_type=media_type, headers={"Cache-Control": "no-cache"})


async def _document(request: Request, media_type: str, write: Callable[[dict[str, Any]], str]) -> Response:
    # It never changes. Writing YAML takes a second, and any client may ask for it.
    app = request.app
    cached = app.state.documents.setdefault(media_type, CachedAnswer(math.inf))
    text = await cached.get(lambda: write(app.openapi()))
    return Response(text, media_type=media_type)

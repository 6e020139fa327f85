"""The OpenAPI document: what FastAPI derives from the routes, completed and put into one shape."""

from typing import Any

import yaml
from fastapi import FastAPI
from fastapi.openapi.utils import get_openapi
from fastapi.routing import APIRoute

from jobkit.schema import PROBLEM_MEDIA_TYPE, RepairSpec
from service.auth import public_paths

TITLE = "Quadpatch"
# That of the project; the version of the contract is in its paths, `/v1`.
VERSION = "0.2.0"
DESCRIPTION = (
    "Repairs holes in 3D scans. Upload a mesh, start a job, fetch the repaired mesh: measured vertices keep their "
    "bits, invented ones are marked, scored and explained. Other tasks of a job restore missing vertices, take noise "
    "away, and compress a surface. Names are snake_case, times RFC 3339, lengths in mesh "
    "units. Every error is an RFC 9457 problem document with a stable `code`. On loopback without API keys no key is "
    "asked for."
)


def install_document(app: FastAPI) -> None:
    """Make `app.openapi()` return the completed document, built once."""

    def openapi() -> dict[str, Any]:
        if app.openapi_schema is None:
            app.openapi_schema = _build(app)
        return app.openapi_schema

    app.openapi = openapi  # type: ignore[method-assign]


def to_yaml(document: dict[str, Any]) -> str:
    """Write a document as YAML, keys in their order."""
    return yaml.safe_dump(document, sort_keys=False, allow_unicode=True, width=120)


def operation_id(route: APIRoute) -> str:
    """Name an operation after its function."""
    return route.name


def _build(app: FastAPI) -> dict[str, Any]:
    document = get_openapi(title=TITLE, version=VERSION, description=DESCRIPTION, routes=app.routes)
    components = document["components"]
    _add_repair_spec(components["schemas"])
    components["securitySchemes"] = {
        "bearer": {"type": "http", "scheme": "bearer", "description": "One of the service's API keys."},
        "api_key": {"type": "apiKey", "in": "header", "name": "X-API-Key", "description": "The same, in a header."},
    }
    document["security"] = [{"bearer": []}, {"api_key": []}]
    if not app.state.settings.key_list:
        document["security"].append({})  # as it stands, no key is asked for
    for path, operations in document["paths"].items():
        for operation in operations.values():
            _name_problems(operation["responses"])
            if path in public_paths(app.state.settings):
                operation["security"] = []
                operation["responses"].pop("401")
    return document


def _name_problems(responses: dict[str, Any]) -> None:
    """Give error responses the media type that they are sent with."""
    for status, response in responses.items():
        if status >= "400" and "application/json" in response.get("content", {}):
            response["content"] = {PROBLEM_MEDIA_TYPE: response["content"]["application/json"]}


def _add_repair_spec(schemas: dict[str, Any]) -> None:
    """Add the model that only stands in a multipart body, which FastAPI does not look into."""
    schema = RepairSpec.model_json_schema(ref_template="#/components/schemas/{model}")
    for name, definition in schema.pop("$defs", {}).items():
        schemas.setdefault(name, definition)
    schemas["RepairSpec"] = schema

"""The OpenAPI document: what FastAPI derives from the routes, completed and put into one shape.

Tested in `tests/service/contract/test_document.py`.
"""

import re
from collections.abc import Iterator, Mapping
from http import HTTPStatus
from typing import Any

import yaml
from fastapi import FastAPI
from fastapi.openapi.utils import get_openapi
from fastapi.routing import APIRoute

from jobkit.version import VERSION
from quadpatch_client.schema import PROBLEM_MEDIA_TYPE, Problem, RepairSpec
from quadpatch_client.schema.codes import open_enum
from service.auth import public_paths
from service.contract.codes import EXAMPLE_CODES, problem_codes
from service.contract.examples import REFERENCE, example_of
from service.contract.messages import message_routes
from service.contract.tags import TAGS
from service.problems import TusStatus
from service.routes.common import MEANINGS

_HEAD = re.compile(r"^((?:`[^`]*`|\.(?! |$)|[^.:`])*).*$")
TITLE = "Quadpatch"
DESCRIPTION = (
    "Repairs holes in 3D scans. Upload a mesh, start a job, fetch the repaired mesh: measured vertices keep their "
    "bits, invented ones are marked, scored and explained. Other tasks of a job restore missing vertices, take noise "
    "away, and compress a surface. Names are snake_case, times RFC 3339, lengths in mesh "
    "units. Every error is an RFC 9457 problem document with a stable `code`. On loopback without API keys no key is "
    "asked for."
)
_SERVERS: list[dict[str, Any]] = [
    {"url": "/", "description": "The service that hands out this document."},
    {
        "url": "{scheme}://{authority}",
        "description": "Any other; by default a local stack.",
        "variables": {
            "scheme": {
                "default": "http",
                "enum": ["http", "https"],
                "description": "https wherever a network is between.",
            },
            "authority": {"default": "127.0.0.1:8000", "description": "Name or address, and port."},
        },
    },
]
_REQUEST_ID = {
    "description": "Id of the request: that of the client, where it sends one, else a new one. Logs have it.",
    "schema": {"type": "string"},
    "example": "d63eb55a-11a0-4400-a36b-f9604e3cf4a3",
}
_RETRY_AFTER = {
    "description": "Seconds after which another try may help; only where it may.",
    "schema": {"type": "string", "pattern": "^[0-9]+$"},
    "example": "2",
}
_RATE_LIMIT = {
    "description": "Of counted requests: `r` are left, and more in `t` seconds (draft-ietf-httpapi-ratelimit-headers).",
    "schema": {"type": "string"},
    "example": '"tenant";r=5997;t=43',
}
_RATE_POLICY = {
    "description": "Of counted requests: the policy, `q` requests within `w` seconds.",
    "schema": {"type": "string"},
    "example": '"tenant";q=6000;w=60',
}
# The request id with every answer, the others with counted requests.
_COMMON_HEADERS = {
    "X-Request-Id": {"$ref": "#/components/headers/RequestId"},
    "RateLimit": {"$ref": "#/components/headers/RateLimit"},
    "RateLimit-Policy": {"$ref": "#/components/headers/RateLimitPolicy"},
}
_RETRYABLE = (
    HTTPStatus.CONFLICT,
    HTTPStatus.TOO_MANY_REQUESTS,
    HTTPStatus.SERVICE_UNAVAILABLE,
    HTTPStatus.INSUFFICIENT_STORAGE,
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
    return yaml.dump(document, Dumper=_PlainDumper, sort_keys=False, allow_unicode=True, width=120)


class _PlainDumper(yaml.SafeDumper):
    """Writes what stands in a document twice out twice: few readers of OpenAPI know anchors."""

    def ignore_aliases(self, data: Any) -> bool:
        return True


def operation_id(route: APIRoute) -> str:
    """Name an operation after its function."""
    return route.name


def _build(app: FastAPI) -> dict[str, Any]:
    document = get_openapi(
        title=TITLE,
        version=VERSION,
        description=DESCRIPTION,
        routes=app.routes,
        webhooks=message_routes().routes,
        servers=_SERVERS,
        contact={"name": "The Quadpatch maintainers"},
        license_info={"name": "GNU General Public License v3.0 or later", "identifier": "GPL-3.0-or-later"},
    )
    components = document["components"]
    schemas = components["schemas"]
    _add_repair_spec(schemas)
    schemas["Problem"]["properties"]["code"] |= open_enum(problem_codes())
    schemas["Problem"]["properties"]["code"].pop("type")
    components["headers"] = {
        "RequestId": _REQUEST_ID,
        "RetryAfter": _RETRY_AFTER,
        "RateLimit": _RATE_LIMIT,
        "RateLimitPolicy": _RATE_POLICY,
    }
    components["responses"] = {_name_of(status): _problem(status) for status in MEANINGS if status >= 400}
    components["securitySchemes"] = {
        "bearer": {"type": "http", "scheme": "bearer", "description": "A key, or a token of the trusted issuer."},
        "api_key": {"type": "apiKey", "in": "header", "name": "X-API-Key", "description": "The same, in a header."},
    }
    document["security"] = [{"bearer": []}, {"api_key": []}]
    if not (app.state.settings.key_list or app.state.settings.oidc_issuer):
        document["security"].append({})  # as it stands, no key is asked for
    public = public_paths(app.state.settings)
    for path, operation in _operations(document["paths"]):
        if path in public:
            operation["security"] = []
            operation["responses"].pop("401")
        _share_problems(operation["responses"], components["responses"])
        _complete(operation, schemas)
        for response in operation["responses"].values():
            if "$ref" not in response:
                response["headers"] = response.get("headers", {}) | _COMMON_HEADERS
    for _, operation in _operations(document["webhooks"]):
        operation["security"] = []
        operation["responses"].pop("422")
        _complete(operation, schemas)
    # FastAPI's form of an error, which no operation has.
    for name in ("HTTPValidationError", "ValidationError"):
        schemas.pop(name, None)
    document["tags"] = [{"name": name, "description": text} for name, text in TAGS.items()]
    return document


def _operations(paths: Mapping[str, Mapping[str, Any]]) -> Iterator[tuple[str, dict[str, Any]]]:
    for path, operations in paths.items():
        for operation in operations.values():
            yield path, operation


def _complete(operation: dict[str, Any], schemas: Mapping[str, Any]) -> None:
    """Give an operation a summary in words, and its bodies examples."""
    text = " ".join(operation["description"].split())
    # Up to the end of the first sentence, or a colon that is no part of code.
    operation["summary"] = _HEAD.sub(r"\1", text).replace("`", "")
    bodies = [operation.get("requestBody", {}), *operation["responses"].values()]
    for content in (content for body in bodies for content in body.get("content", {}).values()):
        if "type" not in content["schema"]:  # of a file
            content.setdefault("example", example_of(content["schema"], schemas))


def _share_problems(responses: dict[str, Any], shared: Mapping[str, Any]) -> None:
    """Put a reference in the place of each error that means what it does elsewhere."""
    for status, response in responses.items():
        if status < "400" or "application/json" not in response.get("content", {}):
            continue
        name = _name_of(int(status))
        if response["description"] == shared[name]["description"]:
            responses[status] = {"$ref": f"#/components/responses/{name}"}
        else:
            response["content"] = {PROBLEM_MEDIA_TYPE: response["content"]["application/json"]}


def _problem(status: int) -> dict[str, Any]:
    """Return an error that operations share; problems have a media type of their own."""
    headers = dict(_COMMON_HEADERS)
    if status in _RETRYABLE:
        headers["Retry-After"] = {"$ref": "#/components/headers/RetryAfter"}
    code, title = EXAMPLE_CODES[status], _phrase(status)
    example = Problem(
        type=f"urn:quadpatch:problem:{code}",
        title=title,
        status=status,
        code=code,
        detail=MEANINGS[status],
        instance="urn:quadpatch:request:d63eb55a-11a0-4400-a36b-f9604e3cf4a3",
        retryable=status in (HTTPStatus.TOO_MANY_REQUESTS, HTTPStatus.SERVICE_UNAVAILABLE),
    )
    content = {"schema": {"$ref": f"{REFERENCE}Problem"}, "example": example.model_dump(mode="json", exclude_none=True)}
    return {"description": MEANINGS[status], "headers": headers, "content": {PROBLEM_MEDIA_TYPE: content}}


def _name_of(status: int) -> str:
    """Return the name of a shared error, like `NotFound`."""
    return _phrase(status).title().replace(" ", "").replace("-", "")


def _phrase(status: int) -> str:
    return (TusStatus if status in set(TusStatus) else HTTPStatus)(status).phrase


def _add_repair_spec(schemas: dict[str, Any]) -> None:
    """Add the model that only stands in a multipart body, which FastAPI does not look into."""
    schema = RepairSpec.model_json_schema(ref_template=f"{REFERENCE}{{model}}")
    for name, definition in schema.pop("$defs", {}).items():
        schemas.setdefault(name, definition)
    schemas["RepairSpec"] = schema

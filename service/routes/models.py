"""Models: versions, cards, aliases, artifacts."""

from http import HTTPStatus
from typing import Annotated, Any

from fastapi import APIRouter, Path, Request
from starlette.concurrency import run_in_threadpool
from starlette.responses import Response

from jobkit.idempotency import note_request, refuse_conflict
from jobkit.model_header import Card
from jobkit.registry import MODEL_PREFIX
from jobkit.schema import Alias, AliasTarget, Model, ModelList, ModelVersion
from jobkit.schema.base import NAME_PATTERN
from jobkit.strict_json import StrictJsonError, read_json
from service.content import OCTETS, Content, content_response
from service.idempotency import note_replayed
from service.problems import invalid_request
from service.routes.common import (
    BINARY,
    CONDITIONAL,
    FILE,
    CallerDep,
    ModelNamePath,
    VersionPath,
    described_header,
    json_response,
    linked,
    not_modified,
    problems,
)
from service.services import ServicesDep
from service.strict import StrictRoute
from service.uploads import UploadRules, receive_upload

router = APIRouter(tags=["models"], route_class=StrictRoute)

_LOCATION = {
    "headers": {"Location": described_header("Path of the version.")},
    "links": {
        operation: {
            "operationId": operation,
            "parameters": {"name": "$response.body#/name", "version": "$response.body#/version"},
        }
        for operation in ("get_model_version", "get_model_artifact")
    }
    | {"get_model": linked("get_model", "$response.body#/name", "name")},
}
_BODY: dict[str, Any] = {
    "requestBody": {
        "required": True,
        "description": "A dictionary (safetensors, its card in its metadata) or a network (ONNX; its card in the part "
        "`card`).",
        "content": {
            "application/octet-stream": {"schema": FILE},
            "multipart/form-data": {
                "schema": {
                    "type": "object",
                    "properties": {
                        "artifact": {**FILE, "description": "The model file."},
                        "card": {"type": "object", "description": "What is known about a network."},
                    },
                    "required": ["artifact"],
                    "additionalProperties": False,
                },
                "encoding": {"card": {"contentType": "application/json"}},
            },
        },
    }
}
AliasPath = Annotated[str, Path(pattern=NAME_PATTERN, description="An alias.", examples=["candidate"])]


@router.get("/v1/models", response_model=ModelList, responses=problems())
def list_models(services: ServicesDep) -> ModelList:
    """List all models with their versions, and all aliases."""
    return services.registry.list_all()


@router.get("/v1/models/{name}", response_model=Model, responses=problems(404))
def get_model(services: ServicesDep, name: ModelNamePath) -> Model:
    """Show a model with all its versions."""
    return services.registry.get(name)


@router.get("/v1/models/{name}/versions/{version}", response_model=ModelVersion, responses=problems(404))
def get_model_version(services: ServicesDep, name: ModelNamePath, version: VersionPath) -> ModelVersion:
    """Show one version with its card."""
    return services.registry.resolve(f"{name}@{version}")


@router.get(
    "/v1/models/{name}/versions/{version}/artifact",
    response_class=Response,
    dependencies=CONDITIONAL,
    responses={
        200: {"description": "The whole file.", "content": {OCTETS: {"schema": BINARY}}},
        206: {"description": "The range.", "content": {OCTETS: {"schema": BINARY}}},
        **not_modified(),
        **problems(404, 410, 412, 416),
    },
)
def get_model_artifact(
    request: Request,
    services: ServicesDep,
    name: ModelNamePath,
    version: VersionPath,
) -> Response:
    """Fetch the bytes of a version."""
    artifact = services.registry.artifact(name, version)
    filename = f"{name}@{version}.{artifact.format}"
    return content_response(request, services, Content(artifact.key, artifact.sha256, artifact.size_bytes, filename))


@router.post(
    "/v1/models/{name}/versions",
    status_code=201,
    response_model=ModelVersion,
    responses={
        201: {"description": "The version is new.", **_LOCATION},
        200: {"model": ModelVersion, "description": "The same bytes are a version of this model already.", **_LOCATION},
        **problems(400, 409, 413, 415),
    },
    openapi_extra=_BODY,
)
async def publish_model(request: Request, services: ServicesDep, caller: CallerDep, name: ModelNamePath) -> Response:
    """Publish a version. Versions never change; the same bytes are the same version."""
    rules = UploadRules("artifact", frozenset({"card"}), MODEL_PREFIX, services.settings.max_upload_mb << 20)
    upload = await receive_upload(request, services.store, rules)
    card = _read_card(upload.fields.get("card"))
    request_said = ("publish_model", name, upload.stored.sha256, upload.fields.get("card", b"").hex())
    idempotency = caller.once(*request_said)
    await run_in_threadpool(refuse_conflict, services.database, idempotency)
    version, is_new = await run_in_threadpool(services.registry.publish, name, upload.stored, card)
    is_first = await run_in_threadpool(note_request, services.database, idempotency, version.links.self)
    response = json_response(version, HTTPStatus.CREATED if is_new else HTTPStatus.OK, Location=version.links.self)
    return note_replayed(response, is_new=is_first)


@router.put("/v1/aliases/{alias}", response_model=Alias, responses=problems(400, 404, 409, 413, 415))
def set_alias(services: ServicesDep, alias: AliasPath, target: AliasTarget) -> Alias:
    """Point an alias to a version. Jobs that are already accepted keep the version they were pinned to."""
    return services.registry.set_alias(alias, target.model)


def _read_card(text: bytes | None) -> Card | None:
    if text is None:
        return None
    try:
        card = read_json(text)
    except StrictJsonError as error:
        raise _card_error(f"not JSON: {error}") from error
    if not isinstance(card, dict):
        raise _card_error("not a JSON object")
    return card


def _card_error(message: str) -> Exception:
    return invalid_request([{"loc": ("body", "card"), "msg": message, "type": "card_invalid"}])

"""Models: versions, cards, aliases, artifacts."""

from http import HTTPStatus
from typing import Annotated, Any

from fastapi import APIRouter, Query, Request
from starlette.concurrency import run_in_threadpool
from starlette.responses import Response

from jobkit.database.idempotency import note_request, refuse_conflict
from jobkit.database.tenancy import DEFAULT_TENANT, own_name
from jobkit.models.errors import SharedModelError
from jobkit.models.proofs import reference_of
from jobkit.models.registry import MODEL_PREFIX, MOST_VERSIONS
from quadpatch_client.schema import Alias, AliasTarget, Model, ModelList, ModelState, ModelVersion
from quadpatch_client.schema.base import NAME_PATTERN
from quadpatch_rules.dictionary_file import Card
from quadpatch_rules.strict_json import StrictJsonError, read_json
from service.content import OCTETS, Content, content_response
from service.idempotency import note_replayed
from service.problems import RETRY_AFTER_S, ProblemError, invalid_request
from service.routes.common import (
    BINARY,
    CONDITIONAL,
    FILE,
    AliasPath,
    CallerDep,
    ModelNamePath,
    VersionPath,
    deprecation_described,
    deprecation_header,
    described_header,
    json_response,
    linked,
    not_modified,
    problems,
)
from service.services import Services, ServicesDep
from service.strict_validation import StrictRoute
from service.submission import request_proof
from service.uploads import UploadRules, receive_upload
from service.waiting import PreferHeader, note_applied, preferred_wait_s

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
# For the proof of a small model by a worker that is free.
PROOF_WAIT_S = 10.0
Limit = Annotated[int, Query(ge=1, le=100, description="Most models on the page.")]
Shared = Annotated[
    bool, Query(description="Let all tenants use the version; for keys of the tenant `default`, the operator's own.")
]
NameCursor = Annotated[
    str | None, Query(pattern=NAME_PATTERN, description="`next_cursor` of the page before this one.")
]
VersionLimit = Annotated[int, Query(ge=1, le=MOST_VERSIONS, description="Most versions on the page.")]
VersionCursor = Annotated[
    int | None, Query(ge=1, le=2**31 - 1, description="`next_cursor` of the page before this one.")
]


@router.get("/v1/models", response_model=ModelList, responses=problems())
def list_models(services: ServicesDep, limit: Limit = 20, cursor: NameCursor = None) -> ModelList:
    """List models by name, each with its 20 newest versions, and the aliases that point to them."""
    return services.registry.page(limit, cursor)


@router.get("/v1/models/{name}", response_model=Model, responses=problems(404))
def get_model(
    services: ServicesDep, name: ModelNamePath, limit: VersionLimit = 100, cursor: VersionCursor = None
) -> Model:
    """Show a model with its versions, newest first."""
    return services.registry.get(name, limit, cursor)


@router.get(
    "/v1/models/{name}/versions/{version}",
    response_model=ModelVersion,
    responses={
        200: {"description": "The version; it may still be proven.", "headers": deprecation_described()},
        **problems(404),
    },
)
async def get_model_version(
    response: Response,
    services: ServicesDep,
    name: ModelNamePath,
    version: VersionPath,
    prefer: PreferHeader = None,
) -> ModelVersion:
    """Show one version with its card, and where its proof stands."""
    reference = f"{name}@{version}"
    shown = await run_in_threadpool(services.registry.resolve, reference)
    if shown.state is ModelState.PROVING and (wait_s := preferred_wait_s(prefer)) > 0:
        if await _wait_for_proof(services, reference, wait_s):
            note_applied(response, prefer)
        shown = await run_in_threadpool(services.registry.resolve, reference)
    if shown.state is ModelState.PROVING:
        response.headers["Retry-After"] = RETRY_AFTER_S
    if shown.deprecated is not None:
        response.headers.update(deprecation_header(shown.deprecated.at))
    return shown


@router.get(
    "/v1/models/{name}/versions/{version}/artifact",
    response_class=Response,
    dependencies=CONDITIONAL,
    responses={
        200: {
            "description": "The whole file.",
            "content": {OCTETS: {"schema": BINARY}},
            "headers": deprecation_described(),
        },
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
    content = Content(artifact.key, artifact.sha256, artifact.size_bytes, filename)
    response = content_response(request, services, content)
    if artifact.deprecated_at is not None:
        response.headers.update(deprecation_header(artifact.deprecated_at))
    return response


@router.post(
    "/v1/models/{name}/versions",
    status_code=201,
    response_model=ModelVersion,
    responses={
        201: {"description": "The version is new, and proven.", **_LOCATION},
        200: {"model": ModelVersion, "description": "The same bytes are a version of this model already.", **_LOCATION},
        202: {"model": ModelVersion, "description": "A worker is yet to prove the version.", **_LOCATION},
        **problems(400, 409, 413, 415, 507),
    },
    openapi_extra=_BODY,
)
async def publish_model(
    request: Request,
    services: ServicesDep,
    caller: CallerDep,
    name: ModelNamePath,
    shared: Shared = False,
    prefer: PreferHeader = None,
) -> Response:
    """Publish a version. Versions never change; the same bytes are the same version.

    A worker opens it and proves that it answers as its card says. The answer waits for that, ten seconds unless
    `Prefer: wait=N` says otherwise; after that it is 202. A version that is refused is answered with 422.
    """
    rules = UploadRules("artifact", frozenset({"card"}), MODEL_PREFIX, services.settings.max_upload_mb << 20)
    upload = await receive_upload(request, services, rules)
    card = _read_card(upload.fields.get("card"))
    if shared and services.database.tenant != DEFAULT_TENANT:
        raise SharedModelError("only the operator shares models: keys of the tenant default")
    request_parts = ("publish_model", name, upload.stored.sha256, upload.fields.get("card", b"").hex())
    idempotency = caller.idempotency(*request_parts)
    await run_in_threadpool(refuse_conflict, services.database, idempotency)
    version, is_new = await run_in_threadpool(services.registry.publish, name, upload.stored, card, shared=shared)
    is_first = await run_in_threadpool(note_request, services.database, idempotency, version.links.self)
    has_waited = True
    if version.state is ModelState.PROVING:
        reference = reference_of(version.name, version.version)
        await run_in_threadpool(request_proof, services, reference)
        has_waited = await _wait_for_proof(services, reference, preferred_wait_s(prefer, PROOF_WAIT_S))
        version = await run_in_threadpool(services.registry.resolve, reference)
    response = note_replayed(_published(version, is_new), is_new=is_first)
    if has_waited:
        note_applied(response, prefer)
    return response


@router.put("/v1/aliases/{alias}", response_model=Alias, responses=problems(400, 404, 409, 413, 415))
def set_alias(services: ServicesDep, alias: AliasPath, target: AliasTarget) -> Alias:
    """Point an alias to a version. Jobs that are already accepted keep the version they were pinned to."""
    return services.registry.set_alias(alias, target.model)


async def _wait_for_proof(services: Services, reference: str, wait_s: float) -> bool:
    """Wait for the end of a proof; return whether that was possible."""
    allowed_s = min(wait_s, services.settings.max_wait_s)
    own = own_name(services.database.tenant, reference)
    return allowed_s <= 0 or await services.model_waiters.wait(own, allowed_s)


def _published(version: ModelVersion, is_new: bool) -> Response:
    """Say what became of an upload; raise ProblemError where the proof failed."""
    location = {"Location": version.links.self}
    if version.problem is not None:
        problem = version.problem
        raise ProblemError(HTTPStatus.UNPROCESSABLE_ENTITY, problem.code, problem.message, location)
    if version.state is ModelState.PROVING:
        return json_response(version, HTTPStatus.ACCEPTED, Retry_After=RETRY_AFTER_S, **location)
    return json_response(version, HTTPStatus.CREATED if is_new else HTTPStatus.OK, **location)


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

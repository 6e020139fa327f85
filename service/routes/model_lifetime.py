"""The end of models: deprecate versions, delete versions and aliases."""

from http import HTTPStatus

from fastapi import APIRouter
from starlette.responses import Response

from jobkit.models import lifetime
from quadpatch_client.schema import DeprecationReason, ModelVersion
from service.routes.common import AliasPath, ModelNamePath, VersionPath, problems
from service.services import ServicesDep
from service.strict_validation import StrictRoute

router = APIRouter(tags=["models"], route_class=StrictRoute)


@router.delete(
    "/v1/models/{name}/versions/{version}", status_code=204, response_class=Response, responses=problems(404, 409)
)
def delete_model_version(services: ServicesDep, name: ModelNamePath, version: VersionPath) -> Response:
    """Delete a version that no alias points to and no unfinished job needs. Its number never comes back."""
    lifetime.delete_version(services.database, name, version)
    return _done()


@router.put(
    "/v1/models/{name}/versions/{version}/deprecation",
    response_model=ModelVersion,
    responses=problems(400, 404, 409, 413, 415),
)
def deprecate_model_version(
    services: ServicesDep, name: ModelNamePath, version: VersionPath, given: DeprecationReason | None = None
) -> ModelVersion:
    """Mark a version as one that should be used no more. Jobs that name it still run, and end with a warning."""
    reason = "" if given is None else given.reason
    return lifetime.deprecate_version(services.database, name, version, reason)


@router.delete(
    "/v1/models/{name}/versions/{version}/deprecation",
    status_code=204,
    response_class=Response,
    responses=problems(404),
)
def restore_model_version(services: ServicesDep, name: ModelNamePath, version: VersionPath) -> Response:
    """Take the mark away; a version without one stays as it is."""
    lifetime.restore_version(services.database, name, version)
    return _done()


@router.delete("/v1/aliases/{alias}", status_code=204, response_class=Response, responses=problems(404, 409))
def delete_alias(services: ServicesDep, alias: AliasPath) -> Response:
    """Delete an alias. Jobs that are accepted keep the version that it meant; `default` can only be moved."""
    lifetime.delete_alias(services.database, alias)
    return _done()


def _done() -> Response:
    return Response(status_code=HTTPStatus.NO_CONTENT)

"""The secret that signs messages to callback URLs."""

from http import HTTPStatus

from fastapi import APIRouter
from starlette.responses import Response

from quadpatch_client.schema import CallbackSecret
from service.idempotency import note_replayed
from service.routes.common import CallerDep, json_response, problems
from service.services import ServicesDep
from service.strict_validation import StrictRoute

router = APIRouter(tags=["webhooks"], route_class=StrictRoute)


@router.post(
    "/v1/callback-secret",
    status_code=201,
    response_model=CallbackSecret,
    responses={201: {"description": "It is shown this once."}, **problems(409)},
)
def renew_callback_secret(services: ServicesDep, caller: CallerDep) -> Response:
    """Get a new secret that signs all messages to callback URLs. For a day the one of before signs as well."""
    secret, is_new = services.callbacks.renew_secret_once(caller.idempotency("renew_callback_secret"))
    return note_replayed(json_response(secret, HTTPStatus.CREATED, Cache_Control="no-store"), is_new=is_new)

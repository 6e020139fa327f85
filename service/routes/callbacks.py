"""The secret that signs messages to callback URLs, and what became of those of a job."""

from http import HTTPStatus

from fastapi import APIRouter
from starlette.responses import Response

from quadpatch_client.schema import CallbackDeliveryList, CallbackSecret
from service.idempotency import note_replayed
from service.routes.common import CallerDep, JobIdPath, json_response, problems
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


@router.get("/v1/jobs/{job_id}/callbacks", response_model=CallbackDeliveryList, responses=problems(404))
def list_callbacks(services: ServicesDep, job_id: JobIdPath) -> CallbackDeliveryList:
    """List messages to the callback URL of a job: each try, and what came back."""
    return services.deliveries.of_job(job_id)

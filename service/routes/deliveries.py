"""Deliveries to a subscriber: list, look at, send again."""

from typing import Annotated

from fastapi import APIRouter, Path, Query
from starlette.responses import Response

from quadpatch_client.schema import DeliveryDetail, DeliveryPage, DeliveryState
from quadpatch_client.schema.webhooks import EXAMPLE_MESSAGE_ID
from quadpatch_rules.ids import MESSAGE_ID_PATTERN
from service.routes.common import CallerDep, WebhookIdPath, problems
from service.routes.webhooks import QUEUED, delivery_response
from service.services import ServicesDep
from service.strict_validation import StrictRoute

router = APIRouter(tags=["webhooks"], route_class=StrictRoute)

DeliveryIdPath = Annotated[
    str, Path(pattern=MESSAGE_ID_PATTERN, description="Id of a delivery.", examples=[EXAMPLE_MESSAGE_ID])
]
Limit = Annotated[int, Query(ge=1, le=100, description="Most deliveries on the page.")]
Cursor = Annotated[
    str | None, Query(pattern=MESSAGE_ID_PATTERN, description="`next_cursor` of the page before this one.")
]
StateFilter = Annotated[DeliveryState | None, Query(description="Only deliveries in this state.")]


@router.get("/v1/webhooks/{webhook_id}/deliveries", response_model=DeliveryPage, responses=problems(404))
def list_deliveries(
    services: ServicesDep,
    webhook_id: WebhookIdPath,
    limit: Limit = 20,
    cursor: Cursor = None,
    state: StateFilter = None,
) -> DeliveryPage:
    """List what was sent to a subscriber, newest first."""
    return services.deliveries.page(webhook_id, limit, cursor, state)


@router.get(
    "/v1/webhooks/{webhook_id}/deliveries/{delivery_id}", response_model=DeliveryDetail, responses=problems(404)
)
def get_delivery(services: ServicesDep, webhook_id: WebhookIdPath, delivery_id: DeliveryIdPath) -> DeliveryDetail:
    """Show a delivery: the message, each try, and what came back."""
    return services.deliveries.get(webhook_id, delivery_id)


@router.post(
    "/v1/webhooks/{webhook_id}/deliveries/{delivery_id}/replay",
    status_code=202,
    response_model=None,
    responses={**QUEUED, **problems(404, 409)},
)
def replay_delivery(
    services: ServicesDep, caller: CallerDep, webhook_id: WebhookIdPath, delivery_id: DeliveryIdPath
) -> Response:
    """Have a message sent again, under the same message id, so that a receiver that knows it already can tell."""
    idempotency = caller.idempotency("replay_delivery", webhook_id, delivery_id)
    return delivery_response(*services.deliveries.replay_once(webhook_id, delivery_id, idempotency))

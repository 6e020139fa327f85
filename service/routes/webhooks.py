"""Subscriptions: make, list, look at, change, delete, test, give a new secret."""

from http import HTTPStatus
from typing import Any

from fastapi import APIRouter
from starlette.responses import Response

from quadpatch_client.schema import DeliveryDetail, NewWebhook, Webhook, WebhookChange, WebhookList, WebhookWithSecret
from service.idempotency import note_replayed
from service.routes.common import CallerDep, WebhookIdPath, described_header, json_response, linked, problems
from service.services import ServicesDep
from service.strict_validation import StrictRoute

router = APIRouter(tags=["webhooks"], route_class=StrictRoute)

_LINKS: dict[str, Any] = {
    operation: linked(operation, "$response.body#/id", "webhook_id")
    for operation in (
        "get_webhook",
        "change_webhook",
        "test_webhook",
        "rotate_webhook_secret",
        "list_deliveries",
        "delete_webhook",
    )
}
DELIVERY_LINKS: dict[str, Any] = {
    operation: {
        "operationId": operation,
        "parameters": {"webhook_id": "$response.body#/webhook_id", "delivery_id": "$response.body#/id"},
    }
    for operation in ("get_delivery", "replay_delivery")
}
QUEUED: dict[int | str, dict[str, Any]] = {
    202: {
        "model": DeliveryDetail,
        "description": "The message is on its way.",
        "headers": {"Location": described_header("Path of the delivery.")},
        "links": DELIVERY_LINKS,
    }
}


@router.post(
    "/v1/webhooks",
    status_code=201,
    response_model=WebhookWithSecret,
    responses={
        201: {
            "description": "From now on messages are sent. The secret is shown this once.",
            "headers": {"Location": described_header("Path of the subscription.")},
            "links": _LINKS,
        },
        **problems(400, 409, 413, 415),
    },
)
def create_webhook(services: ServicesDep, caller: CallerDep, new: NewWebhook) -> Response:
    """Subscribe to what happens to jobs."""
    webhook, is_new = services.webhooks.create_once(new, caller.idempotency("create_webhook", new.model_dump_json()))
    response = json_response(webhook, HTTPStatus.CREATED, Location=webhook.links.self, Cache_Control="no-store")
    return note_replayed(response, is_new=is_new)


@router.get("/v1/webhooks", response_model=WebhookList, responses=problems())
def list_webhooks(services: ServicesDep) -> WebhookList:
    """List all subscriptions, oldest first."""
    return services.webhooks.list_all()


@router.get("/v1/webhooks/{webhook_id}", response_model=Webhook, responses=problems(404))
def get_webhook(services: ServicesDep, webhook_id: WebhookIdPath) -> Webhook:
    """Show a subscription, without its secret."""
    return services.webhooks.get(webhook_id)


@router.patch("/v1/webhooks/{webhook_id}", response_model=Webhook, responses=problems(400, 404, 409, 413, 415))
def change_webhook(services: ServicesDep, webhook_id: WebhookIdPath, change: WebhookChange) -> Webhook:
    """Change a subscription. Switched off it gets nothing, and what is on its way to it is given up."""
    return services.webhooks.change(webhook_id, change)


@router.delete("/v1/webhooks/{webhook_id}", status_code=204, response_model=None, responses=problems(404))
def delete_webhook(services: ServicesDep, webhook_id: WebhookIdPath) -> Response:
    """Delete a subscription with its deliveries."""
    services.webhooks.delete(webhook_id)
    return Response(status_code=HTTPStatus.NO_CONTENT)


@router.post(
    "/v1/webhooks/{webhook_id}/test",
    status_code=202,
    response_model=None,
    responses={**QUEUED, **problems(404, 409)},
)
def test_webhook(services: ServicesDep, caller: CallerDep, webhook_id: WebhookIdPath) -> Response:
    """Have a `webhook.test` message sent."""
    return delivery_response(
        *services.deliveries.send_test_once(webhook_id, caller.idempotency("test_webhook", webhook_id))
    )


@router.post("/v1/webhooks/{webhook_id}/rotate", response_model=WebhookWithSecret, responses=problems(404, 409))
def rotate_webhook_secret(services: ServicesDep, caller: CallerDep, webhook_id: WebhookIdPath) -> Response:
    """Get a new secret. For a day messages are signed with the old one as well."""
    idempotency = caller.idempotency("rotate_webhook_secret", webhook_id)
    webhook, is_new = services.webhooks.rotate_once(webhook_id, idempotency)
    return note_replayed(json_response(webhook, Cache_Control="no-store"), is_new=is_new)


def delivery_response(delivery: DeliveryDetail, is_new: bool) -> Response:
    """Answer with a delivery that was just made, or was by the same request."""
    response = json_response(delivery, HTTPStatus.ACCEPTED, Location=delivery.links.self)
    return note_replayed(response, is_new=is_new)

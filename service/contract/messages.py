"""The messages that subscribers get: the `webhooks` of the document. No request of a client reaches these.

Tested in `tests/service/contract/test_document.py`.
"""

from collections.abc import Mapping
from typing import Annotated, Any

from fastapi import Header
from fastapi.routing import APIRouter

from quadpatch_client.schema import Message
from quadpatch_client.schema.webhooks import EXAMPLE_MESSAGE_ID, MESSAGE_TYPES, MessageType

_MEANINGS: Mapping[MessageType, str] = {
    "job.started": "An attempt at a job started",
    "job.requeued": "A job waits for another attempt",
    "job.succeeded": "A job succeeded, with warnings or without",
    "job.failed": "A job was given up",
    "job.canceled": "A job was canceled",
    "batch.ended": "All jobs of a batch have ended",
    "webhook.test": "A test was asked for",
}
_ANSWERS: dict[int | str, dict[str, Any]] = {
    204: {"description": "Taken; any status from 200 to 299 is as good. After others the message is sent again."},
    410: {"description": "Never again: the subscription is switched off."},
}


def message_routes() -> APIRouter:
    """Return a route for each type of message."""
    router = APIRouter(tags=["webhooks"])
    for kind in MESSAGE_TYPES:
        name = "receive_" + kind.replace(".", "_")
        router.post(
            kind, name=name, operation_id=name, status_code=204, responses=_ANSWERS, description=f"{_MEANINGS[kind]}."
        )(_receive)
    return router


def _receive(
    message: Message,
    message_id: Annotated[
        str,
        Header(
            alias="webhook-id",
            description="Id of the message, the same in every try: what came before was taken before.",
            examples=[EXAMPLE_MESSAGE_ID],
        ),
    ],
    timestamp: Annotated[
        int,
        Header(
            alias="webhook-timestamp",
            description="Seconds since 1970 of this try; refuse one that is far from your clock.",
            examples=[1_795_339_511],
        ),
    ],
    signature: Annotated[
        str,
        Header(
            alias="webhook-signature",
            description="HMAC-SHA256 under the secret of the subscription, as Standard Webhooks has it.",
            examples=["v1,K5oZfzN95Z9UVu1EsfQmfVNQhnkZ2pj9o9NDN/H/pI4="],
        ),
    ],
) -> None:
    """Take a message; the subscriber does."""

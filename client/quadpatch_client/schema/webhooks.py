"""Subscriptions, messages to subscribers and the log of their deliveries, as clients see them.

Tested in `tests/jobkit/webhooks/test_subscriptions.py`.
"""

from enum import StrEnum
from typing import Annotated, Any, Literal, get_args

from pydantic import Field, WithJsonSchema

from quadpatch_client.schema.base import TEXT_PATTERN, BatchId, JobId, Moment, Request, Response
from quadpatch_client.schema.webhook_url import WebhookUrl
from quadpatch_rules.ids import MESSAGE_ID_PATTERN, WEBHOOK_ID_PATTERN

EXAMPLE_WEBHOOK_ID = "wh_01jd7z3v5qk8m2x4c6b8n0a9de"
EXAMPLE_MESSAGE_ID = "msg_01jd7z3v5qk8m2x4c6b8n0a9de"
EXAMPLE_SECRET = "whsec_MfKQ9r8GKYqrTwjUPD8ILPZIo2LaLaSwMfKQ9r8GKYo="

# What a subscriber may want to hear of.
WebhookEvent = Literal["job.started", "job.requeued", "job.succeeded", "job.failed", "job.canceled", "batch.ended"]
MessageType = WebhookEvent | Literal["webhook.test"]
MESSAGE_TYPES: tuple[MessageType, ...] = (*get_args(WebhookEvent), "webhook.test")
ENDINGS: tuple[WebhookEvent, ...] = ("job.succeeded", "job.failed", "job.canceled")


class DeliveryState(StrEnum):
    """Where a delivery stands."""

    PENDING = "pending"
    DELIVERED = "delivered"
    DEAD = "dead"


WebhookId = Annotated[
    str, Field(pattern=WEBHOOK_ID_PATTERN, description="Id of a subscription.", examples=[EXAMPLE_WEBHOOK_ID])
]
MessageId = Annotated[
    str, Field(pattern=MESSAGE_ID_PATTERN, description="Id of a delivery.", examples=[EXAMPLE_MESSAGE_ID])
]
WebhookEvents = Annotated[
    list[WebhookEvent],
    Field(
        min_length=1,
        max_length=10,
        description="What to hear of; all ends of jobs unless given. With warnings or without, success is "
        "`job.succeeded`.",
        examples=[["job.succeeded", "job.failed"]],
    ),
]
WebhookDescription = Annotated[
    str | None,
    Field(max_length=255, pattern=TEXT_PATTERN, description="For people.", examples=["the MES of hall 3"]),
]
Secret = Annotated[
    str,
    Field(
        pattern=r"^whsec_[A-Za-z0-9+/]+={0,2}$",
        description="Signs every message, as Standard Webhooks has it. Shown this once.",
        examples=[EXAMPLE_SECRET],
    ),
]


class NewWebhook(Request):
    """A subscription to be."""

    url: WebhookUrl
    events: WebhookEvents = Field(default_factory=lambda: list(ENDINGS))
    description: WebhookDescription = None


class WebhookChange(Request):
    """What is to change in a subscription; what is left out or null stays as it is."""

    url: WebhookUrl | None = Field(default=None, description="Where to send messages.")
    events: WebhookEvents | None = Field(default=None, description="What to hear of.")
    description: WebhookDescription = None
    enabled: bool | None = Field(default=None, description="Whether anything is sent.", examples=[True])


class WebhookLinks(Response):
    """Paths on this service."""

    self: str = Field(description="This subscription.")
    deliveries: str = Field(description="What was sent, and what came back.")
    test: str = Field(description="POST here to have a test message sent.")
    rotate: str = Field(description="POST here for a new secret.")


class Webhook(Response):
    """A subscription."""

    id: WebhookId
    url: WebhookUrl
    events: WebhookEvents
    description: WebhookDescription = None
    enabled: bool = Field(
        description="Whether anything is sent. Switched off by itself when the receiver answers 410, or a message is "
        "given up after days without success.",
        examples=[True],
    )
    failing_since: Moment | None = Field(
        default=None, description="First failed try since the last success, RFC 3339; null where there is none."
    )
    created_at: Moment = Field(description="When it was made, RFC 3339.")
    updated_at: Moment = Field(description="When it was last changed, RFC 3339.")
    links: WebhookLinks = Field(description="Paths on this service.")


class WebhookWithSecret(Webhook):
    """A subscription, and the secret that signs its messages."""

    secret: Secret


class CallbackSecret(Response):
    """What signs messages to the callback URLs of a tenant's jobs and batches."""

    secret: Secret


class WebhookList(Response):
    """All subscriptions."""

    items: list[Webhook] = Field(description="Oldest first.")


class DeliveryLinks(Response):
    """Paths on this service."""

    self: str = Field(description="This delivery.")
    webhook: str = Field(description="The subscription.")
    replay: str = Field(description="POST here to have the message sent again.")
    job: str | None = Field(default=None, description="The job that the message tells of.")
    batch: str | None = Field(default=None, description="The batch that the message tells of.")


class Delivery(Response):
    """A message on its way to a subscriber."""

    id: MessageId
    message_id: MessageId = Field(description="What the header `webhook-id` says: a replay has that of the original.")
    webhook_id: WebhookId
    job_id: JobId | None = Field(default=None, description="The job that the message tells of.")
    batch_id: BatchId | None = Field(default=None, description="The batch that the message tells of.")
    type: MessageType = Field(description="What the message tells.", examples=["job.succeeded"])
    state: DeliveryState = Field(description="Where it stands.", examples=["delivered"])
    tries: int = Field(ge=0, description="Tries begun so far.", examples=[1])
    next_try_at: Moment | None = Field(default=None, description="When it is tried again, RFC 3339.")
    replay_of: MessageId | None = Field(default=None, description="The delivery that this one repeats.")
    created_at: Moment = Field(description="When it happened, RFC 3339.")
    finished_at: Moment | None = Field(default=None, description="When it was delivered or given up, RFC 3339.")
    links: DeliveryLinks = Field(description="Paths on this service.")


class DeliveryTry(Response):
    """One try at a delivery. A try that no dispatcher lived to note is missing."""

    number: int = Field(ge=1, description="Counts up from 1.", examples=[1])
    at: Moment = Field(description="When it began, RFC 3339.")
    status: int | None = Field(default=None, description="Status of the answer; null without one.", examples=[204])
    error: str | None = Field(default=None, description="What went wrong.", examples=["ConnectTimeout"])
    milliseconds: int = Field(ge=0, description="How long it took, in milliseconds.", examples=[38])


# Kept as it was written: what is sent, and signed, is never read into models.
MessageFacts = Annotated[
    dict[str, Any],
    WithJsonSchema(
        {
            "type": "object",
            "description": "`job` of a message about a job, `batch` of one about a batch, `webhook_id` of a test.",
            "properties": {
                "job": {
                    "$ref": "#/components/schemas/Job",
                    "description": "The job right after the change, as `GET /v1/jobs/{job_id}` shows it, but for "
                    "`queue_position`, `eta_s` and `expires_at`.",
                },
                "batch": {
                    "$ref": "#/components/schemas/Batch",
                    "description": "The batch at its end, as `GET /v1/batches/{batch_id}` shows it, but for "
                    "`expires_at`.",
                },
                "webhook_id": {"type": "string", "description": "The subscription.", "examples": [EXAMPLE_WEBHOOK_ID]},
            },
        }
    ),
]


class Message(Response):
    """The body that a subscriber gets."""

    type: MessageType = Field(description="What happened.", examples=["job.succeeded"])
    timestamp: Moment = Field(description="When it happened, RFC 3339.")
    data: MessageFacts


class DeliveryDetail(Delivery):
    """A delivery with its message and its tries."""

    message: Message = Field(description="The body, as it is signed and sent.")
    log: list[DeliveryTry] = Field(description="Oldest first.")


class CallbackDelivery(Response):
    """A message on its way to the callback URL of a job, with its tries."""

    id: MessageId
    type: MessageType = Field(description="What the message tells.", examples=["job.succeeded"])
    url: str = Field(description="Where it goes.", examples=["https://mes.example.com/done"])
    state: DeliveryState = Field(description="Where it stands.", examples=["delivered"])
    tries: int = Field(ge=0, description="Tries begun so far.", examples=[1])
    next_try_at: Moment | None = Field(default=None, description="When it is tried again, RFC 3339.")
    created_at: Moment = Field(description="When it happened, RFC 3339.")
    finished_at: Moment | None = Field(default=None, description="When it was delivered or given up, RFC 3339.")
    log: list[DeliveryTry] = Field(description="Each try and its answer, oldest first.")


class CallbackDeliveryList(Response):
    """Messages to the callback URL of a job."""

    items: list[CallbackDelivery] = Field(description="Oldest first; none where the job has no callback URL.")


class DeliveryPage(Response):
    """One page of deliveries, newest first."""

    items: list[Delivery] = Field(description="Newest first.")
    next_cursor: str | None = Field(
        default=None, description="Pass as `cursor` to go on; null on the last page.", examples=[EXAMPLE_MESSAGE_ID]
    )

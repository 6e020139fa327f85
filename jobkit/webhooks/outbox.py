"""Messages to subscribers and callback URLs, written in the transaction of the change that they report.

So a message exists if and only if its change does; the dispatcher sends it later, and retries where needed.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime
from types import MappingProxyType

from sqlalchemy import ScalarSelect, select
from sqlalchemy.orm import Session

from jobkit.database.batch_rows import to_batch
from jobkit.database.batch_tables import BatchRow
from jobkit.database.clock import shared_now
from jobkit.database.job_rows import existing_job, to_job
from jobkit.database.readable_rows import readable
from jobkit.database.tables import DeliveryRow, JobRow, WebhookRow
from jobkit.egress import destination_of
from quadpatch_client.schema import ENDINGS, DeliveryState, EventType, Message, WebhookEvent
from quadpatch_rules.ids import new_message_id

EVENTS: Mapping[EventType, WebhookEvent] = MappingProxyType(
    {
        "started": "job.started",
        "requeued": "job.requeued",
        "succeeded": "job.succeeded",
        "failed": "job.failed",
        "canceled": "job.canceled",
    }
)
# Fields that depend on settings, other jobs or the time; they would be wrong when the message is read.
OMITTED_FIELDS = ("expires_at", "queue_position", "eta_s")


@dataclass(frozen=True)
class Receiver:
    """A subscription, or the callback URL of a tenant."""

    webhook_id: str | None = None
    callback_url: str | None = None
    tenant: str | None = None

    @property
    def name(self) -> str:
        """What counts as one receiver: the subscription, or a host for one tenant."""
        if self.callback_url is None:
            return self.webhook_id or ""
        destination = destination_of(self.callback_url)
        return f"{self.tenant} {destination.scheme}://{destination.authority}"


def write_messages(session: Session, job_id: str, change: EventType, at: datetime) -> None:
    """Write a message of a change of a job for each receiver; two queries where there is none."""
    event = EVENTS.get(change)
    if event is None:
        return
    receivers = _subscribers(session, event, select(JobRow.tenant).where(JobRow.id == job_id).scalar_subquery())
    if event in ENDINGS:
        query = select(JobRow.spec["callback_url"].as_string(), JobRow.tenant).where(JobRow.id == job_id)
        receivers += [Receiver(None, url, tenant) for url, tenant in session.execute(query) if url]
    if not receivers:
        return
    for job in readable([existing_job(session, job_id)], to_job):
        data = {"job": job.model_dump(mode="json", exclude=set(OMITTED_FIELDS))}
        for receiver in receivers:
            message = Message(type=event, timestamp=at, data=data)
            session.add(new_delivery(session, receiver, message, job_id=job_id))


def write_end_of_batch(session: Session, row: BatchRow, at: datetime) -> None:
    """Write a message of the end of a batch for each receiver."""
    owner = select(BatchRow.tenant).where(BatchRow.id == row.id).scalar_subquery()
    receivers = _subscribers(session, "batch.ended", owner)
    if row.callback_url is not None:
        receivers.append(Receiver(None, row.callback_url, row.tenant))
    data = {"batch": to_batch(row).model_dump(mode="json", exclude=set(OMITTED_FIELDS))}
    for receiver in receivers:
        message = Message(type="batch.ended", timestamp=at, data=data)
        session.add(new_delivery(session, receiver, message, batch_id=row.id))


def new_delivery(
    session: Session, receiver: Receiver, message: Message, *, job_id: str | None = None, batch_id: str | None = None
) -> DeliveryRow:
    """Return a delivery that is due at once."""
    now = shared_now(session)
    return DeliveryRow(
        id=new_message_id(),
        webhook_id=receiver.webhook_id,
        callback_url=receiver.callback_url,
        tenant=receiver.tenant,
        receiver=receiver.name,
        job_id=job_id,
        batch_id=batch_id,
        type=message.type,
        payload=message.model_dump(mode="json"),
        state=DeliveryState.PENDING.value,
        tries=0,
        next_try_at=now,
        created_at=now,
    )


def _subscribers(session: Session, event: WebhookEvent, owner: ScalarSelect[str]) -> list[Receiver]:
    # The lock keeps a subscription from being deleted until the message to it is committed: a foreign key that fails
    # then would undo the change of the job. It holds up no other message.
    query = select(WebhookRow.id, WebhookRow.events).where(WebhookRow.enabled, WebhookRow.tenant == owner)
    query = query.with_for_update(read=True, key_share=True, of=WebhookRow)
    return [Receiver(webhook_id) for webhook_id, events in session.execute(query) if event in events]

"""Messages to subscribers, written in the transaction of the change that they report.

So a message exists if and only if its change does; the dispatcher sends it later, and retries where needed.
"""

from collections.abc import Mapping
from datetime import datetime
from types import MappingProxyType

from sqlalchemy import select
from sqlalchemy.orm import Session

from jobkit.database.clock import shared_now
from jobkit.database.job_rows import existing_job, to_job
from jobkit.database.readable_rows import readable
from jobkit.database.tables import DeliveryRow, JobRow, WebhookRow
from jobkit.ids import new_message_id
from jobkit.schema import DeliveryState, EventType, Job, Message, WebhookEvent

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


def write_messages(session: Session, job_id: str, change: EventType, at: datetime) -> None:
    """Write a message for each subscription to a change of a job; one query where there is none."""
    event = EVENTS.get(change)
    if event is None:
        return
    # The lock keeps a subscription from being deleted until the message to it is committed: a foreign key that fails
    # then would undo the change of the job. It holds up no other message.
    owner = select(JobRow.tenant).where(JobRow.id == job_id).scalar_subquery()
    query = select(WebhookRow.id, WebhookRow.events).where(WebhookRow.enabled, WebhookRow.tenant == owner)
    query = query.with_for_update(read=True, key_share=True, of=WebhookRow)
    webhook_ids = [webhook_id for webhook_id, events in session.execute(query) if event in events]
    if not webhook_ids:
        return
    for job in readable([existing_job(session, job_id)], to_job):
        _add_messages(session, webhook_ids, event, job, at)


def _add_messages(session: Session, webhook_ids: list[str], event: WebhookEvent, job: Job, at: datetime) -> None:
    message = Message(type=event, timestamp=at, data={"job": job.model_dump(mode="json", exclude=set(OMITTED_FIELDS))})
    for webhook_id in webhook_ids:
        session.add(new_delivery(session, webhook_id, message, job.id))


def new_delivery(session: Session, webhook_id: str, message: Message, job_id: str | None = None) -> DeliveryRow:
    """Return a delivery that is due at once."""
    now = shared_now(session)
    return DeliveryRow(
        id=new_message_id(),
        webhook_id=webhook_id,
        job_id=job_id,
        type=message.type,
        payload=message.model_dump(mode="json"),
        state=DeliveryState.PENDING.value,
        tries=0,
        next_try_at=now,
        created_at=now,
    )

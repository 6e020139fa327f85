"""The log of deliveries: look up, send a test message, send again, forget what is old."""

from collections.abc import Callable
from datetime import datetime
from typing import Any

from sqlalchemy import CursorResult, delete, select
from sqlalchemy.orm import Session

from jobkit.database.clock import utc_now
from jobkit.database.idempotency import Idempotency, make_once
from jobkit.database.job_rows import existing_job
from jobkit.database.readable_rows import readable
from jobkit.database.session import Database
from jobkit.database.tables import DeliveryRow, DeliveryTryRow, WebhookRow
from jobkit.errors import DeliveryNotFoundError, DeliveryPendingError, WebhookDisabledError
from jobkit.webhooks.outbox import Receiver, new_delivery
from jobkit.webhooks.subscriptions import existing_webhook
from quadpatch_client.schema import (
    CallbackDelivery,
    CallbackDeliveryList,
    Delivery,
    DeliveryDetail,
    DeliveryLinks,
    DeliveryPage,
    DeliveryState,
    DeliveryTry,
    Message,
)


class Deliveries:
    """The deliveries to all subscribers."""

    def __init__(self, database: Database) -> None:
        self._database = database

    def page(
        self, webhook_id: str, limit: int, cursor: str | None = None, state: DeliveryState | None = None
    ) -> DeliveryPage:
        """Return deliveries to a subscriber, newest first.

        Parameters
        ----------
        webhook_id : str
        limit : int
            Most deliveries on the page.
        cursor : str, optional
            `next_cursor` of the page before.
        state : DeliveryState, optional
            Only deliveries that are in it now.

        Raises
        ------
        WebhookNotFoundError
            If there is no such subscription.
        """
        query = select(DeliveryRow).where(DeliveryRow.webhook_id == webhook_id)
        query = query.order_by(DeliveryRow.id.desc()).limit(limit + 1)
        if cursor is not None:
            query = query.where(DeliveryRow.id < cursor)
        if state is not None:
            query = query.where(DeliveryRow.state == state.value)
        with self._database.read() as session:
            existing_webhook(session, webhook_id)
            rows = list(session.scalars(query))
        next_cursor = rows[limit - 1].id if len(rows) > limit else None
        items = list(readable(rows[:limit], lambda row: Delivery.model_validate(_wire(row))))
        return DeliveryPage(items=items, next_cursor=next_cursor)

    def of_job(self, job_id: str) -> CallbackDeliveryList:
        """Return the messages to the callback URL of a job, with their tries, oldest first; raise JobNotFoundError."""
        is_it = (DeliveryRow.job_id == job_id) & DeliveryRow.callback_url.is_not(None)
        with self._database.read() as session:
            existing_job(session, job_id)
            rows = list(session.scalars(select(DeliveryRow).where(is_it).order_by(DeliveryRow.id)))
            return CallbackDeliveryList(items=list(readable(rows, lambda row: _callback(session, row))))

    def get(self, webhook_id: str, delivery_id: str) -> DeliveryDetail:
        """Return a delivery with its tries; raise WebhookNotFoundError or DeliveryNotFoundError."""
        with self._database.read() as session:
            return _detail(session, _existing(session, webhook_id, delivery_id))

    def send_test(self, webhook_id: str) -> DeliveryDetail:
        """Have a test message sent; raise WebhookNotFoundError or WebhookDisabledError."""
        return self.send_test_once(webhook_id, None)[0]

    def send_test_once(self, webhook_id: str, idempotency: Idempotency | None) -> tuple[DeliveryDetail, bool]:
        """Have a test message sent, unless the same request has; return its delivery, and whether it is new.

        Raises
        ------
        WebhookNotFoundError, DeliveryNotFoundError
            If there is no such subscription, or what the first request made is gone.
        WebhookDisabledError
            If the subscription is switched off.
        IdempotencyError
            If the key came before with another request.
        """

        def make(session: Session) -> tuple[DeliveryDetail, str]:
            _enabled(session, webhook_id)
            message = Message(type="webhook.test", timestamp=utc_now(), data={"webhook_id": webhook_id})
            return _add(session, new_delivery(session, Receiver(webhook_id), message))

        return self._make_once(webhook_id, idempotency, make)

    def replay(self, webhook_id: str, delivery_id: str) -> DeliveryDetail:
        """Have the message of a delivery sent again, under the same message id. Raises as `replay_once`."""
        return self.replay_once(webhook_id, delivery_id, None)[0]

    def replay_once(
        self, webhook_id: str, delivery_id: str, idempotency: Idempotency | None
    ) -> tuple[DeliveryDetail, bool]:
        """Have a message sent again, unless the same request has; return the new delivery, and whether it is new.

        Raises
        ------
        IdempotencyError
            If the key came before with another request.
        WebhookNotFoundError, DeliveryNotFoundError
            If there is no such thing.
        WebhookDisabledError
            If the subscription is switched off.
        DeliveryPendingError
            If the delivery has not ended yet.
        """

        def make(session: Session) -> tuple[DeliveryDetail, str]:
            row = _existing(session, webhook_id, delivery_id)
            _enabled(session, webhook_id)
            if row.state == DeliveryState.PENDING.value:
                raise DeliveryPendingError(f"delivery {delivery_id} is still under way")
            message, about = Message.model_validate(row.payload), {"job_id": row.job_id, "batch_id": row.batch_id}
            delivery = new_delivery(session, Receiver(webhook_id), message, **about)
            delivery.payload, delivery.replay_of = row.payload, message_id(row)
            return _add(session, delivery)

        return self._make_once(webhook_id, idempotency, make)

    def forget_before(self, moment: datetime, most: int = 1000) -> int:
        """Remove deliveries that ended before a moment, with their tries; return how many of at most `most`."""
        with self._database.write() as session:
            ended = DeliveryRow.finished_at < moment
            ids = list(session.scalars(select(DeliveryRow.id).where(ended).limit(most)))
            result = session.execute(delete(DeliveryRow).where(DeliveryRow.id.in_(ids)))
            return result.rowcount if isinstance(result, CursorResult) else 0

    def _make_once(
        self,
        webhook_id: str,
        idempotency: Idempotency | None,
        make: Callable[[Session], tuple[DeliveryDetail, str]],
    ) -> tuple[DeliveryDetail, bool]:
        def show(session: Session, delivery_id: str) -> DeliveryDetail:
            return _detail(session, _existing(session, webhook_id, delivery_id))

        return make_once(self._database, idempotency, make, show)


def message_id(row: DeliveryRow) -> str:
    """Return what receivers tell messages apart by: a replay is the message that it repeats."""
    return row.replay_of or row.id


def _enabled(session: Session, webhook_id: str) -> WebhookRow:
    row = existing_webhook(session, webhook_id)
    if not row.enabled:
        raise WebhookDisabledError(f"webhook {webhook_id} is switched off; switch it on first")
    return row


def _existing(session: Session, webhook_id: str, delivery_id: str) -> DeliveryRow:
    existing_webhook(session, webhook_id)
    row = session.get(DeliveryRow, delivery_id)
    if row is None or row.webhook_id != webhook_id:
        raise DeliveryNotFoundError(f"webhook {webhook_id} has no delivery {delivery_id}")
    return row


def _add(session: Session, row: DeliveryRow) -> tuple[DeliveryDetail, str]:
    session.add(row)
    session.flush()
    return _detail(session, row), row.id


def _detail(session: Session, row: DeliveryRow) -> DeliveryDetail:
    return DeliveryDetail.model_validate({**_wire(row), "message": row.payload, "log": _log_of(session, row)})


def _callback(session: Session, row: DeliveryRow) -> CallbackDelivery:
    names = CallbackDelivery.model_fields.keys() - {"url", "log"}
    values = {name: getattr(row, name) for name in names}
    return CallbackDelivery.model_validate({**values, "url": row.callback_url, "log": _log_of(session, row)})


def _log_of(session: Session, row: DeliveryRow) -> list[DeliveryTry]:
    query = select(DeliveryTryRow).where(DeliveryTryRow.delivery_id == row.id).order_by(DeliveryTryRow.number)
    return [DeliveryTry.model_validate(entry, from_attributes=True) for entry in session.scalars(query)]


def _wire(row: DeliveryRow) -> dict[str, Any]:
    webhook = f"/v1/webhooks/{row.webhook_id}"
    path = f"{webhook}/deliveries/{row.id}"
    job = None if row.job_id is None else f"/v1/jobs/{row.job_id}"
    names = Delivery.model_fields.keys() - {"links", "message_id"}
    batch = None if row.batch_id is None else f"/v1/batches/{row.batch_id}"
    links = DeliveryLinks(self=path, webhook=webhook, replay=f"{path}/replay", job=job, batch=batch)
    return {name: getattr(row, name) for name in names} | {"links": links, "message_id": message_id(row)}

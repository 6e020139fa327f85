"""Subscriptions: make, look up, change, delete, give a new secret."""

import base64
import secrets
from collections.abc import Callable
from datetime import timedelta
from typing import Any, Self

from sqlalchemy import delete, func, select, update
from sqlalchemy.orm import Session

from jobkit.database.clock import utc_now
from jobkit.database.idempotency import Idempotency, forget_made, is_repeated, make_once
from jobkit.database.readable_rows import readable
from jobkit.database.session import Database
from jobkit.database.tables import DeliveryRow, WebhookRow
from jobkit.errors import TooManyWebhooksError, WebhookNotFoundError
from quadpatch_client.schema import (
    DeliveryState,
    NewWebhook,
    Webhook,
    WebhookChange,
    WebhookLinks,
    WebhookList,
    WebhookWithSecret,
)
from quadpatch_rules.ids import new_webhook_id

MAX_WEBHOOKS = 100
# Receivers that know one of the two secrets verify every message while they change over.
OLD_SECRET_S = 86_400.0
_SECRET_BYTES = 32


class Webhooks:
    """All subscriptions of a database.

    Parameters
    ----------
    database : Database
    check_url : callable
        Raises where nothing may be sent to a URL.
    """

    def __init__(self, database: Database, check_url: Callable[[str], None]) -> None:
        self._database = database
        self._check_url = check_url

    def create(self, new: NewWebhook) -> WebhookWithSecret:
        """Make a subscription; its secret is shown this once. Raises as `create_once`."""
        return self.create_once(new, None)[0]

    def of(self, database: Database) -> Self:
        """Return the subscriptions of another view of the database."""
        return type(self)(database, self._check_url)

    def create_once(self, new: NewWebhook, idempotency: Idempotency | None) -> tuple[WebhookWithSecret, bool]:
        """Make a subscription, or show the one that the same request made, with its secret.

        Returns
        -------
        WebhookWithSecret, bool
            The subscription, and whether it is new.

        Raises
        ------
        IdempotencyError
            If the key came before with another request.
        AddressRefusedError, TlsRequiredError, HostUnknownError
            If nothing may or can be sent to its URL.
        TooManyWebhooksError
            If there are too many already.
        """
        if not is_repeated(self._database, idempotency):
            self._check_url(new.url)
        return make_once(self._database, idempotency, lambda session: _create(session, new), _show_with_secret)

    def list_all(self) -> WebhookList:
        """Return all subscriptions, oldest first."""
        with self._database.read() as session:
            rows = session.scalars(select(WebhookRow).order_by(WebhookRow.id))
            return WebhookList(items=list(readable(rows, to_webhook)))

    def get(self, webhook_id: str) -> Webhook:
        """Return a subscription; raise WebhookNotFoundError."""
        with self._database.read() as session:
            return to_webhook(existing_webhook(session, webhook_id))

    def change(self, webhook_id: str, change: WebhookChange) -> Webhook:
        """Change what the change names. Switched on again, a subscription starts without a history of failure.

        Raises
        ------
        WebhookNotFoundError
            If there is none.
        AddressRefusedError, TlsRequiredError, HostUnknownError
            If nothing may or can be sent to the new URL.
        """
        values: dict[str, Any] = change.model_dump(exclude_none=True)
        if change.events is not None:
            values["events"] = _in_order(change.events)
        if change.enabled:
            values["failing_since"] = None
        if change.url is not None:
            self.get(webhook_id)  # a missing subscription is reported before a wrong URL
            self._check_url(change.url)
        with self._database.write() as session:
            _write(session, webhook_id, values)
            if change.enabled is False:
                give_up_pending(session, webhook_id)
            return to_webhook(existing_webhook(session, webhook_id))

    def rotate(self, webhook_id: str) -> WebhookWithSecret:
        """Give a new secret; messages are signed with the old one as well for a day. Raise WebhookNotFoundError."""
        return self.rotate_once(webhook_id, None)[0]

    def rotate_once(self, webhook_id: str, idempotency: Idempotency | None) -> tuple[WebhookWithSecret, bool]:
        """Give a new secret, or show the present one where the same request has given one.

        Returns
        -------
        WebhookWithSecret, bool
            The subscription, and whether its secret is new.

        Raises
        ------
        WebhookNotFoundError
            If there is none.
        IdempotencyError
            If the key came before with another request.
        """
        return make_once(self._database, idempotency, lambda session: _rotate(session, webhook_id), _show_with_secret)

    def delete(self, webhook_id: str) -> None:
        """Delete a subscription with its deliveries and its idempotency keys; raise WebhookNotFoundError."""
        with self._database.write() as session:
            existing_webhook(session, webhook_id)
            forget_made(session, webhook_id)
            session.execute(delete(WebhookRow).where(WebhookRow.id == webhook_id))


def _create(session: Session, new: NewWebhook) -> tuple[WebhookWithSecret, str]:
    now = utc_now()
    row = WebhookRow(
        id=new_webhook_id(),
        url=new.url,
        secret=new_secret(),
        events=_in_order(new.events),
        description=new.description,
        enabled=True,
        created_at=now,
        updated_at=now,
    )
    if session.scalars(select(func.count()).select_from(WebhookRow)).one() >= MAX_WEBHOOKS:
        raise TooManyWebhooksError(f"there are {MAX_WEBHOOKS} subscriptions, which is the limit")
    session.add(row)
    session.flush()
    return _with_secret(row), row.id


def _rotate(session: Session, webhook_id: str) -> tuple[WebhookWithSecret, str]:
    until = utc_now() + timedelta(seconds=OLD_SECRET_S)
    old = existing_webhook(session, webhook_id).secret
    _write(session, webhook_id, {"secret": new_secret(), "old_secret": old, "old_secret_until": until})
    return _show_with_secret(session, webhook_id), webhook_id


def _show_with_secret(session: Session, webhook_id: str) -> WebhookWithSecret:
    return _with_secret(existing_webhook(session, webhook_id))


def existing_webhook(session: Session, webhook_id: str) -> WebhookRow:
    """Return the row of a subscription as it stands now; raise WebhookNotFoundError."""
    query = select(WebhookRow).where(WebhookRow.id == webhook_id).execution_options(populate_existing=True)
    row = session.scalars(query).one_or_none()
    if row is None:
        raise WebhookNotFoundError(f"there is no webhook {webhook_id}")
    return row


def give_up_pending(session: Session, webhook_id: str) -> None:
    """Give up all pending deliveries to a subscriber; it can be replayed."""
    session.execute(
        update(DeliveryRow)
        .where(DeliveryRow.webhook_id == webhook_id, DeliveryRow.state == DeliveryState.PENDING.value)
        .values(state=DeliveryState.DEAD.value, next_try_at=None, finished_at=utc_now())
    )


def new_secret() -> str:
    """Return a fresh secret as Standard Webhooks writes it."""
    return "whsec_" + base64.b64encode(secrets.token_bytes(_SECRET_BYTES)).decode()


def to_webhook(row: WebhookRow) -> Webhook:
    """Return the row as clients see it, without its secret."""
    return Webhook.model_validate(_wire(row))


def _with_secret(row: WebhookRow) -> WebhookWithSecret:
    return WebhookWithSecret.model_validate({**_wire(row), "secret": row.secret})


def _wire(row: WebhookRow) -> dict[str, Any]:
    path = f"/v1/webhooks/{row.id}"
    links = WebhookLinks(self=path, deliveries=f"{path}/deliveries", test=f"{path}/test", rotate=f"{path}/rotate")
    return {name: getattr(row, name) for name in Webhook.model_fields.keys() - {"links"}} | {"links": links}


def _write(session: Session, webhook_id: str, values: dict[str, Any]) -> None:
    changed = {**values, "updated_at": utc_now()}
    session.execute(update(WebhookRow).where(WebhookRow.id == webhook_id).values(**changed))


def _in_order(events: list[Any]) -> list[Any]:
    return list(dict.fromkeys(events))

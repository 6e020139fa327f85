"""Claims on deliveries that are due, and their results.

A claim raises the number of tries and pushes the next one ahead, both in one conditional update: of two dispatchers
that see the same delivery one sends it. Where the dispatcher that claimed it ends, the delivery is due again when the
claim runs out; the receiver may then get the message twice, under the same id.
"""

import json
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Any

from sqlalchemy import ColumnElement, CursorResult, Select, or_, select, update
from sqlalchemy.orm import Session

from dispatcher.backoff import next_delay_s
from dispatcher.sending import Answer, Outgoing
from jobkit.database.clock import shared_now
from jobkit.database.session import Database
from jobkit.database.tables import CallbackSecretRow, DeliveryRow, DeliveryTryRow, WebhookRow
from jobkit.webhooks.deliveries import message_id
from jobkit.webhooks.subscriptions import give_up_pending
from quadpatch_client.schema import DeliveryState

MAX_PER_RECEIVER = 4
# A subscription that has failed for this long when a message is given up is disabled.
DISABLE_AFTER = timedelta(days=3)
_BATCH = 100


@dataclass(frozen=True)
class Claim:
    """The right to send a delivery once; `receiver` is the id of the subscription, where there is one."""

    delivery_id: str
    receiver: str
    number: int
    at: datetime
    outgoing: Outgoing


def is_anything_due(database: Database) -> bool:
    """Tell whether there is a delivery to send now."""
    with database.read() as session:
        return session.execute(_due(shared_now(session), []).limit(1)).first() is not None


def claim_due(database: Database, most: int, at_work: Mapping[str, int], claim_s: float) -> list[Claim]:
    """Claim deliveries that are due, the longest overdue first.

    Parameters
    ----------
    database : Database
    most : int
        Most claims.
    at_work : mapping of str to int
        How many deliveries to each receiver are being sent now; none gets more than MAX_PER_RECEIVER at a time, so a
        slow one holds up no other.
    claim_s : float
        Seconds after which a delivery without an answer is due again.
    """
    if most <= 0 or not is_anything_due(database):
        return []
    n_sending, claims = Counter(at_work), list[Claim]()
    with database.write() as session:
        now = shared_now(session)
        while len(claims) < most:
            busy = [receiver for receiver, count in n_sending.items() if count >= MAX_PER_RECEIVER]
            rows = session.execute(_due(now, busy).limit(_BATCH)).all()
            for delivery, webhook, secret in rows:
                signer = webhook or secret
                if signer is not None and len(claims) < most and n_sending[delivery.receiver] < MAX_PER_RECEIVER:
                    claims += _claim(session, delivery, signer, now, claim_s)
                    n_sending[delivery.receiver] += 1
            if len(rows) < _BATCH:
                break
    return claims


def note_answer(database: Database, claim: Claim, answer: Answer, chance: float) -> None:
    """Record a try, and update the delivery and the subscription.

    Parameters
    ----------
    database : Database
    claim : Claim
    answer : Answer
    chance : float
        A random number in [0, 1), for the length of the pause.
    """
    with database.write() as session:
        now = shared_now(session)
        # The subscription before the delivery, as all code that writes both: else two writers wait for each other.
        query = select(WebhookRow).where(WebhookRow.id == claim.receiver).with_for_update()
        webhook = session.scalars(query).one_or_none()
        if session.get(DeliveryRow, claim.delivery_id) is None:
            return
        session.add(
            DeliveryTryRow(
                delivery_id=claim.delivery_id,
                number=claim.number,
                at=claim.at,
                status=answer.status,
                error=answer.error,
                milliseconds=answer.milliseconds,
            )
        )
        if webhook is not None:
            webhook.failing_since = None if answer.is_delivered else webhook.failing_since or now
        if answer.is_delivered:
            _end(session, claim, DeliveryState.DELIVERED, now)
            return
        delay_s = None if answer.is_gone else next_delay_s(claim.number, chance, answer.retry_after_s)
        if delay_s is not None:
            _write(session, claim, {"next_try_at": now + timedelta(seconds=delay_s)}, *_still_mine(claim))
            return
        is_given_up = _end(session, claim, DeliveryState.DEAD, now, *_still_mine(claim))
        if webhook is None or not is_given_up:
            return
        if answer.is_gone or (webhook.failing_since or now) <= now - DISABLE_AFTER:
            webhook.enabled, webhook.updated_at = False, now
            give_up_pending(session, webhook.id)


def _due(now: datetime, busy: list[str]) -> Select[DeliveryRow, WebhookRow | None, CallbackSecretRow | None]:
    query = (
        select(DeliveryRow, WebhookRow, CallbackSecretRow)
        .outerjoin(WebhookRow, WebhookRow.id == DeliveryRow.webhook_id)
        .outerjoin(CallbackSecretRow, CallbackSecretRow.tenant == DeliveryRow.tenant)
    )
    return query.where(
        or_(WebhookRow.enabled, DeliveryRow.callback_url.is_not(None)),
        DeliveryRow.state == DeliveryState.PENDING.value,
        DeliveryRow.next_try_at <= now,
        DeliveryRow.receiver.not_in(busy),
    ).order_by(DeliveryRow.next_try_at, DeliveryRow.id)


def _claim(
    session: Session, delivery: DeliveryRow, signer: WebhookRow | CallbackSecretRow, now: datetime, claim_s: float
) -> list[Claim]:
    """Return the claim, an empty list where another dispatcher has it."""
    number = delivery.tries + 1
    url = signer.url if isinstance(signer, WebhookRow) else delivery.callback_url or ""
    outgoing = Outgoing(url, message_id(delivery), _secrets(signer, now), _body(delivery.payload))
    claim = Claim(delivery.id, delivery.receiver, number, now, outgoing)
    values = {"tries": number, "next_try_at": now + timedelta(seconds=claim_s)}
    is_unclaimed = (_is_pending(), DeliveryRow.tries == number - 1, DeliveryRow.next_try_at <= now)
    return [claim] if _write(session, claim, values, *is_unclaimed) else []


def _secrets(signer: WebhookRow | CallbackSecretRow, now: datetime) -> tuple[str, ...]:
    if signer.old_secret is None or signer.old_secret_until is None or signer.old_secret_until < now:
        return (signer.secret,)
    return signer.secret, signer.old_secret


def _body(payload: dict[str, Any]) -> str:
    return json.dumps(payload, ensure_ascii=False, separators=(",", ":"))


def _still_mine(claim: Claim) -> tuple[ColumnElement[bool], ...]:
    return _is_pending(), DeliveryRow.tries == claim.number


def _is_pending() -> ColumnElement[bool]:
    return DeliveryRow.state == DeliveryState.PENDING.value


def _end(session: Session, claim: Claim, state: DeliveryState, now: datetime, *fences: ColumnElement[bool]) -> bool:
    return _write(session, claim, {"state": state.value, "next_try_at": None, "finished_at": now}, *fences)


def _write(session: Session, claim: Claim, values: dict[str, Any], *fences: ColumnElement[bool]) -> bool:
    statement = update(DeliveryRow).where(DeliveryRow.id == claim.delivery_id, *fences).values(**values)
    result = session.execute(statement.execution_options(synchronize_session=False))
    return isinstance(result, CursorResult) and result.rowcount == 1

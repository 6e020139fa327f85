from collections import Counter
from datetime import timedelta

from sqlalchemy import update

from dispatcher.backoff import DELAYS_S, JITTER
from dispatcher.outbox import DISABLE_AFTER, MAX_PER_RECEIVER, Claim, claim_due, is_anything_due, note_answer
from dispatcher.sending import Answer
from jobkit.database.clock import utc_now
from jobkit.database.session import Database
from jobkit.database.tables import DeliveryRow, WebhookRow
from jobkit.webhooks.deliveries import Deliveries
from jobkit.webhooks.subscriptions import Webhooks
from quadpatch_client.schema import DeliveryState
from tests.dispatcher.conftest import Subscribe

URL = "http://127.0.0.1:9/"
CLAIM_S = 60.0
TAKEN = Answer(204, None, None, 3)
FAILED = Answer(500, "answered 500", None, 3)
GONE = Answer(410, "answered 410", None, 3)


def claims_of(database: Database, most: int = 100, at_work: dict[str, int] | None = None) -> list[Claim]:
    return claim_due(database, most, at_work or {}, CLAIM_S)


def make_due(database: Database, *ids: str) -> None:
    with database.write() as session:
        session.execute(update(DeliveryRow).where(DeliveryRow.id.in_(ids)).values(next_try_at=utc_now()))


def set_failing(database: Database, webhook_id: str, ago: timedelta) -> None:
    with database.write() as session:
        session.get_one(WebhookRow, webhook_id).failing_since = utc_now() - ago


def exhaust(database: Database, delivery_id: str, answer: Answer = FAILED) -> None:
    """Fail at all tries that a delivery has."""
    for number in range(1, len(DELAYS_S) + 2):
        make_due(database, delivery_id)
        (claim,) = claims_of(database)
        assert claim.number == number
        note_answer(database, claim, answer, 0.5)


def test_of_two_dispatchers_one_gets_a_delivery(
    database: Database, deliveries: Deliveries, subscribe: Subscribe
) -> None:
    webhook = subscribe(URL)
    delivery = deliveries.send_test(webhook.id)
    assert is_anything_due(database)
    (claim,) = claims_of(database)
    assert (claim.delivery_id, claim.number) == (delivery.id, 1)
    assert claims_of(database) == []
    assert not is_anything_due(database)


def test_a_delivery_whose_dispatcher_died_is_due_again_under_the_same_id(
    database: Database, deliveries: Deliveries, subscribe: Subscribe
) -> None:
    delivery = deliveries.send_test(subscribe(URL).id)
    (lost,) = claims_of(database)
    pushed_to = deliveries.get(lost.receiver, delivery.id).next_try_at
    assert pushed_to is not None
    assert pushed_to - lost.at == timedelta(seconds=CLAIM_S)
    make_due(database, delivery.id)
    (again,) = claims_of(database)
    assert (again.delivery_id, again.number) == (delivery.id, 2)
    assert again.outgoing == lost.outgoing
    # The late answer of the first one is noted, and stops nothing.
    note_answer(database, lost, FAILED, 0.5)
    assert deliveries.get(lost.receiver, delivery.id).state is DeliveryState.PENDING
    note_answer(database, again, TAKEN, 0.5)
    found = deliveries.get(lost.receiver, delivery.id)
    assert (found.state, [entry.number for entry in found.log]) == (DeliveryState.DELIVERED, [1, 2])


def test_a_late_success_counts(database: Database, deliveries: Deliveries, subscribe: Subscribe) -> None:
    delivery = deliveries.send_test(subscribe(URL).id)
    (late,) = claims_of(database)
    make_due(database, delivery.id)
    (again,) = claims_of(database)
    note_answer(database, late, TAKEN, 0.5)
    note_answer(database, again, FAILED, 0.5)
    found = deliveries.get(late.receiver, delivery.id)
    assert (found.state, found.next_try_at) == (DeliveryState.DELIVERED, None)


def test_a_receiver_with_much_to_get_leaves_room_for_the_others(
    database: Database, deliveries: Deliveries, subscribe: Subscribe
) -> None:
    many_due, one_due = subscribe(URL).id, subscribe(URL).id
    for _ in range(250):
        deliveries.send_test(many_due)
    deliveries.send_test(one_due)
    claims = claims_of(database)
    assert Counter(claim.receiver for claim in claims) == {many_due: MAX_PER_RECEIVER, one_due: 1}
    assert claims_of(database, at_work={many_due: MAX_PER_RECEIVER}) == []
    assert len(claims_of(database, at_work={many_due: MAX_PER_RECEIVER - 1})) == 1
    assert len(claims_of(database, most=2)) == 2
    assert claims_of(database, most=0) == []


def test_a_failed_try_is_repeated_after_its_pause(
    database: Database, deliveries: Deliveries, subscribe: Subscribe
) -> None:
    delivery = deliveries.send_test(subscribe(URL).id)
    (claim,) = claims_of(database)
    before = utc_now()
    note_answer(database, claim, Answer(None, "no connection", None, 7), 0.5)
    found = deliveries.get(claim.receiver, delivery.id)
    assert found.next_try_at is not None
    pause = timedelta(seconds=DELAYS_S[0] * (1 + JITTER / 2))
    assert before + pause <= found.next_try_at <= utc_now() + pause
    (entry,) = found.log
    assert (entry.number, entry.status, entry.error, entry.milliseconds) == (1, None, "no connection", 7)


def test_a_receiver_is_left_alone_for_as_long_as_it_asks(
    database: Database, deliveries: Deliveries, subscribe: Subscribe
) -> None:
    delivery = deliveries.send_test(subscribe(URL).id)
    (claim,) = claims_of(database)
    before = utc_now()
    note_answer(database, claim, Answer(429, "answered 429", 900.0, 7), 0.0)
    next_try_at = deliveries.get(claim.receiver, delivery.id).next_try_at
    assert next_try_at is not None
    assert next_try_at >= before + timedelta(seconds=900)


def test_after_the_last_try_a_delivery_is_dead_and_the_subscription_lives(
    database: Database, deliveries: Deliveries, webhooks: Webhooks, subscribe: Subscribe
) -> None:
    webhook = subscribe(URL)
    delivery = deliveries.send_test(webhook.id)
    exhaust(database, delivery.id)
    found = deliveries.get(webhook.id, delivery.id)
    assert (found.state, found.tries, len(found.log)) == (DeliveryState.DEAD, 9, 9)
    assert found.next_try_at is None
    seen = webhooks.get(webhook.id)
    assert seen.enabled
    assert seen.failing_since is not None


def test_a_subscription_that_took_nothing_for_days_is_switched_off(
    database: Database, deliveries: Deliveries, webhooks: Webhooks, subscribe: Subscribe
) -> None:
    webhook = subscribe(URL)
    delivery = deliveries.send_test(webhook.id)
    set_failing(database, webhook.id, DISABLE_AFTER)
    exhaust(database, delivery.id)
    assert not webhooks.get(webhook.id).enabled


def test_a_success_wipes_the_history_of_failure(
    database: Database, deliveries: Deliveries, webhooks: Webhooks, subscribe: Subscribe
) -> None:
    webhook = subscribe(URL)
    deliveries.send_test(webhook.id)
    set_failing(database, webhook.id, 2 * DISABLE_AFTER)
    (claim,) = claims_of(database)
    note_answer(database, claim, TAKEN, 0.5)
    assert webhooks.get(webhook.id).failing_since is None
    delivery = deliveries.send_test(webhook.id)
    exhaust(database, delivery.id)
    assert webhooks.get(webhook.id).enabled


def test_a_receiver_that_is_gone_is_sent_nothing_more(
    database: Database, deliveries: Deliveries, webhooks: Webhooks, subscribe: Subscribe
) -> None:
    webhook = subscribe(URL)
    first, second = (deliveries.send_test(webhook.id) for _ in range(2))
    claim, _ = claims_of(database)
    note_answer(database, claim, GONE, 0.5)
    assert not webhooks.get(webhook.id).enabled
    states = {deliveries.get(webhook.id, delivery.id).state for delivery in (first, second)}
    assert states == {DeliveryState.DEAD}
    make_due(database, first.id, second.id)
    assert claims_of(database) == []


def test_an_answer_to_a_subscription_that_was_deleted_meanwhile_is_dropped(
    database: Database, deliveries: Deliveries, webhooks: Webhooks, subscribe: Subscribe
) -> None:
    webhook = subscribe(URL)
    deliveries.send_test(webhook.id)
    (claim,) = claims_of(database)
    webhooks.delete(webhook.id)
    note_answer(database, claim, TAKEN, 0.5)
    assert webhooks.list_all().items == []


def test_the_old_secret_signs_until_its_time_is_over(
    database: Database, deliveries: Deliveries, webhooks: Webhooks, subscribe: Subscribe
) -> None:
    webhook = subscribe(URL)
    new = webhooks.rotate(webhook.id)
    delivery = deliveries.send_test(webhook.id)
    (claim,) = claims_of(database)
    assert claim.outgoing.secrets == (new.secret, webhook.secret)
    with database.write() as session:
        session.get_one(WebhookRow, webhook.id).old_secret_until = utc_now() - timedelta(seconds=1)
    make_due(database, delivery.id)
    (claim,) = claims_of(database)
    assert claim.outgoing.secrets == (new.secret,)

from datetime import timedelta

import pytest

from jobkit.database.clock import utc_now
from jobkit.database.session import Database
from jobkit.database.tables import DeliveryRow, DeliveryTryRow
from jobkit.errors import DeliveryNotFoundError, DeliveryPendingError
from jobkit.webhooks.deliveries import Deliveries
from jobkit.webhooks.subscriptions import Webhooks
from quadpatch_client.schema import DeliveryState, NewWebhook


@pytest.fixture
def deliveries(database: Database) -> Deliveries:
    return Deliveries(database)


@pytest.fixture
def webhook_id(database: Database) -> str:
    return Webhooks(database, lambda _: None).create(NewWebhook(url="https://a.example/")).id


def finish(database: Database, delivery_id: str, days_ago: float = 0.0) -> None:
    with database.write() as session:
        row = session.get_one(DeliveryRow, delivery_id)
        row.state, row.finished_at = "delivered", utc_now() - timedelta(days=days_ago)
        session.add(DeliveryTryRow(delivery_id=delivery_id, number=1, at=utc_now(), status=204, milliseconds=3))


def test_pages_lead_through_all_deliveries_once_newest_first(deliveries: Deliveries, webhook_id: str) -> None:
    made = sorted((deliveries.send_test(webhook_id).id for _ in range(7)), reverse=True)
    seen: list[str] = []
    cursor = None
    while True:
        page = deliveries.page(webhook_id, 3, cursor)
        seen += [item.id for item in page.items]
        cursor = page.next_cursor
        if cursor is None:
            break
    assert seen == made


def test_a_page_can_be_of_one_state(database: Database, deliveries: Deliveries, webhook_id: str) -> None:
    first, second = (deliveries.send_test(webhook_id).id for _ in range(2))
    finish(database, first)
    for state, ids in (("delivered", [first]), ("pending", [second]), ("dead", [])):
        assert [item.id for item in deliveries.page(webhook_id, 9, state=DeliveryState(state)).items] == ids


def test_a_replay_is_the_same_message_on_a_way_of_its_own(
    database: Database, deliveries: Deliveries, webhook_id: str
) -> None:
    original = deliveries.send_test(webhook_id)
    with pytest.raises(DeliveryPendingError):
        deliveries.replay(webhook_id, original.id)
    finish(database, original.id)
    replay = deliveries.replay(webhook_id, original.id)
    assert (replay.replay_of, replay.message_id, replay.message) == (original.id, original.id, original.message)
    assert (replay.state, replay.tries, replay.log) == ("pending", 0, [])
    assert replay.id != original.id
    finish(database, replay.id)
    assert deliveries.replay(webhook_id, replay.id).message_id == original.id
    assert [entry.status for entry in deliveries.get(webhook_id, original.id).log] == [204]


def test_a_delivery_of_another_subscription_is_not_found(
    database: Database, deliveries: Deliveries, webhook_id: str
) -> None:
    other = Webhooks(database, lambda _: None).create(NewWebhook(url="https://b.example/")).id
    delivery = deliveries.send_test(webhook_id)
    with pytest.raises(DeliveryNotFoundError):
        deliveries.get(other, delivery.id)
    with pytest.raises(DeliveryNotFoundError):
        deliveries.replay(other, delivery.id)


def test_what_ended_long_ago_is_forgotten_and_what_is_under_way_is_not(
    database: Database, deliveries: Deliveries, webhook_id: str
) -> None:
    old, recent, pending = (deliveries.send_test(webhook_id).id for _ in range(3))
    finish(database, old, days_ago=31)
    finish(database, recent, days_ago=29)
    with database.write() as session:
        session.get_one(DeliveryRow, pending).created_at = utc_now() - timedelta(days=400)
    assert deliveries.forget_before(utc_now() - timedelta(days=30)) == 1
    assert {item.id for item in deliveries.page(webhook_id, 9).items} == {recent, pending}
    with database.read() as session:
        assert [entry.delivery_id for entry in session.query(DeliveryTryRow)] == [recent]
    assert deliveries.forget_before(utc_now() - timedelta(days=30)) == 0

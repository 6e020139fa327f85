import base64
import hashlib
import hmac
import re
import threading
from collections import Counter
from collections.abc import Callable
from contextlib import ExitStack
from datetime import timedelta
from pathlib import Path
from typing import Any

import pytest
from sqlalchemy import update
from standardwebhooks import Webhook, WebhookVerificationError

from dispatcher.outbox import MAX_PER_RECEIVER, claim_due
from dispatcher.webhooks import deliver_webhooks, forget_old_deliveries
from jobkit.database.clock import utc_now
from jobkit.database.session import Database
from jobkit.database.tables import DeliveryRow
from jobkit.jobs.jobs import Jobs
from jobkit.settings import Settings
from jobkit.webhooks.deliveries import Deliveries
from jobkit.webhooks.outbox import OMITTED_FIELDS
from jobkit.webhooks.subscriptions import Webhooks
from quadpatch_client.schema import DeliveryState
from tests.dispatcher.conftest import FailJob, Subscribe
from tests.dispatcher.receivers import receiving
from tests.waiting import GUARD_S


def never() -> bool:
    return False


def make_all_due(database: Database) -> None:
    with database.write() as session:
        pending = DeliveryRow.state == DeliveryState.PENDING.value
        session.execute(update(DeliveryRow).where(pending).values(next_try_at=utc_now()))


def test_a_subscriber_hears_of_the_end_of_a_job(
    database: Database, settings: Settings, subscribe: Subscribe, deliveries: Deliveries, fail_job: FailJob
) -> None:
    with receiving() as receiver:
        webhook = subscribe(receiver.url())
        job_id = fail_job()
        assert deliver_webhooks(database, settings, never) == "{'delivered': 1}"
        assert deliver_webhooks(database, settings, never) == ""
    (request,) = receiver.received
    message = Webhook(webhook.secret).verify(request.body, request.headers)
    assert message["type"] == "job.failed"
    assert message["data"] == {"job": Jobs(database).get(job_id).model_dump(mode="json", exclude=set(OMITTED_FIELDS))}
    assert message["data"]["job"]["error"]["message"] == "größer als 5 µm"
    (delivery,) = deliveries.page(webhook.id, 9).items
    assert (delivery.state, delivery.job_id) == (DeliveryState.DELIVERED, job_id)
    assert request.headers["webhook-id"] == delivery.id


def test_a_message_that_failed_comes_again_with_the_same_id_and_body(
    database: Database, settings: Settings, subscribe: Subscribe, deliveries: Deliveries, fail_job: FailJob
) -> None:
    with receiving(answers=[(500, {}), (302, {}), (200, {})]) as receiver:
        webhook = subscribe(receiver.url())
        fail_job()
        for _ in range(5):
            deliver_webhooks(database, settings, never)
            make_all_due(database)
    assert len(receiver.received) == 3
    assert len({(request.headers["webhook-id"], request.body) for request in receiver.received}) == 1
    (delivery,) = deliveries.page(webhook.id, 9).items
    assert [entry.status for entry in deliveries.get(webhook.id, delivery.id).log] == [500, 302, 200]


def test_a_dispatcher_that_dies_between_commit_and_send_loses_nothing(
    database: Database, settings: Settings, subscribe: Subscribe, fail_job: FailJob
) -> None:
    with receiving() as receiver:
        subscribe(receiver.url())
        jobs = {fail_job() for _ in range(6)}
        # The first one claims what it may and is killed; its claims run out.
        lost = claim_due(database, 100, {}, 60.0)
        assert len(lost) == MAX_PER_RECEIVER
        deliver_webhooks(database, settings, never)
        assert len(receiver.received) == 6 - MAX_PER_RECEIVER
        make_all_due(database)
        deliver_webhooks(database, settings, never)
    told = [request.body for request in receiver.received]
    assert len(told) == len(set(receiver.ids())) == 6
    assert all(any(job_id.encode() in body for body in told) for job_id in jobs)


def test_two_dispatchers_at_once_send_every_message_once(
    database: Database, settings: Settings, subscribe: Subscribe, deliveries: Deliveries
) -> None:
    with receiving() as receiver:
        webhook = subscribe(receiver.url())
        made = {deliveries.send_test(webhook.id).id for _ in range(30)}
        threads = [threading.Thread(target=deliver_webhooks, args=(database, settings, never)) for _ in range(2)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
    assert Counter(receiver.ids()) == dict.fromkeys(made, 1)


def test_a_receiver_that_does_not_answer_holds_up_no_other(
    database: Database, settings: Settings, subscribe: Subscribe, deliveries: Deliveries
) -> None:
    slow_settings = settings.model_copy(update={"webhook_timeout_s": 60.0})
    with receiving(held=True) as slow, receiving() as quick:
        stuck = subscribe(slow.url())
        for _ in range(3 * MAX_PER_RECEIVER):
            deliveries.send_test(stuck.id)
        delivery_thread = threading.Thread(target=deliver_webhooks, args=(database, slow_settings, never))
        delivery_thread.start()
        for _ in range(MAX_PER_RECEIVER):
            assert slow.arrived.acquire(timeout=GUARD_S)
        # While the slow one has all that it may have, messages to another one come and go.
        other = subscribe(quick.url())
        for _ in range(2 * MAX_PER_RECEIVER):
            deliveries.send_test(other.id)
        for _ in range(2 * MAX_PER_RECEIVER):
            assert quick.arrived.acquire(timeout=GUARD_S)
        assert len(slow.received) == MAX_PER_RECEIVER
        slow.hold.set()
        delivery_thread.join()
    assert len(set(slow.ids())) == 3 * MAX_PER_RECEIVER
    assert len(set(quick.ids())) == 2 * MAX_PER_RECEIVER


def test_many_receivers_that_do_not_answer_are_waited_for_at_the_same_time(
    database: Database, settings: Settings, subscribe: Subscribe, deliveries: Deliveries
) -> None:
    with ExitStack() as stack:
        receivers = [stack.enter_context(receiving(held=True)) for _ in range(12)]
        for receiver in receivers:
            deliveries.send_test(subscribe(receiver.url()).id)
        delivery_thread = threading.Thread(target=deliver_webhooks, args=(database, settings, never))
        delivery_thread.start()
        # None of them has answered when the last one is asked.
        assert all(receiver.arrived.acquire(timeout=GUARD_S) for receiver in receivers)
        for receiver in receivers:
            receiver.hold.set()
        delivery_thread.join()


def test_a_dispatcher_that_has_to_go_breaks_off_and_the_message_comes_again(
    database: Database, settings: Settings, subscribe: Subscribe, deliveries: Deliveries
) -> None:
    slow_settings = settings.model_copy(update={"webhook_timeout_s": 60.0})
    over = threading.Event()
    with receiving(held=True) as receiver:
        webhook = subscribe(receiver.url())
        delivery = deliveries.send_test(webhook.id)
        delivery_thread = threading.Thread(target=deliver_webhooks, args=(database, slow_settings, over.is_set))
        delivery_thread.start()
        assert receiver.arrived.acquire(timeout=GUARD_S)
        over.set()
        delivery_thread.join(timeout=GUARD_S)
        assert not delivery_thread.is_alive()
        assert deliveries.get(webhook.id, delivery.id).state is DeliveryState.PENDING
        assert deliver_webhooks(database, slow_settings, over.is_set) == ""
        receiver.hold.set()
        make_all_due(database)
        deliver_webhooks(database, settings, never)
    assert receiver.ids() == [delivery.id] * 2
    assert deliveries.get(webhook.id, delivery.id).state is DeliveryState.DELIVERED


def test_a_receiver_that_is_gone_is_switched_off(
    database: Database, settings: Settings, subscribe: Subscribe, webhooks: Webhooks, fail_job: FailJob
) -> None:
    with receiving(answers=[(410, {})]) as receiver:
        webhook = subscribe(receiver.url())
        fail_job()
        deliver_webhooks(database, settings, never)
        assert not webhooks.get(webhook.id).enabled
        fail_job()
        make_all_due(database)
        deliver_webhooks(database, settings, never)
    assert len(receiver.received) == 1


def test_an_address_that_was_allowed_once_is_judged_again_at_every_delivery(
    database: Database, settings: Settings, subscribe: Subscribe, deliveries: Deliveries
) -> None:
    closed = settings.model_copy(update={"webhook_allowed_networks": ""})
    with receiving() as receiver:
        webhook = subscribe(receiver.url())
        delivery = deliveries.send_test(webhook.id)
        deliver_webhooks(database, closed, never)
    assert receiver.received == []
    (entry,) = deliveries.get(webhook.id, delivery.id).log
    assert (entry.status, str(entry.error).partition(":")[0]) == (None, "webhook_address_refused")


def test_a_replay_comes_under_the_id_of_the_original(
    database: Database, settings: Settings, subscribe: Subscribe, deliveries: Deliveries, fail_job: FailJob
) -> None:
    with receiving() as receiver:
        webhook = subscribe(receiver.url())
        fail_job()
        deliver_webhooks(database, settings, never)
        (delivery,) = deliveries.page(webhook.id, 9).items
        deliveries.replay(webhook.id, delivery.id)
        deliver_webhooks(database, settings, never)
    first, second = receiver.received
    assert first.body == second.body
    assert receiver.ids() == [delivery.id] * 2


@pytest.mark.parametrize(("is_over", "words", "left"), [(lambda: True, "", 3), (never, "2 old deliveries removed", 1)])
def test_old_deliveries_are_removed_unless_the_time_is_up(
    database: Database,
    subscribe: Subscribe,
    deliveries: Deliveries,
    is_over: Callable[[], bool],
    words: str,
    left: int,
) -> None:
    webhook = subscribe("http://127.0.0.1:9/")
    made = [deliveries.send_test(webhook.id).id for _ in range(3)]
    with database.write() as session:
        old = update(DeliveryRow).where(DeliveryRow.id.in_(made[:2]))
        session.execute(old.values(state="delivered", finished_at=utc_now() - timedelta(days=31)))
    assert forget_old_deliveries(database, 30.0, is_over) == words
    assert len(deliveries.page(webhook.id, 9).items) == left


def test_the_lines_in_the_documentation_verify_a_message(
    database: Database, settings: Settings, subscribe: Subscribe, deliveries: Deliveries
) -> None:
    page = (Path(__file__).parents[2] / "docs/api.md").read_text("utf-8")
    (lines,) = re.findall(r"```python\n(from standardwebhooks.*?)```", page, re.DOTALL)
    names: dict[str, Any] = {}
    exec(lines, names)
    with receiving() as receiver:
        webhook = subscribe(receiver.url())
        deliveries.send_test(webhook.id)
        deliver_webhooks(database, settings, never)
    (request,) = receiver.received
    read_message = names["read_message"]
    assert read_message(webhook.secret, request.headers, request.body)["type"] == "webhook.test"
    with pytest.raises(WebhookVerificationError):
        read_message(webhook.secret, request.headers, request.body.replace(b"test", b"tost"))


def test_by_hand_the_signature_is_what_the_documentation_says(
    database: Database, settings: Settings, subscribe: Subscribe, deliveries: Deliveries
) -> None:
    with receiving() as receiver:
        webhook = subscribe(receiver.url())
        deliveries.send_test(webhook.id)
        deliver_webhooks(database, settings, never)
    (request,) = receiver.received
    key = base64.b64decode(webhook.secret.removeprefix("whsec_"))
    signed = f"{request.headers['webhook-id']}.{request.headers['webhook-timestamp']}.".encode() + request.body
    signature = base64.b64encode(hmac.new(key, signed, hashlib.sha256).digest()).decode()
    assert request.headers["webhook-signature"] == f"v1,{signature}"

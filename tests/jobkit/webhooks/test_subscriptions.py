"""Also tests `quadpatch_client/schema/webhook_url.py`."""

import base64
from collections.abc import Callable
from datetime import UTC, datetime

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from jobkit.database.clock import utc_now
from jobkit.database.session import Database
from jobkit.database.tables import WebhookRow
from jobkit.errors import AddressRefusedError, TooManyWebhooksError, WebhookDisabledError, WebhookNotFoundError
from jobkit.webhooks.deliveries import Deliveries
from jobkit.webhooks.subscriptions import MAX_WEBHOOKS, Webhooks
from quadpatch_client.schema import NewWebhook, WebhookChange
from quadpatch_client.schema.webhooks import ENDINGS

NEW = NewWebhook(url="https://mes.example.com/hook")


def refuse(url: str) -> None:
    if "inside" in url:
        raise AddressRefusedError(url)


@pytest.fixture
def webhooks(database: Database) -> Webhooks:
    return Webhooks(database, refuse)


def test_a_secret_is_shown_once_and_is_32_random_bytes(webhooks: Webhooks) -> None:
    made = [webhooks.create(NEW) for _ in range(3)]
    assert len({webhook.secret for webhook in made}) == 3
    assert all(len(base64.b64decode(webhook.secret.removeprefix("whsec_"))) == 32 for webhook in made)
    assert all("secret" not in webhooks.get(webhook.id).model_dump() for webhook in made)
    assert [webhook.id for webhook in webhooks.list_all().items] == sorted(webhook.id for webhook in made)


def test_a_subscription_hears_of_all_ends_unless_told_otherwise(webhooks: Webhooks) -> None:
    assert webhooks.create(NEW).events == list(ENDINGS)
    twice = NewWebhook(url=NEW.url, events=["job.failed", "job.failed", "job.started"])
    assert webhooks.create(twice).events == ["job.failed", "job.started"]


def test_a_change_changes_what_it_names_alone(webhooks: Webhooks) -> None:
    webhook = webhooks.create(NEW)
    changed = webhooks.change(webhook.id, WebhookChange(events=["job.failed"]))
    assert changed.events == ["job.failed"]
    kept = {"url", "description", "enabled", "created_at", "links"}
    assert changed.model_dump(include=kept) == webhook.model_dump(include=kept)
    assert webhooks.change(webhook.id, WebhookChange()).events == ["job.failed"]


def test_an_address_that_is_refused_is_refused_at_creation_and_at_every_change(webhooks: Webhooks) -> None:
    with pytest.raises(AddressRefusedError):
        webhooks.create(NewWebhook(url="https://inside/"))
    webhook = webhooks.create(NEW)
    with pytest.raises(AddressRefusedError):
        webhooks.change(webhook.id, WebhookChange(url="https://inside/"))
    assert webhooks.get(webhook.id).url == NEW.url


def test_switched_off_what_is_on_its_way_is_given_up_and_switched_on_the_history_is_clean(
    database: Database, webhooks: Webhooks
) -> None:
    webhook, deliveries = webhooks.create(NEW), Deliveries(database)
    test = deliveries.send_test(webhook.id)
    with database.write() as session:
        session.get_one(WebhookRow, webhook.id).failing_since = utc_now()
    assert not webhooks.change(webhook.id, WebhookChange(enabled=False)).enabled
    given_up = deliveries.get(webhook.id, test.id)
    assert (given_up.state, given_up.next_try_at, given_up.finished_at is None) == ("dead", None, False)
    sends: tuple[Callable[[], object], ...] = (
        lambda: deliveries.send_test(webhook.id),
        lambda: deliveries.replay(webhook.id, test.id),
    )
    for send in sends:
        with pytest.raises(WebhookDisabledError):
            send()
    assert webhooks.change(webhook.id, WebhookChange(enabled=True)).failing_since is None
    assert deliveries.replay(webhook.id, test.id).state == "pending"


def test_a_new_secret_leaves_the_old_one_for_a_day(database: Database, webhooks: Webhooks) -> None:
    webhook = webhooks.create(NEW)
    rotated = webhooks.rotate(webhook.id)
    assert rotated.secret != webhook.secret
    with database.read() as session:
        row = session.get_one(WebhookRow, webhook.id)
    assert (row.secret, row.old_secret) == (rotated.secret, webhook.secret)
    assert row.old_secret_until is not None
    assert (row.old_secret_until - row.updated_at).total_seconds() == pytest.approx(86_400, abs=5)


def test_what_is_deleted_takes_its_deliveries_along(database: Database, webhooks: Webhooks) -> None:
    kept, gone = webhooks.create(NEW), webhooks.create(NEW)
    deliveries = Deliveries(database)
    for webhook in (kept, gone):
        deliveries.send_test(webhook.id)
    webhooks.delete(gone.id)
    assert len(deliveries.page(kept.id, 10).items) == 1
    for ask in (
        lambda: webhooks.get(gone.id),
        lambda: webhooks.delete(gone.id),
        lambda: webhooks.rotate(gone.id),
        lambda: webhooks.change(gone.id, WebhookChange(url="https://inside/")),
        lambda: webhooks.change(gone.id, WebhookChange(enabled=False)),
        lambda: deliveries.page(gone.id, 10),
    ):
        with pytest.raises(WebhookNotFoundError):
            ask()


def test_there_is_a_limit_to_subscriptions(database: Database, webhooks: Webhooks) -> None:
    now = datetime(2026, 1, 1, tzinfo=UTC)
    with database.write() as session:
        session.add_all(
            WebhookRow(id=f"wh_{i}", url="", secret="", events=[], created_at=now, updated_at=now)
            for i in range(MAX_WEBHOOKS - 1)
        )
    webhooks.create(NEW)
    with pytest.raises(TooManyWebhooksError, match=str(MAX_WEBHOOKS)):
        webhooks.create(NEW)


@pytest.mark.parametrize(
    "url",
    [
        "ftp://a.example/",
        "https://",
        "https://user:password@a.example/",
        "https://user@a.example/",
        "https://a.example/#part",
        "https://a.example:0/",
        "https://a.example:65536/",
        "https://a.example/a b",
        "https://a.example/\n",
        "https://a.example/\r\nX-Header: 1",
        "https://a.example\\@b.example/",
        "https://ä.example/",
        "https://a..example/",
        "https://.example/",
        "https://a.example/%zz",
        "https://" + "a" * 64 + ".example/",
        "https://a.example/" + "a" * 2048,
        "//a.example/",
        " https://a.example/",
    ],
)
def test_urls_that_mean_different_things_to_different_readers_are_refused(url: str) -> None:
    with pytest.raises(ValidationError):
        NewWebhook(url=url)


@given(
    host=st.from_regex(r"[a-z0-9]{1,10}(\.[a-z0-9]{1,10}){0,5}", fullmatch=True) | st.just("[2606:4700::1]"),
    port=st.none() | st.integers(1, 65_535),
    path=st.from_regex(r"(/[a-z0-9._~@:-]{0,8}){0,4}", fullmatch=True),
    query=st.from_regex(r"(\?[a-z0-9=&/?-]{0,10})?", fullmatch=True),
)
def test_every_plain_url_is_taken(host: str, port: int | None, path: str, query: str) -> None:
    url = f"https://{host}{'' if port is None else f':{port}'}{path}{query}"
    assert NewWebhook(url=url).url == url

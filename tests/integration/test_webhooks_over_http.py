"""Subscriptions over HTTP, delivered by dispatchers in processes of their own, one of them killed at work."""

from collections.abc import Callable
from typing import Any

import httpx
import pytest
from sqlalchemy import update
from standardwebhooks import Webhook

from jobkit.database.clock import utc_now
from jobkit.database.session import Database
from jobkit.database.tables import DeliveryRow
from jobkit.settings import Settings
from tests.dispatcher.process import dispatching
from tests.dispatcher.receivers import LOOPBACK, receiving
from tests.waiting import GUARD_S, wait_until

ALLOWED = {"webhook_allowed_networks": LOOPBACK}


@pytest.mark.slow
def test_the_end_of_a_job_reaches_its_subscriber_although_the_dispatcher_is_killed_in_the_middle(
    serve: Callable[..., Any], settings: Settings, database: Database
) -> None:
    with (
        serve(**ALLOWED) as service,
        receiving(held=True) as receiver,
        httpx.Client(base_url=service.url, timeout=GUARD_S) as client,
    ):
        webhook = client.post("/v1/webhooks", json={"url": receiver.url()}).raise_for_status().json()
        mesh = client.post("/v1/meshes?filename=a.ply", content=b"ply").raise_for_status().json()
        spec = {"mesh_id": mesh["id"], "method": {"method": "smooth"}}
        job = client.post("/v1/jobs", json=spec).raise_for_status().json()
        with dispatching(settings, **ALLOWED) as first:
            client.post(job["links"]["cancel"]).raise_for_status()
            assert receiver.arrived.acquire(timeout=GUARD_S)
            first.kill()
        receiver.hold.set()
        with database.write() as session:  # as if the claim had run out
            session.execute(update(DeliveryRow).values(next_try_at=utc_now()))
        with dispatching(settings, **ALLOWED):
            assert receiver.arrived.acquire(timeout=GUARD_S)
            delivery = wait_until_delivered(client, webhook)
        told, again = receiver.received
        assert receiver.ids() == [delivery["id"]] * 2
        assert told.body == again.body
        message = Webhook(webhook["secret"]).verify(again.body, again.headers)
        assert (message["type"], message["data"]["job"]["id"]) == ("job.canceled", job["id"])
        # The try of the killed dispatcher is missing in the log, and counted.
        assert [entry["number"] for entry in client.get(delivery["links"]["self"]).json()["log"]] == [2]


def wait_until_delivered(client: httpx.Client, webhook: dict[str, Any]) -> dict[str, Any]:
    (delivery,) = wait_until(lambda: client.get(f"{webhook['links']['deliveries']}?state=delivered").json()["items"])
    return dict(delivery)

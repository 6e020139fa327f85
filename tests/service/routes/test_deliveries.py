from typing import Any

import pytest
from starlette.testclient import TestClient

from jobkit.database.clock import utc_now
from jobkit.database.tables import DeliveryRow
from quadpatch_rules.ids import new_message_id
from service.services import Services


@pytest.fixture
def webhook(client: TestClient) -> dict[str, Any]:
    made: dict[str, Any] = client.post("/v1/webhooks", json={"url": "https://8.8.8.8/hook"}).json()
    return made


def test_a_test_message_is_on_its_way_and_in_the_log(client: TestClient, webhook: dict[str, Any]) -> None:
    answer = client.post(webhook["links"]["test"])
    test = answer.json()
    assert answer.status_code == 202
    assert answer.headers["location"] == test["links"]["self"]
    assert client.get(answer.headers["location"]).json() == test
    assert (test["message"]["type"], test["message"]["data"]) == ("webhook.test", {"webhook_id": webhook["id"]})
    assert test["message"]["timestamp"].endswith("Z")


def test_pages_can_be_followed_and_filtered(client: TestClient, webhook: dict[str, Any]) -> None:
    made = sorted((client.post(webhook["links"]["test"]).json()["id"] for _ in range(3)), reverse=True)
    path = webhook["links"]["deliveries"]
    first = client.get(f"{path}?limit=2").json()
    second = client.get(f"{path}?limit=2&cursor={first['next_cursor']}").json()
    assert [item["id"] for item in first["items"] + second["items"]] == made
    assert second["next_cursor"] is None
    assert client.get(f"{path}?state=dead").json()["items"] == []
    assert len(client.get(f"{path}?state=pending").json()["items"]) == 3
    for query in ("state=lost", "limit=0", "limit=101", "cursor=1", "page=2"):
        assert client.get(f"{path}?{query}").status_code == 422


def test_what_has_ended_can_be_sent_again_under_the_same_message_id(
    client: TestClient, services: Services, webhook: dict[str, Any]
) -> None:
    test = client.post(webhook["links"]["test"]).json()
    pending = client.post(test["links"]["replay"])
    assert (pending.status_code, pending.json()["code"]) == (409, "delivery_pending")
    with services.database.write() as session:
        row = session.get_one(DeliveryRow, test["id"])
        row.state, row.next_try_at, row.finished_at = "dead", None, utc_now()
    replay = client.post(test["links"]["replay"])
    again = replay.json()
    assert replay.status_code == 202
    assert (again["replay_of"], again["message_id"]) == (test["id"], test["id"])
    assert again["message"] == test["message"]
    assert client.get(replay.headers["location"]).json() == again


def test_what_is_not_there_is_not_found(client: TestClient, webhook: dict[str, Any]) -> None:
    path = f"{webhook['links']['deliveries']}/{new_message_id()}"
    for answer in (client.get(path), client.post(f"{path}/replay")):
        assert (answer.status_code, answer.json()["code"]) == (404, "delivery_not_found")
    client.delete(webhook["links"]["self"])
    for answer in (client.get(path), client.get(webhook["links"]["deliveries"]), client.post(webhook["links"]["test"])):
        assert (answer.status_code, answer.json()["code"]) == (404, "webhook_not_found")

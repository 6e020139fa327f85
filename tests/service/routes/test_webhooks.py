from collections.abc import Callable
from typing import Any

import pytest
from starlette.testclient import TestClient

from jobkit.settings import Settings
from jobkit.webhooks.outbox import OMITTED_FIELDS
from quadpatch_client.schema import Job

OPEN = "https://8.8.8.8/hook"


@pytest.fixture
def settings(settings: Settings) -> Settings:
    return settings.model_copy(update={"webhook_allowed_networks": "127.0.0.0/8"})


def create(client: TestClient, **values: Any) -> dict[str, Any]:
    answer = client.post("/v1/webhooks", json={"url": OPEN} | values)
    assert answer.status_code == 201, answer.text
    made: dict[str, Any] = answer.json()
    return made


def test_a_subscription_is_made_shown_without_its_secret_and_deleted(client: TestClient) -> None:
    answer = client.post("/v1/webhooks", json={"url": OPEN, "description": "hall 3"})
    made = answer.json()
    secret = made.pop("secret")
    assert answer.status_code == 201
    assert secret.startswith("whsec_")
    assert answer.headers["location"] == f"/v1/webhooks/{made['id']}"
    assert answer.headers["cache-control"] == "no-store"
    assert made["events"] == ["job.succeeded", "job.failed", "job.canceled"]
    assert client.get(answer.headers["location"]).json() == made
    assert client.get("/v1/webhooks").json() == {"items": [made]}
    assert client.delete(answer.headers["location"]).status_code == 204
    gone = client.get(answer.headers["location"])
    assert (gone.status_code, gone.json()["code"]) == (404, "webhook_not_found")
    assert client.get("/v1/webhooks").json() == {"items": []}


def test_a_subscription_can_be_changed(client: TestClient) -> None:
    made = create(client)
    changed = client.patch(made["links"]["self"], json={"events": ["job.started"], "enabled": False}).json()
    assert (changed["events"], changed["enabled"], changed["url"]) == (["job.started"], False, OPEN)
    test = client.post(made["links"]["test"])
    assert (test.status_code, test.json()["code"]) == (409, "webhook_disabled")
    assert client.patch(made["links"]["self"], json={"enabled": True, "events": None}).json() == {
        **changed,
        "enabled": True,
        "updated_at": client.get(made["links"]["self"]).json()["updated_at"],
    }


def test_a_new_secret_is_shown_once(client: TestClient) -> None:
    made = create(client)
    rotated = client.post(made["links"]["rotate"])
    assert rotated.status_code == 200
    assert rotated.json()["secret"] != made["secret"]
    assert rotated.headers["cache-control"] == "no-store"


@pytest.mark.parametrize(
    ("url", "status", "code"),
    [
        ("https://10.0.0.8/", 403, "webhook_address_refused"),
        ("https://169.254.169.254/latest/meta-data/", 403, "webhook_address_refused"),
        ("https://[::1]/", 403, "webhook_address_refused"),
        ("https://[::ffff:10.0.0.8]/", 403, "webhook_address_refused"),
        ("http://8.8.8.8/", 403, "webhook_needs_tls"),
        ("https://no-such-host.invalid/", 409, "webhook_host_unknown"),
        ("https://user:word@8.8.8.8/", 422, "invalid_request"),
        ("gopher://8.8.8.8/", 422, "invalid_request"),
    ],
)
def test_an_address_that_nothing_is_sent_to_is_refused_with_a_code(
    client: TestClient, url: str, status: int, code: str
) -> None:
    made = create(client)
    for answer in (
        client.post("/v1/webhooks", json={"url": url}),
        client.patch(made["links"]["self"], json={"url": url}),
    ):
        assert (answer.status_code, answer.json()["code"]) == (status, code)
    assert client.get(made["links"]["self"]).json()["url"] == OPEN


def test_an_allowed_network_is_allowed_by_http(client: TestClient) -> None:
    assert create(client, url="http://127.0.0.1:8080/hook")["url"] == "http://127.0.0.1:8080/hook"


@pytest.mark.parametrize(
    "values", [{"events": []}, {"events": ["job.exploded"]}, {"secret": "whsec_AAAA"}, {"url": None}]
)
def test_a_subscription_that_cannot_be_meant_is_refused(client: TestClient, values: dict[str, Any]) -> None:
    answer = client.post("/v1/webhooks", json={"url": OPEN} | values)
    assert (answer.status_code, answer.json()["code"]) == (422, "invalid_request")


def test_an_end_of_a_job_stands_in_the_log_until_it_is_sent(
    client: TestClient, job_id: str, finish: Callable[[str], Job]
) -> None:
    made = create(client)
    finish(job_id)
    (delivery,) = client.get(made["links"]["deliveries"]).json()["items"]
    assert (delivery["type"], delivery["state"], delivery["tries"]) == ("job.succeeded", "pending", 0)
    detail = client.get(delivery["links"]["self"]).json()
    job = client.get(delivery["links"]["job"]).json()
    assert detail["message"]["data"]["job"] == {
        name: value for name, value in job.items() if name not in OMITTED_FIELDS
    }
    assert detail["log"] == []

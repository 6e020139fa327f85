"""Letter H: a request that is repeated under its key makes nothing twice, whatever it makes."""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest
import yaml
from sqlalchemy import func, select
from starlette.testclient import TestClient

from jobkit.access.keys import Keys
from jobkit.database.batch_tables import BatchRow
from jobkit.database.clock import utc_now
from jobkit.database.idempotency import KEEP_FOR, Idempotency, forget_keys, note_request
from jobkit.database.tables import DeliveryRow, IdempotencyRow, JobRow, WebhookRow
from jobkit.database.upload_tables import UploadRow
from quadpatch_client.schema import NewKey, Scope
from service.services import Services

DOCUMENT = yaml.safe_load((Path(__file__).resolve().parents[2] / "openapi.yaml").read_text("utf-8"))
# A second cancel changes nothing by itself.
MAKES_NOTHING = {"cancel_job", "cancel_batch", "cancel_training", "dry_run_rule"}
HOOK = {"url": "https://8.8.8.8/hook"}
KEY = {"Idempotency-Key": "order-17"}
MESH = b"ply\nformat ascii 1.0\nend_header\n"

Ask = Callable[..., Any]


@pytest.fixture
def webhook(client: TestClient) -> str:
    return str(client.post("/v1/webhooks", json=HOOK).json()["links"]["self"])


@pytest.fixture
def ended_delivery(client: TestClient, services: Services, webhook: str) -> str:
    delivery = client.post(f"{webhook}/test").json()
    client.patch(webhook, json={"enabled": False})  # gives it up
    client.patch(webhook, json={"enabled": True})
    return str(delivery["links"]["self"])


@pytest.fixture
def requests(  # noqa: PLR0917 - fixtures
    client: TestClient,
    services: Services,
    mesh_id: str,
    job_id: str,
    webhook: str,
    ended_delivery: str,
    dictionary_bytes: Callable[[int], bytes],
) -> dict[str, tuple[Ask, Ask | None]]:
    """By operation: how to ask for it, and how to ask for something else with the same operation."""
    # Once a key is made, no request goes without one.
    key = Keys(services.database).create(NewKey(name="test", scopes=list(Scope)))[0]
    client.headers["X-API-Key"] = key.key
    other_key = Keys(services.database).create(NewKey(name="other"))[0]
    job = {"mesh_id": mesh_id, "method": {"method": "smooth"}}
    training = {"model": "walls", "meshes": [mesh_id]}
    form = {"mesh": ("a.ply", MESH)}

    def post(path: str, **content: Any) -> Ask:
        # No worker proves the models here.
        return lambda headers: client.post(path, headers={"Prefer": "wait=0", **headers}, **content)

    def start(size: int) -> Ask:
        tus = {"Tus-Resumable": "1.0.0", "Upload-Length": str(size)}
        return lambda headers: client.post("/v1/uploads", headers={**tus, **headers})

    many = {"mesh_ids": [mesh_id], "spec": {"method": {"method": "smooth"}}}
    batch = client.post("/v1/batches", json=many).json()["links"]
    client.post(f"{client.get(batch['jobs']).json()['items'][0]['links']['self']}/cancel")
    return {
        "create_batch": (post("/v1/batches", json=many), post("/v1/batches", json={**many, "label": "b"})),
        "rerun_batch": (post(f"{batch['rerun']}?canceled=true"), post(batch["rerun"])),
        "renew_callback_secret": (post("/v1/callback-secret"), None),
        "create_upload": (start(10), start(11)),
        "upload_mesh": (post("/v1/meshes?filename=a.ply", content=MESH), post("/v1/meshes", content=MESH + b"\n")),
        "create_job": (post("/v1/jobs", json=job), post("/v1/jobs", json={**job, "seed": 1})),
        "create_training": (
            post("/v1/trainings", json=training),
            post("/v1/trainings", json={**training, "seed": 1}),
        ),
        "rerun_job": (post(f"/v1/jobs/{job_id}/rerun"), post(f"/v1/jobs/{job_id}/rerun", json={"seed": 1})),
        "repair": (
            post("/v1/repairs", files=form, data={"spec": '{"method": {"method": "smooth"}}'}),
            post("/v1/repairs", files=form, data={"spec": '{"method": {"method": "smooth"}, "seed": 1}'}),
        ),
        "publish_model": (
            post("/v1/models/parts/versions", content=dictionary_bytes(1)),
            post("/v1/models/parts/versions", content=dictionary_bytes(2)),
        ),
        "create_webhook": (post("/v1/webhooks", json=HOOK), post("/v1/webhooks", json={**HOOK, "description": "b"})),
        "test_webhook": (post(f"{webhook}/test"), None),
        "rotate_webhook_secret": (post(f"{webhook}/rotate"), None),
        "replay_delivery": (post(f"{ended_delivery}/replay"), None),
        "create_key": (post("/v1/keys", json={"name": "a"}), post("/v1/keys", json={"name": "b"})),
        "rotate_key": (post(f"/v1/keys/{other_key.id}/rotate"), None),
    }


def posts() -> dict[str, dict[str, Any]]:
    return {
        methods["post"]["operationId"]: methods["post"] for methods in DOCUMENT["paths"].values() if "post" in methods
    }


def count(services: Services) -> dict[str, int]:
    with services.database.read() as session:
        return {
            table.__tablename__: session.scalars(select(func.count()).select_from(table)).one()
            for table in (JobRow, BatchRow, WebhookRow, DeliveryRow, UploadRow)
        }


def test_every_post_that_makes_something_takes_a_key(requests: dict[str, tuple[Ask, Ask | None]]) -> None:
    taking = {
        name
        for name, operation in posts().items()
        if any(parameter["name"] == "Idempotency-Key" for parameter in operation["parameters"])
    }
    assert taking == posts().keys() - MAKES_NOTHING
    assert taking == requests.keys()
    assert all("409" in posts()[name]["responses"] for name in taking)


def test_a_repeated_request_makes_nothing_twice(
    services: Services, requests: dict[str, tuple[Ask, Ask | None]]
) -> None:
    for name, (ask, _) in requests.items():
        key = {"Idempotency-Key": name}
        first, stand = ask(key), count(services)
        assert first.status_code < 300, (name, first.text)
        assert "idempotent-replayed" not in first.headers
        for _ in range(2):
            again = ask(key)
            assert again.headers["idempotent-replayed"] == "true", name
            assert again.headers.get("location") == first.headers.get("location")
            same = {"id", "sha256", "secret", "url"} & first.json().keys()
            assert same
            assert {field: again.json()[field] for field in same} == {field: first.json()[field] for field in same}
            assert count(services) == stand, name


def test_a_key_names_one_request_whatever_it_is_about(requests: dict[str, tuple[Ask, Ask | None]]) -> None:
    for name, (ask, ask_otherwise) in requests.items():
        if ask_otherwise is not None:
            key = {"Idempotency-Key": name}
            assert ask(key).status_code < 300
            other = ask_otherwise(key)
            assert (other.status_code, other.json()["code"]) == (409, "idempotency_conflict"), name
    for name in requests:
        assert requests["test_webhook"][0](KEY).status_code == 202
        if name != "test_webhook":
            assert requests[name][0](KEY).json()["code"] == "idempotency_conflict", name


def test_a_request_that_fails_leaves_its_key_free(client: TestClient, dictionary_bytes: Callable[[int], bytes]) -> None:
    for _ in range(2):
        assert client.post("/v1/webhooks", json={"url": "https://127.0.0.1/"}, headers=KEY).status_code == 403
        path = "/v1/models/parts/versions"
        assert client.post(path, content=b"no model", headers=KEY).status_code == 422
    assert client.post("/v1/webhooks", json=HOOK, headers=KEY).status_code == 201
    key = {"Idempotency-Key": "of-the-model"}
    assert client.post(path, content=b"no model", headers=key).status_code == 422
    assert client.post(path, content=dictionary_bytes(1), headers={"Prefer": "wait=0", **key}).status_code == 202


def test_thirty_at_once_make_one(client: TestClient, services: Services) -> None:
    with ThreadPoolExecutor(30) as pool:
        answers = list(pool.map(lambda _: client.post("/v1/webhooks", json=HOOK, headers=KEY), range(30)))
    assert {answer.status_code for answer in answers} == {201}
    assert len({answer.json()["id"] for answer in answers}) == 1
    assert sum("idempotent-replayed" not in answer.headers for answer in answers) == 1
    assert count(services)["webhooks"] == 1


def test_the_key_of_a_deleted_subscription_is_free_again(client: TestClient) -> None:
    first = client.post("/v1/webhooks", json=HOOK, headers=KEY).json()
    assert client.delete(first["links"]["self"]).status_code == 204
    second = client.post("/v1/webhooks", json=HOOK, headers=KEY)
    assert second.status_code == 201
    assert second.json()["id"] != first["id"]
    assert "idempotent-replayed" not in second.headers


def test_two_clients_may_use_the_same_key(services: Services) -> None:
    for principal in ("one", "two"):
        assert note_request(services.database, Idempotency(principal, "k", "0" * 64), "a thing")


def test_keys_are_forgotten_but_those_of_jobs(client: TestClient, services: Services, mesh_id: str) -> None:
    client.post("/v1/webhooks", json=HOOK, headers=KEY)
    body = {"mesh_id": mesh_id, "method": {"method": "smooth"}}
    client.post("/v1/jobs", json=body, headers={"Idempotency-Key": "of-a-job"})
    assert forget_keys(services.database, utc_now()) == 0
    assert forget_keys(services.database, utc_now() + KEEP_FOR) == 1
    with services.database.read() as session:
        assert list(session.scalars(select(IdempotencyRow.key))) == ["of-a-job"]

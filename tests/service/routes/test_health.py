"""Also tests `service.readiness`."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from pydantic import SecretStr
from redis import Redis
from starlette.testclient import TestClient

from jobkit.database.leadership import DISPATCHER, Leadership
from jobkit.settings import Settings
from onebox.valkey import running_valkey
from service.app import create_app
from service.services import Services


@pytest.fixture
def without_queue(settings: Settings) -> Iterator[TestClient]:
    lonely = settings.model_copy(update={"redis_url": SecretStr("redis://:s3cret@127.0.0.1:1/0")})
    with TestClient(create_app(lonely), base_url="http://127.0.0.1") as client:
        yield client


@pytest.fixture
def whole(services: Services) -> None:
    """Let a dispatcher lead."""
    assert Leadership(services.database, DISPATCHER, "d-1", 60).lead()


@pytest.mark.usefixtures("whole")
def test_a_whole_box_is_ready(client: TestClient) -> None:
    assert client.get("/healthz").json() == {"status": "ok"}
    assert client.get("/readyz").json() == {
        "status": "ready",
        "database": "ok",
        "store": "ok",
        "queue": "ok",
        "queue_persistence": "ok",
        "dispatcher": "ok",
        "warnings": [],
    }


def test_without_its_queue_the_service_is_ready_to_take_jobs_and_says_what_is_wrong(without_queue: TestClient) -> None:
    answer = without_queue.get("/readyz")
    assert (answer.status_code, answer.json()["status"], answer.json()["queue"]) == (200, "degraded", "unavailable")
    assert answer.json()["warnings"][0] == "the queue does not answer; jobs wait until it does"
    assert "s3cret" not in answer.text


def test_without_a_dispatcher_the_service_is_degraded(client: TestClient) -> None:
    answer = client.get("/readyz").json()
    assert (answer["status"], answer["dispatcher"]) == ("degraded", "absent")
    assert answer["warnings"] == ["no dispatcher leads; lost jobs wait until one does"]


def test_a_dispatcher_that_fell_silent_is_named(client: TestClient, services: Services) -> None:
    assert Leadership(services.database, DISPATCHER, "d-7", -1).lead()
    answer = client.get("/readyz").json()
    assert answer["dispatcher"] == "absent"
    assert answer["warnings"] == ["the dispatcher d-7 fell silent; lost jobs wait until one does"]


@pytest.fixture
def other_queue(tmp_path: Path) -> Iterator[Redis]:
    """A Valkey of this test's own, to be spoiled."""
    with running_valkey(tmp_path / "spoiled") as url, Redis.from_url(url) as connection:
        yield connection


def readiness_with(settings: Settings, queue: Redis, user: str = "") -> dict[str, Any]:
    path = queue.connection_pool.connection_kwargs["path"]
    url = SecretStr(f"unix://{user}{path}")
    with TestClient(create_app(settings.model_copy(update={"redis_url": url})), base_url="http://127.0.0.1") as client:
        assert Leadership(client.app.state.services.database, DISPATCHER, "d-1", 60).lead()  # type: ignore[attr-defined]
        answer = client.get("/readyz")
    assert answer.status_code == 200
    return dict(answer.json())


def test_a_queue_that_may_lose_entries_is_weak(settings: Settings, other_queue: Redis) -> None:
    other_queue.config_set("appendonly", "no")
    other_queue.config_set("maxmemory-policy", "allkeys-lru")
    answer = readiness_with(settings, other_queue)
    assert (answer["status"], answer["queue"], answer["queue_persistence"]) == ("degraded", "ok", "weak")
    assert answer["warnings"] == [
        "the queue may lose entries: its append-only file is off",
        "the queue may lose entries: maxmemory-policy is allkeys-lru, not noeviction",
    ]


def test_a_queue_that_does_not_say_is_unknown_and_no_reason_to_degrade(settings: Settings, other_queue: Redis) -> None:
    other_queue.acl_setuser(
        "quiet", enabled=True, passwords=["+pass"], categories=["+@all"], keys=["*"], commands=["-info"]
    )
    answer = readiness_with(settings, other_queue, "quiet:pass@")
    assert (answer["status"], answer["queue"], answer["queue_persistence"]) == ("ready", "ok", "unknown")
    assert answer["warnings"] == ["the queue's server does not say whether it keeps what it is given"]


def test_without_its_queue_the_service_still_takes_jobs(without_queue: TestClient) -> None:
    """The job is in the database; the dispatcher puts it into the queue once that answers."""
    mesh = without_queue.post("/v1/meshes?filename=a.ply", content=b"ply").json()
    answer = without_queue.post("/v1/jobs", json={"mesh_id": mesh["id"], "method": {"method": "smooth"}})
    assert (answer.status_code, answer.json()["state"]) == (202, "queued")


def test_a_store_that_cannot_be_written_is_not_ready(client: TestClient, break_store: Callable[[], None]) -> None:
    break_store()
    answer = client.get("/readyz")
    assert answer.status_code == 503
    assert answer.headers["retry-after"] == "2"
    assert [error["pointer"] for error in answer.json()["errors"]] == ["store"]

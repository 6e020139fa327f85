from collections.abc import Iterator

import pytest
from pydantic import SecretStr
from starlette.testclient import TestClient

from jobkit.settings import Settings
from service.app import create_app
from service.services import Services


@pytest.fixture
def without_queue(settings: Settings) -> Iterator[TestClient]:
    lonely = settings.model_copy(update={"redis_url": SecretStr("redis://:s3cret@127.0.0.1:1/0")})
    with TestClient(create_app(lonely), base_url="http://127.0.0.1") as client:
        yield client


def test_a_whole_box_is_ready(client: TestClient) -> None:
    assert client.get("/healthz").json() == {"status": "ok"}
    assert client.get("/readyz").json() == {"status": "ready", "database": "ok", "store": "ok", "queue": "ok"}


def test_without_its_queue_the_service_lives_but_is_not_ready(without_queue: TestClient) -> None:
    assert without_queue.get("/healthz").status_code == 200
    answer = without_queue.get("/readyz")
    assert (answer.status_code, answer.json()["code"]) == (503, "not_ready")
    assert [error["pointer"] for error in answer.json()["errors"]] == ["queue"]
    assert "s3cret" not in answer.text


def test_without_its_queue_the_service_still_takes_jobs(without_queue: TestClient) -> None:
    """The promise stands in the database; whoever finds the queue again puts the job there."""
    mesh = without_queue.post("/v1/meshes?filename=a.ply", content=b"ply").json()
    answer = without_queue.post("/v1/jobs", json={"mesh_id": mesh["id"], "method": {"method": "smooth"}})
    assert (answer.status_code, answer.json()["state"]) == (202, "queued")


def test_a_store_that_cannot_be_written_is_not_ready(
    client: TestClient, services: Services, settings: Settings
) -> None:
    (settings.data_dir / "objects" / "incoming").rmdir()
    answer = client.get("/readyz")
    assert answer.status_code == 503
    assert answer.headers["retry-after"] == "2"
    assert [error["pointer"] for error in answer.json()["errors"]] == ["store"]


def test_the_page_says_what_this_is(client: TestClient) -> None:
    answer = client.get("/")
    assert answer.headers["content-type"].startswith("text/html")
    assert "Quadpatch" in answer.text

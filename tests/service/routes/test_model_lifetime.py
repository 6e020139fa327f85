"""Models are deprecated and deleted, unless something needs them."""

from collections.abc import Callable

import pytest
from starlette.testclient import TestClient

from quadpatch_client.schema import Job, ModelVersion
from service.services import Services

Make = Callable[[int], bytes]
Publish = Callable[..., ModelVersion]
PATH = "/v1/models/reliefs/versions"


@pytest.fixture(autouse=True)
def versions(publish: Publish, dictionary_bytes: Make) -> None:
    """Publish `reliefs@1` and `reliefs@2`."""
    for seed in (1, 2):
        publish("reliefs", dictionary_bytes(seed))


def job_with(client: TestClient, mesh_id: str, model: str) -> Job:
    answer = client.post("/v1/jobs", json={"mesh_id": mesh_id, "method": {"method": "dictionary", "model": model}})
    assert answer.status_code == 202, answer.text
    return Job.model_validate(answer.json())


def test_a_version_is_deleted_and_its_number_never_comes_back(
    client: TestClient, publish: Publish, dictionary_bytes: Make
) -> None:
    assert client.delete(f"{PATH}/2").status_code == 204
    for answer in (client.delete(f"{PATH}/2"), client.get(f"{PATH}/2"), client.get(f"{PATH}/2/artifact")):
        assert (answer.status_code, answer.json()["code"]) == (404, "model_not_found")
    assert client.get("/v1/models/reliefs").json()["latest"] == 1
    assert publish("reliefs", dictionary_bytes(2)).version == 3
    for number in (1, 3):
        assert client.delete(f"{PATH}/{number}").status_code == 204
    assert client.get("/v1/models/reliefs").status_code == 404
    assert publish("reliefs", dictionary_bytes(1)).version == 4


def test_a_version_that_an_alias_points_to_is_not_deleted(client: TestClient) -> None:
    client.put("/v1/aliases/ours", json={"model": "reliefs@2"})
    refused = client.delete(f"{PATH}/2")
    assert (refused.status_code, refused.json()["code"]) == (409, "model_in_use")
    assert client.delete("/v1/aliases/ours").status_code == 204
    assert client.delete("/v1/aliases/ours").json()["code"] == "model_not_found"
    assert client.delete(f"{PATH}/2").status_code == 204


def test_the_aliases_of_jobs_that_name_no_model_are_not_deleted(client: TestClient) -> None:
    client.put("/v1/aliases/default", json={"model": "reliefs@2"})
    refused = client.delete("/v1/aliases/default")
    assert (refused.status_code, refused.json()["code"]) == (409, "alias_in_use")
    assert client.get(f"{PATH}/2").json()["aliases"] == ["default"]


def test_a_version_that_an_unfinished_job_needs_is_not_deleted(
    client: TestClient, services: Services, mesh_id: str, finish: Callable[[str], Job]
) -> None:
    queued, running = (job_with(client, mesh_id, "reliefs@2") for _ in range(2))
    services.attempts.start(running.id, "test", 30)
    for job in (queued, running):
        refused = client.delete(f"{PATH}/2")
        assert (refused.status_code, refused.json()["code"]) == (409, "model_in_use")
        client.post(f"/v1/jobs/{job.id}/cancel")
    # The running one is still at it.
    assert client.delete(f"{PATH}/2").status_code == 409
    assert client.delete(f"{PATH}/1").status_code == 204


def test_a_finished_job_keeps_the_name_of_a_version_that_is_deleted(
    client: TestClient, mesh_id: str, finish: Callable[[str], Job]
) -> None:
    job = job_with(client, mesh_id, "reliefs@2")
    finish(job.id)
    assert client.delete(f"{PATH}/2").status_code == 204
    assert client.get(f"/v1/jobs/{job.id}").json()["model"]["version"] == 2


def test_a_deprecated_version_says_so_wherever_it_shows(client: TestClient, mesh_id: str) -> None:
    reason = {"reason": "reliefs@1 does better on thin ribs"}
    marked = client.put(f"{PATH}/2/deprecation", json=reason)
    assert marked.status_code == 200
    deprecated = marked.json()["deprecated"]
    assert deprecated["reason"] == reason["reason"]
    listed = client.get("/v1/models").json()["models"][0]
    assert [version["deprecated"] for version in listed["versions"]] == [deprecated, None]
    for path in (f"{PATH}/2", f"{PATH}/2/artifact"):
        assert client.get(path).headers["deprecation"].startswith("@")
    assert "deprecation" not in client.get(f"{PATH}/1").headers
    job = client.post("/v1/jobs", json={"mesh_id": mesh_id, "method": {"method": "dictionary", "model": "reliefs@2"}})
    assert job.headers["deprecation"].startswith("@")
    assert job.json()["model"]["deprecated_at"] == deprecated["at"]


def test_a_deprecated_version_is_no_longer_meant_by_its_name_and_no_alias_comes_to_it(
    client: TestClient, mesh_id: str
) -> None:
    assert client.put(f"{PATH}/2/deprecation").status_code == 200
    assert job_with(client, mesh_id, "reliefs").model.version == 1
    assert client.get("/v1/models/reliefs").json()["latest"] == 1
    refused = client.put("/v1/aliases/ours", json={"model": "reliefs@2"})
    assert (refused.status_code, refused.json()["code"]) == (409, "model_deprecated")
    assert client.delete(f"{PATH}/2/deprecation").status_code == 204
    assert client.put("/v1/aliases/ours", json={"model": "reliefs@2"}).status_code == 200


def test_what_default_points_to_is_not_deprecated(client: TestClient) -> None:
    for alias in ("default", "ours"):
        client.put(f"/v1/aliases/{alias}", json={"model": "reliefs@2"})
    refused = client.put(f"{PATH}/2/deprecation")
    assert (refused.status_code, refused.json()["code"]) == (409, "model_in_use")
    client.put("/v1/aliases/default", json={"model": "reliefs@1"})
    assert client.put(f"{PATH}/2/deprecation").status_code == 200


@pytest.mark.parametrize("path", ["none/versions/1", "reliefs/versions/3"])
def test_what_is_not_there_is_neither_deprecated_nor_deleted(client: TestClient, path: str) -> None:
    for method, end in (("DELETE", ""), ("PUT", "/deprecation"), ("DELETE", "/deprecation")):
        answer = client.request(method, f"/v1/models/{path}{end}")
        assert (answer.status_code, answer.json()["code"]) == (404, "model_not_found")

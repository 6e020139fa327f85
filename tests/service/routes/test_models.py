import json
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import pytest
from starlette.testclient import TestClient

from jobkit.queue import model_entry
from quadpatch_client.schema import ModelProblem, ModelVersion
from service.services import Services
from tests.waiting import GUARD_S, wait_until

Make = Callable[[int], bytes]
Publish = Callable[..., ModelVersion]
# A graph without nodes, and standard operators: as much as is looked at here.
NETWORK = b"\x08\x0a\x12\x07pytorch\x3a\x03\x12\x01g\x42\x02\x10\x11"


def test_an_artifact_becomes_a_version_and_comes_back(
    client: TestClient, publish: Publish, dictionary_bytes: Make
) -> None:
    data = dictionary_bytes(1)
    version = publish("reliefs", data)
    path = "/v1/models/reliefs/versions/1"
    assert version.links.self == path
    assert (version.kind, version.format, version.card.patch_resolution) == ("dictionary", "safetensors", 8)
    assert client.get(path).json() == json.loads(version.model_dump_json())
    fetched = client.get(version.links.artifact)
    assert fetched.content == data
    assert fetched.headers["content-disposition"] == 'attachment; filename="reliefs_1.safetensors"; ' + (
        "filename*=UTF-8''reliefs%401.safetensors"
    )


def test_the_same_bytes_are_the_same_version(client: TestClient, publish: Publish, dictionary_bytes: Make) -> None:
    assert [publish("reliefs", dictionary_bytes(seed)).version for seed in (1, 2)] == [1, 2]
    again = client.post("/v1/models/reliefs/versions", content=dictionary_bytes(1))
    assert (again.status_code, again.json()["version"]) == (200, 1)


def test_a_network_brings_its_card_in_a_part(publish: Publish) -> None:
    card = {"description": "a small network", "patch_resolution": 24, "channels": 16}
    files = {"artifact": ("small.onnx", NETWORK), "card": (None, json.dumps(card), "application/json")}
    version = publish("small", files=files)
    assert (version.kind, version.format) == ("autoencoder", "onnx")
    assert version.card.description == "a small network"
    assert version.card.extra == {"channels": 16}


def test_models_and_aliases_are_listed(client: TestClient, publish: Publish, dictionary_bytes: Make) -> None:
    for name, seed in (("reliefs", 1), ("reliefs", 2), ("scans", 1)):
        publish(name, dictionary_bytes(seed))
    alias = client.put("/v1/aliases/candidate", json={"model": "reliefs"}).json()
    assert (alias["name"], alias["version"]) == ("reliefs", 2)
    listed = client.get("/v1/models").json()
    assert [(model["name"], model["latest"]) for model in listed["models"]] == [("reliefs", 2), ("scans", 1)]
    assert listed["aliases"] == [alias]
    assert client.get("/v1/models/reliefs").json()["versions"][0]["aliases"] == ["candidate"]


def test_models_and_their_versions_come_in_pages(client: TestClient, publish: Publish, dictionary_bytes: Make) -> None:
    for name, seed in (("a", 1), ("a", 2), ("a", 3), ("b", 1), ("c", 1)):
        publish(name, dictionary_bytes(seed))
    client.put("/v1/aliases/ours", json={"model": "c"})
    first = client.get("/v1/models?limit=2").json()
    rest = client.get(f"/v1/models?limit=2&cursor={first['next_cursor']}").json()
    assert [[model["name"] for model in page["models"]] for page in (first, rest)] == [["a", "b"], ["c"]]
    assert [[alias["alias"] for alias in page["aliases"]] for page in (first, rest)] == [[], ["ours"]]
    assert rest["next_cursor"] is None
    newest = client.get("/v1/models/a?limit=2").json()
    older = client.get(f"/v1/models/a?limit=2&cursor={newest['next_cursor']}").json()
    assert [[v["version"] for v in page["versions"]] for page in (newest, older)] == [[3, 2], [1]]
    assert older["next_cursor"] is None


def test_what_is_not_proven_is_neither_used_nor_pointed_to(
    client: TestClient, services: Services, mesh_id: str, publish: Publish, dictionary_bytes: Make
) -> None:
    publish("reliefs", dictionary_bytes(1))
    answer = client.post("/v1/models/reliefs/versions", content=dictionary_bytes(2), headers={"Prefer": "wait=0"})
    assert (answer.status_code, answer.json()["state"], answer.headers["retry-after"]) == (202, "proving", "2")
    assert answer.headers["location"] == "/v1/models/reliefs/versions/2"
    assert model_entry("reliefs@2", 1) in services.queue.entries()
    job = {"mesh_id": mesh_id, "method": {"method": "dictionary", "model": "reliefs@2"}}
    for refusal in (client.post("/v1/jobs", json=job), client.put("/v1/aliases/ours", json={"model": "reliefs@2"})):
        assert (refusal.status_code, refusal.json()["code"]) == (409, "model_not_proven")
        assert refusal.json()["retryable"] is True
    # The name alone means what can be used.
    assert client.get("/v1/models/reliefs").json()["latest"] == 1
    assert client.put("/v1/aliases/ours", json={"model": "reliefs"}).json()["version"] == 1
    refuse(services, "reliefs@2")
    for refusal in (client.post("/v1/jobs", json=job), client.put("/v1/aliases/ours", json={"model": "reliefs@2"})):
        assert (refusal.status_code, refusal.json()["code"]) == (409, "model_refused")
        assert "unusable_model" in refusal.json()["detail"]
        assert refusal.json()["retryable"] is False
    shown = client.get("/v1/models/reliefs/versions/2").json()
    assert (shown["state"], shown["problem"]) == ("refused", {"code": "unusable_model", "message": "no unit norm"})


@pytest.mark.parametrize(("is_sound", "status"), [(True, 201), (False, 422)])
def test_an_upload_waits_for_its_proof(
    client: TestClient, services: Services, dictionary_bytes: Make, is_sound: bool, status: int
) -> None:
    def work() -> None:
        reference = wait_until(lambda: next(iter(services.proofs.unfinished(["reliefs@1"])), None))
        if is_sound:
            services.proofs.accept(services.proofs.start(reference, "test", 30))
        else:
            refuse(services, reference)

    with ThreadPoolExecutor() as pool:
        done = pool.submit(work)
        answer = client.post(
            "/v1/models/reliefs/versions", content=dictionary_bytes(1), headers={"Prefer": f"wait={GUARD_S:.0f}"}
        )
        done.result()
    assert answer.status_code == status
    assert answer.headers["location"] == "/v1/models/reliefs/versions/1"
    if not is_sound:
        assert (answer.json()["code"], answer.json()["detail"]) == ("unusable_model", "no unit norm")


def refuse(services: Services, reference: str) -> None:
    problem = ModelProblem(code="unusable_model", message="no unit norm")
    services.proofs.refuse(services.proofs.start(reference, "test", 30), problem)


@pytest.mark.parametrize(
    ("path", "request_of", "status", "code"),
    [
        ("/v1/models/junk/versions", {"content": b"neither"}, 422, "unusable_model"),
        ("/v1/models/junk/versions", {"content": b""}, 400, "empty_file"),
        ("/v1/models/self/versions", {"content": NETWORK}, 409, "name_taken"),
        ("/v1/models/Upper/versions", {"content": NETWORK}, 422, "invalid_request"),
        (
            "/v1/models/small/versions",
            {"files": {"artifact": ("a.onnx", NETWORK), "card": (None, "[")}},
            422,
            "invalid_request",
        ),
        (
            "/v1/models/small/versions",
            {"files": {"artifact": ("a.onnx", NETWORK), "card": (None, '{"n_atoms": "many"}')}},
            422,
            "unusable_model",
        ),
    ],
)
def test_what_is_no_model_is_refused(
    client: TestClient, path: str, request_of: dict[str, Any], status: int, code: str
) -> None:
    answer = client.post(path, **request_of)
    assert (answer.status_code, answer.json()["code"]) == (status, code)
    assert client.get("/v1/models").json()["models"] == []


def test_an_alias_points_to_what_is_there(client: TestClient) -> None:
    answer = client.put("/v1/aliases/candidate", json={"model": "none@1"})
    assert (answer.status_code, answer.json()["code"]) == (404, "model_not_found")

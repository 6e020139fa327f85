import json
from collections.abc import Callable
from typing import Any

import pytest
from starlette.testclient import TestClient

Make = Callable[[int], bytes]
# A graph without nodes, and standard operators: as much as is looked at here.
NETWORK = b"\x08\x0a\x12\x07pytorch\x3a\x03\x12\x01g\x42\x02\x10\x11"


def test_an_artifact_becomes_a_version_and_comes_back(client: TestClient, dictionary_bytes: Make) -> None:
    data = dictionary_bytes(1)
    answer = client.post("/v1/models/reliefs/versions", content=data)
    version = answer.json()
    assert answer.status_code == 201
    assert answer.headers["location"] == "/v1/models/reliefs/versions/1" == version["links"]["self"]
    assert (version["kind"], version["format"], version["card"]["patch_resolution"]) == ("dictionary", "safetensors", 8)
    assert client.get(answer.headers["location"]).json() == version
    fetched = client.get(version["links"]["artifact"])
    assert fetched.content == data
    assert fetched.headers["content-disposition"] == 'attachment; filename="reliefs_1.safetensors"; ' + (
        "filename*=UTF-8''reliefs%401.safetensors"
    )


def test_the_same_bytes_are_the_same_version(client: TestClient, dictionary_bytes: Make) -> None:
    answers = [client.post("/v1/models/reliefs/versions", content=dictionary_bytes(seed)) for seed in (1, 2, 1)]
    assert [(answer.status_code, answer.json()["version"]) for answer in answers] == [(201, 1), (201, 2), (200, 1)]


def test_a_network_brings_its_card_in_a_part(client: TestClient) -> None:
    card = {"description": "a small network", "patch_resolution": 24, "channels": 16}
    files = {"artifact": ("small.onnx", NETWORK), "card": (None, json.dumps(card), "application/json")}
    version = client.post("/v1/models/small/versions", files=files).json()
    assert (version["kind"], version["format"]) == ("autoencoder", "onnx")
    assert version["card"]["description"] == "a small network"
    assert version["card"]["extra"] == {"channels": 16}


def test_models_and_aliases_are_listed(client: TestClient, dictionary_bytes: Make) -> None:
    for name, seed in (("reliefs", 1), ("reliefs", 2), ("scans", 1)):
        client.post(f"/v1/models/{name}/versions", content=dictionary_bytes(seed))
    alias = client.put("/v1/aliases/candidate", json={"model": "reliefs"}).json()
    assert (alias["name"], alias["version"]) == ("reliefs", 2)
    listed = client.get("/v1/models").json()
    assert [(model["name"], model["latest"]) for model in listed["models"]] == [("reliefs", 2), ("scans", 1)]
    assert listed["aliases"] == [alias]
    assert client.get("/v1/models/reliefs").json()["versions"][0]["aliases"] == ["candidate"]


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

from collections.abc import Iterator

import pytest
from pydantic import SecretStr
from starlette.testclient import TestClient

from jobkit.errors import SettingsError
from jobkit.settings import Settings
from service.app import create_app
from service.auth import KeyRing, check_exposure

KEY = "a-key-of-station-1"


@pytest.fixture
def guarded(settings: Settings) -> Iterator[TestClient]:
    keyed = settings.model_copy(update={"api_keys": SecretStr(f"{KEY},another-long-key-2"), "host": "0.0.0.0"})
    with TestClient(create_app(keyed), base_url="http://scanner.example") as client:
        yield client


@pytest.mark.parametrize("host", ["0.0.0.0", "::", "192.168.1.20", "quadpatch.example"])
def test_it_refuses_to_listen_to_others_without_a_key(settings: Settings, host: str) -> None:
    exposed = settings.model_copy(update={"host": host})
    with pytest.raises(SettingsError, match="QUADPATCH_API_KEYS"):
        create_app(exposed)
    check_exposure(exposed.model_copy(update={"api_keys": SecretStr(KEY)}))


@pytest.mark.parametrize("host", ["127.0.0.1", "127.0.0.8", "::1", "localhost"])
def test_loopback_needs_no_key(settings: Settings, host: str) -> None:
    local = create_app(settings.model_copy(update={"host": host}))
    with TestClient(local, base_url="http://127.0.0.1") as client:
        assert client.get("/v1/jobs").status_code == 200


@pytest.mark.parametrize(
    "headers", [{"Authorization": f"Bearer {KEY}"}, {"authorization": f"bearer {KEY}"}, {"X-API-Key": KEY}]
)
def test_a_key_opens_in_either_header(guarded: TestClient, headers: dict[str, str]) -> None:
    assert guarded.get("/v1/jobs", headers=headers).status_code == 200


@pytest.mark.parametrize(
    "headers",
    [
        {},
        {"Authorization": f"Bearer {KEY}x"},
        {"Authorization": f"Basic {KEY}"},
        {"Authorization": KEY},
        {"Authorization": "Bearer "},
        {"X-API-Key": ""},
        {"X-API-Key": KEY[:-1]},
        {"X-API-Key": f"{KEY},another-long-key-2"},
    ],
)
@pytest.mark.parametrize("path", ["/v1/jobs", "/v1/models", "/nothing-here"])
def test_nothing_else_opens(guarded: TestClient, headers: dict[str, str], path: str) -> None:
    answer = guarded.get(path, headers=headers)
    assert answer.status_code == 401
    assert answer.json()["code"] == "unauthorized"
    assert answer.headers["www-authenticate"].startswith("Bearer")
    assert "x-request-id" in answer.headers


def test_an_upload_without_a_key_is_refused_before_its_body_is_read(guarded: TestClient) -> None:
    def body() -> Iterator[bytes]:
        raise AssertionError("the body was read")
        yield b""

    answer = guarded.post("/v1/meshes", content=body(), headers={"Content-Length": "5"})
    assert answer.status_code == 401


@pytest.mark.parametrize("path", ["/healthz", "/readyz", "/openapi.yaml", "/"])
def test_signs_of_life_and_the_document_need_no_key(guarded: TestClient, path: str) -> None:
    assert guarded.get(path).status_code == 200


def test_each_key_has_a_name_of_its_own_that_does_not_give_it_away() -> None:
    ring = KeyRing([KEY, "another-long-key-2"])
    first, second = ring.of_settings(KEY), ring.of_settings("another-long-key-2")
    assert first is not None
    assert second is not None
    assert first.key_id != second.key_id
    assert KEY not in first.key_id
    assert ring.of_settings("wrong") is None
    assert KEY not in str(vars(ring))


def test_two_holders_of_keys_may_use_the_same_idempotency_key(guarded: TestClient) -> None:
    bodies = []
    for key in (KEY, "another-long-key-2"):
        headers = {"X-API-Key": key}
        mesh = guarded.post("/v1/meshes", content=b"ply", headers=headers).json()["id"]
        spec = {"mesh_id": mesh, "method": {"method": "smooth"}}
        bodies.append(guarded.post("/v1/jobs", json=spec, headers={**headers, "Idempotency-Key": "same"}).json())
    assert bodies[0]["id"] != bodies[1]["id"]


def test_a_page_from_elsewhere_cannot_use_the_browser_of_this_machine(client: TestClient) -> None:
    answer = client.post("/v1/meshes", content=b"ply", headers={"Origin": "https://evil.example"})
    assert (answer.status_code, answer.json()["code"]) == (403, "foreign_origin")
    answer = client.get("/v1/jobs", headers={"Host": "evil.example"})
    assert (answer.status_code, answer.json()["code"]) == (403, "foreign_host")
    answer = client.post("/v1/meshes", content=b"ply", headers={"Origin": "http://127.0.0.1"})
    assert answer.status_code == 201

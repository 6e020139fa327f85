"""Keys and the audit log: `jobkit/access/audit.py`, `quadpatch_client/schema/keys.py`, `service/audit.py`."""

from collections.abc import Iterator
from datetime import UTC, datetime, timedelta
from typing import Any

import pytest
from pydantic import SecretStr
from sqlalchemy import select
from starlette.testclient import TestClient

from dispatcher.retention import forget_audit
from jobkit.access.keys import Keys
from jobkit.database.access_tables import KeyRow
from jobkit.database.tables import JobRow
from jobkit.settings import Settings
from quadpatch_client.schema import NewKey, Scope
from service import auth
from service.app import create_app
from service.services import Services
from tests.waiting import wait_until

OPERATOR_KEY = "the-key-of-the-operator"


@pytest.fixture
def operator(settings: Settings, monkeypatch: pytest.MonkeyPatch) -> Iterator[TestClient]:
    """Calls with the operator's key; what is known of keys is looked up anew each time."""
    monkeypatch.setattr(auth, "_KNOWN_FOR_S", 0.0)
    keyed = settings.model_copy(update={"api_keys": SecretStr(OPERATOR_KEY)})
    with TestClient(create_app(keyed), base_url="http://127.0.0.1", headers={"X-API-Key": OPERATOR_KEY}) as client:
        yield client


def made(client: TestClient, **fields: Any) -> dict[str, Any]:
    answer = client.post("/v1/keys", json={"name": "station 4", **fields})
    assert answer.status_code == 201, answer.text
    key: dict[str, Any] = answer.json()
    return key


def status(client: TestClient, key: str) -> int:
    return client.get("/v1/jobs", headers={"X-API-Key": key}).status_code


def test_a_key_is_shown_once_and_stored_as_a_digest(operator: TestClient) -> None:
    key = made(operator, tenant="plant-north")
    assert status(operator, key["key"]) == 200
    shown = operator.get(f"/v1/keys/{key['id']}").json()
    assert "key" not in shown
    assert (shown["tenant"], shown["scopes"]) == ("plant-north", ["read", "upload", "repair"])
    assert shown["used_at"] is not None
    services: Services = operator.app.state.services  # type: ignore[attr-defined]
    with services.database.read() as session:
        row = session.get(KeyRow, key["id"])
        assert row is not None
        assert key["key"] not in str({column.key: getattr(row, column.key) for column in KeyRow.__table__.columns})


def test_a_rotated_key_is_taken_for_a_while_and_a_revoked_one_never_again(operator: TestClient) -> None:
    old = made(operator)
    new = operator.post(f"/v1/keys/{old['id']}/rotate").json()
    assert new["id"] == old["id"]
    assert new["old_until"] is not None
    assert [status(operator, key["key"]) for key in (old, new)] == [200, 200]
    assert operator.delete(f"/v1/keys/{old['id']}").status_code == 204
    assert [status(operator, key["key"]) for key in (old, new)] == [401, 401]
    refused = operator.post(f"/v1/keys/{old['id']}/rotate")
    assert (refused.status_code, refused.json()["code"]) == (409, "key_revoked")
    assert operator.get(f"/v1/keys/{old['id']}").json()["revoked_at"] is not None


def test_a_key_ends_when_it_expires(operator: TestClient) -> None:
    now = datetime.now(UTC)
    over, valid = (made(operator, expires_at=(now + timedelta(hours=h)).isoformat()) for h in (-1, 1))
    assert [status(operator, key["key"]) for key in (over, valid)] == [401, 200]


@pytest.mark.parametrize(
    "fields",
    [
        {"scopes": []},
        {"scopes": ["everything"]},
        {"tenant": "Plant North"},
        {"tenant": "a/b"},
        {"name": ""},
        {"name": "a\nb"},
        {"expires_at": "2027-01-01T00:00:00"},
    ],
)
def test_wrong_keys_are_refused(operator: TestClient, fields: dict[str, Any]) -> None:
    answer = operator.post("/v1/keys", json={"name": "x", **fields})
    assert (answer.status_code, answer.json()["code"]) == (422, "invalid_request")


@pytest.mark.parametrize("rate", [0, -1, 1.5, "many", 2**40])
def test_a_limit_of_a_key_is_a_whole_number_of_requests(operator: TestClient, rate: Any) -> None:
    key = made(operator, requests_per_minute=7)
    answer = operator.patch(f"/v1/keys/{key['id']}", json={"requests_per_minute": rate})
    assert (answer.status_code, answer.json()["code"]) == (422, "invalid_request")
    assert operator.get(f"/v1/keys/{key['id']}").json()["requests_per_minute"] == 7


def test_an_unknown_key_is_not_found(operator: TestClient) -> None:
    path = "/v1/keys/key_01jd7z3v5qk8m2x4c6b8n0a9de"
    for answer in (operator.get(path), operator.delete(path), operator.post(f"{path}/rotate")):
        assert (answer.status_code, answer.json()["code"]) == (404, "key_not_found")


def test_once_a_key_is_made_requests_without_one_are_refused(
    settings: Settings, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(auth, "_KNOWN_FOR_S", 0.0)
    with TestClient(create_app(settings), base_url="http://127.0.0.1") as client:
        assert client.get("/v1/jobs").status_code == 200
        key = made(client, scopes=["read", "admin"])
        assert client.get("/v1/jobs").status_code == 401
        assert status(client, key["key"]) == 200
        assert client.get("/healthz").status_code == 200
        client.delete(f"/v1/keys/{key['id']}", headers={"X-API-Key": key["key"]})
        # The last one is gone; that must not open the service.
        assert client.get("/v1/jobs").status_code == 401


def test_keys_that_were_made_let_the_service_listen_to_others(settings: Settings) -> None:
    with TestClient(create_app(settings), base_url="http://127.0.0.1") as client:
        services: Services = client.app.state.services  # type: ignore[attr-defined]
        Keys(services.database).create(NewKey(name="first", scopes=[Scope.READ]))
    exposed = settings.model_copy(update={"host": "0.0.0.0"})
    auth.check_exposure(exposed)
    with TestClient(create_app(exposed), base_url="http://scanner.example") as client:
        assert client.get("/v1/jobs").status_code == 401


def test_the_audit_log_says_who_did_what_when_and_from_where(operator: TestClient) -> None:
    key = made(operator, tenant="plant-north")
    headers = {"X-API-Key": key["key"], "X-Request-Id": "station-4-17"}
    mesh = operator.post("/v1/meshes", content=b"ply", headers=headers).json()["id"]
    operator.get(f"/v1/meshes/{mesh}", headers=headers)
    operator.delete(f"/v1/meshes/{mesh}", headers=headers)
    operator.get("/v1/keys", headers=headers)
    operator.delete(f"/v1/meshes/{mesh}", headers={"X-API-Key": "wrong"})

    def entries() -> list[dict[str, Any]]:
        found: list[dict[str, Any]] = operator.get("/v1/audit").json()["items"]
        return found

    wait_until(lambda: len(entries()) == 5)
    log = [(e["operation"], e["status"], e["tenant"], e["name"]) for e in entries()]
    assert log == [
        ("delete", 401, "default", ""),
        ("list_keys", 403, "plant-north", "station 4"),
        ("delete_mesh", 204, "plant-north", "station 4"),
        ("upload_mesh", 201, "plant-north", "station 4"),
        ("create_key", 201, "default", "settings"),
    ]
    latest = entries()[2]
    assert latest["principal"] == key["id"]
    assert latest["path"] == f"/v1/meshes/{mesh}"
    assert latest["request_id"] == "station-4-17"
    assert latest["address"] == "testclient"
    assert key["key"] not in str(entries())
    page = operator.get("/v1/audit?limit=2").json()
    rest = operator.get(f"/v1/audit?limit=10&cursor={page['next_cursor']}").json()
    assert [*page["items"], *rest["items"]] == entries()


def test_a_job_keeps_the_name_of_the_key_that_asked_for_it(operator: TestClient) -> None:
    smooth = {"method": {"method": "smooth"}}
    key = made(operator, scopes=["upload", "repair", "models"])["key"]
    for headers in ({"X-API-Key": OPERATOR_KEY}, {"X-API-Key": key}):
        mesh = operator.post("/v1/meshes", content=b"ply\nformat ascii 1.0\nend_header\n", headers=headers).json()["id"]
        for path, body in (
            ("/v1/jobs", {"mesh_id": mesh, **smooth}),
            ("/v1/batches", {"mesh_ids": [mesh], "spec": smooth}),
            ("/v1/trainings", {"meshes": [mesh], "model": "castings"}),
        ):
            answer = operator.post(path, json=body, headers=headers)
            assert answer.status_code == 202, answer.text
    services: Services = operator.app.state.services  # type: ignore[attr-defined]
    with services.database.read() as session:
        names = list(session.scalars(select(JobRow.asked_by).order_by(JobRow.id)))
    assert names == ["settings"] * 3 + ["station 4"] * 3


def test_requests_without_a_key_can_not_fill_the_audit_log(operator: TestClient) -> None:
    for number in range(5):
        assert operator.delete("/v1/meshes/x", headers={"X-API-Key": f"wrong {number}"}).status_code == 401
    operator.delete("/v1/keys/key_01jd7z3v5qk8m2x4c6b8n0a9de")
    wait_until(lambda: "revoke_key" in [entry["operation"] for entry in operator.get("/v1/audit").json()["items"]])
    assert [entry["status"] for entry in operator.get("/v1/audit").json()["items"]] == [404, 401]


def test_old_entries_of_the_audit_log_are_removed(operator: TestClient) -> None:
    made(operator)
    wait_until(lambda: len(operator.get("/v1/audit").json()["items"]) == 1)
    services: Services = operator.app.state.services  # type: ignore[attr-defined]
    assert forget_audit(services.database, 1.0, lambda: False) == ""
    assert forget_audit(services.database, -1.0, lambda: False) == "removed 1 entries of the audit log"
    assert operator.get("/v1/audit").json()["items"] == []

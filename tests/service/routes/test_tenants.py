"""Tenants, quotas and limits over HTTP: `service/routes/tenants.py`, `service/routes/limits.py`.

Also `service/full_tenants.py`, `jobkit/access/tenants.py` and `quadpatch_client/schema/tenants.py`.
"""

import hashlib
import platform
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import pytest
from pydantic import SecretStr
from starlette.testclient import TestClient

from jobkit.settings import Settings
from jobkit.version import VERSION
from service import shares
from service.app import create_app

OPERATOR_KEY = "the-key-of-the-operator"
TENANT = "plant-north"
PLY = b"ply\nformat ascii 1.0\ncomment %d\nend_header\n"
TUS = {"Tus-Resumable": "1.0.0"}


@dataclass
class Site:
    client: TestClient
    key: str

    def operator(self, method: str, path: str, **rest: Any) -> Any:
        return self.client.request(method, path, headers={"X-API-Key": OPERATOR_KEY}, **rest)

    def tenant(self, method: str, path: str, headers: dict[str, str] | None = None, **rest: Any) -> Any:
        return self.client.request(method, path, headers={"X-API-Key": self.key, **(headers or {})}, **rest)

    def mesh(self, number: int = 0) -> Any:
        return self.tenant("POST", "/v1/meshes", content=PLY % number)

    def mesh_id(self, number: int) -> str:
        return hashlib.sha256(PLY % number).hexdigest()

    def set(self, **quotas: int | bool | None) -> Any:
        answer = self.operator("PATCH", f"/v1/tenants/{TENANT}", json=quotas)
        assert answer.status_code == 200, answer.text
        return answer.json()


@pytest.fixture
def site(settings: Settings, monkeypatch: pytest.MonkeyPatch) -> Iterator[Site]:
    monkeypatch.setattr(shares, "_KNOWN_FOR_S", 0.0)
    keyed = settings.model_copy(update={"api_keys": SecretStr(OPERATOR_KEY)})
    with TestClient(create_app(keyed), base_url="http://127.0.0.1") as client:
        new = {"name": "station", "tenant": TENANT, "scopes": ["read", "upload", "repair", "models", "admin"]}
        key = client.post("/v1/keys", json=new, headers={"X-API-Key": OPERATOR_KEY}).json()["key"]
        yield Site(client, key)


def refusal(answer: Any) -> tuple[int, str, dict[str, int] | None]:
    return answer.status_code, answer.json()["code"], answer.json().get("quota")


def test_the_operator_sets_what_a_tenant_may_have_and_sees_what_it_has(site: Site, settings: Settings) -> None:
    shown = site.set(jobs_waiting=7, streams=0)
    assert shown["own_quotas"] == ["jobs_waiting", "streams"]
    assert shown["quotas"] == {
        "stored_bytes": settings.tenant_stored_mb << 20,
        "jobs_waiting": 7,
        "jobs_at_once": 0,
        "streams": 0,
        "requests_per_minute": settings.tenant_requests_per_minute,
    }
    size = site.mesh().json()["size_bytes"]
    assert site.operator("GET", f"/v1/tenants/{TENANT}").json()["use"]["stored_bytes"] == size
    # What is left out stays, null goes back to the default.
    assert site.set(jobs_waiting=None)["own_quotas"] == ["streams"]
    names = [tenant["name"] for tenant in site.operator("GET", "/v1/tenants").json()["items"]]
    assert names == ["default", TENANT]
    assert site.operator("GET", "/v1/tenants/unknown").json()["code"] == "tenant_not_found"
    assert site.operator("PATCH", "/v1/tenants/unknown", json={}).json()["name"] == "unknown"


@pytest.mark.parametrize(
    "changes",
    [{"jobs_waiting": -1}, {"jobs_waiting": "many"}, {"jobs": 1}, {"streams": 1.5}, {"stored_bytes": 2**53}],
)
def test_what_is_no_quota_is_refused(site: Site, changes: dict[str, Any]) -> None:
    assert site.operator("PATCH", f"/v1/tenants/{TENANT}", json=changes).status_code == 422


def test_tenants_are_the_operators(site: Site) -> None:
    for method, path, body in (
        ("GET", "/v1/tenants", None),
        ("GET", f"/v1/tenants/{TENANT}", None),
        ("PATCH", f"/v1/tenants/{TENANT}", {"jobs_waiting": 0}),
    ):
        refused = site.tenant(method, path, json=body)
        assert (refused.status_code, refused.json()["code"]) == (403, "foreign_tenant")


def test_a_disabled_tenant_is_refused_until_it_is_let_in_again(site: Site) -> None:
    site.set(disabled=True)
    refused = site.tenant("GET", "/v1/jobs")
    assert (refused.status_code, refused.json()["code"]) == (403, "tenant_disabled")
    assert site.set(jobs_waiting=1)["disabled"] is True
    site.set(disabled=False)
    assert site.tenant("GET", "/v1/jobs").status_code == 200
    kept = site.operator("PATCH", "/v1/tenants/default", json={"disabled": True})
    assert (kept.status_code, kept.json()["code"]) == (409, "operator_tenant")


def test_jobs_over_the_quota_are_refused_and_may_come_later(site: Site) -> None:
    mesh_id = site.mesh().json()["id"]
    site.set(jobs_waiting=2)
    jobs = [site.tenant("POST", "/v1/jobs", json={"mesh_id": mesh_id}) for _ in range(3)]
    assert [job.status_code for job in jobs] == [202, 202, 429]
    assert refusal(jobs[2]) == (429, "quota_jobs", {"limit": 2, "used": 2})
    assert int(jobs[2].headers["retry-after"]) > 0
    assert jobs[2].json()["retryable"] is True
    site.tenant("POST", f"/v1/jobs/{jobs[0].json()['id']}/cancel")
    assert site.tenant("POST", "/v1/jobs", json={"mesh_id": mesh_id}).status_code == 202


def test_an_earlier_job_is_shown_again_whatever_the_quota(site: Site) -> None:
    mesh_id = site.mesh().json()["id"]
    site.set(jobs_waiting=1)
    headers = {"Idempotency-Key": "order-17"}
    first, again = (
        site.tenant("POST", "/v1/jobs", json={"mesh_id": mesh_id}, headers=headers).json()["id"] for _ in range(2)
    )
    assert first == again


def test_files_over_the_quota_are_refused_for_good(site: Site, dictionary_bytes: Callable[[int], bytes]) -> None:
    size = site.mesh(1).json()["size_bytes"]
    site.set(stored_bytes=2 * size + 10)
    assert site.mesh(2).status_code == 201
    refused = site.mesh(3)
    assert refusal(refused) == (507, "quota_bytes", {"limit": 2 * size + 10, "used": 2 * size})
    assert "retry-after" not in refused.headers
    assert refused.json()["retryable"] is False
    assert refusal(site.tenant("POST", "/v1/models/m/versions", content=dictionary_bytes(1)))[:2] == (
        507,
        "quota_bytes",
    )
    started = site.tenant("POST", "/v1/uploads", headers={**TUS, "Upload-Length": "11"})
    assert refusal(started)[:2] == (507, "quota_bytes")
    started = site.tenant("POST", "/v1/uploads", headers={**TUS, "Upload-Length": "10"})
    assert started.status_code == 201
    # The upload counts as large as it is to be.
    assert refusal(site.tenant("POST", "/v1/jobs", json={"mesh_id": site.mesh_id(1)}))[1] == "quota_bytes"
    site.tenant("DELETE", started.json()["links"]["self"], headers=TUS)
    assert site.tenant("POST", "/v1/jobs", json={"mesh_id": site.mesh_id(1)}).status_code == 202


def test_a_tenant_that_is_full_starts_no_job_and_its_room_is_looked_at_every_few_seconds(site: Site) -> None:
    mesh = site.mesh(1).json()
    job, size = {"mesh_id": mesh["id"]}, mesh["size_bytes"]
    site.set(stored_bytes=size + 10)
    assert site.tenant("POST", "/v1/jobs", json=job).status_code == 202
    site.set(stored_bytes=size)
    assert site.tenant("POST", "/v1/jobs", json=job).status_code == 202
    services: Any = site.client.app.state.services  # type: ignore[attr-defined]
    services.full_tenants._have_room.clear()
    assert refusal(site.tenant("POST", "/v1/jobs", json=job)) == (507, "quota_bytes", {"limit": size, "used": size})


def test_a_body_that_does_not_say_its_length_is_held_to_the_quota_when_it_is_here(site: Site) -> None:
    site.set(stored_bytes=10)
    refused = site.tenant("POST", "/v1/meshes", content=iter([PLY % 1]))
    assert refusal(refused)[:2] == (507, "quota_bytes")
    assert site.tenant("GET", "/v1/meshes").json()["items"] == []


def test_streams_over_the_quota_are_refused(site: Site) -> None:
    mesh_id = site.mesh().json()["id"]
    job = site.tenant("POST", "/v1/jobs", json={"mesh_id": mesh_id}).json()
    services: Any = site.client.app.state.services  # type: ignore[attr-defined]
    site.set(streams=1)
    lease = services.streams._leases.take(TENANT)
    refused = site.tenant("GET", job["links"]["events"], headers={"Accept": "text/event-stream"})
    assert refusal(refused) == (429, "quota_streams", {"limit": 1, "used": 1})
    assert refused.headers["retry-after"]
    services.streams._leases.give_back(lease)
    site.tenant("POST", f"/v1/jobs/{job['id']}/cancel")
    # Whole, and gone: its place is free again.
    for _ in range(2):
        opened = site.tenant("GET", job["links"]["events"], headers={"Accept": "text/event-stream"})
        assert "event: canceled" in opened.text


def test_a_caller_is_told_what_limits_it(site: Site, settings: Settings) -> None:
    site.set(requests_per_minute=0, jobs_waiting=5)
    mesh_id = site.mesh().json()["id"]
    site.tenant("POST", "/v1/jobs", json={"mesh_id": mesh_id})
    limits = site.tenant("GET", "/v1/limits").json()
    assert (limits["tenant"], limits["rate"], limits["quotas"]["jobs_waiting"]) == (TENANT, None, 5)
    assert (limits["use"]["jobs_waiting"], limits["use"]["jobs_at_work"]) == (1, 0)
    assert limits["bodies"] == {"mesh": settings.max_upload_mb << 20, "json_body": settings.max_json_kb << 10}
    assert limits["jobs"]["memory_mb"] == settings.job_memory_limit_mb
    assert {"ply", "stl", "3mf"} <= set(limits["formats_read"])
    assert "gltf" not in limits["formats_written"]
    site.set(requests_per_minute=100)
    limits = site.tenant("GET", "/v1/limits").json()
    assert limits["rate"] == {"name": "tenant", "requests": 100, "window_s": 60}


def test_every_key_may_ask_for_limits_and_version_and_none_without_one(site: Site) -> None:
    new = {"name": "sender", "tenant": TENANT, "scopes": ["upload"]}
    sender = site.operator("POST", "/v1/keys", json=new).json()["key"]
    for path in ("/v1/limits", "/v1/version"):
        assert site.client.get(path, headers={"X-API-Key": sender}).status_code == 200
        assert site.client.get(path).status_code == 401
    version = site.tenant("GET", "/v1/version").json()
    assert version == {"version": VERSION, "api": "v1", "python": platform.python_version()}

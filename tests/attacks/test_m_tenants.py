"""What one tenant may learn of another: nothing (`jobkit/database/tenancy.py`).

Every route is tried with the key of a foreign tenant.
"""

import contextlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import pytest
from pydantic import SecretStr
from sqlalchemy import create_engine, select
from sqlalchemy.exc import OperationalError
from sqlalchemy.orm import DeclarativeBase, Mapped, mapped_column
from sqlalchemy.pool import StaticPool
from starlette.testclient import TestClient

from jobkit.database.tables import MeshRow
from jobkit.database.tenancy import Owned, TenantSession
from jobkit.settings import Settings
from quadpatch_client.schema import JobResult, ResultFile
from service.app import create_app
from service.scopes import OF_ALL, OPERATIONS, PUBLIC, scopes_of
from service.services import Services
from tests.service.conftest import FILES

OPERATOR_KEY = "the-key-of-the-operator"
OWN, FOREIGN = "plant-north", "plant-south"
HOOK = "https://93.184.216.34/hook"
SMOOTH = {"method": {"method": "smooth"}}


@dataclass
class Plants:
    """Two tenants, and what one of them has."""

    client: TestClient
    keys: dict[str, str]
    ids: dict[str, str]
    dictionary: Callable[[int], bytes]

    def call(self, tenant: str, method: str, path: str, **rest: Any) -> Any:
        headers = {"X-API-Key": self.keys[tenant], **rest.pop("headers", {})}
        return self.client.request(method, path.format(**self.ids), headers=headers, **rest)


@pytest.fixture
def plants(settings: Settings, dictionary_bytes: Callable[[int], bytes]) -> Iterator[Plants]:
    keyed = settings.model_copy(update={"api_keys": SecretStr(OPERATOR_KEY)})
    with TestClient(create_app(keyed), base_url="http://127.0.0.1") as client:
        keys = {"default": OPERATOR_KEY}
        for tenant in (OWN, FOREIGN):
            new = {"name": "station", "tenant": tenant, "scopes": ["read", "upload", "repair", "models", "admin"]}
            made = client.post("/v1/keys", json=new, headers={"X-API-Key": OPERATOR_KEY})
            assert made.status_code == 201, made.text
            keys[tenant] = made.json()["key"]
        plants = Plants(client, keys, {}, dictionary_bytes)
        _fill(plants)
        yield plants


def _fill(plants: Plants) -> None:
    """Let the one tenant have one of everything."""
    services: Services = plants.client.app.state.services  # type: ignore[attr-defined]
    mesh = plants.call(OWN, "POST", "/v1/meshes?filename=secret.ply", content=b"ply\nformat ascii 1.0\nend_header\n")
    assert mesh.status_code == 201, mesh.text
    plants.ids["mesh_id"] = mesh.json()["id"]
    job = plants.call(OWN, "POST", "/v1/jobs", json={"mesh_id": mesh.json()["id"], "method": {"method": "smooth"}})
    assert job.status_code == 202, job.text
    plants.ids["job_id"] = job.json()["id"]
    _finish(services, job.json()["id"])
    version = plants.call(
        OWN, "POST", "/v1/models/scales/versions", content=plants.dictionary(1), headers={"Prefer": "wait=0"}
    )
    assert version.status_code == 202, version.text
    services.proofs.accept(services.proofs.start(f"{OWN}/scales@1", "test", 30))
    alias = plants.call(OWN, "PUT", "/v1/aliases/candidate", json={"model": "scales@1"})
    assert alias.status_code == 200, alias.text
    plants.ids |= {"name": "scales", "version": "1", "alias": "candidate"}
    _fill_more(plants)


def _fill_more(plants: Plants) -> None:
    """Add what names the mesh, and what names nothing."""
    mesh_ids = [plants.ids["mesh_id"]]
    batch = plants.call(OWN, "POST", "/v1/batches", json={"mesh_ids": mesh_ids, "spec": SMOOTH})
    assert batch.status_code == 202, batch.text
    plants.ids["batch_id"] = batch.json()["id"]
    training = plants.call(OWN, "POST", "/v1/trainings", json={"model": "reliefs", "meshes": mesh_ids})
    assert training.status_code == 202, training.text
    plants.ids["training_id"] = training.json()["id"]
    rule = plants.call(OWN, "PUT", "/v1/rules/scales", json={"acceptance": {"min_confidence": 0.5}})
    assert rule.status_code == 201, rule.text
    plants.ids["reference"] = "scales"
    shadow = plants.call(OWN, "PUT", "/v1/shadows/scales", json={"candidate": "scales@1"})
    assert shadow.status_code == 200, shadow.text
    webhook = plants.call(OWN, "POST", "/v1/webhooks", json={"url": HOOK, "events": ["job.succeeded"]})
    assert webhook.status_code == 201, webhook.text
    plants.ids["webhook_id"] = webhook.json()["id"]
    delivery = plants.call(OWN, "POST", "/v1/webhooks/{webhook_id}/test")
    plants.ids["delivery_id"] = delivery.json()["id"]
    upload = plants.call(OWN, "POST", "/v1/uploads", headers={**TUS, "Upload-Length": "5"})
    assert upload.status_code == 201, upload.text
    plants.ids["upload_id"] = upload.json()["id"]
    plants.ids["key_id"] = plants.call(OWN, "GET", "/v1/keys").json()["items"][0]["id"]


def _finish(services: Services, job_id: str) -> None:
    attempt = services.attempts.start(job_id, "test", 30).attempt
    files = []
    for role, name, data in FILES:
        with services.store.writer("results") as writer:
            writer.write(data)
            stored = writer.commit()
        facts = {"media_type": "application/octet-stream", "size_bytes": len(data), "sha256": stored.sha256}
        files.append(ResultFile.model_validate({"role": role, "name": name, **facts}))
    services.attempts.publish(attempt, JobResult(format="ply", files=files))


BODIES: dict[str, Any] = {
    "create_job": {"mesh_id": "{mesh_id}"},
    "rerun_job": {},
    "create_batch": {"mesh_ids": ["{mesh_id}"]},
    "create_training": {"model": "stolen", "meshes": ["{mesh_id}"]},
    "set_alias": {"model": "scales@1"},
    "set_shadow": {"candidate": "scales@1"},
    "dry_run_rule": {"mesh_id": "{mesh_id}"},
    "deprecate_model_version": {"reason": "x"},
    "change_webhook": {"enabled": False},
    "change_key": {"requests_per_minute": 1},
}
TUS = {"Tus-Resumable": "1.0.0"}
HEADERS = {
    "delete_upload": TUS,
    "continue_upload": {**TUS, "Upload-Offset": "0", "Content-Type": "application/offset+octet-stream"},
}
# What may be answered otherwise than by 404: what has no id of another tenant in it.
LISTS = {
    "list_jobs": "items",
    "list_meshes": "items",
    "list_batches": "items",
    "list_models": "models",
    "list_trainings": "items",
    "list_rules": "items",
    "list_shadows": "items",
    "list_webhooks": "items",
    "list_keys": "items",
    "list_audit": "items",
}
MAKES = {"describe_uploads", "create_upload", "upload_mesh", "repair", "publish_model", "metrics"}
MAKES |= {"create_key", "create_webhook", "get_limits", "get_version", "renew_callback_secret", "save_rule"}
# The operator's own: 403 for the keys of all others, whatever tenant is named.
OPERATORS = {"list_tenants", "get_tenant", "change_tenant"}


@dataclass(frozen=True)
class Route:
    name: str
    method: str
    path: str


def _routes() -> list[Route]:
    paths = create_app(Settings.model_construct()).openapi()["paths"]
    routes = [
        Route(item["operationId"], method, path) for path, items in paths.items() for method, item in items.items()
    ]
    return [route for route in routes if route.name not in PUBLIC]


def _body(operation: str, ids: dict[str, str]) -> dict[str, Any] | None:
    fields = BODIES.get(operation)
    known = {"{mesh_id}": ids["mesh_id"]}
    filled = {
        name: [known[entry] for entry in value] if isinstance(value, list) else known.get(str(value), value)
        for name, value in (fields or {}).items()
    }
    return None if fields is None else filled


def test_every_operation_has_a_scope() -> None:
    names = [route.name for route in _routes()]
    assert len(names) > 40
    assert [name for name in names if scopes_of(name) is None] == []
    known = [name for operations in OPERATIONS.values() for name in operations]
    assert sorted([*known, *OF_ALL]) == sorted(set(names))


def test_a_foreign_key_finds_nothing_on_any_route(plants: Plants) -> None:
    answers = {}
    for route in _routes():
        if route.name in LISTS or route.name in MAKES or route.name in OPERATORS:
            continue
        body = _body(route.name, plants.ids)
        headers = HEADERS.get(route.name, {})
        answers[route.name] = plants.call(FOREIGN, route.method, route.path, json=body, headers=headers)
    assert len(answers) > 30
    wrong = {name: answer.status_code for name, answer in answers.items() if answer.status_code != 404}
    assert wrong == {}
    for answer in answers.values():
        assert answer.json()["code"].endswith("_not_found")
    # Nothing of it has changed.
    for path in ("/v1/jobs/{job_id}", "/v1/meshes/{mesh_id}", "/v1/models/scales", "/v1/uploads/{upload_id}"):
        assert plants.call(OWN, "GET", path).status_code == 200
    assert plants.call(OWN, "GET", "/v1/webhooks/{webhook_id}").json()["enabled"] is True
    assert plants.call(OWN, "GET", "/v1/batches/{batch_id}").json()["state"] == "running"


def test_a_foreign_key_lists_and_counts_nothing(plants: Plants) -> None:
    paths = {route.name: route.path for route in _routes()}
    for name, field in LISTS.items():
        own, foreign = (plants.call(tenant, "GET", paths[name]).json()[field] for tenant in (OWN, FOREIGN))
        if name in ("list_jobs", "list_meshes", "list_batches", "list_webhooks"):
            assert foreign == []
        assert own
        names = [item.get("id") or item.get("name") for item in own if not item.get("versions", [{}])[0].get("shared")]
        assert not {item.get("id") or item.get("name") for item in foreign} & set(names)
    models = plants.call(FOREIGN, "GET", "/v1/models").json()
    assert "candidate" not in [alias["alias"] for alias in models["aliases"]]
    assert all(version["shared"] for model in models["models"] for version in model["versions"])


def test_the_same_bytes_are_new_to_another_tenant_and_stay_when_one_deletes_them(plants: Plants) -> None:
    again = plants.call(FOREIGN, "POST", "/v1/meshes", content=b"ply\nformat ascii 1.0\nend_header\n")
    assert again.status_code == 201
    assert again.json()["id"] == plants.ids["mesh_id"]
    assert again.json()["filename"] is None
    assert plants.call(FOREIGN, "DELETE", "/v1/meshes/{mesh_id}").status_code == 204
    assert plants.call(OWN, "GET", "/v1/meshes/{mesh_id}").json()["filename"] == "secret.ply"
    assert plants.call(OWN, "GET", "/v1/meshes/{mesh_id}/content").content.startswith(b"ply")


def test_no_result_of_another_tenant_is_taken_over(plants: Plants) -> None:
    content = b"ply\nformat ascii 1.0\nend_header\n"
    assert plants.call(FOREIGN, "POST", "/v1/meshes", content=content).status_code == 201
    spec = {"mesh_id": plants.ids["mesh_id"], **SMOOTH}
    own, foreign = (plants.call(tenant, "POST", "/v1/jobs", json=spec) for tenant in (OWN, FOREIGN))
    assert own.json()["mesh_id"] == foreign.json()["mesh_id"]
    assert foreign.headers["Cache-Status"] == "quadpatch; fwd=miss"


def test_a_batch_of_a_tenant_takes_its_own_meshes_alone(plants: Plants) -> None:
    made = plants.call(FOREIGN, "POST", "/v1/batches", json={"filter": {}, "spec": SMOOTH})
    assert (made.status_code, made.json()["code"]) == (409, "batch_size")


def test_two_tenants_may_have_models_and_aliases_of_one_name(plants: Plants) -> None:
    other = plants.dictionary(7)
    made = plants.call(FOREIGN, "POST", "/v1/models/scales/versions", content=other, headers={"Prefer": "wait=0"})
    assert (made.status_code, made.json()["version"]) == (202, 1)
    artifacts = [
        plants.call(tenant, "GET", "/v1/models/scales/versions/1/artifact").content for tenant in (OWN, FOREIGN)
    ]
    assert artifacts[0] != artifacts[1] == other


def test_tenants_use_what_the_operator_shares_and_may_not_change_it(plants: Plants) -> None:
    shared = plants.call(
        "default",
        "POST",
        "/v1/models/parts/versions?shared=true",
        content=plants.dictionary(3),
        headers={"Prefer": "wait=0"},
    )
    assert shared.json()["shared"] is True
    assert plants.call(FOREIGN, "GET", "/v1/models/parts").status_code == 200
    for method, path, body in (
        ("PUT", "/v1/models/parts/versions/1/deprecation", {"reason": ""}),
        ("DELETE", "/v1/models/parts/versions/1", None),
    ):
        refused = plants.call(FOREIGN, method, path, json=body)
        assert (refused.status_code, refused.json()["code"]) == (409, "shared_model")
    taken = plants.call(FOREIGN, "POST", "/v1/models/parts/versions", content=plants.dictionary(4))
    assert (taken.status_code, taken.json()["code"]) == (409, "name_taken")
    sharing = plants.call(FOREIGN, "POST", "/v1/models/mine/versions?shared=true", content=plants.dictionary(4))
    assert sharing.json()["code"] == "shared_model"


def test_what_a_shared_alias_points_to_is_shared_with_it(plants: Plants) -> None:
    services: Services = plants.client.app.state.services  # type: ignore[attr-defined]
    wait = {"Prefer": "wait=0"}
    for seed, name in ((5, "general"), (6, "better")):
        plants.call("default", "POST", f"/v1/models/{name}/versions", content=plants.dictionary(seed), headers=wait)
        services.proofs.accept(services.proofs.start(f"{name}@1", "test", 30))
    services.registry.set_alias("default", "general")
    assert plants.call(FOREIGN, "GET", "/v1/models/general").status_code == 200
    assert plants.call(FOREIGN, "GET", "/v1/models/better").status_code == 404
    assert plants.call("default", "PUT", "/v1/aliases/default", json={"model": "better"}).json()["shared"] is True
    job = {"mesh_id": plants.ids["mesh_id"], "method": {"method": "dictionary"}}
    assert plants.call(OWN, "POST", "/v1/jobs", json=job).json()["model"]["name"] == "better"


def test_a_version_is_shared_later_by_publishing_it_again(plants: Plants) -> None:
    path, content = "/v1/models/parts/versions", plants.dictionary(3)
    for query, status in (("", 404), ("?shared=true", 200), ("", 200)):
        plants.call("default", "POST", path + query, content=content, headers={"Prefer": "wait=0"})
        assert plants.call(FOREIGN, "GET", "/v1/models/parts").status_code == status


def test_tables_of_modules_that_are_loaded_late_are_limited_too() -> None:
    class OtherBase(DeclarativeBase):
        pass

    engine = create_engine("sqlite://", poolclass=StaticPool)
    with TenantSession(engine, info={"tenant": OWN}) as session:
        with contextlib.suppress(OperationalError):
            session.scalars(select(MeshRow)).all()

        class LateRow(Owned, OtherBase):
            __tablename__ = "late"
            id: Mapped[int] = mapped_column(primary_key=True)

        OtherBase.metadata.create_all(engine)
        session.add_all([LateRow(id=1), LateRow(id=2, tenant=FOREIGN)])
        session.flush()
        assert list(session.scalars(select(LateRow.id))) == [1]


def test_a_key_does_what_its_scopes_say_and_no_more(plants: Plants) -> None:
    looker = plants.call(OWN, "POST", "/v1/keys", json={"name": "screen", "scopes": ["read"]}).json()
    plants.keys["looker"] = looker["key"]
    assert plants.call("looker", "GET", "/v1/jobs/{job_id}").status_code == 200
    for method, path, body in (
        ("POST", "/v1/meshes", None),
        ("DELETE", "/v1/jobs/{job_id}", None),
        ("GET", "/v1/keys", None),
        ("GET", "/metrics", None),
        ("PUT", "/v1/aliases/candidate", {"model": "scales@1"}),
    ):
        refused = plants.call("looker", method, path, json=body)
        assert (refused.status_code, refused.json()["code"]) == (403, "scope_missing"), path


def test_tenants_and_their_quotas_are_the_operators(plants: Plants) -> None:
    routes = [route for route in _routes() if route.name in OPERATORS]
    assert len(routes) == len(OPERATORS)
    for route in routes:
        path = route.path.replace("{tenant}", OWN)
        body: dict[str, Any] | None = {} if route.method == "patch" else None
        refused = plants.call(FOREIGN, route.method, path, json=body)
        assert (refused.status_code, refused.json()["code"]) == (403, "foreign_tenant")
    own = plants.call(FOREIGN, "GET", "/v1/limits").json()
    assert (own["tenant"], own["use"]["stored_bytes"], own["use"]["jobs_waiting"]) == (FOREIGN, 0, 0)


def test_metrics_count_all_tenants_and_are_the_operators(plants: Plants) -> None:
    refused = plants.call(OWN, "GET", "/metrics")
    assert (refused.status_code, refused.json()["code"]) == (403, "foreign_tenant")
    assert plants.call("default", "GET", "/metrics").status_code == 200


def test_a_key_of_a_tenant_makes_keys_of_that_tenant_alone(plants: Plants) -> None:
    refused = plants.call(OWN, "POST", "/v1/keys", json={"name": "x", "tenant": FOREIGN})
    assert (refused.status_code, refused.json()["code"]) == (403, "foreign_tenant")
    assert plants.call(OWN, "POST", "/v1/keys", json={"name": "x"}).json()["tenant"] == OWN


def test_a_worker_repairs_the_mesh_of_the_tenant_with_its_model(plants: Plants) -> None:
    method = {"method": "dictionary", "model": "candidate"}
    job = plants.call(OWN, "POST", "/v1/jobs", json={"mesh_id": plants.ids["mesh_id"], "method": method})
    assert job.status_code == 202, job.text
    assert (job.json()["model"]["name"], job.json()["model"]["version"]) == ("scales", 1)
    services: Services = plants.client.app.state.services  # type: ignore[attr-defined]
    started = services.attempts.start(job.json()["id"], "test", 30)
    assert started.tenant == OWN
    owned = services.of(started.tenant)
    assert owned.meshes.source(started.job.mesh_id).sha256 == plants.ids["mesh_id"]
    assert owned.registry.artifact("scales", 1).format == "safetensors"

"""Also tests `service.rules` and `quadpatch_client.schema.rules`."""

from collections.abc import Callable
from typing import Any

import pytest
from starlette.testclient import TestClient

CASTINGS = {
    "holes": {"rules": [{"min_diameter": 5.0, "action": "skip"}, {"max_diameter": 1.5, "action": "smooth"}]},
    "method": {"method": "auto", "effort": "fast"},
    "acceptance": {"max_expected_error": 0.1, "otherwise": "fail"},
}


@pytest.fixture
def rule(client: TestClient) -> Any:
    answer = client.put("/v1/rules/castings", json=CASTINGS)
    assert answer.status_code == 201, answer.text
    return answer.json()


def test_a_rule_is_saved_by_name_with_versions(client: TestClient, rule: Any) -> None:
    assert (rule["name"], rule["version"], rule["content"]["description"]) == ("castings", 1, "")
    assert client.put("/v1/rules/castings", json=CASTINGS).status_code == 200
    second = client.put("/v1/rules/castings", json={**CASTINGS, "description": "line 2"})
    assert (second.status_code, second.headers["location"]) == (201, "/v1/rules/castings/versions/2")
    assert client.get("/v1/rules/castings").json() == second.json()
    assert client.get(rule["links"]["self"]).json() == rule
    assert [item["version"] for item in client.get(rule["links"]["versions"]).json()["items"]] == [2, 1]
    assert [item["version"] for item in client.get("/v1/rules").json()["items"]] == [2]
    assert client.delete("/v1/rules/castings").status_code == 204
    for path in ("/v1/rules/castings", rule["links"]["self"], rule["links"]["versions"]):
        answer = client.get(path)
        assert (answer.status_code, answer.json()["code"]) == (404, "rule_not_found")


def test_a_job_that_names_a_rule_is_pinned_to_what_it_says_now(client: TestClient, mesh_id: str, rule: Any) -> None:
    body, key = {"mesh_id": mesh_id, "rule": "castings"}, {"Idempotency-Key": "a"}
    first = client.post("/v1/jobs", json=body, headers=key)
    assert first.status_code == 202, first.text
    spec = first.json()["spec"]
    assert spec["rule"] == "castings@1"
    for name in ("holes", "method", "acceptance"):
        assert spec[name] == rule["content"][name]
    client.put("/v1/rules/castings", json={"acceptance": {"min_confidence": 0.5}})
    assert client.post("/v1/jobs", json=body, headers=key).json()["id"] == first.json()["id"]
    later = client.post("/v1/jobs", json=body).json()["spec"]
    assert (later["rule"], later["acceptance"]["min_confidence"]) == ("castings@2", 0.5)
    old = client.post("/v1/jobs", json={"mesh_id": mesh_id, "rule": "castings@1"}).json()["spec"]
    assert old["acceptance"] == spec["acceptance"]


def test_a_rerun_keeps_the_version_and_takes_another_rule_or_none(client: TestClient, mesh_id: str, rule: Any) -> None:
    job = client.post("/v1/jobs", json={"mesh_id": mesh_id, "rule": "castings"}).json()
    client.put("/v1/rules/castings", json={})
    again = client.post(f"/v1/jobs/{job['id']}/rerun").json()["spec"]
    assert (again["rule"], again["acceptance"]) == ("castings@1", rule["content"]["acceptance"])
    conflicting = client.post(f"/v1/jobs/{job['id']}/rerun", json={"method": {"method": "smooth"}})
    assert (conflicting.status_code, conflicting.json()["code"]) == (422, "options_conflict")
    free = client.post(f"/v1/jobs/{job['id']}/rerun", json={"rule": None, "method": {"method": "smooth"}})
    assert (free.status_code, free.json()["spec"]["rule"]) == (202, None)


@pytest.mark.parametrize(
    "said",
    [{"holes": {"max_diameter": 3.0}}, {"method": {"method": "smooth"}}, {"acceptance": {"min_confidence": 0.9}}],
)
def test_what_a_rule_says_is_not_said_twice(client: TestClient, mesh_id: str, rule: Any, said: dict[str, Any]) -> None:
    answer = client.post("/v1/jobs", json={"mesh_id": mesh_id, "rule": rule["name"], **said})
    assert (answer.status_code, answer.json()["code"]) == (422, "options_conflict")
    assert answer.json()["detail"] == f"{next(iter(said))} is for the rule castings to say: drop one of the two"
    kept = {name: CASTINGS[name] for name in said}
    assert client.post("/v1/jobs", json={"mesh_id": mesh_id, "rule": rule["name"], **kept}).status_code == 202


def test_rules_go_with_fills_alone(client: TestClient, mesh_id: str, rule: Any) -> None:
    fields: list[dict[str, Any]] = [{"rule": rule["name"]}, {"acceptance": {}}]
    for field in fields:
        answer = client.post("/v1/jobs", json={"mesh_id": mesh_id, "task": "denoise", **field})
        assert (answer.status_code, answer.json()["code"]) == (422, "options_conflict")
    missing = client.post("/v1/jobs", json={"mesh_id": mesh_id, "rule": "unknown"})
    assert (missing.status_code, missing.json()["code"]) == (404, "rule_not_found")


def test_what_excludes_itself_is_no_rule(client: TestClient) -> None:
    patches = {"preset": "type1", "length": 2.0}
    answer = client.put("/v1/rules/odd", json={"method": {"method": "auto", "patches": patches}})
    assert (answer.status_code, answer.json()["code"]) == (422, "options_conflict")
    assert client.get("/v1/rules/odd").status_code == 404


def test_a_dry_run_says_what_would_become_of_each_loop(
    client: TestClient, mesh_id: str, rule: Any, analyse: Callable[[str], None]
) -> None:
    early = client.post(rule["links"]["dry_run"], json={"mesh_id": mesh_id})
    assert (early.status_code, early.json()["code"]) == (409, "mesh_not_ready")
    analyse(mesh_id)
    client.put("/v1/rules/castings", json={})
    for reference, actions in (("castings@1", [None, "model", "smooth"]), ("castings", [None, "model", "model"])):
        tried = client.post(f"/v1/rules/{reference}/dry-run", json={"mesh_id": mesh_id}).json()
        assert [hole["action"] for hole in tried["plan"]["holes"]] == actions
        plan = client.post("/v1/jobs?dry_run=true", json={"mesh_id": mesh_id, "rule": reference}).json()
        assert tried["plan"] == plan
    assert tried["rule"] == "castings@2"
    assert client.get("/v1/jobs").json()["items"] == []
    assert client.post("/v1/rules/castings@9/dry-run", json={"mesh_id": mesh_id}).status_code == 404

"""Letter H: HTTP as the RFCs have it, the same on every route.

Also tests `service.strict_validation`.
"""

from collections.abc import Callable, Iterator

import pytest
from starlette.testclient import TestClient

from quadpatch_client.schema import Job
from service.multipart import MAX_OUTSIDE_BYTES

JSON = {"Content-Type": "application/json"}


@pytest.fixture
def paths(client: TestClient, mesh_id: str, job_id: str, finish: Callable[[str], Job]) -> list[str]:
    finish(job_id)
    job = f"/v1/jobs/{job_id}"
    meshes = [f"/v1/meshes/{mesh_id}", f"/v1/meshes/{mesh_id}/content"]
    results = [f"{job}/result", f"{job}/report", f"{job}/preview.png"]
    plain = ["/", "/healthz", "/readyz", "/openapi.json", "/openapi.yaml", "/metrics", "/v1/models", "/v1/webhooks"]
    models = ["/v1/models/general-dictionary", "/v1/models/general-dictionary/versions/1"]
    return [*plain, *models, "/v1/jobs", job, f"{job}/events", *meshes, *results]


def test_head_answers_as_get_does_without_the_content(client: TestClient, paths: list[str]) -> None:
    for path in [*paths, "/nowhere", "/v1/jobs?limit=0", "/v1/jobs/job_01jd7z3v5qk8m2x4c6b8n0a9de"]:
        get, head = client.get(path), client.head(path)
        assert (head.status_code, head.content) == (get.status_code, b""), path
        changing = {"x-request-id", "content-length"} if path in ("/metrics", "/nowhere") else {"x-request-id"}
        assert {k: v for k, v in head.headers.items() if k not in changing} == {
            k: v for k, v in get.headers.items() if k not in changing
        }, path


def test_head_of_a_stream_ends(client: TestClient, job_id: str) -> None:
    answer = client.head(f"/v1/jobs/{job_id}/events", headers={"Accept": "text/event-stream"})
    assert answer.status_code == 200
    assert answer.headers["content-type"].startswith("text/event-stream")


def test_if_match_holds_for_the_same_bytes_alone(client: TestClient, mesh_id: str) -> None:
    path = f"/v1/meshes/{mesh_id}/content"
    for tag in (f'"{mesh_id}"', "*", f'"other", "{mesh_id}"'):
        assert client.get(path, headers={"If-Match": tag}).status_code == 200
    for tag in ('"other"', f'W/"{mesh_id}"', mesh_id, ""):
        answer = client.get(path, headers={"If-Match": tag})
        assert (answer.status_code, answer.json()["code"]) == (412, "precondition_failed")


def test_a_condition_that_is_not_looked_at_is_never_taken_for_one_that_holds(client: TestClient, job_id: str) -> None:
    path = f"/v1/jobs/{job_id}"
    for method, where in (("POST", f"{path}/cancel"), ("DELETE", path), ("PUT", f"{path}/pin"), ("POST", "/v1/jobs")):
        answer = client.request(method, where, headers={"If-Match": '"1"'})
        assert (answer.status_code, answer.json()["code"]) == (412, "precondition_failed")
    assert client.get(path).json()["state"] == "queued"
    assert client.post(f"{path}/cancel", headers={"If-Match": "*"}).status_code == 200


def test_every_route_refuses_a_body_that_it_does_not_read(client: TestClient, job_id: str, mesh_id: str) -> None:
    asked = [("POST", f"/v1/jobs/{job_id}/cancel"), ("PUT", f"/v1/jobs/{job_id}/pin"), ("GET", "/v1/jobs")]
    for method, path in [*asked, ("DELETE", f"/v1/meshes/{mesh_id}"), ("GET", "/healthz")]:
        answer = client.request(method, path, content=b'{"state": "queued"}', headers=JSON)
        assert (answer.status_code, answer.json()["code"]) == (400, "unexpected_body"), path


def test_every_route_refuses_what_it_does_not_know(client: TestClient, paths: list[str]) -> None:
    for path in paths:
        assert client.get(f"{path}?unknown=1").status_code == 422, path
    for path in ("/v1/jobs?limit=1&limit=2", "/v1/jobs?label=a&label=b"):
        assert client.get(path).json()["errors"][0]["code"] == "repeated"


def test_a_rerun_changes_what_its_body_names(client: TestClient, job_id: str) -> None:
    path = f"/v1/jobs/{job_id}/rerun"
    for content in (None, b"{}"):
        again = client.post(path, content=content, headers=JSON if content else {})
        assert again.status_code == 202, again.text
        assert again.json()["spec"] == client.get(f"/v1/jobs/{job_id}").json()["spec"]
    changed = client.post(path, json={"seed": 7, "holes": {"max_diameter": 2.0}}).json()
    assert (changed["spec"]["seed"], changed["spec"]["holes"]["max_diameter"]) == (7, 2.0)
    assert changed["spec"]["method"] == {"method": "smooth"}
    assert changed["rerun_of"] == job_id
    for wrong in ({"sead": 7}, {"mesh_id": "0" * 64}, {"seed": -1}, {"holes": {"ids": [0]}, "weld_tolerance": 0.5}):
        assert client.post(path, json=wrong).status_code == 422, wrong
    assert client.post(path, content=b"seed=7").status_code == 415


def test_a_rerun_with_ids_is_checked_with_what_the_first_one_said(client: TestClient, mesh_id: str) -> None:
    spec = {"mesh_id": mesh_id, "method": {"method": "smooth"}, "holes": {"ids": [0]}}
    job = client.post("/v1/jobs", json=spec).json()["id"]
    assert client.post(f"/v1/jobs/{job}/rerun", json={"weld_tolerance": 0.5}).status_code == 422


@pytest.mark.parametrize("key", ["a-key"])
def test_a_rerun_under_one_key_with_other_changes_is_a_conflict(client: TestClient, job_id: str, key: str) -> None:
    path, headers = f"/v1/jobs/{job_id}/rerun", {"Idempotency-Key": key}
    first = client.post(path, json={"seed": 1}, headers=headers).json()
    assert client.post(path, json={"seed": 1}, headers=headers).json()["id"] == first["id"]
    assert client.post(path, json={"seed": 2}, headers=headers).json()["code"] == "idempotency_conflict"


def body_with(before: int, after: int) -> Iterator[bytes]:
    yield from (b"\r\n" * 32_768 for _ in range(before // 65_536))
    yield b'--b\r\nContent-Disposition: form-data; name="file"; filename="a.ply"\r\n\r\nply\r\n--b--\r\n'
    yield from (b"x" * 65_536 for _ in range(after // 65_536))


@pytest.mark.parametrize(("before", "after"), [(2 * MAX_OUTSIDE_BYTES, 0), (0, 2 * MAX_OUTSIDE_BYTES)])
def test_bytes_outside_of_all_parts_are_bounded(client: TestClient, before: int, after: int) -> None:
    headers = {"Content-Type": "multipart/form-data; boundary=b"}
    answer = client.post("/v1/meshes", content=body_with(before, after), headers=headers)
    assert (answer.status_code, answer.json()["code"]) == (400, "malformed_multipart")
    assert client.post("/v1/meshes", content=body_with(0, 65_536), headers=headers).status_code == 201

import hashlib
import json
from typing import Any

import pytest
from starlette.testclient import TestClient

Files = dict[str, tuple[str, bytes] | tuple[None, str, str]]
MESH = ("scan.ply", b"ply\n")


def spec(**values: Any) -> tuple[None, str, str]:
    return (None, json.dumps({"method": {"method": "smooth"}} | values), "application/json")


def test_one_request_uploads_and_starts_a_job(client: TestClient) -> None:
    answer = client.post("/v1/repairs", files={"mesh": MESH, "spec": spec(label="part 7", output={"format": "stl"})})
    job = answer.json()
    assert answer.status_code == 202
    assert answer.headers["location"] == f"/v1/jobs/{job['id']}"
    assert job["mesh_id"] == hashlib.sha256(MESH[1]).hexdigest()
    assert (job["spec"]["label"], job["spec"]["output"]["format"]) == ("part 7", "stl")
    assert client.get(f"/v1/meshes/{job['mesh_id']}").json()["filename"] == "scan.ply"


def test_the_parts_may_come_in_any_order(client: TestClient) -> None:
    answer = client.post("/v1/repairs", files=[("spec", spec(seed=3)), ("mesh", MESH)])
    assert answer.json()["spec"]["seed"] == 3


def test_without_a_spec_models_compete(client: TestClient) -> None:
    answer = client.post("/v1/repairs", files={"mesh": MESH})
    assert answer.status_code == 202
    job = answer.json()
    assert (job["model"]["kind"], job["spec"]["method"]["effort"]) == ("auto", "standard")


def test_a_repeated_key_starts_nothing_twice(client: TestClient) -> None:
    headers = {"Idempotency-Key": "order-17"}
    files: Files = {"mesh": MESH, "spec": spec()}
    first = client.post("/v1/repairs", files=files, headers=headers)
    assert client.post("/v1/repairs", files=files, headers=headers).json() == first.json()
    other = client.post("/v1/repairs", files={"mesh": ("scan.ply", b"other"), "spec": spec()}, headers=headers)
    assert (other.status_code, other.json()["code"]) == (409, "idempotency_conflict")


@pytest.mark.parametrize(
    ("request_of", "status", "code"),
    [
        ({"files": {"spec": spec()}}, 422, "invalid_request"),
        ({"files": {"mesh": MESH, "spec": (None, "{", "application/json")}}, 422, "invalid_request"),
        ({"files": {"mesh": MESH, "spec": spec(sed=1)}}, 422, "invalid_request"),
        ({"files": {"mesh": MESH, "spec": spec(mesh_id="f" * 64)}}, 422, "invalid_request"),
        ({"files": {"mesh": MESH, "spec": (None, "x" * 2_000_000)}}, 413, "body_too_large"),
        ({"files": {"mesh": MESH, "other": (None, "1")}}, 422, "invalid_request"),
        ({"content": b"ply"}, 415, "unsupported_media_type"),
        ({"json": {}}, 415, "unsupported_media_type"),
    ],
)
def test_a_request_that_makes_no_sense_is_refused(
    client: TestClient, request_of: dict[str, Any], status: int, code: str
) -> None:
    answer = client.post("/v1/repairs", **request_of)
    assert (answer.status_code, answer.json()["code"]) == (status, code)


def test_a_wrong_field_of_the_spec_is_pointed_at(client: TestClient) -> None:
    answer = client.post("/v1/repairs", files={"mesh": MESH, "spec": spec(holes={"max_diameter": -1})})
    assert [error["pointer"] for error in answer.json()["errors"]] == ["/spec/holes/max_diameter"]

"""Tests `service.mesh_checks` and `service.plan_summary`: jobs whose task is not to fill holes."""

import json
from collections.abc import Callable
from typing import Any

import pytest
from starlette.testclient import TestClient

from quadpatch_client.schema import TASKS, MeshFacts, MeshProblem, ModelVersion
from quadpatch_rules.tasks import TRAIN
from service.services import Services

Publish = Callable[..., ModelVersion]
Settle = Callable[..., None]
NAN: dict[str, Any] = {"task": "restore", "restore": {"missing": {"kind": "nan"}}}
DENOISE: dict[str, Any] = {"task": "denoise"}
SELF: dict[str, Any] = {"method": "dictionary", "model": "self"}
DECODE: dict[str, Any] = {"task": "decode"}
BOX: dict[str, Any] = {"kind": "box", "min": [0, 0, 0], "max": [1, 1, 1]}
NAMED = {"model": "mine@3"}
ENCODE: dict[str, Any] = {"task": "encode", "encode": {"max_error": 0.01}, "method": SELF}


@pytest.fixture
def settle(services: Services) -> Settle:
    """Do what a worker does with the analysis of a mesh: facts of a format, or the code of a problem."""

    def run(
        mesh_id: str, file_format: str = "ply", problem: str | None = None, encoded: dict[str, Any] | None = None
    ) -> None:
        analysis = services.meshes.start_analysis(mesh_id, "test", 30)
        if problem is not None:
            services.meshes.reject(analysis, MeshProblem(code=problem, message="bad"))
            return
        facts = MeshFacts.model_validate({"format": file_format, "holes": [], "diagonal": 1.7, "encoded": encoded})
        services.meshes.publish(analysis, facts)

    return run


@pytest.fixture
def reference_id(client: TestClient) -> str:
    return str(client.post("/v1/meshes?filename=clean.ply", content=b"ply\nclean\n").json()["id"])


@pytest.fixture
def dictionary(client: TestClient, dictionary_bytes: Callable[[int], bytes], publish: Publish) -> str:
    """The default dictionary."""
    publish("reliefs", dictionary_bytes(1))
    client.put("/v1/aliases/default", json={"model": "reliefs@1"})
    return "reliefs"


@pytest.mark.usefixtures("dictionary")
def test_each_task_is_accepted_and_shown_with_its_defaults(client: TestClient, mesh_id: str) -> None:
    wholes = [{"task": "fill"}, NAN, DENOISE, {**ENCODE, "method": {"method": "dictionary"}}, DECODE]
    answers = [client.post("/v1/jobs", json={"mesh_id": mesh_id, **whole}) for whole in wholes]
    assert [answer.status_code for answer in answers] == 5 * [202]
    jobs = [answer.json() for answer in answers]
    assert [job["spec"]["task"] for job in jobs] == [task for task in TASKS if task != TRAIN]
    assert [job["model"]["requested"] for job in jobs] == ["auto", "self", "self", "default", "self"]
    again = client.post(f"/v1/jobs/{jobs[2]['id']}/rerun").json()
    assert (again["spec"], again["rerun_of"]) == (jobs[2]["spec"], jobs[2]["id"])


def test_a_mesh_and_a_task_may_come_in_one_request(client: TestClient) -> None:
    spec = (None, json.dumps(DENOISE | {"denoise": {"noise": 0.1}}), "application/json")
    job = client.post("/v1/repairs", files={"mesh": ("scan.ply", b"ply\n"), "spec": spec}).json()
    assert (job["spec"]["task"], job["spec"]["denoise"]["noise"]) == ("denoise", 0.1)


@pytest.mark.parametrize(
    "spec",
    [
        {**DENOISE, "holes": {"ids": [0]}},
        {**DENOISE, "output": {"closeups": True}},
        {"task": "restore"},
        {"task": "encode"},
        {**ENCODE, "method": {"method": "smooth"}},
    ],
)
def test_a_task_with_options_of_another_one_or_without_its_own_is_refused_wherever_a_job_is_made(
    client: TestClient, mesh_id: str, settle: Settle, spec: dict[str, Any]
) -> None:
    settle(mesh_id)
    first = client.post("/v1/jobs", json={"mesh_id": mesh_id, **DENOISE}).json()["id"]
    answers = [
        client.post("/v1/jobs", json={"mesh_id": mesh_id, **spec}),
        client.post("/v1/jobs?dry_run=true", json={"mesh_id": mesh_id, **spec}),
        client.post(f"/v1/jobs/{first}/rerun", json=spec),
        client.post("/v1/repairs", files={"mesh": ("a.ply", b"ply\n"), "spec": (None, json.dumps(spec))}),
    ]
    assert {(answer.status_code, answer.json()["code"]) for answer in answers} == {(422, "options_conflict")}
    assert [job["id"] for job in client.get("/v1/jobs").json()["items"]] == [first]


def test_a_qpz_file_can_be_decoded_and_nothing_else(client: TestClient, mesh_id: str, settle: Settle) -> None:
    settle(mesh_id, "qpz")
    for spec in ({"method": {"method": "smooth"}}, NAN, DENOISE, ENCODE):
        answer = client.post("/v1/jobs", json={"mesh_id": mesh_id, **spec})
        assert (answer.status_code, answer.json()["code"]) == (409, "mesh_encoded")
        assert "decode it first" in answer.json()["detail"]
    assert client.post("/v1/jobs", json={"mesh_id": mesh_id, "task": "decode"}).status_code == 202


def test_only_a_qpz_file_can_be_decoded(client: TestClient, mesh_id: str, settle: Settle) -> None:
    assert client.post("/v1/jobs", json={"mesh_id": mesh_id, "task": "decode"}).status_code == 202
    settle(mesh_id)
    answer = client.post("/v1/jobs", json={"mesh_id": mesh_id, "task": "decode"})
    assert (answer.status_code, answer.json()["code"]) == (409, "mesh_not_encoded")


def test_a_scan_with_nan_can_be_restored_and_nothing_else(client: TestClient, mesh_id: str, settle: Settle) -> None:
    settle(mesh_id, problem="not_finite")
    by_property = {"task": "restore", "restore": {"missing": {"kind": "property", "name": "lost"}}}
    for spec in ({"method": {"method": "smooth"}}, DENOISE, by_property):
        answer = client.post("/v1/jobs", json={"mesh_id": mesh_id, **spec})
        assert (answer.status_code, answer.json()["code"]) == (409, "mesh_rejected")
    assert client.post("/v1/jobs", json={"mesh_id": mesh_id, **NAN}).status_code == 202
    assert client.post("/v1/jobs?dry_run=true", json={"mesh_id": mesh_id, **NAN}).json()["task"] == "restore"


def test_another_fault_of_a_scan_is_one_for_restoring_too(client: TestClient, mesh_id: str, settle: Settle) -> None:
    settle(mesh_id, problem="unreadable_mesh")
    answer = client.post("/v1/jobs", json={"mesh_id": mesh_id, **NAN})
    assert (answer.status_code, answer.json()["code"]) == (409, "mesh_rejected")


def test_a_reference_has_to_be_a_mesh_that_is_there_and_usable(
    client: TestClient, mesh_id: str, reference_id: str, settle: Settle
) -> None:
    def start(reference: str) -> tuple[int, Any]:
        spec = {"mesh_id": mesh_id, **DENOISE, "denoise": {"reference": reference}}
        answer = client.post("/v1/jobs", json=spec)
        return answer.status_code, answer.json().get("code")

    assert start("f" * 64) == (404, "mesh_not_found")
    assert start(reference_id) == (202, None)
    settle(reference_id, problem="empty_mesh")
    assert start(reference_id) == (409, "mesh_rejected")


def test_a_reference_that_is_encoded_is_refused(
    client: TestClient, mesh_id: str, reference_id: str, settle: Settle
) -> None:
    settle(reference_id, "qpz")
    answer = client.post("/v1/jobs", json={"mesh_id": mesh_id, **DENOISE, "denoise": {"reference": reference_id}})
    assert (answer.status_code, answer.json()["code"]) == (409, "mesh_encoded")
    assert answer.json()["detail"].startswith("the reference")


def test_a_reference_can_be_deleted_only_after_its_job(
    client: TestClient, mesh_id: str, reference_id: str, finish: Callable[[str], Any]
) -> None:
    spec = {"mesh_id": mesh_id, **DENOISE, "denoise": {"reference": reference_id}}
    job_id = client.post("/v1/jobs", json=spec).json()["id"]
    refused = client.delete(f"/v1/meshes/{reference_id}")
    assert (refused.status_code, refused.json()["code"]) == (409, "mesh_in_use")
    finish(job_id)
    assert client.get(f"/v1/meshes/{reference_id}").json()["expires_at"] is None
    assert client.delete(f"/v1/jobs/{job_id}").status_code == 204
    assert client.delete(f"/v1/meshes/{reference_id}").status_code == 204


@pytest.mark.parametrize(
    ("spec", "summary"),
    [
        (NAN, "give the vertices whose coordinates are NaN a position, and keep all others"),
        (
            {"task": "restore", "restore": {"missing": {"kind": "property", "name": "lost"}}},
            "give the vertices that the property lost marks a position, and keep all others",
        ),
        (
            {"task": "restore", "restore": {"missing": {"kind": "indices", "indices": [4, 4, 7]}}},
            "give the 2 vertices of the list a position, and keep all others",
        ),
        (DENOISE, "take noise that is estimated from the vertices, moving each by no more than that noise allows"),
        (
            {**DENOISE, "denoise": {"noise": 0.1, "max_shift": 0.25, "region": BOX}},
            "take noise of 0.1 from the vertices in the box, moving each by 0.25 at most",
        ),
        (
            {**DENOISE, "denoise": {"noise": 0.1, "region": {"kind": "property", "name": "rough"}}},
            "take noise of 0.1 from the vertices that the property rough marks, "
            "moving each by no more than that noise allows",
        ),
        (ENCODE, "encode the surface as a regular mesh, no farther than 0.01 from the scan"),
        (
            {**ENCODE, "encode": {"max_error": 2.0, "keep_connectivity": True}},
            "encode the surface with its triangles, no farther than 2 from the scan",
        ),
    ],
)
def test_a_dry_run_says_what_a_task_would_do_and_has_no_holes(
    client: TestClient, mesh_id: str, settle: Settle, spec: dict[str, Any], summary: str
) -> None:
    early = client.post("/v1/jobs?dry_run=true", json={"mesh_id": mesh_id, **spec})
    assert (early.status_code, early.json()["code"]) == (409, "mesh_not_ready")
    settle(mesh_id)
    plan = client.post("/v1/jobs?dry_run=true", json={"mesh_id": mesh_id, **spec}).json()
    assert (plan["task"], plan["summary"], plan["holes"], plan["selected"]) == (spec["task"], summary, [], 0)
    assert plan["limits"]["memory_mb"] == 4096
    assert client.get("/v1/jobs").json()["items"] == []


def test_a_request_of_before_there_were_tasks_is_the_same_when_it_comes_again(client: TestClient, mesh_id: str) -> None:
    """By its idempotency key: whether the task is named or not."""
    headers = {"Idempotency-Key": "part-1187"}
    spec = {"mesh_id": mesh_id, "method": {"method": "smooth"}}
    first = client.post("/v1/jobs", json=spec, headers=headers)
    again = client.post("/v1/jobs", json=spec | {"task": "fill"}, headers=headers)
    assert again.json()["id"] == first.json()["id"]
    other = client.post("/v1/jobs", json={"mesh_id": mesh_id, **DENOISE}, headers=headers)
    assert (other.status_code, other.json()["code"]) == (409, "idempotency_conflict")


@pytest.mark.usefixtures("dictionary")
def test_a_file_is_decoded_with_the_dictionary_whose_bytes_it_names(
    client: TestClient, services: Services, mesh_id: str, settle: Settle, publish: Publish, dictionary_bytes: Any
) -> None:
    """Whatever that is called by now."""
    publish("others", dictionary_bytes(2))
    sha256 = services.registry.resolve("reliefs@1").sha256
    settle(mesh_id, "qpz", encoded={"max_error": 0.1, "keeps_connectivity": False, **NAMED, "model_sha256": sha256})
    job = client.post("/v1/jobs", json={"mesh_id": mesh_id, **DECODE}).json()
    assert (job["model"]["requested"], job["model"]["name"], job["model"]["version"]) == ("self", "reliefs", 1)
    named = {"mesh_id": mesh_id, **DECODE, "method": {"method": "dictionary", "model": "reliefs"}}
    assert client.post("/v1/jobs", json=named).json()["model"]["name"] == "reliefs"
    other = {"mesh_id": mesh_id, **DECODE, "method": {"method": "dictionary", "model": "others"}}
    refused = client.post("/v1/jobs", json=other)
    assert (refused.status_code, refused.json()["code"]) == (409, "model_kind_mismatch")
    assert "was encoded with mine@3; others@1 is another dictionary" in refused.json()["detail"]


def test_a_file_whose_dictionary_is_not_registered_is_refused(client: TestClient, mesh_id: str, settle: Settle) -> None:
    encoded = {"max_error": 0.1, "keeps_connectivity": False, **NAMED, "model_sha256": "e" * 64}
    settle(mesh_id, "qpz", encoded=encoded)
    answer = client.post("/v1/jobs", json={"mesh_id": mesh_id, **DECODE})
    assert (answer.status_code, answer.json()["code"]) == (404, "model_not_found")
    assert "mine@3" in answer.json()["detail"]


def test_a_file_that_holds_its_dictionary_needs_no_model(client: TestClient, mesh_id: str, settle: Settle) -> None:
    settle(mesh_id, "qpz", encoded={"max_error": 0.1, "keeps_connectivity": False})
    answer = client.post("/v1/jobs", json={"mesh_id": mesh_id, **DECODE})
    assert (answer.status_code, answer.json()["model"]["kind"]) == (202, "self")

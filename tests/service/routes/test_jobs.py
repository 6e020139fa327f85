"""Also tests `quadpatch_client.schema.jobs`, `service.routes.common` and `service.submission`."""

import json
from collections.abc import Callable
from typing import Any

import pytest
from starlette.testclient import TestClient

from quadpatch_client.schema import AutoMethod, Job, JobError, JobState, ModelVersion
from service.services import Services
from tests.jobkit.models.test_registry import NETWORK

SMOOTH = {"method": "smooth"}
Publish = Callable[..., ModelVersion]


def test_a_job_is_promised_with_its_place_and_its_defaults(
    client: TestClient, services: Services, mesh_id: str
) -> None:
    answer = client.post("/v1/jobs", json={"mesh_id": mesh_id, "method": SMOOTH})
    job = answer.json()
    assert answer.status_code == 202
    assert answer.headers["location"] == f"/v1/jobs/{job['id']}"
    assert answer.headers["retry-after"] == "2"
    pictures = {"preview": True, "closeups": False, "html_report": False, "tint": "invented"}
    assert job["spec"]["output"] == {"format": None, "attributes": None, **pictures}
    assert client.get(answer.headers["location"]).json() == job
    assert f"{job['id']}-1" in services.queue.entries()


def test_a_mesh_id_alone_is_a_job_in_which_models_compete(client: TestClient, mesh_id: str) -> None:
    job = client.post("/v1/jobs", json={"mesh_id": mesh_id}).json()
    assert (job["model"]["requested"], job["model"]["kind"], job["model"]["name"]) == ("auto", "auto", None)
    assert job["spec"]["method"] == AutoMethod(method="auto", effort="standard").model_dump()


@pytest.mark.parametrize(
    ("method", "status", "words"),
    [
        ({"method": "auto", "effort": "best", "fitting": {"steps": 40, "seconds": 30.0}}, 202, ""),
        ({"method": "auto", "effort": "fast"}, 202, ""),
        ({"method": "auto", "fitting": {"steps": 40}}, 422, "method.fitting goes with the effort best"),
        ({"method": "auto", "effort": "most"}, 422, "/method/effort"),
        ({"method": "auto", "model": "self"}, 422, "/method/model"),
        ({"method": "smooth", "effort": "fast"}, 422, "/method/effort"),
        ({"method": "cnn", "model": "self", "effort": "best"}, 422, "/method/effort"),
    ],
)
def test_an_effort_goes_with_auto_and_fitting_with_the_effort_best(
    client: TestClient, mesh_id: str, method: dict[str, Any], status: int, words: str
) -> None:
    answer = client.post("/v1/jobs", json={"mesh_id": mesh_id, "method": method})
    assert answer.status_code == status
    assert words in answer.text


def test_a_dictionary_without_a_name_is_the_default_one_as_it_was_when_the_job_came(
    client: TestClient, mesh_id: str, dictionary_bytes: Callable[[int], bytes], publish: Publish
) -> None:
    spec = {"mesh_id": mesh_id, "method": {"method": "dictionary"}}
    missing = client.post("/v1/jobs", json=spec)
    assert (missing.status_code, missing.json()["code"]) == (404, "model_not_found")
    publish("reliefs", dictionary_bytes(1))
    client.put("/v1/aliases/default", json={"model": "reliefs@1"})
    job = client.post("/v1/jobs", json=spec).json()
    assert (job["model"]["name"], job["model"]["version"], job["model"]["requested"]) == ("reliefs", 1, "default")
    publish("reliefs", dictionary_bytes(2))
    client.put("/v1/aliases/default", json={"model": "reliefs@2"})
    assert client.get(f"/v1/jobs/{job['id']}").json()["model"] == job["model"]


@pytest.mark.parametrize(
    ("change", "status", "code"),
    [
        ({"mesh_id": "f" * 64}, 404, "mesh_not_found"),
        ({"method": {"method": "dictionary", "model": "none@3"}}, 404, "model_not_found"),
        ({"method": {"method": "cnn"}}, 409, "no_network_registered"),
        ({"limits": {"time_s": 86_000}}, 403, "over_service_limit"),
        ({"limits": {"memory_mb": 1_000_000}}, 403, "over_service_limit"),
    ],
)
def test_a_job_that_cannot_work_is_refused_at_once(
    client: TestClient, mesh_id: str, change: dict[str, Any], status: int, code: str
) -> None:
    answer = client.post("/v1/jobs", json={"mesh_id": mesh_id, "method": SMOOTH} | change)
    assert (answer.status_code, answer.json()["code"]) == (status, code)
    assert client.get("/v1/jobs").json()["items"] == []


PAPER = {"method": {"method": "dictionary", "model": "self", "recipe": "paper"}}
CONFLICTS: list[dict[str, Any]] = [
    PAPER | {"holes": {"cap": "flat"}},
    PAPER | {"holes": {"rules": [{"action": "skip", "ids": [1]}, {"action": "smooth", "max_diameter": 5.0}]}},
    PAPER | {"holes": {"rules": [{"action": "flat", "kind": "open_end"}]}},
    PAPER | {"holes": {"bridges": [[0, 1]]}},
    {"method": SMOOTH, "weld_tolerance": 0.5, "holes": {"rules": [{"action": "skip", "ids": [1]}]}},
]


@pytest.mark.parametrize("spec", CONFLICTS)
def test_options_that_exclude_each_other_are_refused_wherever_a_job_is_made(
    client: TestClient, mesh_id: str, analyse: Callable[[str], None], spec: dict[str, Any]
) -> None:
    analyse(mesh_id)
    first = client.post("/v1/jobs", json={"mesh_id": mesh_id, "method": SMOOTH}).json()["id"]
    answers = [
        client.post("/v1/jobs", json={"mesh_id": mesh_id, **spec}),
        client.post("/v1/jobs?dry_run=true", json={"mesh_id": mesh_id, **spec}),
        client.post(f"/v1/jobs/{first}/rerun", json=spec),
        client.post("/v1/repairs", files={"mesh": ("a.ply", b"ply\n"), "spec": (None, json.dumps(spec))}),
    ]
    for answer in answers:
        assert (answer.status_code, answer.json()["code"]) == (422, "options_conflict")
        assert answer.json()["detail"].startswith(("holes.cap, holes.bridges and the actions", "ids of"))
    assert [job["id"] for job in client.get("/v1/jobs").json()["items"]] == [first]


def test_the_recipe_of_the_paper_goes_with_rules_that_fill_by_the_model(client: TestClient, mesh_id: str) -> None:
    rules = [{"action": "skip", "ids": [1]}, {"action": "model", "kind": "hole"}]
    answer = client.post("/v1/jobs", json={"mesh_id": mesh_id, **PAPER, "holes": {"rules": rules}})
    assert answer.status_code == 202


def test_a_network_can_be_fitted_to_the_mesh_and_one_that_is_taken_as_it_is_can_not(
    client: TestClient, mesh_id: str, publish: Publish
) -> None:
    publish("small", NETWORK)
    fitting = {"steps": 30, "seconds": 20.0}
    method = {"method": "cnn", "model": "self", "fitting": fitting}
    accepted = client.post("/v1/jobs", json={"mesh_id": mesh_id, "method": method})
    assert accepted.status_code == 202
    assert accepted.json()["spec"]["method"]["fitting"] == fitting
    assert (accepted.json()["model"]["kind"], accepted.json()["model"]["name"]) == ("self_network", None)
    refused = client.post("/v1/jobs", json={"mesh_id": mesh_id, "method": {**method, "model": "small"}})
    assert (refused.status_code, refused.json()["code"]) == (409, "model_kind_mismatch")
    assert "fitting goes with the model self only" in refused.json()["detail"]


def test_a_hole_that_is_not_there_is_refused_once_the_holes_are_known(
    client: TestClient, mesh_id: str, analyse: Callable[[str], None]
) -> None:
    specs = [{"mesh_id": mesh_id, "method": SMOOTH, "holes": h} for h in ({"ids": [0, 7]}, {"bridges": [[0, 7]]})]
    assert {client.post("/v1/jobs", json=spec).status_code for spec in specs} == {202}
    analyse(mesh_id)
    for spec in specs:
        answer = client.post("/v1/jobs", json=spec)
        assert (answer.status_code, answer.json()["code"]) == (409, "unknown_hole")
        assert "id 7" in answer.json()["detail"]


def test_a_loop_in_two_bridges_is_refused(client: TestClient, mesh_id: str) -> None:
    answer = client.post("/v1/jobs", json={"mesh_id": mesh_id, "holes": {"bridges": [[0, 1], [1, 2]]}})
    assert (answer.status_code, answer.json()["code"]) == (422, "invalid_request")
    assert "loop 1 is named twice" in answer.text


def test_a_dry_run_says_what_would_happen_and_does_nothing(
    client: TestClient, mesh_id: str, analyse: Callable[[str], None]
) -> None:
    spec = {"mesh_id": mesh_id, "method": SMOOTH, "limits": {"time_s": 5}}
    early = client.post("/v1/jobs?dry_run=true", json=spec)
    assert (early.status_code, early.json()["code"], early.json()["retryable"]) == (409, "mesh_not_ready", True)
    analyse(mesh_id)
    answer = client.post("/v1/jobs?dry_run=true", json=spec)
    plan = answer.json()
    assert answer.status_code == 200
    assert [(hole["selected"], hole["reason"]) for hole in plan["holes"]] == [
        (False, "too_wide"),
        (True, None),
        (True, None),
    ]
    assert plan["selected"] == 2
    assert plan["limits"] == {"time_s": 5.0, "memory_mb": 4096}
    assert plan["model"]["kind"] == "none"
    assert client.get("/v1/jobs").json()["items"] == []


def test_a_repeated_key_starts_nothing_twice(client: TestClient, mesh_id: str) -> None:
    headers = {"Idempotency-Key": "order-17"}
    spec = {"mesh_id": mesh_id, "method": SMOOTH}
    first = client.post("/v1/jobs", json=spec, headers=headers)
    again = client.post("/v1/jobs", json=spec | {"seed": 0}, headers=headers)
    assert again.status_code == 202
    assert again.json() == first.json()
    assert again.headers["idempotent-replayed"] == "true"
    assert "idempotent-replayed" not in first.headers
    other = client.post("/v1/jobs", json=spec | {"seed": 1}, headers=headers)
    assert (other.status_code, other.json()["code"]) == (409, "idempotency_conflict")
    assert len(client.get("/v1/jobs").json()["items"]) == 1


def test_a_key_is_honoured_even_after_its_model_is_gone(
    client: TestClient, mesh_id: str, dictionary_bytes: Callable[[int], bytes], publish: Publish
) -> None:
    publish("reliefs", dictionary_bytes(1))
    client.put("/v1/aliases/default", json={"model": "reliefs@1"})
    headers = {"Idempotency-Key": "order-18"}
    first = client.post("/v1/jobs", json={"mesh_id": mesh_id}, headers=headers).json()
    publish("reliefs", dictionary_bytes(2))
    client.put("/v1/aliases/default", json={"model": "reliefs@2"})
    assert client.post("/v1/jobs", json={"mesh_id": mesh_id}, headers=headers).json() == first


@pytest.mark.parametrize("key", ["", "a b", "x" * 256, "\xe4"])
def test_a_key_that_is_no_key_is_refused(client: TestClient, mesh_id: str, key: str) -> None:
    headers = {b"Idempotency-Key": key.encode("latin-1")}
    answer = client.post("/v1/jobs", json={"mesh_id": mesh_id, "method": SMOOTH}, headers=headers)
    assert answer.status_code == 422


def test_pages_hold_every_job_once_though_new_ones_arrive(client: TestClient, mesh_id: str) -> None:
    spec = {"mesh_id": mesh_id, "method": SMOOTH}
    old = [client.post("/v1/jobs", json=spec).json()["id"] for _ in range(5)]
    seen, cursor = [], ""
    while cursor is not None:
        query = {"limit": 2} | ({"cursor": cursor} if cursor else {})
        page = client.get("/v1/jobs", params=query).json()
        seen += [job["id"] for job in page["items"]]
        client.post("/v1/jobs", json=spec)
        cursor = page["next_cursor"]
    assert sorted(seen) == sorted(old)


def test_jobs_can_be_listed_by_state(client: TestClient, services: Services, job_id: str) -> None:
    services.attempts.start(job_id, "test", 30)
    assert [job["id"] for job in client.get("/v1/jobs?state=running").json()["items"]] == [job_id]
    assert client.get("/v1/jobs?state=queued").json()["items"] == []


def test_a_queued_job_is_canceled_at_once(client: TestClient, job_id: str) -> None:
    for _ in range(2):
        answer = client.post(f"/v1/jobs/{job_id}/cancel")
        assert (answer.status_code, answer.json()["state"]) == (200, "canceled")
    assert answer.json()["links"]["cancel"] is None


def test_a_running_job_is_asked_to_stop(client: TestClient, services: Services, job_id: str) -> None:
    attempt = services.attempts.start(job_id, "test", 30).attempt
    for _ in range(2):
        answer = client.post(f"/v1/jobs/{job_id}/cancel")
        assert (answer.status_code, answer.json()["state"]) == (202, "canceling")
    services.attempts.acknowledge_cancel(attempt)
    answer = client.post(f"/v1/jobs/{job_id}/cancel")
    assert (answer.status_code, answer.json()["state"]) == (200, "canceled")


@pytest.mark.parametrize("end", ["succeeded", "failed"])
def test_a_job_that_has_ended_cannot_be_canceled(
    client: TestClient, services: Services, job_id: str, finish: Callable[[str], Job], end: str
) -> None:
    if end == "succeeded":
        finish(job_id)
    else:
        attempt = services.attempts.start(job_id, "test", 30).attempt
        services.attempts.fail(attempt, JobError(code="time_limit", message="too slow"))
    answer = client.post(f"/v1/jobs/{job_id}/cancel")
    assert (answer.status_code, answer.json()["code"]) == (409, "job_finished")
    assert services.jobs.get(job_id).state == JobState(end)


def test_a_rerun_is_a_new_job_with_the_same_spec(client: TestClient, job_id: str) -> None:
    answer = client.post(f"/v1/jobs/{job_id}/rerun", headers={"Idempotency-Key": "again"})
    job = answer.json()
    assert answer.status_code == 202
    assert job["id"] != job_id
    assert job["rerun_of"] == job_id
    assert job["spec"] == client.get(f"/v1/jobs/{job_id}").json()["spec"]
    again = client.post(f"/v1/jobs/{job_id}/rerun", headers={"Idempotency-Key": "again"})
    assert again.json() == job


def test_events_are_paged_by_their_number(client: TestClient, job_id: str, finish: Callable[[str], Job]) -> None:
    finish(job_id)
    first = client.get(f"/v1/jobs/{job_id}/events?limit=2").json()
    assert [event["type"] for event in first["items"]] == ["queued", "started"]
    rest = client.get(f"/v1/jobs/{job_id}/events?after={first['next_after']}").json()
    assert [event["type"] for event in rest["items"]] == ["succeeded"]
    assert rest["next_after"] is None

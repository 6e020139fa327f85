"""Also tests `quadpatch_client.schema.shadows` and `jobkit.shadows.shadows`."""

from collections.abc import Callable
from typing import Any

import pytest
from starlette.testclient import TestClient

from jobkit.shadows.runs import Comparison, ShadowRuns
from quadpatch_client.schema import Job, ModelVersion
from service.services import Services

Publish = Callable[..., ModelVersion]


@pytest.fixture
def shadow(client: TestClient, publish: Publish, dictionary_bytes: Callable[[int], bytes]) -> Any:
    """The second version of a dictionary beside the first one, on all jobs that name the alias `ours`."""
    for seed in (1, 2):
        publish("walls", dictionary_bytes(seed))
    publish("paper", dictionary_bytes(-1))
    client.put("/v1/aliases/ours", json={"model": "walls@1"}).raise_for_status()
    answer = client.put("/v1/shadows/ours", json={"candidate": "walls@2", "share": 1})
    assert answer.status_code == 200, answer.text
    return answer.json()


@pytest.fixture
def measure(
    client: TestClient, services: Services, mesh_id: str, analyse: Callable[[str], None], finish: Callable[[str], Job]
) -> Callable[[float], str]:
    """Make a job that has its result, and do what a worker does with the candidate."""
    analyse(mesh_id)

    def run(ratio: float) -> str:
        body = {"mesh_id": mesh_id, "method": {"method": "dictionary", "model": "ours"}}
        job_id = client.post("/v1/jobs", json=body, headers={"Cache-Control": "no-cache"}).json()["id"]
        runs = ShadowRuns(services.database)
        assert runs.add(services.of("default").registry, finish(job_id), "default")
        runs.measure(runs.start(job_id, "test", 30), Comparison(3, ratio))
        return str(job_id)

    return run


def test_a_shadow_says_what_its_runs_found_and_its_jobs_stay_as_they_are(
    client: TestClient, shadow: Any, measure: Callable[[float], str]
) -> None:
    assert (shadow["candidate"], shadow["share"], shadow["state"]) == ("walls@2", 1.0, "running")
    assert shadow["figures"]["verdict"] == "nothing is measured yet"
    ids = [measure(ratio) for ratio in 9 * [0.8] + [1.1]]
    shown = client.get(shadow["links"]["self"]).json()
    assert client.get("/v1/shadows").json()["items"] == [shown]
    assert shown["figures"]["verdict"] == "better on 9 of 10 jobs: may be made default"
    assert (shown["figures"]["better"], shown["figures"]["worse"], shown["figures"]["holes"]) == (9, 1, 30)
    first = client.get(shadow["links"]["runs"] + "?limit=6").json()
    rest = client.get(shadow["links"]["runs"], params={"cursor": first["next_cursor"]}).json()
    runs = [*first["items"], *rest["items"]]
    assert [run["job_id"] for run in runs] == ids[::-1]
    assert rest["next_cursor"] is None
    assert {run["state"] for run in runs} == {"measured"}
    events = [event["type"] for event in client.get(f"/v1/jobs/{ids[0]}/events").json()["items"]]
    assert events == ["queued", "started", "succeeded"]
    assert len(client.get("/v1/jobs").json()["items"]) == len(ids)


def test_a_cleared_shadow_is_gone(client: TestClient, shadow: Any, measure: Callable[[float], str]) -> None:
    job_id = measure(0.9)
    assert client.delete("/v1/shadows/ours").status_code == 204
    for path in ("/v1/shadows/ours", "/v1/shadows/ours/runs"):
        answer = client.get(path)
        assert (answer.status_code, answer.json()["code"]) == (404, "shadow_not_found")
    assert client.delete("/v1/shadows/ours").status_code == 404
    assert client.get(f"/v1/jobs/{job_id}/result").status_code == 200


@pytest.mark.parametrize(
    ("name", "body", "status", "code"),
    [
        ("nowhere", {"candidate": "walls@2"}, 404, "model_not_found"),
        ("ours", {"candidate": "walls@9"}, 404, "model_not_found"),
        ("ours", {"candidate": "walls@2", "share": 1.5}, 422, "invalid_request"),
        ("ours", {"candidate": "walls@2", "share": -0.1}, 422, "invalid_request"),
        ("ours", {"share": 0.5}, 422, "invalid_request"),
        ("ours", {"candidate": "paper"}, 409, "model_kind_mismatch"),
    ],
)
def test_what_can_not_be_compared_is_refused(
    client: TestClient, shadow: Any, name: str, body: dict[str, Any], status: int, code: str
) -> None:
    answer = client.put(f"/v1/shadows/{name}", json=body)
    assert (answer.status_code, answer.json()["code"]) == (status, code)
    assert client.get("/v1/shadows").json()["items"] == [shadow]

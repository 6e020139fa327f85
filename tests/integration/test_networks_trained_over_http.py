"""A network fitted from uploaded meshes over HTTP, against a local stack whose worker is killed meanwhile.

Also tests `training.requested_network` in an engine that is confined.
"""

from collections.abc import Iterator

import httpx
import pytest

from tests.integration.conftest import RunningStack, ply_bytes
from tests.integration.test_shadows_over_http import kill_the_worker_at_work
from tests.integration.test_trainings_over_http import wait_for
from tests.training.walls import wall
from tests.waiting import GUARD_S, wait_until

TINY = {"steps": 2, "held_out": 0.5}


@pytest.fixture
def http(local_stack: RunningStack) -> Iterator[httpx.Client]:
    with httpx.Client(base_url=local_stack.url, timeout=GUARD_S) as http:
        yield http


def upload(http: httpx.Client, *seeds: int) -> list[str]:
    ids = []
    for seed in seeds:
        mesh = wall(seed, n=50)
        answer = http.post("/v1/meshes?filename=net.ply", content=ply_bytes(mesh.vertices, mesh.triangles))
        ids.append(str(answer.raise_for_status().json()["id"]))
    wait_until(lambda: {http.get(f"/v1/meshes/{mesh_id}").json()["state"] for mesh_id in ids} == {"ready"})
    return ids


def test_a_killed_worker_leaves_one_network_that_jobs_may_use(
    local_stack: RunningStack,
    http: httpx.Client,
) -> None:
    assert wait_until(lambda: "network" in http.get("/v1/limits").json()["trainings"])
    ids = upload(http, 21, 22)
    body = {"model": "nets", "kind": "network", "meshes": ids, "network": TINY, "make_default": "if_better"}
    path = http.post("/v1/trainings", json=body).raise_for_status().headers["location"]
    wait_until(lambda: http.get(path).json()["stage"] == "learn" and local_stack.engines())
    kill_the_worker_at_work(local_stack)

    training = wait_for(http, path)
    assert (training["state"], training["attempt"], training["error"]) == ("succeeded", 2, None)
    assert (training["train"]["kind"], training["train"]["alias"]) == ("network", "default-network")
    learned = training["result"]
    assert (learned["kind"], learned["version"], learned["is_new"]) == ("network", 1, True)
    assert learned["verdict"].startswith(("better", "worse", "no better", "not judged"))
    assert learned["patches"] > 0
    (version,) = http.get("/v1/models/nets").json()["versions"]
    assert (version["kind"], version["format"], version["state"]) == ("autoencoder", "onnx", "ready")
    assert version["sha256"] == learned["sha256"]
    report = http.get(training["links"]["report"]).json()
    assert (report["kind"], len(report["learning_errors"])) == ("network", 2)
    percents = [event["data"].get("percent") for event in http.get(f"{path}/events?limit=1000").json()["items"]]
    assert any(percent for percent in percents)

    spec = {"mesh_id": ids[0], "method": {"method": "cnn", "model": "nets"}}
    job = http.post("/v1/jobs", json=spec).raise_for_status().json()
    assert wait_for(http, f"/v1/jobs/{job['id']}")["state"].startswith("succeeded")


def test_a_canceled_training_of_a_network_leaves_no_model(
    local_stack: RunningStack,
    http: httpx.Client,
) -> None:
    body = {"model": "never-net", "kind": "network", "meshes": upload(http, 23), "network": {"steps": 20_000}}
    path = http.post("/v1/trainings", json=body).raise_for_status().headers["location"]
    wait_until(lambda: http.get(path).json()["stage"] == "learn" and local_stack.engines())
    assert http.post(f"{path}/cancel").status_code in (200, 202)
    assert wait_for(http, path)["state"] == "canceled"
    wait_until(lambda: not local_stack.engines() and not local_stack.requests())
    assert http.get("/v1/models/never-net").status_code == 404

"""A training from uploaded meshes to a model version, against a local stack whose worker is killed meanwhile.

Also tests `worker.trainings`.
"""

from collections.abc import Iterator
from typing import Any

import httpx
import pytest

from tests.integration.conftest import RunningStack, ply_bytes
from tests.training.walls import wall
from tests.waiting import GUARD_S, wait_until

OPTIONS = {"atoms": 64, "patch_resolution": 24, "steps": 5, "held_out": 0.5}


@pytest.fixture
def http(local_stack: RunningStack) -> Iterator[httpx.Client]:
    with httpx.Client(base_url=local_stack.url, timeout=GUARD_S) as http:
        yield http


def upload_walls(http: httpx.Client, name: str, *seeds: int) -> list[str]:
    """Upload patterned sheets; return their ids when they are analysed."""
    ids = []
    for seed in seeds:
        mesh = wall(seed)
        answer = http.post(f"/v1/meshes?filename={name}-{seed}.ply", content=ply_bytes(mesh.vertices, mesh.triangles))
        ids.append(str(answer.raise_for_status().json()["id"]))
    wait_until(lambda: {http.get(f"/v1/meshes/{mesh_id}").json()["state"] for mesh_id in ids} == {"ready"})
    return ids


def wait_for(http: httpx.Client, path: str) -> Any:
    """Wait until a training has ended."""
    return wait_until(lambda: training if (training := http.get(path).json())["finished_at"] else None)


def test_a_killed_worker_leaves_one_version_whose_verdict_moves_the_alias(
    local_stack: RunningStack, http: httpx.Client
) -> None:
    ids = upload_walls(http, "wall", 0, 1)
    body = {
        "model": "walls",
        "filter": {"filename": "wall-*.ply"},
        "options": OPTIONS,
        "make_default": "if_better",
        "alias": "my-default",
    }
    answers = [http.post("/v1/trainings", json=body, headers={"Idempotency-Key": "walls"}) for _ in range(2)]
    assert [answer.status_code for answer in answers] == [202, 202]
    path = answers[0].headers["location"]
    assert answers[1].headers["location"] == path
    wait_until(lambda: http.get(path).json()["stage"] == "learn" and local_stack.engines())
    (engine,) = local_stack.engines()
    (worker,) = [worker for worker in local_stack.workers() if engine in worker.children(recursive=True)]
    worker.kill()
    wait_until(lambda: not engine.is_running())

    training = wait_for(http, path)
    assert (training["state"], training["attempt"], training["error"]) == ("succeeded", 2, None)
    assert sorted(training["train"]["meshes"]) == sorted(ids)
    learned = training["result"]
    (judged,) = learned["judged"]
    assert judged["ratio"] < 0.8
    assert judged["mesh_id"] in ids
    assert learned["learned_from"] == [mesh_id for mesh_id in ids if mesh_id != judged["mesh_id"]]
    assert learned["verdict"] == "better than the plain fill on 1 of 1 mesh: made my-default"

    model = http.get("/v1/models/walls").json()
    assert [version["version"] for version in model["versions"]] == [1]
    (version,) = model["versions"]
    assert (version["state"], version["sha256"], version["aliases"]) == ("ready", learned["sha256"], ["my-default"])
    assert version["card"]["extra"]["verdict"] == "better than the plain fill on 1 of 1 mesh"
    events = [event["type"] for event in http.get(f"{path}/events?limit=1000").json()["items"]]
    assert [event for event in events if event != "progress"] == [
        "queued",
        "started",
        "requeued",
        "started",
        "succeeded",
    ]
    spec = {"mesh_id": ids[0], "method": {"method": "dictionary", "model": "my-default"}}
    job = http.post("/v1/jobs", json=spec).raise_for_status().json()
    assert (job["model"]["name"], job["model"]["version"]) == ("walls", 1)


def test_a_canceled_training_leaves_no_model(local_stack: RunningStack, http: httpx.Client) -> None:
    ids = upload_walls(http, "fence", 2, 3)
    body = {"model": "never", "meshes": ids, "options": {**OPTIONS, "steps": 100}}
    path = http.post("/v1/trainings", json=body).raise_for_status().headers["location"]
    wait_until(lambda: http.get(path).json()["stage"] == "learn" and local_stack.engines())
    assert http.post(f"{path}/cancel").status_code in (200, 202)
    assert wait_for(http, path)["state"] == "canceled"
    wait_until(lambda: not local_stack.engines() and not local_stack.requests())
    assert http.get("/v1/models/never").status_code == 404
    assert http.delete(f"/v1/meshes/{ids[1]}").status_code == 409
    assert http.delete(path.replace("trainings", "jobs")).status_code == 204
    assert http.delete(f"/v1/meshes/{ids[1]}").status_code == 204

"""A candidate beside the default on the local stack: a learned dictionary on a scan like those it was learned from."""

from collections.abc import Iterator
from pathlib import Path

import httpx
import numpy as np
import pytest

from tests.integration.conftest import RunningStack
from tests.integration.test_trainings_over_http import upload_walls, wait_for
from tests.training.walls import wall
from tests.waiting import GUARD_S, wait_until
from training.judgement import cut_known_holes


@pytest.fixture
def http(local_stack: RunningStack) -> Iterator[httpx.Client]:
    with httpx.Client(base_url=local_stack.url, timeout=GUARD_S) as http:
        yield http


def kill_the_worker_at_work(local_stack: RunningStack) -> None:
    wait_until(local_stack.engines)
    (engine,) = local_stack.engines()
    (worker,) = [worker for worker in local_stack.workers() if engine in worker.children(recursive=True)]
    worker.kill()


def test_a_candidate_is_compared_and_a_killed_worker_costs_neither_the_job_nor_the_figures(
    local_stack: RunningStack, http: httpx.Client, tmp_path: Path
) -> None:
    ids = upload_walls(http, "shadowed", 7)
    options = {"atoms": 64, "patch_resolution": 24, "steps": 3}
    answer = http.post("/v1/trainings", json={"model": "shadowed", "meshes": ids, "options": options})
    training = wait_for(http, answer.raise_for_status().headers["location"])
    assert training["state"] == "succeeded"
    http.put("/v1/aliases/watched", json={"model": "general-dictionary@1"}).raise_for_status()
    body = {"candidate": "shadowed@1", "share": 1}
    http.put("/v1/shadows/watched", json=body).raise_for_status()

    assert cut_known_holes(wall(8), tmp_path / "scan.ply", np.random.default_rng(0)) is not None
    mesh = http.post("/v1/meshes?filename=scan.ply", content=(tmp_path / "scan.ply").read_bytes()).json()
    spec = {"mesh_id": mesh["id"], "method": {"method": "dictionary", "model": "watched"}}
    path = f"/v1/jobs/{http.post('/v1/jobs', json=spec).raise_for_status().json()['id']}"
    wait_until(lambda: http.get(path).json()["finished_at"])
    job, result = http.get(path).json(), http.get(f"{path}/result").content
    assert job["state"] == "succeeded"

    wait_until(lambda: http.get("/v1/shadows/watched/runs").json()["items"][0]["state"] == "running")
    kill_the_worker_at_work(local_stack)
    (run,) = wait_until(
        lambda: runs if (runs := http.get("/v1/shadows/watched/runs").json()["items"])[0]["finished_at"] else None
    )
    assert (run["state"], run["candidate"], run["baseline"]) == ("measured", "shadowed@1", "general-dictionary@1")
    assert run["holes"] >= 10
    assert run["ratio"] < 0.95
    figures = http.get("/v1/shadows/watched").json()["figures"]
    assert (figures["jobs"], figures["better"], figures["standard_error"]) == (1, 1, None)
    assert http.get(path).json() == job
    assert http.get(f"{path}/result").content == result
    wait_until(lambda: not local_stack.engines() and not local_stack.requests())
    assert http.delete("/v1/shadows/watched").status_code == 204
    wait_until(
        lambda: {"set_shadow", "clear_shadow"} <= {e["operation"] for e in http.get("/v1/audit").json()["items"]}
    )

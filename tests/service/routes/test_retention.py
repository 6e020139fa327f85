from collections.abc import Callable

import pytest
from starlette.testclient import TestClient

from jobkit.settings import Settings
from quadpatch_client.schema import Job
from service.app import create_app
from service.services import Services

Finish = Callable[[str], Job]


def test_a_deleted_job_is_gone_with_its_files(
    client: TestClient, services: Services, job_id: str, finish: Finish
) -> None:
    finish(job_id)
    answer = client.delete(f"/v1/jobs/{job_id}")
    assert (answer.status_code, answer.content) == (204, b"")
    for path in ("", "/events", "/result", "/pin"):
        method = "PUT" if path == "/pin" else "GET"
        seen = client.request(method, f"/v1/jobs/{job_id}{path}")
        assert (seen.status_code, seen.json()["code"]) == (404, "job_not_found"), path
    assert list(services.store.keys("results")) == []
    again = client.delete(f"/v1/jobs/{job_id}")
    assert (again.status_code, again.json()["code"]) == (404, "job_not_found")


def test_an_unfinished_job_has_to_be_canceled_first(client: TestClient, job_id: str) -> None:
    answer = client.delete(f"/v1/jobs/{job_id}")
    assert (answer.status_code, answer.json()["code"]) == (409, "job_not_finished")
    assert "cancel it first" in answer.json()["detail"]
    client.post(f"/v1/jobs/{job_id}/cancel")
    assert client.delete(f"/v1/jobs/{job_id}").status_code == 204


def test_a_mesh_is_deleted_after_its_jobs_and_can_be_uploaded_again(
    client: TestClient, mesh_id: str, job_id: str, finish: Finish
) -> None:
    data = client.get(f"/v1/meshes/{mesh_id}/content").content
    finish(job_id)
    answer = client.delete(f"/v1/meshes/{mesh_id}")
    assert (answer.status_code, answer.json()["code"]) == (409, "mesh_in_use")
    assert answer.json()["detail"].startswith("1 job names mesh")
    client.delete(f"/v1/jobs/{job_id}")
    assert client.delete(f"/v1/meshes/{mesh_id}").status_code == 204
    assert client.get(f"/v1/meshes/{mesh_id}").json()["code"] == "mesh_not_found"
    assert client.delete(f"/v1/meshes/{mesh_id}").status_code == 404
    assert client.post("/v1/meshes?filename=part.ply", content=data).status_code == 201
    assert client.get(f"/v1/meshes/{mesh_id}/content").content == data


def test_a_pin_keeps_and_is_told(client: TestClient, mesh_id: str, job_id: str, finish: Finish) -> None:
    finish(job_id)
    before = client.get(f"/v1/jobs/{job_id}")
    assert before.json()["pinned"] is False
    assert before.json()["expires_at"] > before.json()["finished_at"]
    for _ in range(2):
        assert client.put(f"/v1/jobs/{job_id}/pin").status_code == 204
    pinned = client.get(f"/v1/jobs/{job_id}", headers={"If-None-Match": before.headers["etag"]})
    assert (pinned.status_code, pinned.json()["pinned"], pinned.json()["expires_at"]) == (200, True, None)
    for _ in range(2):
        assert client.delete(f"/v1/jobs/{job_id}/pin").status_code == 204
    assert client.get(f"/v1/jobs/{job_id}").json() == before.json()
    client.put(f"/v1/meshes/{mesh_id}/pin")
    assert client.get(f"/v1/meshes/{mesh_id}").json()["pinned"] is True
    client.delete(f"/v1/meshes/{mesh_id}/pin")
    assert client.get(f"/v1/meshes/{mesh_id}").json()["pinned"] is False


def test_a_mesh_expires_unless_a_job_names_it(client: TestClient, mesh_id: str) -> None:
    assert client.get(f"/v1/meshes/{mesh_id}").json()["expires_at"] is not None
    client.post("/v1/jobs", json={"mesh_id": mesh_id, "method": {"method": "smooth"}})
    assert client.get(f"/v1/meshes/{mesh_id}").json()["expires_at"] is None


def test_without_a_retention_nothing_expires(settings: Settings) -> None:
    keeping = settings.model_copy(update={"mesh_retention_days": 0.0, "job_retention_days": 0.0})
    with TestClient(create_app(keeping), base_url="http://127.0.0.1") as client:
        mesh_id = client.post("/v1/meshes?filename=a.ply", content=b"ply").json()["id"]
        assert client.get(f"/v1/meshes/{mesh_id}").json()["expires_at"] is None
        job = client.post("/v1/jobs", json={"mesh_id": mesh_id, "method": {"method": "smooth"}}).json()
        canceled = client.post(f"/v1/jobs/{job['id']}/cancel").json()
        assert canceled["finished_at"] is not None
        assert canceled["expires_at"] is None


@pytest.mark.parametrize("path", ["/v1/jobs/job_00000000000000000000000000/pin", f"/v1/meshes/{'0' * 64}/pin"])
@pytest.mark.parametrize("method", ["PUT", "DELETE"])
def test_nothing_can_be_pinned_that_is_not_there(client: TestClient, method: str, path: str) -> None:
    assert client.request(method, path).status_code == 404

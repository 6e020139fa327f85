"""Views over HTTP: 202 until they are made, then bytes with tags; who may see them.

Also tests `service/views.py` and `client/quadpatch_client/schema/views.py`.
"""

from collections.abc import Callable

import pytest
from starlette.testclient import TestClient

from jobkit.meshes import Meshes
from jobkit.storage.base import StoredObject
from jobkit.views import View, ViewOrder
from quadpatch_client.schema import Job, JobError, MeshProblem, ModelVersion
from service.services import Services

GLB = b"glTF, as if it were one"


@pytest.fixture
def make(services: Services) -> Callable[[ViewOrder], View]:
    """Do what a worker does with a view that can be made."""

    def run(order: ViewOrder) -> View:
        with services.store.writer("views") as writer:
            writer.write(GLB)
            stored: StoredObject = writer.commit()
        services.views.publish(services.views.start(services.views.order(order).id, "test", 30), stored)
        return services.views.order(order)

    return run


def test_a_view_is_being_made_until_it_is_there(
    client: TestClient, services: Services, mesh_id: str, make: Callable[[ViewOrder], View]
) -> None:
    path, depth = f"/v1/meshes/{mesh_id}/view?level=fine", services.queue.depth()
    for _ in range(2):
        answer = client.get(path)
        assert (answer.status_code, answer.json()) == (202, {"state": "making"})
        assert int(answer.headers["retry-after"]) > 0
        assert answer.headers["cache-control"] == "no-store"
    assert services.queue.depth() == depth + 1
    make(ViewOrder("mesh", mesh_id=mesh_id, level="fine"))
    answer = client.get(path)
    assert (answer.status_code, answer.content) == (200, GLB)
    assert answer.headers["content-type"] == "model/gltf-binary"
    assert answer.headers["cache-control"] == "private, max-age=3600"
    part = client.get(path, headers={"Range": "bytes=0-3"})
    assert (part.status_code, part.content) == (206, b"glTF")
    same = client.get(path, headers={"If-None-Match": answer.headers["etag"]})
    assert (same.status_code, same.headers["cache-control"]) == (304, "private, max-age=3600")
    assert client.head(path).headers["content-length"] == str(len(GLB))


def test_levels_are_views_of_their_own(client: TestClient, mesh_id: str, make: Callable[[ViewOrder], View]) -> None:
    make(ViewOrder("mesh", mesh_id=mesh_id, level="coarse"))
    assert client.get(f"/v1/meshes/{mesh_id}/view").status_code == 200
    assert client.get(f"/v1/meshes/{mesh_id}/view?level=fine").status_code == 202
    assert client.get(f"/v1/meshes/{mesh_id}/outlines").status_code == 202


def test_an_answer_that_waits_says_so(client: TestClient, mesh_id: str) -> None:
    answer = client.get(f"/v1/meshes/{mesh_id}/outlines", headers={"Prefer": "wait=1"})
    assert (answer.status_code, answer.headers["preference-applied"]) == (202, "wait=1")


def test_what_can_not_be_made_is_a_conflict_with_the_reason(
    client: TestClient, services: Services, mesh_id: str
) -> None:
    view = services.views.order(ViewOrder("mesh", mesh_id=mesh_id, level="coarse"))
    services.views.refuse(services.views.start(view.id, "test", 30), "empty_mesh", "no face")
    answer = client.get(f"/v1/meshes/{mesh_id}/view")
    assert (answer.status_code, answer.json()["code"]) == (409, "view_failed")
    assert "empty_mesh: no face" in answer.json()["detail"]
    assert not answer.json()["retryable"]


def test_a_rejected_mesh_has_no_view(client: TestClient, services: Services, mesh_id: str) -> None:
    analysis = services.meshes.start_analysis(mesh_id, "test", 30)
    services.meshes.reject(analysis, MeshProblem(code="unreadable_mesh", message="no mesh"))
    for path in ("view", "outlines"):
        assert client.get(f"/v1/meshes/{mesh_id}/{path}").json()["code"] == "mesh_rejected"


def test_a_view_whose_bytes_are_lost_is_made_again(
    client: TestClient, services: Services, mesh_id: str, make: Callable[[ViewOrder], View]
) -> None:
    order = ViewOrder("mesh", mesh_id=mesh_id, level="coarse")
    stored = make(order).stored
    assert stored is not None
    services.store.delete(stored.key)
    assert client.get(f"/v1/meshes/{mesh_id}/view").status_code == 202
    make(order)
    assert client.get(f"/v1/meshes/{mesh_id}/view").content == GLB


def test_a_job_is_shown_once_it_has_a_result(
    client: TestClient,
    job_id: str,
    mesh_id: str,
    finish: Callable[[str], Job],
    make: Callable[[ViewOrder], View],
) -> None:
    path = f"/v1/jobs/{job_id}/view"
    assert client.get(path).json()["code"] == "job_not_finished"
    finish(job_id)
    assert client.get(path).status_code == 202
    make(ViewOrder("job", mesh_id=mesh_id, job_id=job_id, level="coarse"))
    assert client.get(path).content == GLB
    compared = f"{path}?reference={mesh_id}"
    assert client.get(compared).status_code == 202
    make(ViewOrder("job", mesh_id=mesh_id, job_id=job_id, reference_id=mesh_id, level="coarse"))
    assert client.get(compared).content == GLB
    assert client.get(f"{path}?reference={'0' * 64}").json()["code"] == "mesh_not_found"


def test_a_job_without_a_result_is_not_shown(client: TestClient, services: Services, job_id: str) -> None:
    attempt = services.attempts.start(job_id, "test", 30).attempt
    services.attempts.fail(attempt, JobError(code="no_quads", message="too thin"))
    assert client.get(f"/v1/jobs/{job_id}/view").json()["code"] == "job_has_no_result"


def test_a_model_is_shown_once_it_is_proven(
    client: TestClient,
    dictionary_bytes: Callable[[int], bytes],
    publish: Callable[..., ModelVersion],
    make: Callable[[ViewOrder], View],
) -> None:
    publish("parts", dictionary_bytes(1))
    path = "/v1/models/parts/versions/1/picture"
    assert client.get(path).status_code == 202
    make(ViewOrder("model", model_name="parts", model_version=1))
    answer = client.get(path)
    assert (answer.content, answer.headers["content-type"]) == (GLB, "image/png")
    assert client.get("/v1/models/parts/versions/2/picture").json()["code"] == "model_not_found"
    assert client.delete("/v1/models/parts/versions/1").status_code == 204
    assert client.get(path).json()["code"] == "model_not_found"


def test_there_is_no_view_of_what_is_not_there_and_no_other_level(client: TestClient, mesh_id: str) -> None:
    assert client.get(f"/v1/meshes/{'0' * 64}/view").json()["code"] == "mesh_not_found"
    assert client.get("/v1/jobs/job_00000000000000000000000000/view").json()["code"] == "job_not_found"
    assert client.get(f"/v1/meshes/{mesh_id}/view?level=huge").json()["code"] == "invalid_request"
    assert client.get(f"/v1/meshes/{mesh_id}/view?part=1").json()["code"] == "invalid_request"


def test_a_deleted_mesh_has_no_view(
    client: TestClient, services: Services, mesh_id: str, make: Callable[[ViewOrder], View]
) -> None:
    make(ViewOrder("mesh", mesh_id=mesh_id, level="coarse"))
    assert client.delete(f"/v1/meshes/{mesh_id}").status_code == 204
    assert client.get(f"/v1/meshes/{mesh_id}/view").json()["code"] == "mesh_not_found"
    assert Meshes(services.database).page(1).items == []

"""Also tests `service.training_submission`, `quadpatch_client.schema.learning`, `quadpatch_client.schema.trainings`."""

from collections.abc import Callable
from functools import partial
from typing import Any

import pytest
from starlette.testclient import TestClient

from jobkit.database.clock import utc_now
from jobkit.errors import StaleAttemptError
from jobkit.jobs.attempts import Attempts
from jobkit.jobs.trainings import register_learned
from jobkit.jobs.turns import next_in_turn
from jobkit.meshes import Meshes
from jobkit.models.registry import MODEL_PREFIX, Registry
from jobkit.queue import NETWORKS
from quadpatch_client.schema import JobResult, MeshProblem, ModelVersion, TrainingResult
from service.services import Services

Analyse = Callable[[str], None]


@pytest.fixture
def mesh_ids(client: TestClient) -> list[str]:
    """Three meshes, the second the largest."""
    contents = [b"ply 1", b"ply 2 " + bytes(50), b"ply 3"]
    answers = [client.post(f"/v1/meshes?filename=wall-{i}.ply", content=content) for i, content in enumerate(contents)]
    return [str(answer.json()["id"]) for answer in answers]


@pytest.fixture
def train(client: TestClient, mesh_ids: list[str]) -> Callable[..., Any]:
    """Start a training of all meshes."""

    def run(**rest: Any) -> Any:
        answer = client.post("/v1/trainings", json={"model": "walls", "meshes": mesh_ids, **rest})
        assert answer.status_code == 202, answer.text
        return answer.json()

    return run


@pytest.fixture
def learn(services: Services, dictionary_bytes: Callable[[int], bytes]) -> Callable[[str], None]:
    """Do what a worker does with a training that succeeds."""

    def run(training_id: str) -> None:
        database = services.database.of("default")
        attempts, job = Attempts(database), services.jobs.get(training_id)
        assert job.spec.train is not None
        attempt = attempts.start(training_id, "test", 30).attempt
        with services.store.writer(MODEL_PREFIX) as writer:
            writer.write(dictionary_bytes(3))
            stored = writer.commit()
        row = Registry(database, services.store).prepared("walls", stored, is_proven=True)
        learned = TrainingResult.model_validate(
            {
                "model": "walls",
                "version": 1,
                "is_new": True,
                "sha256": stored.sha256,
                "learned_from": [],
                "patches": 10,
                "judged": [],
                "is_better": True,
                "verdict": "better than the plain fill on 1 of 1 mesh",
            }
        )
        result = JobResult(format="safetensors", training=learned)
        attempts.publish(attempt, result, None, partial(register_learned, row=row, train=job.spec.train))

    return run


def test_a_training_is_a_job_with_a_page_of_its_own(
    client: TestClient, mesh_ids: list[str], train: Callable[..., Any], learn: Callable[[str], None]
) -> None:
    training = train(label="walls of May", make_default="if_better", alias="walls-default")
    path = f"/v1/trainings/{training['id']}"
    assert (training["state"], training["links"]["self"], training["links"]["cancel"]) == (
        "queued",
        path,
        f"{path}/cancel",
    )
    assert training["train"]["meshes"] == mesh_ids
    job = client.get(f"/v1/jobs/{training['id']}").json()
    assert (job["spec"]["task"], job["mesh_id"]) == ("train", mesh_ids[1])
    learn(training["id"])
    ended = client.get(path, headers={"Prefer": "wait=5"}).json()
    assert (ended["state"], ended["label"]) == ("succeeded", "walls of May")
    assert ended["result"]["verdict"] == "better than the plain fill on 1 of 1 mesh: made walls-default"
    assert client.get(ended["links"]["model"]).json()["aliases"] == ["walls-default"]
    events = client.get(f"{path}/events").json()["items"]
    assert [event["type"] for event in events] == ["queued", "started", "succeeded"]
    assert client.get(f"/v1/jobs/{training['id']}/result").status_code == 404
    assert [entry["id"] for entry in client.get("/v1/trainings?state=succeeded").json()["items"]] == [training["id"]]


def test_trainings_are_listed_apart_from_other_jobs(client: TestClient, job_id: str, train: Callable[..., Any]) -> None:
    training = train()
    assert [entry["id"] for entry in client.get("/v1/trainings").json()["items"]] == [training["id"]]
    assert [entry["id"] for entry in client.get("/v1/jobs").json()["items"]] == [training["id"], job_id]
    for suffix in ("", "/events"):
        answer = client.get(f"/v1/trainings/{job_id}{suffix}")
        assert (answer.status_code, answer.json()["code"]) == (404, "job_not_found")
    assert client.post(f"/v1/trainings/{job_id}/cancel").status_code == 404
    assert client.get(f"/v1/jobs/{job_id}").json()["state"] == "queued"


@pytest.fixture
def able(services: Services) -> None:
    """Let a worker that fits networks be known to the queue."""
    key = "rq:worker:able"
    services.queue.connection.sadd(f"rq:workers:{services.settings.queue_name}", key)
    services.queue.note_abilities(key, [NETWORKS])


def test_no_network_is_promised_that_no_worker_can_fit(client: TestClient, mesh_ids: list[str]) -> None:
    body = {"model": "nets", "kind": "network", "meshes": mesh_ids}
    answer = client.post("/v1/trainings", json=body)
    assert (answer.status_code, answer.json()["code"]) == (409, "no_network_worker")
    assert client.get("/v1/trainings").json()["items"] == []
    assert client.get("/v1/limits").json()["trainings"] == ["dictionary"]


@pytest.mark.usefixtures("able")
def test_a_network_is_a_training_like_others(client: TestClient, train: Callable[..., Any]) -> None:
    assert client.get("/v1/limits").json()["trainings"] == ["dictionary", "network"]
    training = train(kind="network", network={"steps": 7})
    said = training["train"]
    assert (said["kind"], said["network"]["steps"], said["alias"]) == ("network", 7, "default-network")
    job = client.get(f"/v1/jobs/{training['id']}").json()
    assert job["model"]["kind"] == "self_network"
    assert train(model="fences", kind="network", alias="mine")["train"]["alias"] == "mine"


def test_a_worker_without_torch_leaves_networks_to_others(
    services: Services, able: None, train: Callable[..., Any]
) -> None:
    network, dictionary = train(kind="network"), train(model="fences")
    unable = Attempts(services.database, fits_networks=False)
    with services.database.read() as session:
        assert next_in_turn(session, utc_now()) == network["id"]
        assert next_in_turn(session, utc_now(), fits_networks=False) == dictionary["id"]
    with pytest.raises(StaleAttemptError, match="for a worker that fits networks"):
        unable.start(network["id"], "w", 30)
    assert unable.start(dictionary["id"], "w", 30).job.id == dictionary["id"]
    assert services.attempts.start(network["id"], "w", 30).job.id == network["id"]


def test_a_training_is_canceled_once(client: TestClient, train: Callable[..., Any]) -> None:
    path = train()["links"]["cancel"]
    assert [client.post(path).json()["state"] for _ in range(2)] == ["canceled", "canceled"]


def test_a_filter_finds_what_is_analysed(client: TestClient, mesh_ids: list[str], analyse: Analyse) -> None:
    body = {"model": "walls", "filter": {"filename": "WALL-*.ply"}}
    answer = client.post("/v1/trainings", json=body)
    assert (answer.status_code, answer.json()["code"]) == (409, "no_training_mesh")
    for mesh_id in mesh_ids[:2]:
        analyse(mesh_id)
    found = client.post("/v1/trainings", json=body).json()["train"]["meshes"]
    assert sorted(found) == sorted(mesh_ids[:2])
    one = {"model": "walls", "filter": {"filename": "wall-*.ply", "most": 1}}
    assert client.post("/v1/trainings", json=one).json()["train"]["meshes"] == [mesh_ids[1]]


def test_a_repeated_request_is_the_same_training_whatever_the_filter_finds_now(
    client: TestClient, mesh_ids: list[str], analyse: Analyse
) -> None:
    body, key = {"model": "walls", "filter": {"format": "ply"}}, {"Idempotency-Key": "a"}
    analyse(mesh_ids[0])
    first = client.post("/v1/trainings", json=body, headers=key)
    analyse(mesh_ids[1])
    second = client.post("/v1/trainings", json=body, headers=key)
    assert (second.status_code, second.headers["idempotent-replayed"]) == (202, "true")
    assert second.json()["id"] == first.json()["id"]
    other = client.post("/v1/trainings", json=body | {"model": "fences"}, headers=key)
    assert (other.status_code, other.json()["code"]) == (409, "idempotency_conflict")


@pytest.mark.parametrize(
    ("body", "place"),
    [
        ({"model": "walls"}, ""),
        ({"model": "walls", "meshes": ["0" * 64], "filter": {}}, ""),
        ({"model": "walls", "meshes": ["0" * 64, "0" * 64]}, ""),
        ({"model": "walls", "meshes": []}, "/meshes"),
        ({"model": "walls", "meshes": ["0" * 64], "options": {"atoms": 4}}, "/options/atoms"),
        ({"model": "walls", "meshes": ["0" * 64], "options": {"held_out": 0.9}}, "/options/held_out"),
        ({"model": "No Name", "meshes": ["0" * 64]}, "/model"),
        ({"model": "nets", "kind": "network", "meshes": ["0" * 64], "options": {}}, ""),
        ({"model": "nets", "meshes": ["0" * 64], "network": {"steps": 5}}, ""),
        ({"model": "nets", "kind": "network", "meshes": ["0" * 64], "network": {"steps": 0}}, "/network/steps"),
        ({"model": "nets", "kind": "tree", "meshes": ["0" * 64]}, "/kind"),
    ],
)
def test_what_makes_no_sense_is_refused_with_its_place(client: TestClient, body: Any, place: str) -> None:
    answer = client.post("/v1/trainings", json=body)
    assert (answer.status_code, answer.json()["code"]) == (422, "invalid_request")
    assert [error["pointer"] for error in answer.json()["errors"]] == [place]


def test_what_cannot_be_learned_from_or_named_is_refused(
    client: TestClient,
    services: Services,
    mesh_ids: list[str],
    publish: Callable[..., ModelVersion],
    dictionary_bytes: Any,
) -> None:
    def refused(**rest: Any) -> tuple[int, str]:
        answer = client.post("/v1/trainings", json={"model": "walls", "meshes": mesh_ids, **rest})
        return answer.status_code, answer.json()["code"]

    publish("fences", dictionary_bytes(1))
    client.put("/v1/aliases/candidate", json={"model": "fences"})
    assert refused(model="candidate") == (409, "name_taken")
    assert refused(model="self") == (409, "name_taken")
    assert refused(model="walls", alias="walls", make_default="if_better") == (409, "name_taken")
    assert refused(meshes=["0" * 64]) == (404, "mesh_not_found")
    assert refused(limits={"time_s": 86_400.0}) == (403, "over_service_limit")
    meshes = Meshes(services.database)
    meshes.reject(meshes.start_analysis(mesh_ids[0], "test", 30), MeshProblem(code="empty_mesh", message="no face"))
    assert refused() == (409, "mesh_rejected")


def test_other_routes_start_no_training(client: TestClient, train: Callable[..., Any], mesh_id: str) -> None:
    training = train()
    spec = client.get(f"/v1/jobs/{training['id']}").json()["spec"]
    for body in ({"mesh_id": mesh_id, "task": "train"}, spec, {"mesh_id": mesh_id, "train": spec["train"]}):
        answer = client.post("/v1/jobs", json=body)
        assert (answer.status_code, answer.json()["code"]) == (422, "options_conflict")
    answer = client.post(f"/v1/jobs/{training['id']}/rerun")
    assert (answer.status_code, answer.json()["code"]) == (422, "options_conflict")

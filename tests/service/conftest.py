"""The app in this process, and hands that do what a worker does."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from starlette.testclient import TestClient

from jobkit.settings import Settings
from jobkit.storage.base import result_key
from quadpatch_client.schema import BoundingBox, Hole, HoleCounts, Job, JobResult, MeshFacts, ModelVersion, ResultFile
from service.app import create_app
from service.services import Services

FILES = (
    ("result", "repaired.ply", b"ply, repaired"),
    ("report", "report.json", b'{"schema": 1}'),
    ("preview", "preview.png", b"\x89PNG\r\n\x1a\n"),
    ("closeups", "closeups.zip", b"PK\x05\x06" + bytes(18)),
    ("html_report", "report.html", b"<!DOCTYPE html>"),
    ("pdf_report", "report.pdf", b"%PDF-1.4"),
)


@pytest.fixture
def client(settings: Settings) -> Iterator[TestClient]:
    with TestClient(create_app(settings), base_url="http://127.0.0.1") as client:
        yield client


@pytest.fixture
def services(client: TestClient) -> Services:
    opened: Services = client.app.state.services  # type: ignore[attr-defined]
    return opened


@pytest.fixture
def mesh_id(client: TestClient) -> str:
    answer = client.post("/v1/meshes?filename=part 7.ply", content=b"ply\nformat ascii 1.0\nend_header\n")
    assert answer.status_code == 201, answer.text
    return str(answer.json()["id"])


@pytest.fixture
def job_id(client: TestClient, mesh_id: str) -> str:
    answer = client.post("/v1/jobs", json={"mesh_id": mesh_id, "method": {"method": "smooth"}})
    assert answer.status_code == 202, answer.text
    return str(answer.json()["id"])


@pytest.fixture
def finish(services: Services, tmp_path: Path) -> Callable[[str], Job]:
    """Do what a worker does with a job that succeeds."""

    def run(job_id: str) -> Job:
        attempt = services.attempts.start(job_id, "test", 30).attempt
        files = []
        for role, name, data in FILES:
            path = tmp_path / name
            path.write_bytes(data)
            stored = services.store.put_file(result_key(job_id, attempt.number, name), path)
            facts = {"media_type": "application/octet-stream", "size_bytes": len(data), "sha256": stored.sha256}
            files.append(ResultFile.model_validate({"role": role, "name": name, **facts}))
        services.attempts.publish(attempt, JobResult(format="ply", holes=HoleCounts(found=1), files=files))
        return services.jobs.get(job_id)

    return run


@pytest.fixture
def publish(client: TestClient, services: Services) -> Callable[..., ModelVersion]:
    """Publish a model, and do what a worker does with one that can be used; keywords as `client.post` takes them."""

    def run(name: str, content: bytes | None = None, **rest: Any) -> ModelVersion:
        answer = client.post(f"/v1/models/{name}/versions", content=content, headers={"Prefer": "wait=0"}, **rest)
        assert answer.status_code == 202, answer.text
        published = ModelVersion.model_validate(answer.json())
        reference = f"{name}@{published.version}"
        services.proofs.accept(services.proofs.start(reference, "test", 30))
        return services.registry.resolve(reference)

    return run


@pytest.fixture
def analyse(services: Services) -> Callable[[str], None]:
    """Do what a worker does with a mesh that can be read: three holes, 10, 2 and 1 mesh units wide."""

    def run(mesh_id: str) -> None:
        holes = [
            Hole(id=i, perimeter=3.2 * d, diameter=d, area=0.7 * d * d, planarity=0.0, edges=12)
            for i, d in enumerate((10.0, 2.0, 1.0))
        ]
        facts = MeshFacts(
            format="ply",
            vertices=100,
            triangles=180,
            bounding_box=BoundingBox(min=[0, 0, 0], max=[10, 10, 2]),
            diagonal=14.3,
            mean_edge_length=0.5,
            holes=holes,
        )
        services.meshes.publish(services.meshes.start_analysis(mesh_id, "test", 30), facts)

    return run

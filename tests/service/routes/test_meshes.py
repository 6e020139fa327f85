"""Also tests `service.uploads`."""

import gzip
import hashlib
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from starlette.testclient import TestClient

from jobkit.database.session import Database
from jobkit.database.tables import MeshRow
from jobkit.settings import Settings
from jobkit.storage.base import ObjectStore
from jobkit.storage.digests import digest_field
from quadpatch_client.schema import MeshProblem
from service.app import create_app
from service.services import Services

DATA = b"ply\nformat binary_little_endian 1.0\n"


@pytest.fixture
def small(settings: Settings) -> Iterator[TestClient]:
    limited = settings.model_copy(update={"max_upload_mb": 1})
    with TestClient(create_app(limited), base_url="http://127.0.0.1") as client:
        yield client


@pytest.fixture
def stored_files(settings: Settings, store: ObjectStore) -> Callable[[], list[str]]:
    """All files of the store, and incoming ones."""

    def listing() -> list[str]:
        folders = (settings.data_dir / "objects" / "incoming", settings.data_dir / "scratch")
        return [found.key for found in store.keys("meshes")] + [str(p) for f in folders for p in f.glob("*")]

    return listing


@pytest.mark.parametrize(
    "request_of",
    [
        {"content": DATA, "params": {"filename": "scan.ply"}},
        {"content": DATA, "headers": {"Content-Disposition": 'attachment; filename="scan.ply"'}},
        {"content": DATA, "headers": {"Content-Type": "model/ply"}, "params": {"filename": "scan.ply"}},
        {"content": iter([DATA[:5], DATA[5:]]), "params": {"filename": "scan.ply", "format": "ply"}},
        {"files": {"file": ("scan.ply", DATA)}},
    ],
    ids=["raw", "named by header", "media type", "chunked", "form"],
)
def test_a_mesh_can_be_uploaded_in_every_usual_way(client: TestClient, request_of: dict[str, Any]) -> None:
    answer = client.post("/v1/meshes", **request_of)
    assert answer.status_code == 201
    mesh = answer.json()
    assert mesh["id"] == hashlib.sha256(DATA).hexdigest()
    assert (mesh["filename"], mesh["format"], mesh["size_bytes"]) == ("scan.ply", "ply", len(DATA))
    assert mesh["state"] == "analysing"
    assert answer.headers["location"] == mesh["links"]["self"]
    assert client.get(mesh["links"]["content"]).content == DATA


def test_the_same_bytes_are_the_same_mesh(client: TestClient, stored_files: Callable[[], list[str]]) -> None:
    first = client.post("/v1/meshes?filename=a.ply", content=DATA)
    second = client.post("/v1/meshes?filename=b.ply", content=DATA)
    assert (first.status_code, second.status_code) == (201, 200)
    kept_from, kept_on_from = first.json().pop("expires_at"), second.json().pop("expires_at")
    assert kept_from < kept_on_from
    assert second.json() | {"expires_at": kept_from} == first.json() | {"filename": "b.ply"}
    assert len(stored_files()) == 1


def test_a_fresh_mesh_is_queued_for_its_analysis(client: TestClient, services: Services, mesh_id: str) -> None:
    assert f"mesh_{mesh_id}-1" in services.queue.entries()


@pytest.mark.parametrize("kind", ["stated", "chunked", "form"])
def test_a_body_over_the_limit_is_refused_and_leaves_nothing(
    small: TestClient, stored_files: Callable[[], list[str]], kind: str
) -> None:
    too_much = b"0" * ((1 << 20) + 1)
    if kind == "form":
        answer = small.post("/v1/meshes", files={"file": ("a.ply", too_much)})
    else:
        answer = small.post("/v1/meshes", content=iter([too_much]) if kind == "chunked" else too_much)
    assert answer.status_code == 413
    assert answer.json()["code"] == "body_too_large"
    assert str(1 << 20) in answer.json()["detail"]
    assert stored_files() == []


def test_a_body_of_exactly_the_limit_is_taken(small: TestClient) -> None:
    assert small.post("/v1/meshes", content=b"0" * (1 << 20)).status_code == 201


@pytest.mark.parametrize(
    ("request_of", "status", "code"),
    [
        ({"content": b""}, 400, "empty_file"),
        ({"files": {"file": ("a.ply", b"")}}, 400, "empty_file"),
        ({"files": {"mesh": ("a.ply", DATA)}}, 422, "invalid_request"),
        ({"files": [("file", ("a.ply", DATA)), ("file", ("b.ply", DATA))]}, 400, "malformed_multipart"),
        ({"content": DATA, "headers": {"Content-Type": "application/json"}}, 415, "unsupported_media_type"),
        ({"data": {"file": "ply"}}, 415, "unsupported_media_type"),
        ({"content": DATA, "headers": {"Content-Type": "multipart/form-data"}}, 400, "malformed_multipart"),
        ({"content": DATA, "params": {"format": "dwg"}}, 422, "invalid_request"),
        ({"content": DATA, "params": {"filename": "a" * 256}}, 422, "invalid_request"),
    ],
)
def test_an_upload_that_makes_no_sense_is_refused(
    client: TestClient, stored_files: Callable[[], list[str]], request_of: dict[str, Any], status: int, code: str
) -> None:
    answer = client.post("/v1/meshes", **request_of)
    assert (answer.status_code, answer.json()["code"]) == (status, code)
    assert stored_files() == []


def test_a_file_of_unknown_format_is_left_to_the_worker(client: TestClient) -> None:
    answer = client.post("/v1/meshes?filename=scan.xyz", content=b"1 2 3")
    assert answer.status_code == 201
    assert answer.json()["format"] is None


def test_facts_and_holes_show_once_the_mesh_is_analysed(
    client: TestClient, mesh_id: str, analyse: Callable[[str], None]
) -> None:
    waiting = client.get(f"/v1/meshes/{mesh_id}")
    assert waiting.json()["facts"] is None
    assert waiting.headers["retry-after"] == "2"
    analyse(mesh_id)
    ready = client.get(f"/v1/meshes/{mesh_id}?wait=30", headers={"Prefer": "wait=30"})
    assert ready.json()["state"] == "ready"
    assert [hole["diameter"] for hole in ready.json()["facts"]["holes"]] == [10.0, 2.0, 1.0]
    assert "retry-after" not in ready.headers
    assert ready.headers["preference-applied"] == "wait=30"


def test_a_rejected_mesh_says_why_and_takes_no_job(client: TestClient, services: Services, mesh_id: str) -> None:
    problem = MeshProblem(code="unreadable_mesh", message="the header promises 10 vertices, 3 follow")
    services.meshes.reject(services.meshes.start_analysis(mesh_id, "test", 30), problem)
    mesh = client.get(f"/v1/meshes/{mesh_id}").json()
    assert (mesh["state"], mesh["problem"]["code"]) == ("rejected", "unreadable_mesh")
    answer = client.post("/v1/jobs", json={"mesh_id": mesh_id, "method": {"method": "smooth"}})
    assert (answer.status_code, answer.json()["code"]) == (409, "mesh_rejected")
    assert "3 follow" in answer.json()["detail"]


def test_while_the_store_is_away_clients_are_told_to_come_again(
    client: TestClient, mesh_id: str, break_store: Callable[[], None]
) -> None:
    break_store()
    for answer in (client.get(f"/v1/meshes/{mesh_id}/content"), client.post("/v1/meshes?filename=b.ply", content=DATA)):
        assert (answer.status_code, answer.json()["code"]) == (503, "store_unavailable")
        assert (answer.headers["retry-after"], answer.json()["retryable"]) == ("2", True)
    assert client.get(f"/v1/meshes/{mesh_id}").status_code == 200


def test_while_the_database_is_away_clients_are_told_to_come_again(
    client: TestClient, services: Services, mesh_id: str, break_database: Callable[[], None]
) -> None:
    services.database.close()
    break_database()
    for answer in (client.get(f"/v1/meshes/{mesh_id}"), client.post("/v1/jobs", json={"mesh_id": mesh_id})):
        assert (answer.status_code, answer.json()["code"]) == (503, "database_unavailable")
        assert answer.headers["retry-after"] == "2"


def test_bytes_that_are_there_need_not_be_sent(client: TestClient, mesh_id: str) -> None:
    headers = {"Repr-Digest": digest_field(mesh_id)}
    answer = client.post("/v1/meshes?filename=other.ply", headers=headers)
    assert (answer.status_code, answer.json()["id"], answer.json()["filename"]) == (200, mesh_id, "other.ply")
    assert answer.headers["location"] == f"/v1/meshes/{mesh_id}"
    # A client that waits for 100 (Continue) gets the answer before it sends: the body is not read.
    unread = client.post("/v1/meshes", content=b"anything", headers=headers)
    assert (unread.status_code, unread.json()["id"]) == (200, mesh_id)


def test_bytes_that_are_not_there_are_asked_for(client: TestClient) -> None:
    headers = {"Repr-Digest": digest_field(hashlib.sha256(b"new").hexdigest())}
    answer = client.post("/v1/meshes", headers=headers)
    assert (answer.status_code, answer.json()["code"]) == (404, "mesh_not_found")
    assert client.post("/v1/meshes", content=b"new", headers=headers).status_code == 201


def test_bytes_that_the_store_has_lost_are_asked_for(client: TestClient, services: Services, mesh_id: str) -> None:
    services.store.delete(services.meshes.source(mesh_id).key)
    headers = {"Repr-Digest": digest_field(mesh_id)}
    assert client.post("/v1/meshes", headers=headers).status_code == 404


def test_bytes_that_are_known_to_be_damaged_are_asked_for(
    client: TestClient, services: Services, database: Database, mesh_id: str
) -> None:
    with database.write() as session:
        row = session.get_one(MeshRow, mesh_id)
        row.state, row.problem = "rejected", {"code": "mesh_damaged", "message": "damaged"}
    headers = {"Repr-Digest": digest_field(mesh_id)}
    assert client.post("/v1/meshes", headers=headers).status_code == 404
    data = b"".join(services.store.read(services.meshes.source(mesh_id).key))
    again = client.post("/v1/meshes", content=data, headers=headers)
    assert (again.status_code, again.json()["state"]) == (200, "analysing")


def test_a_digest_under_a_coding_names_no_file(client: TestClient, mesh_id: str) -> None:
    sha256 = digest_field(mesh_id)
    coded = {"Content-Encoding": "gzip", "Repr-Digest": sha256}
    assert client.post("/v1/meshes", content=gzip.compress(b"x"), headers=coded).json()["code"] == "digest_mismatch"
    known = client.post("/v1/meshes", headers={"Content-Encoding": "gzip", "Unencoded-Digest": sha256})
    assert (known.status_code, known.json()["id"]) == (200, mesh_id)

"""Letter E: what is stored is what was sent; damage in the store reaches no job and no client as if it were whole.

Also tests `service.digests`.
"""

import base64
import gzip
import hashlib
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from starlette.testclient import TestClient

from dispatcher.scrub import Scrub, ScrubLimits
from jobkit.database.session import Database
from jobkit.errors import ObjectDamagedError
from jobkit.jobs.jobs import Jobs
from jobkit.jobs.new_jobs import NewJob
from jobkit.meshes import MESH_DAMAGED, Meshes
from jobkit.settings import Settings
from jobkit.storage.base import CHUNK_BYTES, ObjectStore, StoredObject
from jobkit.storage.digests import verified_chunks
from quadpatch_client.schema import JobSpec, JobState, MeshState, ResolvedModel
from service.app import create_app
from tests.integration.conftest import ply_bytes, punched_relief
from tests.jobkit.fixtures import DAY, age_rows, finish, new_job
from tests.jobkit.fixtures import damage as damage_object
from tests.worker.test_repairs import working
from worker.jobs import inspect_mesh, run_job

DATA = b"ply\nformat binary_little_endian 1.0\n"
BOUNDARY = "frontier"


@pytest.fixture
def client(settings: Settings) -> Iterator[TestClient]:
    with TestClient(create_app(settings), base_url="http://127.0.0.1", raise_server_exceptions=False) as client:
        yield client


@pytest.fixture
def damage(store: ObjectStore, tmp_path: Path) -> Callable[[str], None]:
    """Flip four bytes in the middle of an object, as a disk may."""

    return lambda key: damage_object(store, key, tmp_path)


def stored_mesh(store: ObjectStore) -> StoredObject:
    with store.writer("meshes") as writer:
        writer.write(ply_bytes(*punched_relief(20, 1)))
        return writer.commit()


def digest(data: bytes, algorithm: str = "sha256") -> str:
    return f"sha-{algorithm[3:]}=:{base64.b64encode(hashlib.new(algorithm, data).digest()).decode()}:"


def test_a_job_on_a_damaged_mesh_fails_and_says_so(
    settings: Settings, database: Database, store: ObjectStore, damage: Callable[[str], None]
) -> None:
    stored = stored_mesh(store)
    mesh = Meshes(database).add(stored, "scan.ply", "ply")[0]
    spec = JobSpec.model_validate({"mesh_id": mesh.id, "method": {"method": "smooth"}, "output": {"preview": False}})
    job = Jobs(database).create(NewJob(spec, ResolvedModel(requested="smooth", kind="none"), 3))[0]
    damage(stored.key)
    with working(settings, database, store) as context:
        run_job(job.id)
        ended = context.jobs.get(job.id)
    assert ended.state is JobState.FAILED
    assert ended.error is not None
    assert (ended.error.code, ended.error.retryable) == (MESH_DAMAGED, False)


def test_a_damaged_mesh_is_analysed_again_once_its_bytes_come_back(
    settings: Settings, database: Database, store: ObjectStore, damage: Callable[[str], None]
) -> None:
    stored, meshes = stored_mesh(store), Meshes(database)
    mesh = meshes.add(stored, "scan.ply", "ply")[0]
    damage(stored.key)
    with working(settings, database, store):
        inspect_mesh(mesh.id)
        rejected = meshes.get(mesh.id)
        assert rejected.state is MeshState.REJECTED
        assert rejected.problem is not None
        assert rejected.problem.code == MESH_DAMAGED
        meshes.add(stored_mesh(store), "scan.ply", "ply")
        inspect_mesh(mesh.id)
        assert meshes.get(mesh.id).state is MeshState.READY


@pytest.mark.parametrize("length", [0, 1, CHUNK_BYTES, 3 * CHUNK_BYTES + 1])
def test_the_last_chunk_comes_only_if_all_are_right(length: int) -> None:
    data = bytes(length)
    chunks = [data[i : i + CHUNK_BYTES] for i in range(0, length, CHUNK_BYTES)]
    assert b"".join(verified_chunks(chunks, hashlib.sha256(data).hexdigest())) == data
    received = bytearray()
    with pytest.raises(ObjectDamagedError):
        received.extend(byte for chunk in verified_chunks(chunks, "0" * 64) for byte in chunk)
    assert len(received) <= max(0, length - 1)


def test_content_states_its_digest_and_damaged_content_is_not_sent_whole(
    client: TestClient, damage: Callable[[str], None]
) -> None:
    mesh_id = client.post("/v1/meshes?filename=a.ply", content=DATA).json()["id"]
    path = f"/v1/meshes/{mesh_id}/content"
    answer = client.get(path)
    assert answer.content == DATA
    assert answer.headers["repr-digest"] == digest(DATA)
    part = client.get(path, headers={"Range": "bytes=1-2"})
    assert (part.status_code, part.headers["repr-digest"]) == (206, digest(DATA))
    damage(f"meshes/{mesh_id[:2]}/{mesh_id}")
    assert len(client.get(path).content) < len(DATA)


def test_what_the_scrub_found_damaged_is_refused_under_its_code(
    client: TestClient, database: Database, store: ObjectStore, damage: Callable[[str], None]
) -> None:
    mesh_id = client.post("/v1/meshes?filename=a.ply", content=DATA).json()["id"]
    mesh = Meshes(database).get(mesh_id)
    job = finish(database, store, Jobs(database).create(new_job(mesh))[0].id)
    model = client.get("/v1/models").json()
    assert model["models"] == []
    keys = [f"meshes/{mesh_id[:2]}/{mesh_id}", f"results/{job.id}/{job.attempt}/repaired.ply"]
    for key in keys:
        damage(key)
    age_rows(database, 28 * DAY)
    assert Scrub(database, store, ScrubLimits(30, 1e9)).round().damaged == len(keys)
    for path in (f"/v1/meshes/{mesh_id}/content", f"/v1/jobs/{job.id}/result"):
        for method, headers in (("GET", {}), ("GET", {"Range": "bytes=0-1"}), ("HEAD", {})):
            assert client.request(method, path, headers=headers).status_code == 410
        assert client.get(path).json()["code"] == "object_damaged"
    refused = client.post("/v1/jobs", json={"mesh_id": mesh_id, "method": {"method": "smooth"}})
    assert (refused.status_code, refused.json()["code"]) == (409, "mesh_rejected")
    assert MESH_DAMAGED in refused.json()["detail"]
    assert client.post("/v1/meshes?filename=a.ply", content=DATA).json()["state"] == "analysing"
    assert client.get(f"/v1/meshes/{mesh_id}/content").content == DATA


def form(data: bytes, name: str = "file", *headers: str) -> tuple[bytes, str]:
    lines = (f'Content-Disposition: form-data; name="{name}"; filename="a.ply"', *headers)
    head = f"--{BOUNDARY}\r\n" + "".join(f"{line}\r\n" for line in lines) + "\r\n"
    return head.encode() + data + f"\r\n--{BOUNDARY}--\r\n".encode(), f"multipart/form-data; boundary={BOUNDARY}"


@pytest.mark.parametrize("header", ["Content-Digest", "Repr-Digest"])
@pytest.mark.parametrize("algorithm", ["sha256", "sha512"])
@pytest.mark.parametrize("is_form", [False, True])
def test_a_stated_digest_is_held_against_what_arrived(
    client: TestClient, store: ObjectStore, header: str, algorithm: str, is_form: bool
) -> None:
    body, media_type = form(DATA) if is_form else (DATA, "model/ply")
    headers = {"Content-Type": media_type}
    wrong = client.post("/v1/meshes", content=body, headers={**headers, header: digest(body + b"x", algorithm)})
    assert (wrong.status_code, wrong.json()["code"]) == (400, "digest_mismatch")
    assert list(store.keys("meshes")) == []
    right = client.post(
        "/v1/meshes", content=body, headers={**headers, header: "md5=:AAAA:, " + digest(body, algorithm)}
    )
    assert right.status_code == 201


@pytest.mark.parametrize("header", ["Content-Digest", "Repr-Digest"])
@pytest.mark.parametrize("algorithm", ["sha256", "sha512"])
@pytest.mark.parametrize(
    ("path", "name"), [("/v1/meshes", "file"), ("/v1/repairs", "mesh"), ("/v1/models/parts/versions", "artifact")]
)
def test_a_digest_among_the_headers_of_a_part_is_held_against_that_part(
    client: TestClient, store: ObjectStore, header: str, algorithm: str, path: str, name: str
) -> None:
    wrong, media_type = form(DATA, name, f"{header}: {digest(DATA + b'x', algorithm)}")
    answer = client.post(path, content=wrong, headers={"Content-Type": media_type})
    assert (answer.status_code, answer.json()["code"]) == (400, "digest_mismatch")
    assert [*store.keys("meshes"), *store.keys("models")] == []
    right, media_type = form(DATA, name, f"{header}: md5=:AAAA:", f"{header}: {digest(DATA, algorithm)}")
    answer = client.post(path, content=right, headers={"Content-Type": media_type})
    taken = {
        "/v1/meshes": (201, None),
        "/v1/repairs": (202, None),
        "/v1/models/parts/versions": (422, "unusable_model"),
    }
    assert (answer.status_code, answer.json().get("code")) == taken[path]


def test_a_field_beside_the_file_is_checked_as_well(client: TestClient) -> None:
    mesh, media_type = form(DATA, "mesh")
    spec = b'{"method": {"method": "smooth"}}'
    for stated, status in ((spec, 202), (spec + b" ", 400)):
        field, _ = form(spec, "spec", f"Content-Digest: {digest(stated)}")
        body = mesh.removesuffix(f"--{BOUNDARY}--\r\n".encode()) + field
        answer = client.post("/v1/repairs", content=body, headers={"Content-Type": media_type})
        assert answer.status_code == status, answer.text


@pytest.mark.parametrize("stated", [b'{"model": "general"}', b""])
@pytest.mark.parametrize(("method", "path"), [("POST", "/v1/jobs"), ("PUT", "/v1/aliases/a"), ("POST", "/v1/webhooks")])
def test_a_json_body_is_held_against_its_digest(client: TestClient, method: str, path: str, stated: bytes) -> None:
    body, media_type = b'{"model": "general-dictionary"}', "application/json"
    headers = {"Content-Type": media_type, "Content-Digest": digest(stated)}
    answer = client.request(method, path, content=body, headers=headers)
    assert (answer.status_code, answer.json()["code"]) == (400, "digest_mismatch")
    answer = client.request(method, path, content=gzip.compress(body), headers={**headers, "Content-Encoding": "gzip"})
    assert (answer.status_code, answer.json()["code"]) == (415, "unsupported_encoding")


@pytest.mark.parametrize("coding", ["Content-Encoding: gzip", "Content-Transfer-Encoding: base64"])
def test_a_coded_part_is_refused_and_never_stored(client: TestClient, store: ObjectStore, coding: str) -> None:
    body, media_type = form(gzip.compress(DATA), "file", coding)
    answer = client.post("/v1/meshes", content=body, headers={"Content-Type": media_type})
    assert (answer.status_code, answer.json()["code"]) == (415, "unsupported_encoding")
    assert list(store.keys("meshes")) == []
    body, media_type = form(DATA, "file", "Content-Transfer-Encoding: binary", "Content-Encoding: identity")
    assert client.post("/v1/meshes", content=body, headers={"Content-Type": media_type}).status_code == 201


@pytest.mark.parametrize("value", ["sha-256=abc", "sha-256", ":", "sha-256=:a:", 'sha-256="x"', "sha-256=:$$$$:"])
def test_a_digest_that_cannot_be_read_is_refused(client: TestClient, value: str) -> None:
    answer = client.post("/v1/meshes", content=DATA, headers={"Content-Digest": value})
    assert (answer.status_code, answer.json()["code"]) == (400, "malformed_digest")
    body, media_type = form(DATA, "file", f"Content-Digest: {value}")
    answer = client.post("/v1/meshes", content=body, headers={"Content-Type": media_type})
    assert (answer.status_code, answer.json()["code"]) == (400, "malformed_digest")


@pytest.mark.parametrize("coding", ["br", "deflate", "gzip, gzip", "x-gzip", "identity, gzip"])
@pytest.mark.parametrize("path", ["/v1/meshes", "/v1/models/ripples/versions"])
def test_a_coded_body_is_refused_and_never_stored(
    client: TestClient, store: ObjectStore, coding: str, path: str
) -> None:
    answer = client.post(path, content=gzip.compress(DATA), headers={"Content-Encoding": coding})
    assert answer.status_code == 415, answer.text
    assert answer.json()["code"] == "unsupported_encoding"
    assert answer.headers["accept-encoding"] == "gzip, zstd, identity"
    assert list(store.keys("meshes")) == []


def test_a_body_whose_coding_is_named_identity_is_taken(client: TestClient) -> None:
    assert client.post("/v1/meshes", content=DATA, headers={"Content-Encoding": "identity"}).status_code == 201

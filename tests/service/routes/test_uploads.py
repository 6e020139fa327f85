"""The protocol tus 1.0 by hand.

Also tests `service.routes.upload_headers`, `service.upload_parts`, `service.upload_completion` and
`quadpatch_client.schema.uploads`.
"""

import base64
import hashlib
import itertools
import random
import threading
from collections.abc import Callable, Iterator
from datetime import timedelta
from email.utils import parsedate_to_datetime
from typing import Any

import pytest
from starlette.testclient import TestClient

from jobkit.database.clock import utc_now
from jobkit.database.session import Database
from jobkit.database.upload_tables import UploadRow
from jobkit.errors import DatabaseUnavailableError
from jobkit.meshes import Meshes
from jobkit.settings import Settings
from jobkit.storage.base import ObjectStore
from jobkit.uploads.parts import PART_BYTES
from jobkit.uploads.uploads import Uploads
from service import upload_completion
from service.app import create_app
from service.services import Services
from tests.waiting import GUARD_S

TUS = {"Tus-Resumable": "1.0.0"}
BYTES = {**TUS, "Content-Type": "application/offset+octet-stream"}
DATA = random.Random(3).randbytes(100_000)
LARGE = random.Random(4).randbytes(2 * PART_BYTES + 12_345)


def sha256(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()


def metadata(**values: str) -> dict[str, str]:
    pairs = (f"{key} {base64.b64encode(value.encode()).decode()}" for key, value in values.items())
    return {"Upload-Metadata": ",".join(pairs)}


def checksum(data: bytes, algorithm: str = "sha256") -> dict[str, str]:
    digest = base64.b64encode(hashlib.new(algorithm, data).digest()).decode()
    return {"Upload-Checksum": f"{algorithm} {digest}"}


def start(client: TestClient, size: int = len(DATA), /, **headers: str) -> str:
    named = {name.replace("_", "-"): value for name, value in headers.items()}
    answer = client.post("/v1/uploads", headers={**TUS, "Upload-Length": str(size), **named})
    assert answer.status_code == 201, answer.text
    return str(answer.headers["location"])


def send(client: TestClient, path: str, data: bytes, offset: int, **headers: str) -> Any:
    named = {name.replace("_", "-"): value for name, value in headers.items()}
    return client.patch(path, content=data, headers={**BYTES, "Upload-Offset": str(offset), **named})


def offset_of(client: TestClient, path: str) -> int:
    return int(client.head(path, headers=TUS).headers["upload-offset"])


def keys(store: ObjectStore, prefix: str) -> list[str]:
    return [listed.key for listed in store.keys(prefix)]


def code(answer: Any) -> tuple[int, str]:
    assert answer.headers["tus-resumable"] == "1.0.0"
    return answer.status_code, answer.json()["code"]


def test_options_says_what_is_offered(client: TestClient, settings: Settings) -> None:
    answer = client.options("/v1/uploads")
    assert (answer.status_code, answer.content) == (204, b"")
    assert answer.headers["tus-version"] == answer.headers["tus-resumable"] == "1.0.0"
    assert answer.headers["tus-max-size"] == str(settings.max_upload_mb << 20)
    assert answer.headers["tus-checksum-algorithm"] == "sha256,sha1"
    assert set(answer.headers["tus-extension"].split(",")) == {
        "creation",
        "creation-with-upload",
        "checksum",
        "termination",
        "expiration",
        "concatenation",
    }


@pytest.mark.parametrize("version", [{}, {"Tus-Resumable": "0.2.2"}])
@pytest.mark.parametrize("method", ["POST", "PATCH", "DELETE", "HEAD"])
def test_another_version_is_refused_and_does_nothing(client: TestClient, method: str, version: dict[str, str]) -> None:
    path = "/v1/uploads" if method == "POST" else start(client)
    answer = client.request(method, path, headers={"Upload-Length": "5", "Upload-Offset": "0", **version})
    assert answer.status_code == 412
    assert answer.headers["tus-version"] == answer.headers["tus-resumable"] == "1.0.0"
    assert method == "POST" or offset_of(client, path) == 0


@pytest.mark.parametrize("data", [DATA, LARGE], ids=["small", "large"])
def test_bytes_in_pieces_become_a_mesh(client: TestClient, store: ObjectStore, data: bytes) -> None:
    path = start(client, len(data), **metadata(filename="../scan.ply", sha256=sha256(data), other="kept"))
    begun = client.head(path, headers=TUS)
    assert (begun.headers["upload-offset"], begun.headers["upload-length"]) == ("0", str(len(data)))
    assert begun.headers["cache-control"] == "no-store"
    assert begun.headers["upload-metadata"].startswith("filename Li4vc2Nhbi5wbHk=,sha256 ")
    half = len(data) // 2
    first = send(client, path, data[:half], 0)
    assert (first.status_code, first.headers["upload-offset"]) == (204, str(half))
    assert "quadpatch-mesh" not in first.headers
    assert offset_of(client, path) == half
    last = send(client, path, data[half:], half)
    assert (last.status_code, last.headers["quadpatch-mesh"]) == (204, f"/v1/meshes/{sha256(data)}")
    mesh = client.get(last.headers["quadpatch-mesh"]).json()
    assert (mesh["filename"], mesh["format"], mesh["size_bytes"]) == ("scan.ply", "ply", len(data))
    assert client.get(f"/v1/meshes/{sha256(data)}/content").content == data
    assert keys(store, "uploads") == []
    shown = client.get(path).json()
    assert (shown["state"], shown["mesh_id"], shown["offset_bytes"]) == ("completed", sha256(data), len(data))
    assert client.head(path, headers=TUS).headers["quadpatch-mesh"] == f"/v1/meshes/{sha256(data)}"
    assert send(client, path, b"", len(data)).status_code == 204


def test_the_first_request_may_bring_bytes(client: TestClient) -> None:
    headers = {**BYTES, "Upload-Length": str(len(DATA)), **metadata(filename="a", format="stl")}
    some = client.post("/v1/uploads", content=DATA[:7], headers=headers)
    assert (some.status_code, some.headers["upload-offset"]) == (201, "7")
    assert send(client, some.headers["location"], DATA[7:], 7).headers["quadpatch-mesh"]
    whole = client.post("/v1/uploads", content=DATA, headers=headers)
    assert (whole.status_code, whole.headers["quadpatch-mesh"]) == (201, f"/v1/meshes/{sha256(DATA)}")
    assert whole.json()["format"] == "stl"


def test_many_small_requests_become_a_mesh(client: TestClient, services: Services) -> None:
    data = DATA[:2000]
    path = start(client, len(data))
    for offset in range(0, len(data), 25):
        assert send(client, path, data[offset : offset + 25], offset).status_code == 204
        assert len(services.uploads.parts(path.rpartition("/")[2])) < 10
    assert client.get(path).json()["mesh_id"] == sha256(data)


def test_bytes_for_another_offset_are_refused(client: TestClient) -> None:
    path = start(client)
    send(client, path, DATA[:100], 0)
    for offset in (0, 99, 101):
        assert code(send(client, path, DATA[offset:], offset)) == (409, "upload_offset_conflict")
    assert offset_of(client, path) == 100


def test_more_bytes_than_announced_are_refused(client: TestClient, store: ObjectStore) -> None:
    path = start(client, 10)

    def unannounced() -> Iterator[bytes]:
        yield DATA[:11]

    assert code(send(client, path, DATA[:11], 0)) == (413, "body_too_large")
    answer = client.patch(path, content=unannounced(), headers={**BYTES, "Upload-Offset": "0"})
    assert code(answer) == (413, "body_too_large")
    assert offset_of(client, path) == 0
    assert keys(store, "uploads") == []


@pytest.mark.parametrize("algorithm", ["sha1", "sha256"])
@pytest.mark.parametrize("data", [DATA, LARGE], ids=["small", "large"])
def test_a_wrong_checksum_keeps_nothing(client: TestClient, store: ObjectStore, algorithm: str, data: bytes) -> None:
    path = start(client, len(data))
    assert code(send(client, path, data, 0, **checksum(data + b"x", algorithm))) == (460, "checksum_mismatch")
    assert offset_of(client, path) == 0
    assert keys(store, "uploads") == []
    assert send(client, path, data, 0, **checksum(data, algorithm)).headers["quadpatch-mesh"]


@pytest.mark.parametrize("field", ["md5 AAAA", "sha256", "sha256 ????", "sha256 AAAA, sha1 AAAA"])
def test_a_checksum_that_cannot_be_checked_is_refused(client: TestClient, field: str) -> None:
    answer = send(client, start(client), DATA, 0, Upload_Checksum=field)
    assert code(answer) == (400, "unsupported_checksum")
    assert answer.headers["tus-checksum-algorithm"] == "sha256,sha1"


def test_a_digest_of_http_is_a_checksum_too(client: TestClient, store: ObjectStore) -> None:
    path = start(client)
    answer = send(client, path, DATA, 0, Content_Digest="sha-256=:AAAA:")
    assert code(answer) == (400, "digest_mismatch")
    assert (offset_of(client, path), keys(store, "uploads")) == (0, [])


def test_bytes_that_are_not_those_announced_are_no_mesh(client: TestClient, store: ObjectStore) -> None:
    path = start(client, **metadata(sha256=sha256(b"other")))
    assert code(send(client, path, DATA, 0)) == (410, "digest_mismatch")
    assert client.head(path, headers=TUS).status_code == 410
    assert code(send(client, path, b"", len(DATA))) == (410, "digest_mismatch")
    shown = client.get(path).json()
    assert (shown["state"], shown["problem"]["code"], shown["mesh_id"]) == ("failed", "digest_mismatch", None)
    assert [*keys(store, "uploads"), *keys(store, "meshes")] == []
    assert client.delete(path, headers=TUS).status_code == 204


def test_a_part_that_the_store_has_lost_fails_the_upload(client: TestClient, store: ObjectStore) -> None:
    path = start(client)
    send(client, path, DATA[:500], 0)
    (key,) = keys(store, "uploads")
    store.delete(key)
    assert code(send(client, path, DATA[500:], 500)) == (410, "upload_damaged")
    assert [*keys(store, "uploads"), *keys(store, "meshes")] == []


def test_a_part_whose_bytes_have_changed_fails_the_upload(client: TestClient, store: ObjectStore) -> None:
    path = start(client)
    send(client, path, DATA[:500], 0)
    (key,) = keys(store, "uploads")
    with store.writer("uploads") as writer:
        writer.write(bytes(500))
        writer.commit(key)
    assert code(send(client, path, DATA[500:], 500)) == (410, "upload_damaged")
    assert keys(store, "meshes") == []


def test_an_upload_can_be_given_up(client: TestClient, store: ObjectStore) -> None:
    path = start(client)
    send(client, path, DATA[:500], 0)
    gone = client.delete(path, headers=TUS)
    assert (gone.status_code, gone.headers["tus-resumable"]) == (204, "1.0.0")
    assert keys(store, "uploads") == []
    assert code(client.get(path)) == (404, "upload_not_found")
    assert code(send(client, path, DATA, 0)) == (404, "upload_not_found")
    assert client.head(path, headers=TUS).status_code == 404


def test_the_mesh_outlives_its_upload(client: TestClient) -> None:
    path = start(client)
    mesh = send(client, path, DATA, 0).headers["quadpatch-mesh"]
    client.delete(path, headers=TUS)
    assert client.get(f"{mesh}/content").content == DATA


def test_an_upload_expires(client: TestClient, database: Database) -> None:
    path = start(client)
    answer = send(client, path, DATA[:500], 0)
    left = parsedate_to_datetime(answer.headers["upload-expires"]) - utc_now()
    assert timedelta(hours=23) < left <= timedelta(hours=24)
    with database.write() as session:
        row = session.get_one(UploadRow, path.rpartition("/")[2])
        row.expires_at = utc_now() - timedelta(seconds=1)
    assert code(send(client, path, DATA[500:], 500)) == (404, "upload_not_found")


@pytest.mark.parametrize(
    "headers",
    [
        {},
        {"Upload-Length": "0"},
        {"Upload-Length": "-1"},
        {"Upload-Length": "many"},
        {"Upload-Defer-Length": "1"},
        {"Upload-Length": "5", "Upload-Concat": "whole"},
        {"Upload-Length": "5", "Upload-Concat": "final;/v1/uploads/upl_00000000000000000000000000"},
        {"Upload-Concat": "final;"},
        {"Upload-Concat": "final;https://elsewhere/v1/meshes/a"},
        {"Upload-Length": "5", "Upload-Metadata": "filename ?"},
        {"Upload-Length": "5", "Upload-Metadata": "a YQ==,a YQ=="},
        {"Upload-Length": "5", **metadata(sha256="abc")},
        {"Upload-Length": "5", **metadata(format="exe")},
        {"Upload-Length": "5", "Upload-Metadata": "a " + "YQ==" * 2000},
    ],
)
def test_a_creation_that_says_too_little_or_nonsense_is_refused(
    client: TestClient, database: Database, headers: dict[str, str]
) -> None:
    assert code(client.post("/v1/uploads", headers={**TUS, **headers})) == (422, "invalid_request")
    with database.read() as session:
        assert session.query(UploadRow).count() == 0


@pytest.mark.parametrize(
    "text", ["\x00\x1b[31m", "<script>", "a" * 300, "../../etc/passwd", "\udcff".encode("utf-8", "replace").decode()]
)
def test_a_name_is_data(client: TestClient, text: str) -> None:
    path = start(client, **metadata(filename=text))
    name = client.get(path).json()["filename"]
    assert name is None or (name.isprintable() and "/" not in name and len(name) <= 255)


def test_what_is_too_large_is_refused_before_it_is_sent(client: TestClient, settings: Settings) -> None:
    size = (settings.max_upload_mb << 20) + 1
    assert code(client.post("/v1/uploads", headers={**TUS, "Upload-Length": str(size)})) == (413, "body_too_large")


def test_what_the_disk_has_no_room_for_is_refused_before_it_is_sent(
    client: TestClient, services: Services, monkeypatch: pytest.MonkeyPatch
) -> None:
    needed = 2000 if services.store.is_local else 1000
    free = needed - 1 + (services.settings.disk_reserve_mb << 20)
    monkeypatch.setattr(type(services.store), "free_bytes", lambda _: free)
    assert code(client.post("/v1/uploads", headers={**TUS, "Upload-Length": "1000"})) == (507, "store_full")
    start(client, 999)


def test_there_are_only_so_many(settings: Settings) -> None:
    app = create_app(settings.model_copy(update={"max_uploads": 2}))
    with TestClient(app, base_url="http://127.0.0.1") as client:
        first, _ = start(client), start(client)
        refused = client.post("/v1/uploads", headers={**TUS, "Upload-Length": "5"})
        assert code(refused) == (503, "too_many_uploads")
        assert refused.headers["retry-after"]
        client.delete(first, headers=TUS)
        start(client)


@pytest.mark.parametrize(
    ("changes", "status"),
    [
        ({"Content-Type": "application/octet-stream"}, 415),
        ({"Content-Encoding": "gzip"}, 415),
        ({"Upload-Offset": "x"}, 422),
        ({"Upload-Offset": "-1"}, 422),
    ],
)
def test_a_body_that_is_not_as_the_protocol_says_is_refused(
    client: TestClient, changes: dict[str, str], status: int
) -> None:
    path = start(client)
    answer = client.patch(path, content=DATA, headers={**BYTES, "Upload-Offset": "0", **changes})
    assert answer.status_code == status
    assert offset_of(client, path) == 0


def test_partial_uploads_are_joined(client: TestClient, store: ObjectStore) -> None:
    cuts = [0, 30_000, 30_001, len(DATA)]
    pieces = [DATA[begin:end] for begin, end in itertools.pairwise(cuts)]
    paths = [start(client, len(piece), Upload_Concat="partial") for piece in pieces]
    for path, piece in reversed(list(zip(paths, pieces, strict=True))):
        assert "quadpatch-mesh" not in send(client, path, piece, 0).headers
    assert client.head(paths[0], headers=TUS).headers["upload-concat"] == "partial"
    urls = [paths[0], f"http://127.0.0.1{paths[1]}", paths[2]]
    joined = client.post(
        "/v1/uploads",
        headers={**TUS, "Upload-Concat": f"final;{' '.join(urls)}", **metadata(filename="a.obj", sha256=sha256(DATA))},
    )
    assert (joined.status_code, joined.headers["upload-offset"]) == (201, str(len(DATA)))
    assert joined.headers["quadpatch-mesh"] == f"/v1/meshes/{sha256(DATA)}"
    shown = client.head(joined.headers["location"], headers=TUS)
    assert (shown.headers["upload-length"], shown.headers["upload-concat"][:6]) == (str(len(DATA)), "final;")
    assert code(send(client, joined.headers["location"], b"", len(DATA))) == (403, "upload_is_final")
    for path in (joined.headers["location"], *paths):
        client.delete(path, headers=TUS)
    assert keys(store, "uploads") == []


def test_what_is_not_whole_cannot_be_joined(client: TestClient) -> None:
    path = start(client, 10, Upload_Concat="partial")
    send(client, path, b"12345", 0)
    answer = client.post("/v1/uploads", headers={**TUS, "Upload-Concat": f"final;{path}"})
    assert code(answer) == (409, "upload_not_finished")
    send(client, path, b"67890", 5)
    assert client.post("/v1/uploads", headers={**TUS, "Upload-Concat": f"final;{path}"}).status_code == 201


def test_a_method_may_stand_in_a_header(client: TestClient) -> None:
    path = start(client)
    patch = {**BYTES, "Upload-Offset": "0", "X-HTTP-Method-Override": "PATCH"}
    assert client.post(path, content=DATA[:5], headers=patch).status_code == 204
    assert offset_of(client, path) == 5
    assert client.post(path, headers={**TUS, "X-HTTP-Method-Override": "DELETE"}).status_code == 204
    assert code(client.post(path, headers=TUS)) == (405, "method_not_allowed")


def test_a_repeated_creation_makes_one_upload(client: TestClient) -> None:
    headers = {**BYTES, "Upload-Length": str(len(DATA)), "Idempotency-Key": "one"}
    first = client.post("/v1/uploads", content=DATA[:10], headers=headers)
    again = client.post("/v1/uploads", content=DATA[:10], headers=headers)
    assert first.headers["location"] == again.headers["location"]
    assert (again.headers["idempotent-replayed"], again.headers["upload-offset"]) == ("true", "10")


def test_of_two_that_send_at_once_one_is_refused(
    client: TestClient, store: ObjectStore, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Both have read the offset before either of them is acknowledged."""
    path, barrier = start(client, 1000), threading.Barrier(2)
    acknowledge = Uploads.acknowledge

    def wait_for_the_other(*arguments: Any) -> Any:
        barrier.wait(GUARD_S)
        return acknowledge(*arguments)

    monkeypatch.setattr(Uploads, "acknowledge", wait_for_the_other)
    bodies, answers = [b"a" * 500, b"b" * 500], {}
    threads = [
        threading.Thread(target=lambda body=body: answers.update({body: send(client, path, body, 0)}))
        for body in bodies
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    monkeypatch.undo()
    assert sorted(answer.status_code for answer in answers.values()) == [204, 409]
    (won,) = [body for body, answer in answers.items() if answer.status_code == 204]
    assert len(keys(store, "uploads")) == 1
    assert send(client, path, b"c" * 500, 500).headers["quadpatch-mesh"].endswith(sha256(won + b"c" * 500))


def test_a_database_that_is_lost_while_it_commits_costs_no_byte(
    client: TestClient, store: ObjectStore, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The service can't know whether the offset has moved, so it must not give the part back."""
    acknowledge = Uploads.acknowledge

    def lost_after(*arguments: Any) -> Any:
        acknowledge(*arguments)
        raise DatabaseUnavailableError("the line broke")

    path = start(client)
    with monkeypatch.context() as patch:
        patch.setattr(Uploads, "acknowledge", lost_after)
        assert code(send(client, path, DATA[:500], 0)) == (503, "database_unavailable")
    assert offset_of(client, path) == 500
    assert send(client, path, DATA[500:], 500).headers["quadpatch-mesh"].endswith(sha256(DATA))


class KilledError(Exception):
    """Stands for the end of the process at that moment."""


@pytest.mark.parametrize("moment", ["stored", "registered", "completed"])
def test_a_process_that_dies_while_it_completes_leaves_it_to_the_next(
    settings: Settings, store: ObjectStore, moment: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whatever the moment, the next request that asks for the upload makes the mesh, and makes it once."""

    def dying(act: Callable[..., Any]) -> Callable[..., Any]:
        def run(*arguments: Any, **named: Any) -> Any:
            act(*arguments, **named)
            raise KilledError

        return run

    patched = {
        "stored": (upload_completion, "_put_together"),
        "registered": (upload_completion, "register_mesh"),
        "completed": (Uploads, "complete"),
    }
    data = random.Random(moment).randbytes(5000)
    app, (owner, name) = create_app(settings), patched[moment]
    with TestClient(app, base_url="http://127.0.0.1", raise_server_exceptions=False) as client:
        path = start(client, len(data), **metadata(filename="a.ply", sha256=sha256(data)))
        with monkeypatch.context() as patch:
            patch.setattr(owner, name, dying(getattr(owner, name)))
            assert send(client, path, data, 0).status_code == 500
    added: list[bool] = []
    add = Meshes.add

    def counted(*arguments: Any, **rest: Any) -> Any:
        mesh, is_new = add(*arguments, **rest)
        added.append(is_new)
        return mesh, is_new

    monkeypatch.setattr(Meshes, "add", counted)
    with TestClient(create_app(settings), base_url="http://127.0.0.1") as client:
        answer = client.head(path, headers=TUS)
        assert (answer.headers["upload-offset"], answer.headers["quadpatch-mesh"]) == (
            str(len(data)),
            f"/v1/meshes/{sha256(data)}",
        )
        assert client.get(f"/v1/meshes/{sha256(data)}/content").content == data
        assert client.head(path, headers=TUS).status_code == 200
    assert added == {"stored": [True], "registered": [False], "completed": []}[moment]
    assert len(keys(store, "meshes")) == 1
    # What the dead process could not delete any more is left to the sweep.
    assert len(keys(store, "uploads")) == (1 if moment == "completed" else 0)

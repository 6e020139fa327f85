"""Room for uploads: `service/room.py`."""

import asyncio
from collections.abc import AsyncIterator
from dataclasses import dataclass
from datetime import timedelta
from typing import Any, cast

import pytest
from hypothesis import given
from hypothesis import strategies as st
from sqlalchemy import update
from starlette.testclient import TestClient

from jobkit.database.clock import utc_now
from jobkit.database.session import Database
from jobkit.database.upload_tables import UploadRow
from jobkit.errors import StoreFullError
from jobkit.settings import Settings
from jobkit.storage.base import ObjectStore
from jobkit.uploads.uploads import NewUpload, Uploads
from quadpatch_client.schema import UploadKind
from service.app import create_app
from service.room import DiskRoom
from service.services import Services

MIB = 1 << 20
TUS = {"Tus-Resumable": "1.0.0"}
PLY = b"ply\nformat ascii 1.0\nend_header\n"


@dataclass
class Disk:
    """A store on a disk with so much free."""

    free: int
    is_local: bool = True

    def free_bytes(self) -> int:
        return self.free


def room(disk: Disk, database: Database, reserve: int = 0) -> DiskRoom:
    return DiskRoom(cast(ObjectStore, disk), database, reserve)


def test_the_reserve_for_jobs_is_left_free(database: Database) -> None:
    kept = room(Disk(1000), database, reserve=300)
    kept.check(700)
    with pytest.raises(StoreFullError, match="reserve for jobs"):
        kept.check(701)


def test_bodies_under_way_keep_their_room_and_give_back_what_has_arrived(database: Database) -> None:
    disk = Disk(1000)
    of_disk = room(disk, database)
    with of_disk.kept(600) as first:
        first.check()
        with of_disk.kept(401) as second, pytest.raises(StoreFullError):
            second.check()
        of_disk.check(400)
        with pytest.raises(StoreFullError):
            of_disk.check(401)
        first.note(500)
        disk.free -= 500
        of_disk.check(400)
        with pytest.raises(StoreFullError):
            of_disk.check(401)
    of_disk.check(500)


@given(
    bodies=st.lists(st.tuples(st.integers(0, 10), st.lists(st.integers(0, 10), max_size=4)), max_size=5),
)
def test_in_the_end_nothing_is_kept(bodies: list[tuple[int, list[int]]]) -> None:
    of_disk = room(Disk(1 << 40, is_local=False), cast(Database, None))
    for announced, chunks in bodies:
        with of_disk.kept(announced) as body:
            for chunk in chunks:
                body.note(chunk)
    assert of_disk._pending_bytes == 0


def test_resumable_uploads_under_way_count_twice_on_local_files(database: Database) -> None:
    uploads = Uploads(database.of("plant-north"), hours=1, most=10, max_bytes=10_000)
    uploads.create(NewUpload(UploadKind.WHOLE, 100), None)
    of_disk = room(Disk(1000), database)
    of_disk.check(800)
    with pytest.raises(StoreFullError):
        of_disk.check(801)
    of_disk.check(400, is_resumable=True)
    with pytest.raises(StoreFullError):
        of_disk.check(401, is_resumable=True)
    # In a bucket there is always room; only the whole is spooled on this disk.
    room(Disk(1000, is_local=False), database).check(1000, is_resumable=True)


def test_an_upload_that_fell_silent_keeps_no_room(database: Database) -> None:
    Uploads(database, hours=24, most=10, max_bytes=10_000).create(NewUpload(UploadKind.WHOLE, 500), None)
    of_disk = room(Disk(1000), database)
    with pytest.raises(StoreFullError):
        of_disk.check(1)
    with database.write() as session:
        session.execute(update(UploadRow).values(updated_at=utc_now() - timedelta(hours=1)))
    of_disk.check(1000)


def test_a_body_of_unknown_length_ends_where_the_reserve_begins(database: Database) -> None:
    disk = Disk(100 * MIB)
    of_disk = room(disk, database, reserve=50 * MIB)

    async def body() -> AsyncIterator[bytes]:
        for _ in range(100):
            disk.free -= MIB
            yield bytes(MIB)

    async def receive() -> int:
        n_chunks = 0
        with of_disk.kept(0) as kept:
            async for _ in kept.watch(body()):
                n_chunks += 1
        return n_chunks

    with pytest.raises(StoreFullError):
        asyncio.run(receive())
    assert 30 * MIB < disk.free < 50 * MIB


@pytest.fixture
def full(settings: Settings, monkeypatch: pytest.MonkeyPatch) -> Any:
    """A service whose disk has less free than its reserve."""
    reserved = settings.model_copy(update={"disk_reserve_mb": 1 << 30})
    with TestClient(create_app(reserved), base_url="http://127.0.0.1") as client:
        yield client


@pytest.mark.parametrize(
    ("method", "path", "rest"),
    [
        ("POST", "/v1/meshes", {"content": PLY}),
        ("POST", "/v1/meshes", {"files": {"file": PLY}}),
        ("POST", "/v1/models/m/versions", {"content": PLY}),
        ("POST", "/v1/repairs", {"files": {"mesh": PLY}}),
        ("POST", "/v1/uploads", {"headers": {**TUS, "Upload-Length": "5"}}),
    ],
)
def test_uploads_are_refused_before_jobs_are_hurt(full: TestClient, method: str, path: str, rest: Any) -> None:
    answer = full.request(method, path, **rest)
    assert (answer.status_code, answer.json()["code"], answer.json()["retryable"]) == (507, "store_full", True)
    assert answer.headers["retry-after"]


def test_an_upload_does_not_go_on_where_the_reserve_is_used_up(client: TestClient, services: Services) -> None:
    started = client.post("/v1/uploads", headers={**TUS, "Upload-Length": "5"})
    services.room._reserve_bytes = 1 << 60
    headers = {**TUS, "Upload-Offset": "0", "Content-Type": "application/offset+octet-stream"}
    refused = client.patch(started.headers["location"], headers=headers, content=b"12345")
    assert (refused.status_code, refused.json()["code"]) == (507, "store_full")
    services.room._reserve_bytes = 0
    assert client.patch(started.headers["location"], headers=headers, content=b"12345").status_code == 204

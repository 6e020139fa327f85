"""Also tests `jobkit.uploads.parts` and `jobkit.database.upload_tables`."""

import threading
from collections.abc import Callable
from dataclasses import replace
from datetime import timedelta

import pytest
from hypothesis import given
from hypothesis import strategies as st
from sqlalchemy import func, select

from jobkit.database.clock import utc_now
from jobkit.database.idempotency import Idempotency
from jobkit.database.session import Database
from jobkit.database.upload_tables import UploadPartRow, UploadRow
from jobkit.errors import (
    IdempotencyError,
    TooLargeError,
    TooManyUploadsError,
    UploadFinalError,
    UploadNotFinishedError,
    UploadNotFoundError,
    UploadOffsetError,
)
from jobkit.uploads.parts import PART_BYTES, UploadPart, mergeable, named_parts
from jobkit.uploads.uploads import EXPIRED_AT_ONCE, NewUpload, Uploads, expire_uploads, refuse_final
from quadpatch_client.schema import Upload, UploadKind, UploadProblem, UploadState

WHOLE = NewUpload(UploadKind.WHOLE, 100, "scan.ply", "ply")
PARTIAL = NewUpload(UploadKind.PARTIAL, 100)
SHA256 = "0" * 64
MESH_ID = "1" * 64


@pytest.fixture
def uploads(database: Database) -> Uploads:
    return Uploads(database, hours=24, most=10, max_bytes=1000)


def part(start: int, size: int, name: str = "a") -> UploadPart:
    return UploadPart(start, size, f"uploads/{name}-{start}", SHA256)


def start(uploads: Uploads, new: NewUpload = WHOLE) -> Upload:
    return uploads.create(new, None)[0]


def whole_partial(uploads: Uploads, name: str) -> Upload:
    upload = start(uploads, PARTIAL)
    uploads.acknowledge(upload.id, 0, [part(0, 40, name)])
    return uploads.acknowledge(upload.id, 40, [part(40, 60, name)])


def final(*joins: Upload) -> NewUpload:
    return NewUpload(UploadKind.FINAL, 0, joins=tuple(upload.id for upload in joins))


def count(database: Database, table: type) -> int:
    with database.read() as session:
        return session.scalar(select(func.count()).select_from(table)) or 0


def test_the_offset_moves_with_the_parts(uploads: Uploads) -> None:
    upload = start(uploads)
    assert (upload.state, upload.offset_bytes, upload.size_bytes, upload.filename) == ("open", 0, 100, "scan.ply")
    moved = uploads.acknowledge(upload.id, 0, [part(0, 40), part(40, 10)])
    assert moved == uploads.get(upload.id)
    assert moved.offset_bytes == 50
    assert moved.expires_at >= upload.expires_at
    assert uploads.parts(upload.id) == [part(0, 40), part(40, 10)]


def test_bytes_for_another_offset_are_refused_and_change_nothing(uploads: Uploads) -> None:
    upload = start(uploads)
    uploads.acknowledge(upload.id, 0, [part(0, 40)])
    for offset in (0, 41):
        with pytest.raises(UploadOffsetError):
            uploads.acknowledge(upload.id, offset, [part(offset, 7, "b")])
    assert uploads.parts(upload.id) == [part(0, 40)]
    assert uploads.get(upload.id).offset_bytes == 40


def test_of_many_that_write_at_once_one_is_acknowledged(database: Database, uploads: Uploads) -> None:
    upload = start(uploads)
    barrier, outcomes = threading.Barrier(6), []

    def write(name: str) -> None:
        barrier.wait()
        try:
            uploads.acknowledge(upload.id, 0, [part(0, 10, name)])
            outcomes.append(name)
        except UploadOffsetError:
            outcomes.append("")

    threads = [threading.Thread(target=write, args=(f"t{i}",)) for i in range(6)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    (winner,) = filter(None, outcomes)
    assert uploads.parts(upload.id) == [part(0, 10, winner)]


def test_small_parts_give_way_to_the_one_that_begins_with_their_bytes(uploads: Uploads) -> None:
    upload = start(uploads)
    uploads.acknowledge(upload.id, 0, [part(0, 10), part(10, 10)])
    merged = part(0, 30, "merged")
    moved = uploads.acknowledge(upload.id, 20, [merged], [part(0, 10), part(10, 10)])
    assert moved.offset_bytes == 30
    assert uploads.parts(upload.id) == [merged]


def test_an_upload_becomes_a_mesh_once_and_its_parts_are_given_back_once(uploads: Uploads) -> None:
    upload = start(uploads)
    uploads.acknowledge(upload.id, 0, [part(0, 100)])
    assert uploads.complete(upload.id, MESH_ID) == [part(0, 100).key]
    assert uploads.complete(upload.id, "2" * 64) == []
    assert uploads.fail(upload.id, UploadProblem(code="a_b", message="too late")) == []
    done = uploads.get(upload.id)
    assert (done.state, done.mesh_id, done.links.mesh) == ("completed", MESH_ID, f"/v1/meshes/{MESH_ID}")
    with pytest.raises(UploadOffsetError):
        uploads.acknowledge(upload.id, 100, [part(100, 1)])


def test_a_failed_upload_says_why_and_keeps_nothing(uploads: Uploads) -> None:
    upload = start(uploads)
    uploads.acknowledge(upload.id, 0, [part(0, 100)])
    problem = UploadProblem(code="digest_mismatch", message="other bytes")
    assert uploads.fail(upload.id, problem) == [part(0, 100).key]
    assert (uploads.get(upload.id).state, uploads.get(upload.id).problem) == ("failed", problem)
    assert uploads.parts(upload.id) == []


def test_limits_hold_for_size_and_number(uploads: Uploads) -> None:
    with pytest.raises(TooLargeError):
        start(uploads, replace(WHOLE, size_bytes=1001))
    kept = [start(uploads, PARTIAL) for _ in range(10)]
    with pytest.raises(TooManyUploadsError):
        start(uploads)
    # A partial upload that is whole holds its bytes all the same.
    uploads.acknowledge(kept[0].id, 0, [part(0, 100)])
    with pytest.raises(TooManyUploadsError):
        start(uploads)
    uploads.delete(kept[1].id)
    start(uploads)


def test_a_repeated_request_makes_one_upload(database: Database, uploads: Uploads) -> None:
    key = Idempotency("client", "key", SHA256)
    first, is_new = uploads.create(WHOLE, key)
    assert uploads.create(WHOLE, key) == (first, False)
    assert is_new
    with pytest.raises(IdempotencyError):
        uploads.create(WHOLE, Idempotency("client", "key", MESH_ID))
    assert count(database, UploadRow) == 1
    uploads.delete(first.id)
    assert uploads.create(WHOLE, key)[1]


def test_a_final_upload_names_the_objects_of_what_it_joins(uploads: Uploads) -> None:
    first, second = whole_partial(uploads, "a"), whole_partial(uploads, "b")
    joined = start(uploads, final(second, first, second))
    assert (joined.state, joined.offset_bytes, joined.size_bytes) == ("open", 300, 300)
    assert [found.key for found in uploads.parts(joined.id)] == [
        f"uploads/{name}-{begin}" for name in "bab" for begin in (0, 40)
    ]
    assert [found.start for found in uploads.parts(joined.id)] == [0, 40, 100, 140, 200, 240]
    with pytest.raises(UploadFinalError):
        refuse_final(joined)


def test_objects_go_when_the_last_upload_that_names_them_does(uploads: Uploads) -> None:
    first, second = whole_partial(uploads, "a"), whole_partial(uploads, "b")
    joined = start(uploads, final(first, second))
    assert uploads.delete(first.id) == []
    assert uploads.delete(joined.id) == ["uploads/a-0", "uploads/a-40"]
    assert uploads.delete(second.id) == ["uploads/b-0", "uploads/b-40"]


def test_what_a_final_upload_has_joined_goes_an_hour_later(database: Database, uploads: Uploads) -> None:
    first, second = whole_partial(uploads, "a"), whole_partial(uploads, "b")
    joined, again = (start(uploads, final(first, second)) for _ in range(2))
    assert uploads.complete(joined.id, MESH_ID) == []
    # A client that did not get the answer joins them again.
    assert uploads.complete(again.id, MESH_ID) == []
    assert expire_uploads(database, utc_now() + timedelta(minutes=59)) == (0, [])
    n_removed, keys = expire_uploads(database, utc_now() + timedelta(minutes=61))
    assert (n_removed, keys) == (2, [f"uploads/{name}-{begin}" for name in "ab" for begin in (0, 40)])
    assert (count(database, UploadRow), count(database, UploadPartRow)) == (2, 0)


@pytest.mark.parametrize(
    ("make", "error"),
    [
        (lambda uploads: start(uploads, PARTIAL), UploadNotFinishedError),
        (start, UploadNotFinishedError),
        (lambda uploads: whole_partial(uploads, "a").model_copy(update={"id": "upl_none"}), UploadNotFoundError),
    ],
)
def test_only_partial_uploads_that_are_whole_can_be_joined(
    database: Database, uploads: Uploads, make: Callable[[Uploads], Upload], error: type[Exception]
) -> None:
    other = make(uploads)
    before = count(database, UploadRow)
    with pytest.raises(error):
        start(uploads, final(other))
    assert count(database, UploadRow) == before


def test_too_much_together_is_too_large(uploads: Uploads) -> None:
    one = whole_partial(uploads, "a")
    with pytest.raises(TooLargeError):
        start(uploads, final(*[one] * 11))


def test_expired_uploads_are_gone_at_once_and_removed_in_batches(database: Database) -> None:
    short = Uploads(database, hours=1e-9, most=1000, max_bytes=1000)
    with pytest.raises(UploadNotFoundError):
        short.get(start(short).id)
    for _ in range(EXPIRED_AT_ONCE):
        start(short)
    kept = start(Uploads(database, hours=24, most=1000, max_bytes=1000))
    assert [expire_uploads(database, utc_now())[0] for _ in range(3)] == [EXPIRED_AT_ONCE, 1, 0]
    n_removed, keys = expire_uploads(database, utc_now() + timedelta(hours=25))
    assert (n_removed, keys) == (1, [])
    assert kept.state is UploadState.OPEN


def test_an_expired_upload_gives_its_objects_back(database: Database, uploads: Uploads) -> None:
    uploads.acknowledge(start(uploads).id, 0, [part(0, 10)])
    key = part(0, 10).key
    assert named_parts(database, {key, "uploads/other"}) == {key}
    assert expire_uploads(database, utc_now()) == (0, [])
    assert expire_uploads(database, utc_now() + timedelta(hours=25)) == (1, [key])
    assert named_parts(database, {key}) == set()


@given(st.lists(st.integers(1, 3 * PART_BYTES), max_size=40))
def test_merging_leaves_the_bytes_and_few_parts(sizes: list[int]) -> None:
    parts, copied = written(sizes)
    assert sum(found.size_bytes for found in parts) == sum(sizes)
    assert [found.start for found in parts] == [sum(p.size_bytes for p in parts[:i]) for i in range(len(parts))]
    assert copied <= 24 * sum(sizes)
    assert len(parts) <= 2 * sum(sizes) // (PART_BYTES // 2) + 26


def test_thousands_of_small_requests_leave_few_parts_and_copy_little() -> None:
    parts, copied = written([1000] * 20_000)
    assert len(parts) < 25
    assert copied < 15 * 20_000_000


def written(sizes: list[int]) -> tuple[list[UploadPart], int]:
    """Do what the service does with requests of these sizes; return the parts, and how many bytes were copied."""
    parts: list[UploadPart] = []
    copied = 0
    for size in sizes:
        merged = mergeable(parts)
        parts = parts[: len(parts) - len(merged)]
        copied += sum(found.size_bytes for found in merged)
        left = size + sum(found.size_bytes for found in merged)
        while left:
            parts.append(part(parts[-1].end if parts else 0, min(left, PART_BYTES)))
            left -= parts[-1].size_bytes
    return parts, copied

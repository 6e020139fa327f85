"""What every store guarantees, on local files and on a real S3 server."""

import hashlib
from collections.abc import Iterator
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from jobkit.errors import ObjectNotFoundError, SettingsError, TooLargeError
from jobkit.storage.base import ObjectStore, result_key
from jobkit.storage.open import open_store


def put(store: ObjectStore, data: bytes, key: str | None = None) -> str:
    with store.writer("meshes") as writer:
        writer.write(data)
        return writer.commit(key).key


def keys(store: ObjectStore, prefix: str = "") -> set[str]:
    return {listed.key for listed in store.keys(prefix)}


@settings(max_examples=30, suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow])
@given(chunks=st.lists(st.binary(max_size=200), max_size=8), start=st.integers(0, 900), length=st.integers(0, 900))
def test_what_is_written_in_chunks_is_read_back_in_any_range(
    any_store: ObjectStore, chunks: list[bytes], start: int, length: int
) -> None:
    data = b"".join(chunks)
    with any_store.writer("meshes") as writer:
        for chunk in chunks:
            writer.write(chunk)
        stored = writer.commit()
    assert stored.sha256 == hashlib.sha256(data).hexdigest()
    assert stored.size_bytes == any_store.size(stored.key) == len(data)
    assert b"".join(any_store.read(stored.key)) == data
    assert b"".join(any_store.read(stored.key, start, length)) == data[start : start + length]
    assert b"".join(any_store.read(stored.key, start)) == data[start:]


def test_an_object_of_many_chunks_comes_back_as_it_was(any_store: ObjectStore, tmp_path: Path) -> None:
    data = b"".join(bytes([i]) * (1 << 20) for i in range(19)) + b"tail"
    path = tmp_path / "large"
    path.write_bytes(data)
    stored = any_store.put_file("results/large", path)
    assert stored.sha256 == hashlib.sha256(data).hexdigest()
    assert hashlib.sha256(b"".join(any_store.read("results/large"))).hexdigest() == stored.sha256
    assert b"".join(any_store.read("results/large", 8_000_000, 9_000_000)) == data[8_000_000:17_000_000]


def test_the_same_bytes_are_kept_once(any_store: ObjectStore) -> None:
    assert put(any_store, b"same") == put(any_store, b"same")
    assert len(keys(any_store)) == 1


def test_a_body_over_the_limit_leaves_nothing_behind(any_store: ObjectStore) -> None:
    with any_store.writer("meshes", max_bytes=10) as writer:
        writer.write(b"0123456789")
        with pytest.raises(TooLargeError, match="more than 10 bytes"):
            writer.write(b"0")
    assert keys(any_store) == set()


def test_a_body_of_exactly_the_limit_is_kept(any_store: ObjectStore) -> None:
    with any_store.writer("meshes", max_bytes=10) as writer:
        writer.write(b"0123456789")
        assert writer.commit().size_bytes == 10


def test_what_is_not_committed_is_thrown_away(any_store: ObjectStore) -> None:
    with any_store.writer("meshes") as writer:
        writer.write(b"half")
    assert keys(any_store) == set()


def test_two_attempts_at_one_job_keep_their_files_apart(any_store: ObjectStore, tmp_path: Path) -> None:
    path = tmp_path / "out.ply"
    for attempt in (1, 2):
        path.write_bytes(b"attempt %d" % attempt)
        any_store.put_file(result_key("job_a", attempt, "out.ply"), path)
    assert b"".join(any_store.read(result_key("job_a", 1, "out.ply"))) == b"attempt 1"
    any_store.delete_prefix("results/job_a/1")
    assert b"".join(any_store.read(result_key("job_a", 2, "out.ply"))) == b"attempt 2"
    with pytest.raises(ObjectNotFoundError):
        any_store.size(result_key("job_a", 1, "out.ply"))


def test_a_prefix_ends_where_a_name_ends(any_store: ObjectStore) -> None:
    for key in ("results/job/1/a", "results/job/10/a", "results/job-2/1/a"):
        put(any_store, b"0", key)
    assert keys(any_store, "results/job/1") == {"results/job/1/a"}
    assert keys(any_store, "results/job") == {"results/job/1/a", "results/job/10/a"}
    any_store.delete_prefix("results/job/1")
    assert keys(any_store) == {"results/job/10/a", "results/job-2/1/a"}


def test_a_listing_tells_size_and_age_and_nothing_that_is_still_being_written(any_store: ObjectStore) -> None:
    key = put(any_store, b"12345")
    with any_store.writer("meshes") as writer:
        writer.write(b"half")
        any_store.check()
        (listed,) = any_store.keys()
    assert (listed.key, listed.size_bytes) == (key, 5)
    assert abs(listed.modified_at - datetime.now(UTC)) < timedelta(hours=1)
    assert listed.modified_at.tzinfo is UTC
    assert keys(any_store, "results") == set()


def test_a_missing_object_is_noticed_before_the_first_byte(any_store: ObjectStore) -> None:
    put(any_store, b"0", "meshes/none/below")
    for key in ("meshes/none", "meshes/no", "models/none"):
        with pytest.raises(ObjectNotFoundError):
            any_store.read(key)
        with pytest.raises(ObjectNotFoundError), any_store.local_file(key):
            pytest.fail("there is no such file")
    any_store.delete("models/none")


@pytest.mark.parametrize("key", ["", "/etc/passwd", "../secret", "a/../../b", "a//b", ".hidden", "a/.hidden", "a\0b"])
def test_no_key_leads_out_of_the_store(any_store: ObjectStore, key: str) -> None:
    with pytest.raises(ObjectNotFoundError):
        any_store.read(key)
    with pytest.raises(ObjectNotFoundError):
        any_store.delete(key)
    with pytest.raises(ObjectNotFoundError):
        any_store.delete_prefix(key)


def test_the_object_is_a_file_for_those_who_need_one(any_store: ObjectStore) -> None:
    key = put(any_store, b"atoms")
    with any_store.local_file(key) as path:
        assert path.read_bytes() == b"atoms"
    any_store.delete(key)
    with pytest.raises(ObjectNotFoundError):
        any_store.size(key)


def test_an_error_of_the_user_of_the_file_is_not_translated(any_store: ObjectStore) -> None:
    key = put(any_store, b"atoms")
    with pytest.raises(PermissionError, match="theirs"), any_store.local_file(key):
        raise PermissionError("theirs")


def test_a_reader_that_stops_early_leaves_nothing_open(any_store: ObjectStore) -> None:
    key = put(any_store, b"0" * (3 << 20))
    chunks: Iterator[bytes] = any_store.read(key)
    assert len(next(chunks)) == 1 << 20
    chunks.close()  # type: ignore[attr-defined]


@pytest.mark.parametrize(
    "url",
    ["/a/folder", "file://other-machine/folder", "gs://bucket", "s3://", "s3://key:secret@bucket", "s3://bucket?a=b"],
)
def test_a_store_of_another_kind_is_refused(url: str) -> None:
    with pytest.raises(SettingsError, match="file:///a/folder or s3://bucket/prefix") as caught:
        open_store(url)
    assert "secret" not in str(caught.value)

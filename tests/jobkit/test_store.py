import hashlib
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from jobkit.errors import ObjectNotFoundError, SettingsError, StoreUnavailableError, TooLargeError
from jobkit.store import LocalStore, ObjectStore, open_store, result_key


def files_below(folder: Path) -> list[Path]:
    return [path for path in folder.rglob("*") if path.is_file()]


@settings(max_examples=30, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(chunks=st.lists(st.binary(max_size=200), max_size=8), start=st.integers(0, 900), length=st.integers(0, 900))
def test_what_is_written_in_chunks_is_read_back_in_any_range(
    store: ObjectStore, chunks: list[bytes], start: int, length: int
) -> None:
    data = b"".join(chunks)
    with store.writer("meshes") as writer:
        for chunk in chunks:
            writer.write(chunk)
        stored = writer.commit()
    assert stored.sha256 == hashlib.sha256(data).hexdigest()
    assert stored.size_bytes == store.size(stored.key) == len(data)
    assert b"".join(store.read(stored.key)) == data
    assert b"".join(store.read(stored.key, start, length)) == data[start : start + length]


def test_the_same_bytes_are_kept_once(tmp_path: Path) -> None:
    store = LocalStore(tmp_path)
    keys = set()
    for _ in range(2):
        with store.writer("meshes") as writer:
            writer.write(b"same")
            keys.add(writer.commit().key)
    assert len(keys) == 1
    assert len(files_below(tmp_path)) == 1


def test_a_body_over_the_limit_leaves_nothing_behind(tmp_path: Path) -> None:
    store = LocalStore(tmp_path)
    with store.writer("meshes", max_bytes=10) as writer:
        writer.write(b"0123456789")
        with pytest.raises(TooLargeError, match="more than 10 bytes"):
            writer.write(b"0")
    assert files_below(tmp_path) == []


def test_a_body_of_exactly_the_limit_is_kept(store: ObjectStore) -> None:
    with store.writer("meshes", max_bytes=10) as writer:
        writer.write(b"0123456789")
        assert writer.commit().size_bytes == 10


def test_what_is_not_committed_is_thrown_away(tmp_path: Path) -> None:
    store = LocalStore(tmp_path)
    with store.writer("meshes") as writer:
        writer.write(b"half")
    assert files_below(tmp_path) == []


def test_two_attempts_at_one_job_keep_their_files_apart(store: ObjectStore, tmp_path: Path) -> None:
    path = tmp_path / "out.ply"
    for attempt in (1, 2):
        path.write_bytes(b"attempt %d" % attempt)
        store.put_file(result_key("job_a", attempt, "out.ply"), path)
    assert b"".join(store.read(result_key("job_a", 1, "out.ply"))) == b"attempt 1"
    store.delete_prefix("results/job_a/1")
    assert b"".join(store.read(result_key("job_a", 2, "out.ply"))) == b"attempt 2"
    with pytest.raises(ObjectNotFoundError):
        store.size(result_key("job_a", 1, "out.ply"))


def test_a_missing_object_is_noticed_before_the_first_byte(store: ObjectStore) -> None:
    with pytest.raises(ObjectNotFoundError):
        store.read("meshes/none")
    store.delete("meshes/none")


@pytest.mark.parametrize("key", ["", "/etc/passwd", "../secret", "a/../../b", "a//b", ".hidden", "a/.hidden", "a\0b"])
def test_no_key_leads_out_of_the_folder(store: ObjectStore, key: str) -> None:
    with pytest.raises(ObjectNotFoundError):
        store.read(key)
    with pytest.raises(ObjectNotFoundError):
        store.delete(key)


def test_the_object_is_a_file_for_those_who_need_one(store: ObjectStore) -> None:
    with store.writer("models") as writer:
        writer.write(b"atoms")
        stored = writer.commit()
    with store.local_file(stored.key) as path:
        assert path.read_bytes() == b"atoms"


def test_a_store_that_cannot_be_written_says_so(tmp_path: Path) -> None:
    store = LocalStore(tmp_path / "objects")
    store.check()
    (tmp_path / "objects" / "incoming").rmdir()
    with pytest.raises(StoreUnavailableError):
        store.check()


@pytest.mark.parametrize("url", ["s3://bucket", "/a/folder", "file://other-machine/folder"])
def test_a_store_of_another_kind_is_refused(url: str) -> None:
    with pytest.raises(SettingsError, match="file:///"):
        open_store(url)


def test_a_store_may_lie_in_a_folder_with_a_blank_in_its_name(tmp_path: Path) -> None:
    store = open_store(f"file://{tmp_path}/my%20objects")
    store.check()
    assert (tmp_path / "my objects").is_dir()


def test_a_reader_that_stops_early_leaves_no_file_open(store: ObjectStore) -> None:
    with store.writer("meshes") as writer:
        writer.write(b"0" * (3 << 20))
        stored = writer.commit()
    chunks: Iterator[bytes] = store.read(stored.key)
    assert len(next(chunks)) == 1 << 20
    chunks.close()  # type: ignore[attr-defined]

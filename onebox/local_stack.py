"""The local stack: which processes it is made of, and the folder that they share."""

import contextlib
import fcntl
import os
import socket
import sys
import urllib.error
import urllib.request
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from http import HTTPStatus
from pathlib import Path

from jobkit.errors import SettingsError
from jobkit.readiness import READY_FILE_VARIABLE
from jobkit.settings import load_settings
from onebox.errors import StartError
from onebox.processes import Program
from onebox.valkey import answers, prepare_valkey
from service.auth import check_exposure
from worker.engine.limits import thread_environment

LOCK_NAME = "box.lock"
# Below the data folder; holds the address while all of its processes are up.
ADDRESS_FILE = Path("run/address")
_LOOPBACK = "127.0.0.1"
# Handing back a job takes a worker some seconds.
_WORKER_STOP_S = 20.0
# Beginnings of variables that may hold secrets, and which process has no use for them.
_NOT_FOR_VALKEY = ("QUADPATCH_", "AWS_", "OTEL_")
_NOT_FOR_DISPATCHER = ("QUADPATCH_API_KEYS", "OTEL_")
_NOT_FOR_WORKERS = ("QUADPATCH_API_KEYS",)


@dataclass(frozen=True)
class LocalStack:
    """How a local stack is set up.

    Attributes
    ----------
    data : Path
        Folder of database, objects, queue and logs.
    host : str
        Address to listen on.
    port : int
    n_workers : int
    """

    data: Path
    host: str
    port: int
    n_workers: int

    @property
    def url(self) -> str:
        """Where a client on this machine reaches the service."""
        host = _LOOPBACK if self.host in ("0.0.0.0", "::", "") else self.host
        return f"http://[{host}]:{self.port}" if ":" in host else f"http://{host}:{self.port}"

    @property
    def log_folder(self) -> Path:
        """Where every process writes its log."""
        return self.data / "logs"


def default_workers() -> int:
    """Count of workers that suits this machine: two at least, so that a long repair holds up no analysis."""
    return max(2, _n_cores() // 2)


def programs(stack: LocalStack) -> list[Program]:
    """Return the processes of a local stack, in the order in which they start."""
    valkey = prepare_valkey(stack.data / "valkey")
    shared = {
        "QUADPATCH_DATA_DIR": str(stack.data.resolve()),
        "QUADPATCH_REDIS_URL": valkey.url,
        "QUADPATCH_HOST": stack.host,
        "QUADPATCH_PORT": str(stack.port),
    }
    n_threads = max(min(2, _n_cores()), _n_cores() // stack.n_workers)
    # Two busy workers of two cores are not to divide them by four.
    n_processes = load_settings().job_processes or max(1, _n_cores() // stack.n_workers)
    threads = {**shared, **thread_environment(n_threads), "QUADPATCH_JOB_PROCESSES": str(n_processes)}
    workers = [_program(f"worker-{number}", stack, threads) for number in range(1, stack.n_workers + 1)]
    return [
        Program("valkey", valkey.command, ready=lambda: answers(valkey.socket_path), withheld=_NOT_FOR_VALKEY),
        _program("dispatcher", stack, shared),
        Program("api", (sys.executable, "-m", "service"), shared, ready=ready_check(f"{stack.url}/readyz")),
        *workers,
    ]


def _program(name: str, stack: LocalStack, environment: dict[str, str]) -> Program:
    """Describe a process that says by a file that it is ready: the dispatcher, or a worker by its number."""
    ready_file = stack.data / "run" / f"{name}.ready"
    ready_file.parent.mkdir(parents=True, exist_ok=True)
    ready_file.unlink(missing_ok=True)
    return Program(
        name,
        (sys.executable, "-m", name.partition("-")[0]),
        {**environment, READY_FILE_VARIABLE: str(ready_file.resolve())},
        ready=ready_file.exists,
        stop_timeout_s=_WORKER_STOP_S,
        is_alongside=True,
        withheld=_NOT_FOR_DISPATCHER if name == "dispatcher" else _NOT_FOR_WORKERS,
    )


def ready_check(url: str) -> Callable[[], bool]:
    """Make a function that asks the service whether it can work."""
    # A proxy that the environment names is not for requests to this machine.
    opener = urllib.request.build_opener(urllib.request.ProxyHandler({}))

    def is_ready() -> bool:
        try:
            with opener.open(url, timeout=5) as response:
                return bool(response.status == HTTPStatus.OK)
        except (urllib.error.URLError, OSError):
            return False

    return is_ready


def check_settings(host: str, data: Path) -> None:
    """Look at the settings of a stack with some data folder before anything is started.

    Raises
    ------
    StartError
        If one is wrong, or `host` may not be listened on with them.
    """
    try:
        check_exposure(load_settings().model_copy(update={"host": host, "data_dir": data}))
    except SettingsError as error:
        raise StartError(str(error)) from error


def usable_port(host: str, wanted: int) -> int:
    """Return the port if it is free, or any free one for 0.

    Raises
    ------
    StartError
        If it is taken, or not allowed, or the address is not one of this machine.
    """
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    with socket.socket(family, socket.SOCK_STREAM) as probe:
        # As the service itself does: a port whose last connections are still fading away is free.
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((host, wanted))
        except OSError as error:
            raise StartError(
                f"can't listen on {host}, port {wanted}: {error.strerror}; choose another --port, or 0 for any"
            ) from error
        return int(probe.getsockname()[1])


@contextmanager
def owned_folder(data: Path) -> Iterator[None]:
    """Keep a data folder for one local stack alone.

    Raises
    ------
    StartError
        If another local stack uses it, or it can't be made.
    """
    try:
        _make_private(data)
        descriptor = os.open(data / LOCK_NAME, os.O_RDWR | os.O_CREAT, 0o600)
    except OSError as error:
        raise StartError(f"the data folder {data} can't be used: {error.strerror}") from error
    with contextlib.ExitStack() as stack:
        stack.callback(os.close, descriptor)
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError as error:
            owner = os.read(descriptor, 32).decode(errors="replace").strip()
            message = (
                f"another local stack, process {owner}, uses {data}; stop it, or choose another folder with --data"
            )
            raise StartError(message) from error
        os.truncate(descriptor, 0)
        os.write(descriptor, str(os.getpid()).encode())
        yield


def _make_private(data: Path) -> None:
    """Make the folder for this user alone; a folder that holds anything else than a local stack keeps its mode."""
    data.mkdir(mode=0o700, parents=True, exist_ok=True)
    if (data / LOCK_NAME).exists() or not any(data.iterdir()):
        data.chmod(0o700)


def _n_cores() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1

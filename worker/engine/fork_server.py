"""A process that has loaded the method once and forks an engine child per request.

A fresh interpreter needs more than a second to import numpy, scipy and the mesh libraries; a fork of this process
needs none of it. It never touches a mesh itself, has one thread, and holds no onnxruntime session, which must not
cross a fork.

Requests come over a socket, one at a time: a JSON line with the folder of the request, and the write end of the
pipe for the child's reports. The answers are `{"ready"}` once the method is loaded, `{"pid"}` when a child runs, and
`{"pid", "status", "peak_kb"}` when it has ended: `peak_kb` is its largest resident set in KiB, counted by the kernel.

Tested in `tests/worker/engine/test_supervision.py`.
"""

import contextlib
import gc
import importlib
import json
import os
import signal
import socket
import sys
from collections.abc import Callable
from pathlib import Path

from quadpatch_rules.parent_death import parent_death_signal

MESSAGE_BYTES = 65536
# Called with the folder of the request and the write end of the pipe for reports.
Engine = Callable[[Path, int], None]


def main(arguments: list[str]) -> int:
    """Serve until the worker closes the socket.

    Parameters
    ----------
    arguments : list of str
        Descriptor of the socket, process id of the worker, dotted name of the engine's module.
    """
    parent_death_signal(int(arguments[1]), signal.SIGKILL)()
    # Ctrl-C and the like are for the worker to handle; it ends this process when it is done.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    engine: Engine = importlib.import_module(arguments[2]).run_request
    set_death_signal = parent_death_signal(os.getpid(), signal.SIGKILL)
    # What is loaded by now is never freed: the collector would only unshare its pages.
    gc.collect()
    gc.freeze()
    with socket.socket(fileno=int(arguments[0])) as connection:
        _answer(connection, {"ready": 1})
        while _serve_one(connection, engine, set_death_signal):
            pass
    return 0


def _serve_one(connection: socket.socket, engine: Engine, set_death_signal: Callable[[], None]) -> bool:
    message, descriptors, _, _ = socket.recv_fds(connection, MESSAGE_BYTES, 1)
    if not message:
        return False
    (reports,) = descriptors
    folder = Path(json.loads(message)["folder"])
    pid = os.fork()
    if pid == 0:
        connection.close()
        _become_engine(lambda: engine(folder, reports), folder, set_death_signal)
    os.close(reports)
    _answer(connection, {"pid": pid})
    status, peak_kb = _wait(pid)
    _answer(connection, {"pid": pid, "status": status, "peak_kb": peak_kb})
    return True


def _wait(pid: int) -> tuple[int, int]:
    """Wait for a child and end all processes that it started; no other process can get its id before it is reaped.

    Returns how it ended, and its largest resident set in KiB.
    """
    os.waitid(os.P_PID, pid, os.WEXITED | os.WNOWAIT)
    # It may have ended before it had a group of its own.
    with contextlib.suppress(ProcessLookupError, PermissionError):
        os.killpg(pid, signal.SIGKILL)
    _, status, usage = os.wait4(pid, 0)
    return os.waitstatus_to_exitcode(status), usage.ru_maxrss


def _answer(connection: socket.socket, answer: dict[str, int]) -> None:
    connection.sendall(json.dumps(answer).encode() + b"\n")


def _become_engine(run: Callable[[], None], folder: Path, set_death_signal: Callable[[], None]) -> None:
    """Turn the forked process into an engine child; never returns."""
    status = 1
    try:
        os.setsid()
        set_death_signal()
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, signal.SIG_DFL)
        _redirect(folder)
        run()
        status = 0
    finally:
        # On a full disk this output is lost, but the process must end here even so.
        for stream in (sys.stdout, sys.stderr):
            with contextlib.suppress(OSError):
                stream.flush()
        # Not sys.exit: the exit handlers of the parent must not run in this process.
        os._exit(status)


def _redirect(folder: Path) -> None:
    """Send everything that native libraries print into the log of the request."""
    os.chdir(folder)
    os.umask(0o077)
    os.environ["TMPDIR"] = os.environ["HOME"] = str(folder)
    try:
        log = os.open("engine.log", os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o600)
    except OSError:
        # A full disk: the engine will find that out itself, and report it.
        log = os.open(os.devnull, os.O_WRONLY)
    null_device = os.open(os.devnull, os.O_RDONLY)
    os.dup2(null_device, 0)
    os.dup2(log, 1)
    os.dup2(log, 2)
    os.close(log)
    os.close(null_device)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

"""What an engine that was taken over would try; each attempt says whether it got through."""

import ctypes
import os
import socket
import subprocess
import threading
from collections.abc import Callable
from pathlib import Path


def _gets_through(action: Callable[[Path], object]) -> Callable[[Path], bool]:
    def attempt(folder: Path) -> bool:
        try:
            action(folder)
        except OSError:
            return False
        return True

    return attempt


def _call(number: int, *arguments: int) -> None:
    if ctypes.CDLL(None, use_errno=True).syscall(number, *arguments) < 0:
        raise OSError(ctypes.get_errno(), "refused")


def _fork(_: Path) -> None:
    pid = os.fork()
    if pid == 0:
        os._exit(0)
    os.waitpid(pid, 0)


def _run_thread(_: Path) -> None:
    thread = threading.Thread(target=lambda: None)
    thread.start()
    thread.join()


def _read_environment(pid: int) -> bytes:
    return Path(f"/proc/{pid}/environ").read_bytes()


IO_URING_SETUP = 425
ALLOWED: dict[str, Callable[[Path], object]] = {
    "write in the folder": lambda folder: (folder / "made").write_text("x"),
    "read the mesh": lambda folder: (folder / "source.ply").read_bytes(),
    "start a thread": _run_thread,
    "read about itself": lambda _: Path("/proc/self/status").read_bytes(),
    "signal itself": lambda _: os.kill(os.getpid(), 0),
    "write to nowhere": lambda _: Path(os.devnull).write_text("x"),
}
FORBIDDEN: dict[str, Callable[[Path], object]] = {
    "open an internet socket": lambda _: socket.socket(),
    "open a datagram socket": lambda _: socket.socket(socket.AF_INET6, socket.SOCK_DGRAM),
    "open a unix socket": lambda _: socket.socket(socket.AF_UNIX),
    "open a pair of sockets": lambda _: socket.socketpair(),
    "open a netlink socket": lambda _: socket.socket(socket.AF_NETLINK, socket.SOCK_RAW),
    "open a ring for input and output": lambda _: _call(IO_URING_SETUP, 1, 0),
    "fork": _fork,
    "run a program": lambda _: subprocess.run(["true"], check=True),
    "read the fork server's environment": lambda _: _read_environment(os.getppid()),
    "read the worker's environment": lambda folder: _read_environment(int((folder / "worker.pid").read_text())),
    "list processes": lambda _: os.listdir("/proc"),
    "signal the fork server": lambda _: os.kill(os.getppid(), 0),
    "signal the worker": lambda folder: os.kill(int((folder / "worker.pid").read_text()), 0),
    "signal everything": lambda _: os.kill(-1, 0),
    "limit the worker": lambda folder: _limit(int((folder / "worker.pid").read_text())),
    "read beside the folder": lambda folder: (folder.parent / "secret").read_bytes(),
    "list beside the folder": lambda folder: os.listdir(folder.parent),
    "write beside the folder": lambda folder: (folder.parent / "planted").write_text("x"),
    "cut off beside the folder": lambda folder: os.truncate(folder.parent / "secret", 0),
    "link to beside the folder": lambda folder: os.link(folder.parent / "secret", folder / "linked"),
    "move out of the folder": lambda folder: os.rename(folder / "made", folder.parent / "made"),
    "write to the mesh": lambda folder: (folder / "source.ply").open("ab").close(),
    "write to a library": lambda _: Path(ctypes.__file__).open("ab").close(),
    "read the host's users' secrets": lambda _: Path("/etc/shadow").read_bytes(),
    "write in a shared folder": lambda _: Path("/dev/shm/planted").write_text("x"),
    "enter a new namespace": lambda _: _call(272, 0x10000000) if os.uname().machine == "x86_64" else _refuse(),
}
ATTEMPTS = {name: _gets_through(action) for name, action in (ALLOWED | FORBIDDEN).items()}


def _refuse() -> None:
    raise PermissionError


def _limit(pid: int) -> None:
    import resource  # noqa: PLC0415 - Linux alone has what is asked of it

    resource.prlimit(pid, resource.RLIMIT_NOFILE, (256, 4096))

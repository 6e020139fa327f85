"""Folders of requests: made for each request, removed after it, and removed later where a worker was killed."""

import fcntl
import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

_LOCK_NAME = "worker.lock"


@contextmanager
def request_folder(parent: Path) -> Iterator[Path]:
    """Make a folder for one request, and remove it at the end with all that is in it."""
    folder = Path(tempfile.mkdtemp(prefix="request-", dir=parent))
    try:
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)


@contextmanager
def worker_folder(folder: Path) -> Iterator[None]:
    """Keep a worker's folder for the length of a `with` block; remove folders of workers that have ended.

    A lock on a file shows whether the worker runs: the kernel drops it with the process. A process id would not, since
    another process may have it by now.
    """
    descriptor = _locked(folder)
    try:
        for other in folder.parent.iterdir():
            if other != folder:
                _remove_if_abandoned(other)
        yield
    finally:
        shutil.rmtree(folder, ignore_errors=True)
        os.close(descriptor)


def _locked(folder: Path) -> int:
    """Make a folder and lock it; return the open file that holds the lock.

    Another worker that starts at this moment may find the file before it is locked, take the folder for an abandoned
    one and remove it: then it is made again.
    """
    path = folder / _LOCK_NAME
    while True:
        folder.mkdir(parents=True, exist_ok=True)
        try:
            descriptor = os.open(path, os.O_RDWR | os.O_CREAT, 0o600)
        except FileNotFoundError:
            continue
        fcntl.flock(descriptor, fcntl.LOCK_EX)
        if _is_at(descriptor, path):
            return descriptor
        os.close(descriptor)


def _is_at(descriptor: int, path: Path) -> bool:
    try:
        return os.path.samestat(os.fstat(descriptor), path.stat())
    except FileNotFoundError:
        return False


def _remove_if_abandoned(folder: Path) -> None:
    """Remove the folder of a worker that has ended; the lock is held until it is gone."""
    path = folder / _LOCK_NAME
    try:
        descriptor = os.open(path, os.O_RDWR)
    except OSError:
        return  # it is being made or removed at this moment
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        # Else another one has been made in its place since.
        if _is_at(descriptor, path):
            shutil.rmtree(folder, ignore_errors=True)
    except BlockingIOError:
        return
    finally:
        os.close(descriptor)

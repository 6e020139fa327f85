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
    folder.mkdir(parents=True, exist_ok=True)
    descriptor = os.open(folder / _LOCK_NAME, os.O_RDWR | os.O_CREAT, 0o600)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX)
        for other in folder.parent.iterdir():
            if other != folder and _is_abandoned(other):
                shutil.rmtree(other, ignore_errors=True)
        yield
    finally:
        shutil.rmtree(folder, ignore_errors=True)
        os.close(descriptor)


def _is_abandoned(folder: Path) -> bool:
    try:
        descriptor = os.open(folder / _LOCK_NAME, os.O_RDWR)
    except OSError:
        return False  # it is being made or removed at this moment
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    else:
        return True
    finally:
        os.close(descriptor)

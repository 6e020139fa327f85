"""Where outputs go: into a file under its name, through a link to what it leads to, or into a stream.

A file appears whole or not at all. A device, a pipe and standard output have no name that may be replaced: they are
written once all bytes have arrived.

Tested in `tests/attacks/test_j_client_outputs.py`.
"""

import os
import re
import shutil
from collections.abc import Callable, Iterable
from pathlib import Path

from quadpatch_client.errors import UsageError

STDOUT = Path("-")
_DESCRIPTORS = {"-": 1, "/dev/stdout": 1, "/dev/stderr": 2}
_NUMBERED = re.compile(r"/(?:dev|proc/self)/fd/(\d+)")


def is_stream(path: Path) -> bool:
    """Tell whether an output is standard output, a device or a pipe, and no file."""
    return descriptor_of(path) is not None or (path.exists() and not path.is_file() and not path.is_dir())


def is_stdout(path: Path) -> bool:
    """Tell whether an output is standard output, under any of its names."""
    return descriptor_of(path) == 1


def descriptor_of(path: Path) -> int | None:
    """Return the open descriptor that a path stands for; opened by its name it would be cut to nothing."""
    match = _NUMBERED.fullmatch(str(path))
    return int(match[1]) if match else _DESCRIPTORS.get(str(path))


def is_same_file(one: Path, other: Path) -> bool:
    """Tell whether two paths lead to one file: by another spelling, a symbolic link or a hard link."""
    if is_stdout(one) or is_stdout(other):
        return is_stdout(one) and is_stdout(other)
    try:
        return one.samefile(other)
    except OSError:
        # One of them is not there yet.
        return one.resolve() == other.resolve()


def folder_of(path: Path) -> Path | None:
    """Return the folder in which a file is put together before it appears; None for a stream: any will do."""
    return None if is_stream(path) else path.resolve().parent


def deliver(whole: Path, target: Path) -> None:
    """Put a file that has arrived whole where it is wanted.

    Parameters
    ----------
    whole : Path
        In the folder that `folder_of` names.
    target : Path
        A link is kept, and what it leads to is replaced.
    """
    descriptor = descriptor_of(target)
    if descriptor is not None:
        _copy(whole, lambda: os.dup(descriptor))
    elif is_stream(target):
        _copy(whole, lambda: os.open(target, os.O_WRONLY))
    else:
        whole.replace(target.resolve())


def check_place(path: Path) -> None:
    """Raise UsageError where an output can't be written."""
    if is_stream(path):
        return
    if path.is_dir():
        raise UsageError(f"{path} is a folder, not a file to write")
    parent = path.resolve().parent
    if not parent.is_dir():
        raise UsageError(f"{path} can't be written: there is no folder {parent}")


def check_stdout(outputs: Iterable[Path | None], as_json: bool) -> None:
    """Raise UsageError where more than one thing would go to standard output."""
    if sum(path is not None and is_stdout(path) for path in outputs) + as_json > 1:
        raise UsageError("only one of mesh, report, page, picture and --json can go to standard output")


def shown(path: Path) -> str:
    """Name an output for people."""
    return "standard output" if is_stdout(path) else str(path)


def current_umask() -> int:
    """Return the umask; it can only be read by setting it."""
    mask = os.umask(0o077)
    os.umask(mask)
    return mask


def _copy(whole: Path, opened: Callable[[], int]) -> None:
    with whole.open("rb") as source, os.fdopen(opened(), "wb") as sink:
        shutil.copyfileobj(source, sink)

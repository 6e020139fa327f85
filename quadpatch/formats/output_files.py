"""Files that are written whole or not at all: a full disk does not cost the scan that was there before.

A device, a pipe and standard output have no name that may be replaced: they are written as they are, once all bytes
are there. The client has the same rule (`quadpatch_client.outputs`); a test holds the two together.
"""

import errno
import os
import re
from collections.abc import Callable, Iterable
from pathlib import Path

from quadpatch.errors import OptionError

_DESCRIPTORS = {"-": 1, "/dev/stdout": 1, "/dev/stderr": 2}
_NUMBERED = re.compile(r"/(?:dev|proc/self)/fd/(\d+)")
_CLOSE_UP = re.compile(r"hole_\d+\.png")


def descriptor_of(path: Path) -> int | None:
    """Return the open descriptor that a path stands for; opened by its name it would be cut to nothing."""
    match = _NUMBERED.fullmatch(str(path))
    return int(match[1]) if match else _DESCRIPTORS.get(str(path))


def is_stream(path: Path) -> bool:
    """Tell whether an output is standard output, a device or a pipe, and no file."""
    return descriptor_of(path) is not None or (path.exists() and not path.is_file() and not path.is_dir())


def write_whole(path: Path, data: bytes | Iterable[bytes | memoryview]) -> None:
    """Write a file that appears in one step; on failure, what was there before stays.

    Parameters
    ----------
    path : Path
        A link is kept, and what it leads to is replaced. `-` and other names of open descriptors, devices and pipes
        are written and not replaced.
    data : bytes, or iterable of bytes-like
        The file, whole or piece by piece.

    Raises
    ------
    OSError
        Naming `path`.
    """
    try:
        _write(path, [data] if isinstance(data, bytes) else data)
    except OSError as error:
        # A failing write names no file, or the partial one.
        raise OSError(error.errno, error.strerror, str(path)) from error


def _write(path: Path, pieces: Iterable[bytes | memoryview]) -> None:
    descriptor = descriptor_of(path)
    if descriptor is not None:
        _write_through(pieces, lambda: os.dup(descriptor))
        return
    if is_stream(path):
        _write_through(pieces, lambda: os.open(path, os.O_WRONLY))
        return
    target = path.resolve()
    partial = target.with_name(f".quadpatch-{os.getpid()}.part")
    try:
        with partial.open("wb") as file:
            file.writelines(pieces)
        partial.replace(target)
    finally:
        partial.unlink(missing_ok=True)


def _write_through(pieces: Iterable[bytes | memoryview], opened: Callable[[], int]) -> None:
    with os.fdopen(opened(), "wb") as sink:
        sink.writelines(pieces)


def check_outputs(
    source: Path, mesh: Path, others: Iterable[Path], *, may_overwrite: bool = False, inputs: Iterable[Path] = ()
) -> None:
    """Find out before any work whether outputs have a folder and overwrite neither the scan nor each other.

    Parameters
    ----------
    source : Path
        What is read.
    mesh : Path
        Where the repaired mesh goes.
    others : iterable of Path
        Where report and pictures go.
    may_overwrite : bool
        Whether the repaired mesh may take the place of what is read. The others never may.
    inputs : iterable of Path
        What else is read, and never overwritten.

    Raises
    ------
    OptionError
        If two of them are the same file, under whatever name.
    OSError
        If a folder is missing, or an output is a folder.
    """
    _check_place(mesh)
    if is_same_file(mesh, source) and not may_overwrite:
        raise OptionError(f"{mesh} is the scan itself: name another file, or say --overwrite")
    for path in inputs:
        if is_same_file(mesh, path):
            raise OptionError(f"{mesh} is read as well: name another file")
    claimed_paths = [source, mesh, *inputs]
    for path in others:
        _check_place(path)
        if any(is_same_file(path, other) for other in claimed_paths):
            raise OptionError(f"{path} is named twice: mesh, report and picture need files of their own")
        claimed_paths.append(path)


def check_folder(folder: Path, files: Iterable[Path] = ()) -> None:
    """Find out before any work whether a folder for close-ups is there or can be made.

    Parameters
    ----------
    folder : Path
    files : iterable of Path
        Other inputs and outputs.

    Raises
    ------
    OptionError
        If one of the files has the name of a close-up in this folder.
    OSError
        If it is no folder, or can't be made.
    """
    if descriptor_of(folder) is not None or (folder.exists() and not folder.is_dir()):
        raise OSError(errno.ENOTDIR, os.strerror(errno.ENOTDIR), str(folder))
    _check_parent(folder)
    for path in files:
        if _CLOSE_UP.fullmatch(path.name) and is_same_file(path.parent, folder):
            raise OptionError(f"{path} has the name of a close-up in {folder}: name another file or folder")


def _check_place(path: Path) -> None:
    if is_stream(path):
        return
    if path.is_dir():
        raise OSError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
    _check_parent(path)


def _check_parent(path: Path) -> None:
    parent = path.resolve().parent
    if not parent.is_dir():
        raise OSError(errno.ENOENT, f"there is no folder {parent}", str(path))


def is_same_file(one: Path, other: Path) -> bool:
    """Tell whether two paths lead to one file: by another spelling, a symbolic link or a hard link."""
    numbers = descriptor_of(one), descriptor_of(other)
    if numbers != (None, None):
        return numbers[0] == numbers[1]
    try:
        return one.samefile(other)
    except OSError:
        # One of them is not there yet.
        return one.resolve() == other.resolve()

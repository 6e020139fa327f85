"""Files that are written whole or not at all: a full disk must not cost anybody the scan that was there before."""

import errno
import os
from collections.abc import Iterable
from pathlib import Path

from quadpatch.errors import OptionError


def write_whole(path: Path, data: bytes) -> None:
    """Write a file that appears in one step; on failure, what was there before stays.

    Parameters
    ----------
    path : Path
        A link is followed; a device or pipe is written as it is.
    data : bytes

    Raises
    ------
    OSError
        Naming `path`.
    """
    target = path.resolve()
    partial = target.with_name(f".quadpatch-{os.getpid()}.part")
    try:
        if target.exists() and not target.is_file():
            target.write_bytes(data)
            return
        try:
            partial.write_bytes(data)
            partial.replace(target)
        finally:
            partial.unlink(missing_ok=True)
    except OSError as error:
        # A failing write names no file, and the partial one is nobody's business.
        raise OSError(error.errno, error.strerror, str(path)) from error


def check_outputs(source: Path, mesh: Path, others: Iterable[Path], *, may_overwrite: bool = False) -> None:
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
    taken = [source, mesh]
    for path in others:
        _check_place(path)
        if any(is_same_file(path, other) for other in taken):
            raise OptionError(f"{path} is named twice: mesh, report and picture need files of their own")
        taken.append(path)


def check_folder(folder: Path) -> None:
    """Find out before any work whether a folder is there or can be made; raise OSError."""
    if folder.exists() and not folder.is_dir():
        raise OSError(errno.ENOTDIR, os.strerror(errno.ENOTDIR), str(folder))
    if not folder.parent.is_dir():
        raise OSError(errno.ENOENT, f"there is no folder {folder.parent}", str(folder))


def _check_place(path: Path) -> None:
    if path.is_dir():
        raise OSError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
    if not path.parent.is_dir():
        raise OSError(errno.ENOENT, f"there is no folder {path.parent}", str(path))


def is_same_file(one: Path, other: Path) -> bool:
    """Tell whether two paths lead to one file: by another spelling, a symbolic link or a hard link."""
    try:
        return one.samefile(other)
    except OSError:
        # One of them is not there yet.
        return one.resolve() == other.resolve()

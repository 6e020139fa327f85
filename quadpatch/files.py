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


def check_outputs(source: Path, outputs: Iterable[Path]) -> None:
    """Find out before any work whether outputs have a folder and do not overwrite each other.

    Parameters
    ----------
    source : Path
        What is read. The first output may take its place, the others may not.
    outputs : iterable of Path

    Raises
    ------
    OptionError
        If two of them are the same file.
    OSError
        If a folder is missing, or an output is a folder.
    """
    taken: set[Path] = set()
    for path in outputs:
        if path.is_dir():
            raise OSError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
        if not path.parent.is_dir():
            raise OSError(errno.ENOENT, f"there is no folder {path.parent}", str(path))
        if path.resolve() in taken:
            raise OptionError(f"{path} is named twice: mesh, report and picture need files of their own")
        taken |= {path.resolve(), source.resolve()}

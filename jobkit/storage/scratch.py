"""Files that are being written: each is locked by its process, so that those of killed processes can be recognised.

The kernel drops a lock with the process that holds it. The next process that opens the folder removes unlocked files.
"""

import contextlib
import fcntl
import os
import uuid
from pathlib import Path
from typing import BinaryIO


class ScratchFolder:
    """A folder of locked files; made, and swept, when it is opened.

    Parameters
    ----------
    folder : Path
        On a local disk. Where it can't be made, `new_file` fails instead: a full disk must not keep a process from
        starting.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        with contextlib.suppress(OSError):
            folder.mkdir(parents=True, exist_ok=True)
            self._sweep()

    def new_file(self) -> tuple[Path, BinaryIO]:
        """Make an empty file, locked as long as it is open; raise OSError where that is not possible."""
        while True:
            path = self.folder / uuid.uuid4().hex
            file = path.open("x+b")
            try:
                fcntl.flock(file, fcntl.LOCK_EX)
                # A sweep may have removed it before it was locked.
                if os.fstat(file.fileno()).st_nlink:
                    return path, file
            except BaseException:
                path.unlink(missing_ok=True)
                file.close()
                raise
            file.close()

    def _sweep(self) -> None:
        for path in self.folder.iterdir():
            with contextlib.suppress(OSError), path.open("rb") as file:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
                path.unlink()

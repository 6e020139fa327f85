"""Small disks of memory that can be filled up or made read-only; plain folders where this user may not mount."""

import contextlib
import errno
import os
import subprocess
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

from tests.waiting import GUARD_S

_FILLER = "filler"
_PIECE_BYTES = 1 << 20


class Disk:
    """A folder, a disk of its own where `is_mounted`.

    Attributes
    ----------
    folder : Path
    is_mounted : bool
    """

    def __init__(self, folder: Path, is_mounted: bool) -> None:
        self.folder = folder
        self.is_mounted = is_mounted

    def fill(self) -> None:
        """Leave no byte free."""
        with (self.folder / _FILLER).open("ab", buffering=0) as file:
            size = _PIECE_BYTES
            while size:
                try:
                    file.write(b"\0" * size)
                except OSError as error:
                    if error.errno != errno.ENOSPC:
                        raise
                    size //= 2

    def empty(self) -> None:
        """Free the space again."""
        (self.folder / _FILLER).unlink(missing_ok=True)

    def make_read_only(self) -> None:
        """Refuse writes; files that are just being written hold it up for a moment."""
        deadline = time.monotonic() + GUARD_S
        while not self._remount("ro"):
            assert time.monotonic() < deadline, "the disk could not be made read-only: it was written to all the time"
            time.sleep(0.01)

    def make_writable(self) -> None:
        """Take writes again."""
        assert self._remount("rw")

    def _remount(self, mode: str) -> bool:
        if not self.is_mounted:
            # Root ignores the mode, but root can mount.
            for folder in (self.folder, *(path for path in self.folder.rglob("*") if path.is_dir())):
                with contextlib.suppress(FileNotFoundError):  # removed since it was listed
                    folder.chmod(0o755 if mode == "rw" else 0o555)
            return True
        command = ["mount", "-o", f"remount,{mode}", str(self.folder)]
        return subprocess.run(command, check=False, capture_output=True).returncode == 0


@contextmanager
def open_disks(root: Path, *names: str, size_mb: int = 768) -> Iterator[list[Disk]]:
    """Make a disk of memory under each name, or a folder where that is not allowed."""
    with ExitStack() as stack:
        yield [stack.enter_context(_open_disk(root / name, size_mb)) for name in names]


@contextmanager
def _open_disk(folder: Path, size_mb: int) -> Iterator[Disk]:
    folder.mkdir(parents=True)
    mount = ["mount", "-t", "tmpfs", "-o", f"size={size_mb}m", "tmpfs", str(folder)]
    is_mounted = os.geteuid() == 0 and subprocess.run(mount, check=False, capture_output=True).returncode == 0
    try:
        yield Disk(folder, is_mounted)
    finally:
        if is_mounted:
            subprocess.run(["umount", "--lazy", str(folder)], check=True, capture_output=True)

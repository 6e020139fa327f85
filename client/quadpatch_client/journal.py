"""What has become of the files of a folder, one line of JSON for each change: it survives kill -9 and power loss.

A line counts once it is on the disk. The last line may be torn; it is left out. Of each file the latest line counts,
and it holds for the bytes that the file had then: by its size and the time of its last change.

Tested in `tests/quadpatch_client/test_journal.py`.
"""

import json
import os
import tempfile
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any, Literal, Self

from quadpatch_client.errors import UsageError
from quadpatch_client.outputs import current_umask

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None  # type: ignore[assignment]

State = Literal["started", "done", "done_with_warnings", "skipped", "failed"]
# There is a result.
DONE: tuple[State, ...] = ("done", "done_with_warnings")


@dataclass(frozen=True)
class Stamp:
    """Which bytes a file had: its size, in bytes, and when it was last changed, in nanoseconds."""

    size: int
    mtime_ns: int

    @classmethod
    def of(cls, path: Path) -> Self:
        """Look at a file."""
        status = path.stat()
        return cls(status.st_size, status.st_mtime_ns)


@dataclass(frozen=True)
class Entry:
    """One line.

    Attributes
    ----------
    file : str
        Path in the folder, with `/`.
    state : str
    stamp : Stamp
    options : str
        What was asked for, as a digest.
    facts : dict
        The row of the file in the summary, as far as it is known.
    """

    file: str
    state: State
    stamp: Stamp
    options: str = ""
    facts: dict[str, Any] = field(default_factory=dict)


class Journal:
    """Entries of one folder, in a file; threads may share it.

    Parameters
    ----------
    path : Path
        Made where it is missing; its folder has to be there.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._lock = threading.Lock()
        self.entries = {entry.file: entry for entry in _read(path)}
        self._compact()
        self._file = path.open("a", encoding="utf-8")

    def write(self, entry: Entry) -> None:
        """Add a line; it is on the disk when this returns."""
        with self._lock:
            self._file.write(_line(entry))
            self._file.flush()
            os.fsync(self._file.fileno())
            self.entries[entry.file] = entry

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    def __enter__(self) -> Self:
        """Return itself."""
        return self

    def __exit__(self, *_: object) -> None:
        """Close."""
        self.close()

    def _compact(self) -> None:
        """Write the entries that count into a new file that takes the place of the old one in one step."""
        descriptor, name = tempfile.mkstemp(dir=self._path.parent, prefix=f".{self._path.name}.", suffix=".part")
        with os.fdopen(descriptor, "w", encoding="utf-8") as file:
            file.writelines(map(_line, self.entries.values()))
        whole = Path(name)
        whole.chmod(0o666 & ~current_umask())
        sync(whole)
        whole.replace(self._path)
        sync(self._path.parent)


@contextmanager
def one_client_alone(folder: Path) -> Iterator[None]:
    """Hold a folder, so that no second client works on it at the same time; a client that dies lets it go.

    Raises
    ------
    UsageError
        If another one holds it.
    """
    if fcntl is None:
        # There an open file can't be replaced, so two clients get in each other's way without doing harm.
        yield
        return
    with (folder / ".quadpatch.lock").open("a") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            raise UsageError(f"another quadpatch-client is at work on {folder}") from error
        yield


def sync(path: Path) -> None:
    """Bring a file, or the names in a folder, onto the disk, as far as the system lets a reader do that."""
    try:
        descriptor = os.open(path, os.O_RDONLY)
    except OSError:
        return  # Windows opens no folder
    try:
        os.fsync(descriptor)
    except OSError:
        pass  # nor syncs what was opened to be read
    finally:
        os.close(descriptor)


def _line(entry: Entry) -> str:
    return json.dumps(asdict(entry), separators=(",", ":")) + "\n"


def _read(path: Path) -> Iterator[Entry]:
    if not path.exists():
        return
    for line in path.read_text("utf-8", "replace").split("\n"):
        try:
            values = json.loads(line)
            yield Entry(**{**values, "stamp": Stamp(**values["stamp"])})
        except (ValueError, TypeError, KeyError):
            continue  # torn, or of a newer version

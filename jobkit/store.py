"""Object store: bytes under keys, written whole or not at all.

Uploads are content-addressed: their key follows from their sha256, so the same bytes are kept once. Results lie under
`results/{job}/{attempt}/{name}`: a late twin of an attempt can't write over another one's files.
"""

import hashlib
import os
import re
import shutil
import uuid
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import BinaryIO, Protocol, Self
from urllib.parse import unquote, urlsplit

from jobkit.errors import ObjectNotFoundError, SettingsError, StoreUnavailableError, TooLargeError

CHUNK_BYTES = 1 << 20
_KEY = re.compile(r"^[A-Za-z0-9_][A-Za-z0-9._-]*(/[A-Za-z0-9_][A-Za-z0-9._-]*)*$")


@dataclass(frozen=True)
class StoredObject:
    """What lies under a key."""

    key: str
    size_bytes: int
    sha256: str


class ObjectWriter(Protocol):
    """A sink for one object; leaving it without a commit leaves nothing behind."""

    def write(self, chunk: bytes) -> None:
        """Append bytes; raise TooLargeError beyond the limit."""
        ...

    def commit(self, key: str | None = None) -> StoredObject:
        """Keep the bytes under that key; None: under one that follows from their sha256."""
        ...

    def __enter__(self) -> Self:
        """Start."""
        ...

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Throw away what was not committed."""
        ...


class ObjectStore(Protocol):
    """Where meshes, results and models lie."""

    def writer(self, prefix: str, max_bytes: int | None = None) -> ObjectWriter:
        """Open a sink; content-addressed keys start with `prefix`."""
        ...

    def put_file(self, key: str, path: Path) -> StoredObject:
        """Keep a copy of a local file under that key."""
        ...

    def size(self, key: str) -> int:
        """Return the size in bytes; raise ObjectNotFoundError."""
        ...

    def read(self, key: str, start: int = 0, length: int | None = None) -> Iterator[bytes]:
        """Yield the bytes of a range; raise ObjectNotFoundError at once."""
        ...

    def local_file(self, key: str) -> AbstractContextManager[Path]:
        """Give the object as a file that must not be changed, for the length of a with block."""
        ...

    def check(self) -> None:
        """Raise StoreUnavailableError if objects can't be written."""
        ...

    def delete(self, key: str) -> None:
        """Remove the object; nothing happens where there is none."""
        ...

    def delete_prefix(self, prefix: str) -> None:
        """Remove everything below `prefix/`."""
        ...


def result_key(job_id: str, attempt: int, name: str) -> str:
    """Return the key of one file of an attempt's result."""
    return f"results/{job_id}/{attempt}/{name}"


def open_store(url: str) -> ObjectStore:
    """Open the store that the URL names: `file:///a/folder`.

    Raises
    ------
    SettingsError
        If the URL names another kind of store.
    """
    parts = urlsplit(url)
    if parts.scheme != "file" or parts.netloc not in ("", "localhost"):
        raise SettingsError(f"object store {url!r} is not supported; use file:///a/folder")
    return LocalStore(Path(unquote(parts.path)))


class LocalStore:
    """A store in a folder. Files appear by an atomic rename after their bytes have reached the disk."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._incoming = folder / "incoming"
        self._incoming.mkdir(parents=True, exist_ok=True)

    def writer(self, prefix: str, max_bytes: int | None = None) -> "LocalWriter":
        """Open a sink."""
        return LocalWriter(self, prefix, max_bytes)

    def put_file(self, key: str, path: Path) -> StoredObject:
        """Keep a copy of a local file under that key."""
        with path.open("rb") as source, self.writer("") as writer:
            while chunk := source.read(CHUNK_BYTES):
                writer.write(chunk)
            return writer.commit(key)

    def size(self, key: str) -> int:
        """Return the size in bytes."""
        return self._existing(key).stat().st_size

    def read(self, key: str, start: int = 0, length: int | None = None) -> Iterator[bytes]:
        """Yield the bytes of a range."""
        return _read_range(self._existing(key).open("rb"), start, length)

    @contextmanager
    def local_file(self, key: str) -> Iterator[Path]:
        """Give the file itself."""
        yield self._existing(key)

    def check(self) -> None:
        """Write and remove a byte."""
        path = self.new_incoming()
        try:
            path.write_bytes(b"0")
            path.unlink()
        except OSError as error:
            raise StoreUnavailableError("the object store can't be written") from error

    def delete(self, key: str) -> None:
        """Remove the object."""
        self.path(key).unlink(missing_ok=True)

    def delete_prefix(self, prefix: str) -> None:
        """Remove everything below the prefix."""
        shutil.rmtree(self.path(prefix), ignore_errors=True)

    def path(self, key: str) -> Path:
        """Return where the object lies, or would lie; a key can't lead out of the folder."""
        if not _KEY.match(key):
            raise ObjectNotFoundError(f"{key!r} is no key of an object")
        return self._folder / key

    def new_incoming(self) -> Path:
        """Return a fresh path for bytes that are still on their way."""
        return self._incoming / uuid.uuid4().hex

    def _existing(self, key: str) -> Path:
        path = self.path(key)
        if not path.is_file():
            raise ObjectNotFoundError(f"the store holds nothing under {key!r}")
        return path


class LocalWriter:
    """Bytes on their way into a LocalStore."""

    def __init__(self, store: LocalStore, prefix: str, max_bytes: int | None) -> None:
        self._store = store
        self._prefix = prefix
        self._max_bytes = max_bytes
        self._path = store.new_incoming()
        self._file: BinaryIO = self._path.open("xb")
        self._hash = hashlib.sha256()
        self._size = 0

    def write(self, chunk: bytes) -> None:
        """Append bytes."""
        if self._max_bytes is not None and self._size + len(chunk) > self._max_bytes:
            raise TooLargeError(f"the body has more than {self._max_bytes} bytes, which is the limit")
        self._file.write(chunk)
        self._hash.update(chunk)
        self._size += len(chunk)

    def commit(self, key: str | None = None) -> StoredObject:
        """Flush, sync and rename."""
        digest = self._hash.hexdigest()
        final = key or f"{self._prefix}/{digest[:2]}/{digest}"
        target = self._store.path(final)
        self._file.flush()
        os.fsync(self._file.fileno())
        self._file.close()
        target.parent.mkdir(parents=True, exist_ok=True)
        self._path.replace(target)
        _sync_folder(target.parent)
        return StoredObject(final, self._size, digest)

    def __enter__(self) -> Self:
        """Start."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Throw away what was not committed."""
        self._file.close()
        self._path.unlink(missing_ok=True)


def _read_range(file: BinaryIO, start: int, length: int | None) -> Iterator[bytes]:
    with file:
        file.seek(start)
        left = length
        while left is None or left > 0:
            chunk = file.read(CHUNK_BYTES if left is None else min(CHUNK_BYTES, left))
            if not chunk:
                return
            left = None if left is None else left - len(chunk)
            yield chunk


def _sync_folder(folder: Path) -> None:
    # The rename itself lives in the folder: without this a power cut may undo it.
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)

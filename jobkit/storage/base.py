"""Object store: bytes under keys, written whole or not at all.

Uploads are content-addressed: their key follows from their sha256, so the same bytes are kept once. Results lie under
`results/{job}/{attempt}/{name}`: an attempt can't overwrite the files of another one.
"""

import re
from collections.abc import Iterator
from contextlib import AbstractContextManager
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from types import TracebackType
from typing import NamedTuple, Protocol, Self

from jobkit.errors import ObjectNotFoundError

CHUNK_BYTES = 1 << 20
_KEY = re.compile(r"^[A-Za-z0-9_][A-Za-z0-9._-]*(/[A-Za-z0-9_][A-Za-z0-9._-]*)*\Z")


@dataclass(frozen=True)
class StoredObject:
    """What lies under a key."""

    key: str
    size_bytes: int
    sha256: str


class ListedObject(NamedTuple):
    """An entry of a listing; `modified_at` is in UTC, by the clock of the store."""

    key: str
    size_bytes: int
    modified_at: datetime


class ObjectWriter(Protocol):
    """A sink for one object; leaving it without a commit leaves nothing behind."""

    def write(self, chunk: bytes) -> None:
        """Append bytes; raise TooLargeError beyond the limit, StoreUnavailableError where there is no room."""
        ...

    @property
    def sha256(self) -> str:
        """The sha256 of what was written so far, in hex."""
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
        """Discard what was not committed."""
        ...


class ObjectStore(Protocol):
    """Where meshes, results and models lie; everything may raise StoreUnavailableError."""

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

    def keys(self, prefix: str = "") -> Iterator[ListedObject]:
        """List what lies below `prefix/`, or everything, in no order; what is still being written does not show."""
        ...

    def check(self) -> None:
        """Raise StoreUnavailableError if objects can't be written."""
        ...

    @property
    def is_local(self) -> bool:
        """Whether objects lie on the disk that incoming bytes are written to."""
        ...

    def free_bytes(self) -> int:
        """Return what is free on the disk that incoming bytes are written to."""
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


def content_key(prefix: str, sha256: str) -> str:
    """Return the key that follows from the bytes."""
    return f"{prefix}/{sha256[:2]}/{sha256}"


def checked_key(key: str) -> str:
    """Return the key if it is one; a key can't lead out of the store. Raises ObjectNotFoundError."""
    if not _KEY.match(key):
        raise ObjectNotFoundError(f"{key!r} is no key of an object")
    return key


def not_found_error(key: str) -> ObjectNotFoundError:
    """Make the error of a key with nothing under it."""
    return ObjectNotFoundError(f"the store holds nothing under {key!r}")

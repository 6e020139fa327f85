"""Incoming bytes of a store: counted, hashed and written to a local file until they are complete."""

import contextlib
import errno
import hashlib
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import TracebackType
from typing import Self

from jobkit.errors import StoreUnavailableError, TooLargeError
from jobkit.storage.base import StoredObject, checked_key, content_key
from jobkit.storage.scratch import ScratchFolder

_FULL = (errno.ENOSPC, errno.EDQUOT)
_READ_ONLY = (errno.EROFS, errno.EACCES, errno.EPERM)


class SpoolingWriter:
    """An ObjectWriter over a file of a scratch folder; memory does not depend on the size.

    Parameters
    ----------
    scratch : ScratchFolder
    store_file : callable
        Puts the file, whole and on the disk, under its key; may move it away.
    prefix : str
        Of content-addressed keys.
    max_bytes : int, optional
        Most that may be written.
    """

    def __init__(
        self, scratch: ScratchFolder, store_file: Callable[[Path, str], None], prefix: str, max_bytes: int | None
    ) -> None:
        self._store_file = store_file
        self._prefix = prefix
        self._max_bytes = max_bytes
        self._hash = hashlib.sha256()
        self._size = 0
        with translated_os_errors():
            self._path, self._file = scratch.new_file()

    def write(self, chunk: bytes) -> None:
        """Append bytes."""
        if self._max_bytes is not None and self._size + len(chunk) > self._max_bytes:
            raise TooLargeError(f"the body has more than {self._max_bytes} bytes, which is the limit")
        with translated_os_errors():
            self._file.write(chunk)
        self._hash.update(chunk)
        self._size += len(chunk)

    @property
    def sha256(self) -> str:
        """The sha256 of what was written so far, in hex."""
        return self._hash.hexdigest()

    def commit(self, key: str | None = None) -> StoredObject:
        """Sync and keep."""
        digest = self.sha256
        final_key = checked_key(key or content_key(self._prefix, digest))
        self.sync()
        self._store_file(self._path, final_key)
        return StoredObject(final_key, self._size, digest)

    def sync(self) -> None:
        """Let the bytes reach the disk."""
        with translated_os_errors():
            self._file.flush()
            os.fsync(self._file.fileno())

    def __enter__(self) -> Self:
        """Start."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Discard what was not committed."""
        with contextlib.suppress(OSError):
            self._path.unlink(missing_ok=True)
        # Closing flushes, which fails again on a full disk; the bytes are not wanted any more.
        with contextlib.suppress(OSError):
            self._file.close()


@contextmanager
def translated_os_errors() -> Iterator[None]:
    """Raise errors of the disk as errors of the contract; paths stay out of the message."""
    try:
        yield
    except FileNotFoundError as error:
        raise StoreUnavailableError("the folder of the object store is not there") from error
    except OSError as error:
        if error.errno in _FULL:
            raise StoreUnavailableError("the object store has no space left") from error
        if error.errno in _READ_ONLY:
            raise StoreUnavailableError("the object store refuses to be written") from error
        raise StoreUnavailableError(f"the object store can't be used: {error.strerror or 'disk error'}") from error

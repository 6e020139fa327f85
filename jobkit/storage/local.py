"""A store in a folder. Files appear by an atomic rename after their bytes have reached the disk."""

import contextlib
import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import UTC, datetime
from pathlib import Path
from typing import BinaryIO

from jobkit.errors import StoreUnavailableError
from jobkit.storage.base import CHUNK_BYTES, ListedObject, StoredObject, checked_key, not_found_error
from jobkit.storage.scratch import ScratchFolder
from jobkit.storage.spool import SpoolingWriter, translated_os_errors

_INCOMING = "incoming"


class LocalStore:
    """An ObjectStore on a disk that all processes share.

    Parameters
    ----------
    folder : Path
        Made where it is missing, but only at this moment: a disk that is unmounted later is no empty store.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        # Incoming bytes are on the same file system, so that they can be renamed into place.
        self._incoming = ScratchFolder(folder / _INCOMING)

    def writer(self, prefix: str, max_bytes: int | None = None) -> SpoolingWriter:
        """Open a sink."""
        return SpoolingWriter(self._incoming, self._store_file, prefix, max_bytes)

    def put_file(self, key: str, path: Path) -> StoredObject:
        """Keep a copy of a local file under that key."""
        with path.open("rb") as source, self.writer("") as writer:
            while chunk := source.read(CHUNK_BYTES):
                writer.write(chunk)
            return writer.commit(key)

    def size(self, key: str) -> int:
        """Return the size in bytes."""
        with self._existing(key) as path:
            return path.stat().st_size

    def read(self, key: str, start: int = 0, length: int | None = None) -> Iterator[bytes]:
        """Yield the bytes of a range."""
        with self._existing(key) as path:
            file = path.open("rb")
        return _read_range(file, start, length)

    @contextmanager
    def local_file(self, key: str) -> Iterator[Path]:
        """Give the file itself."""
        with self._existing(key) as path:
            pass
        yield path

    def keys(self, prefix: str = "") -> Iterator[ListedObject]:
        """List what lies below the prefix."""
        self._assert_mounted()
        top = self._path(prefix) if prefix else self._folder
        for path in _files_below(top, self._incoming.folder):
            try:
                file_stat = path.stat()
            except FileNotFoundError:
                continue  # deleted since it was listed
            modified_at = datetime.fromtimestamp(file_stat.st_mtime, UTC)
            yield ListedObject(path.relative_to(self._folder).as_posix(), file_stat.st_size, modified_at)

    def check(self) -> None:
        """Write a byte and discard it."""
        with self.writer("") as writer:
            writer.write(b"0")
            writer.sync()

    @property
    def is_local(self) -> bool:
        """Objects lie where incoming bytes are written."""
        return True

    def free_bytes(self) -> int:
        """Return what is free on the disk."""
        with translated_os_errors():
            return shutil.disk_usage(self._folder).free

    def delete(self, key: str) -> None:
        """Remove the object."""
        with translated_os_errors():
            self._path(key).unlink(missing_ok=True)

    def delete_prefix(self, prefix: str) -> None:
        """Remove everything below the prefix."""
        with translated_os_errors(), contextlib.suppress(FileNotFoundError):
            shutil.rmtree(self._path(prefix))

    def _store_file(self, path: Path, key: str) -> None:
        target = self._path(key)
        with translated_os_errors():
            target.parent.mkdir(parents=True, exist_ok=True)
            path.replace(target)
            _sync_folder(target.parent)

    def _path(self, key: str) -> Path:
        return self._folder / checked_key(key)

    @contextmanager
    def _existing(self, key: str) -> Iterator[Path]:
        """Give the path of an object that may be removed at any moment; raise ObjectNotFoundError where it has."""
        path = self._path(key)
        with translated_os_errors():
            try:
                if not path.is_file():
                    raise FileNotFoundError(key)
                yield path
            except FileNotFoundError as error:
                self._assert_mounted()
                raise not_found_error(key) from error

    def _assert_mounted(self) -> None:
        """Tell a disk that is not mounted from a store that has lost its objects."""
        if not self._incoming.folder.is_dir():
            raise StoreUnavailableError("the folder of the object store is not there")


def _files_below(top: Path, excluded: Path) -> Iterator[Path]:
    def refuse(error: OSError) -> None:
        if not isinstance(error, FileNotFoundError):
            raise StoreUnavailableError("the object store can't be listed") from error

    for folder, subfolders, files in os.walk(top, onerror=refuse):
        subfolders[:] = [name for name in subfolders if Path(folder, name) != excluded]
        yield from (Path(folder, name) for name in files)


def _read_range(file: BinaryIO, start: int, length: int | None) -> Iterator[bytes]:
    with file:
        file.seek(start)
        remaining = length
        while remaining is None or remaining > 0:
            with translated_os_errors():
                chunk = file.read(CHUNK_BYTES if remaining is None else min(CHUNK_BYTES, remaining))
            if not chunk:
                return
            remaining = None if remaining is None else remaining - len(chunk)
            yield chunk


def _sync_folder(folder: Path) -> None:
    # The rename is stored in the folder: without this a power failure may undo it.
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)

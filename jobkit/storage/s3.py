"""A store in a bucket of S3, or of a compatible service.

Credentials, region and endpoint come from where other S3 clients look for them: the AWS_ environment variables (also
those of roles and web identities), or the metadata service of the machine. They are no settings of this project.
"""

import logging
import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from datetime import UTC, timedelta
from pathlib import Path

import obstore
from obstore.exceptions import BaseError, PermissionDeniedError, UnauthenticatedError
from obstore.store import S3Store as Bucket

from jobkit.errors import StoreUnavailableError
from jobkit.storage.base import CHUNK_BYTES, ListedObject, StoredObject, checked_key, not_found_error
from jobkit.storage.scratch import ScratchFolder
from jobkit.storage.spool import SpoolingWriter, translated_os_errors

# Of a multipart upload: S3 takes 10,000 parts at most, so objects of up to 80 GiB; two at a time are held in memory.
_PART_BYTES = 8 << 20
_PARTS_AT_ONCE = 2
# Of a download: every range is a request of its own, so that a slow reader never runs into the timeout of one.
_RANGE_BYTES = 4 << 20
_LISTED_AT_ONCE = 1_000
# Written over and over by `check`.
_CHECK_KEY = "writable"
# The API answers 503 and workers wait a while, so waits here are short.
_CONNECT_TIMEOUT_S = 3
_REQUEST_TIMEOUT_S = 120
_MAX_RETRIES = 3
_RETRY_TIMEOUT_S = 10

_log = logging.getLogger("quadpatch.store")


class S3Store:
    """An ObjectStore in a bucket.

    Parameters
    ----------
    bucket : str
    prefix : str
        In front of all keys; empty: none.
    scratch : Path
        Folder on a local disk: uploads are spooled there until their sha256 is known, and `local_file` downloads there.
    """

    def __init__(self, bucket: str, prefix: str, scratch: Path) -> None:
        self._scratch = ScratchFolder(scratch)
        self._bucket = Bucket(
            bucket,
            prefix=prefix or None,
            client_options={
                # An endpoint without TLS is the choice of the operator.
                "allow_http": _endpoint().startswith("http://"),
                "connect_timeout": timedelta(seconds=_CONNECT_TIMEOUT_S),
                "timeout": timedelta(seconds=_REQUEST_TIMEOUT_S),
            },
            retry_config={"max_retries": _MAX_RETRIES, "retry_timeout": timedelta(seconds=_RETRY_TIMEOUT_S)},
        )

    def writer(self, prefix: str, max_bytes: int | None = None) -> SpoolingWriter:
        """Open a sink."""
        return SpoolingWriter(self._scratch, self._upload, prefix, max_bytes)

    def put_file(self, key: str, path: Path) -> StoredObject:
        """Keep a copy of a local file under that key."""
        with path.open("rb") as source, self.writer("") as writer:
            while chunk := source.read(CHUNK_BYTES):
                writer.write(chunk)
            return writer.commit(key)

    def size(self, key: str) -> int:
        """Return the size in bytes."""
        with self._existing(key):
            return obstore.head(self._bucket, key)["size"]

    def read(self, key: str, start: int = 0, length: int | None = None) -> Iterator[bytes]:
        """Yield the bytes of a range."""
        size = self.size(key)
        end = size if length is None else min(size, start + length)
        return self._read_ranges(key, start, end)

    @contextmanager
    def local_file(self, key: str) -> Iterator[Path]:
        """Download the object; the file is removed at the end."""
        chunks = self.read(key)
        with translated_os_errors():
            path, file = self._scratch.new_file()
        try:
            for chunk in chunks:
                with translated_os_errors():
                    file.write(chunk)
            with translated_os_errors():
                file.flush()
            yield path
        finally:
            path.unlink(missing_ok=True)
            with suppress(OSError):
                file.close()

    def keys(self, prefix: str = "") -> Iterator[ListedObject]:
        """List what lies below the prefix."""
        top = checked_key(prefix) if prefix else None
        with _translated():
            for batch in obstore.list(self._bucket, top, chunk_size=_LISTED_AT_ONCE):
                for listed in batch:
                    if listed["path"] != _CHECK_KEY:
                        yield ListedObject(listed["path"], listed["size"], listed["last_modified"].astimezone(UTC))

    def check(self) -> None:
        """Write a byte, here and there."""
        with self.writer("") as writer:
            writer.write(b"0")
            writer.commit(_CHECK_KEY)

    @property
    def is_local(self) -> bool:
        """Objects lie in the bucket, which is never full."""
        return False

    def free_bytes(self) -> int:
        """Return what is free on the disk of the scratch folder, where each object is spooled as a whole."""
        with translated_os_errors():
            return shutil.disk_usage(self._scratch.folder).free

    def delete(self, key: str) -> None:
        """Remove the object."""
        with _translated():
            obstore.delete(self._bucket, checked_key(key))

    def delete_prefix(self, prefix: str) -> None:
        """Remove everything below the prefix."""
        with _translated():
            for batch in obstore.list(self._bucket, checked_key(prefix), chunk_size=_LISTED_AT_ONCE):
                obstore.delete(self._bucket, [listed["path"] for listed in batch])

    def _upload(self, path: Path, key: str) -> None:
        """Send a file; S3 shows it when its last part has come, and never before."""
        with _translated():
            obstore.put(self._bucket, key, path, chunk_size=_PART_BYTES, max_concurrency=_PARTS_AT_ONCE)

    def _read_ranges(self, key: str, start: int, end: int) -> Iterator[bytes]:
        for first in range(start, end, _RANGE_BYTES):
            with self._existing(key):
                part = obstore.get_range(self._bucket, key, start=first, end=min(first + _RANGE_BYTES, end)).to_bytes()
            yield from (part[i : i + CHUNK_BYTES] for i in range(0, len(part), CHUNK_BYTES))

    @contextmanager
    def _existing(self, key: str) -> Iterator[None]:
        """Tell an object that is not there from a bucket that is not there, to which S3 gives the same status."""
        checked_key(key)
        with _translated():
            try:
                yield
            except FileNotFoundError as error:
                obstore.list_with_delimiter(self._bucket, "no-such-prefix")
                raise not_found_error(key) from error


def _endpoint() -> str:
    names = ("AWS_ENDPOINT_URL_S3", "AWS_ENDPOINT_URL", "AWS_ENDPOINT")
    return next((os.environ[name] for name in names if os.environ.get(name)), "")


@contextmanager
def _translated() -> Iterator[None]:
    try:
        yield
    except (PermissionDeniedError, UnauthenticatedError) as error:
        _log.warning("the object store refuses the credentials: %s", error)
        raise StoreUnavailableError("the object store refuses the credentials") from error
    except FileNotFoundError as error:
        raise StoreUnavailableError("the bucket of the object store is not there") from error
    except (BaseError, OSError) as error:
        # The library's text names hosts and buckets, so it stays in the log.
        raise StoreUnavailableError("the object store does not answer") from error

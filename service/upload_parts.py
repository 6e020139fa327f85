"""The body of a request that continues a resumable upload, stored in parts as it arrives.

What has arrived when the line breaks is kept: every full part is acknowledged at once, and the rest when the client is
gone. A process that is killed loses at most the part that was not full. Bytes under a checksum or a digest are
acknowledged only when all of them have come and fit it.

Tested in `tests/service/routes/test_uploads.py`.
"""

import logging
import secrets
from collections.abc import AsyncIterator, Iterable, Iterator
from typing import Protocol

from starlette.concurrency import run_in_threadpool
from starlette.requests import ClientDisconnect

from jobkit.errors import (
    ObjectNotFoundError,
    StoreUnavailableError,
    TooLargeError,
    UploadNotFoundError,
    UploadOffsetError,
)
from jobkit.storage.base import ObjectStore, ObjectWriter
from jobkit.storage.digests import verified_chunks
from jobkit.uploads.parts import PART_BYTES, PART_PREFIX, UploadPart, mergeable
from jobkit.uploads.uploads import Uploads, offset_error
from quadpatch_client.schema import Upload

_log = logging.getLogger("service")


class Check(Protocol):
    """Compares the bytes of a request with what its headers state."""

    def update(self, data: bytes) -> None:
        """Add bytes."""
        ...

    def check(self) -> None:
        """Raise where they differ."""
        ...


async def append(
    uploads: Uploads, store: ObjectStore, upload: Upload, body: AsyncIterator[bytes], checks: list[Check]
) -> Upload:
    """Add the bytes of a body to an upload; return it as it is then.

    Parameters
    ----------
    uploads : Uploads
    store : ObjectStore
    upload : Upload
        As it was when the body began.
    body : iterator of bytes
    checks : list of Check
        Where there are any, either all bytes of the body are kept or none.

    Raises
    ------
    TooLargeError
        If there are more bytes than the upload is to have.
    UploadOffsetError
        If other bytes were acknowledged meanwhile.
    """
    parts = await run_in_threadpool(_Parts, uploads, store, upload, is_held_back=bool(checks))
    try:
        async for chunk in body:
            for check in checks:
                check.update(chunk)
            await run_in_threadpool(parts.write, chunk)
        for check in checks:
            check.check()
        return await run_in_threadpool(parts.acknowledge)
    except ClientDisconnect:
        if not checks:
            await run_in_threadpool(parts.acknowledge)
        raise
    finally:
        await run_in_threadpool(parts.discard)


def drop_objects(store: ObjectStore, keys: Iterable[str]) -> None:
    """Delete objects that no upload needs; what can't be deleted now is left to the sweep."""
    try:
        for key in keys:
            store.delete(key)
    except StoreUnavailableError as error:
        _log.warning("parts of an upload are left to the sweep: %s", error)


class _Parts:
    """Writes bytes into one part after the other."""

    def __init__(self, uploads: Uploads, store: ObjectStore, upload: Upload, is_held_back: bool) -> None:
        self._uploads, self._store, self._upload = uploads, store, upload
        self._is_held_back = is_held_back
        self._stored: list[UploadPart] = []
        self._replaced = mergeable(uploads.parts(upload.id))
        self._start = self._end = upload.offset_bytes
        self._writer: ObjectWriter | None = None

    def write(self, data: bytes) -> None:
        """Append bytes, and begin a new part wherever one is full."""
        if self._end + len(data) > self._upload.size_bytes:
            raise TooLargeError(f"the upload is to have {self._upload.size_bytes} bytes, and more have come")
        rest = memoryview(data)
        while rest:
            writer = self._writer or self._begin()
            n_bytes = min(len(rest), max(1, self._start + PART_BYTES - self._end))
            writer.write(bytes(rest[:n_bytes]))
            self._end += n_bytes
            rest = rest[n_bytes:]
            if self._end - self._start >= PART_BYTES:
                self._store_part()

    def acknowledge(self) -> Upload:
        """Store what has come, and move the offset of the upload behind it."""
        if self._writer is not None:
            self._is_held_back = False
            self._store_part()
        elif self._stored:
            self._move_offset()
        return self._upload

    def discard(self) -> None:
        """Remove what was not acknowledged."""
        if self._writer is not None:
            self._writer.__exit__(None, None, None)
            self._writer = None
        drop_objects(self._store, [part.key for part in self._stored])

    def _begin(self) -> ObjectWriter:
        """Open a part; the first one begins with the bytes of small ones before it."""
        self._writer = self._store.writer(PART_PREFIX).__enter__()
        if not self._stored and self._replaced:
            self._start = self._replaced[0].start
            for chunk in self._bytes_of(self._replaced):
                self._writer.write(chunk)
        return self._writer

    def _bytes_of(self, parts: Iterable[UploadPart]) -> Iterator[bytes]:
        try:
            for part in parts:
                yield from verified_chunks(self._store.read(part.key), part.sha256)
        except ObjectNotFoundError:
            if self._uploads.get(self._upload.id).offset_bytes != self._upload.offset_bytes:
                raise offset_error(self._upload.id, self._upload.offset_bytes) from None
            raise

    def _store_part(self) -> None:
        assert self._writer is not None
        key = f"{PART_PREFIX}/{self._upload.id}-{self._start}-{secrets.token_hex(8)}"
        with self._writer as writer:
            stored = writer.commit(key)
        self._writer = None
        self._stored.append(UploadPart(self._start, stored.size_bytes, stored.key, stored.sha256))
        self._start = self._end
        if not self._is_held_back:
            self._move_offset()

    def _move_offset(self) -> None:
        # Where the database is lost in the middle of it, rows may name these parts: only a refusal gives them back.
        stored, self._stored = self._stored, []
        try:
            self._upload = self._uploads.acknowledge(self._upload.id, self._upload.offset_bytes, stored, self._replaced)
        except (UploadOffsetError, UploadNotFoundError):
            self._stored = stored
            raise
        replaced, self._replaced = self._replaced, []
        drop_objects(self._store, [part.key for part in replaced])

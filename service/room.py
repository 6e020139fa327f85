"""Room on the disk for uploads: what is promised to those under way, and a reserve for jobs, is not given twice.

A disk that is full fails every job that runs, so uploads are refused before that. Bodies that this process receives
count with the bytes that are still to come, and resumable uploads, of all processes, with those and the whole that is
put together from the parts. A resumable upload that has been silent for ten minutes holds no room: its client may never
come back, and when it does, room is looked for again.

Tested in `tests/service/test_room.py`.
"""

from collections.abc import AsyncIterator, Iterator
from contextlib import contextmanager
from datetime import timedelta

import anyio.to_thread
from sqlalchemy import func, select

from jobkit.database.clock import shared_now
from jobkit.database.session import Database
from jobkit.database.upload_tables import UploadRow
from jobkit.errors import StoreFullError
from jobkit.storage.base import ObjectStore
from quadpatch_client.schema import UploadState

ACTIVE_FOR = timedelta(minutes=10)
# Of a body that did not say how long it is: so often the disk is looked at.
_LOOK_EVERY_BYTES = 16 << 20


class DiskRoom:
    """What the disk of the store has left for uploads.

    Parameters
    ----------
    store : ObjectStore
    database : Database
        That sees all tenants.
    reserve_bytes : int
        What uploads leave free.
    """

    def __init__(self, store: ObjectStore, database: Database, reserve_bytes: int) -> None:
        self._store, self._database, self._reserve_bytes = store, database, reserve_bytes
        self._pending_bytes = 0

    def check(self, n_bytes: int, *, is_resumable: bool = False) -> None:
        """Raise StoreFullError where the disk has no room for so many more bytes.

        Those of a resumable upload take it twice on local files: as parts, and as the whole.
        """
        needed = n_bytes * 2 if is_resumable and self._store.is_local else n_bytes
        promised = self._pending_bytes + (self._promised_bytes() if self._store.is_local else 0)
        if needed > self._store.free_bytes() - self._reserve_bytes - promised:
            raise StoreFullError("the disk has no room for it beside other uploads and the reserve for jobs")

    def check_reserve(self) -> None:
        """Raise StoreFullError where the reserve for jobs is used already: no upload goes on then."""
        if self._store.free_bytes() < self._reserve_bytes:
            raise StoreFullError("the disk has no room for more beside the reserve for jobs")

    @contextmanager
    def kept(self, n_bytes: int) -> Iterator["KeptRoom"]:
        """Keep room for a body of that size, 0 where it is not known, for a with block, which has to check it."""
        kept = KeptRoom(self, n_bytes)
        self._pending_bytes += n_bytes
        try:
            yield kept
        finally:
            self._pending_bytes -= kept.pending_bytes

    def note_arrived(self, n_bytes: int) -> None:
        """Keep less, since bytes of a body lie on the disk now."""
        self._pending_bytes -= n_bytes

    def _promised_bytes(self) -> int:
        with self._database.read() as session:
            is_active = UploadRow.updated_at > shared_now(session) - ACTIVE_FOR
            still_to_come = func.sum(2 * UploadRow.size_bytes - UploadRow.offset_bytes)
            query = select(still_to_come).where(UploadRow.state == UploadState.OPEN.value, is_active)
            return int(session.scalar(query) or 0)


class KeptRoom:
    """Room for one body; `pending_bytes` are still to come."""

    def __init__(self, room: DiskRoom, n_bytes: int) -> None:
        self._room = room
        self._unannounced_bytes = 0
        self.pending_bytes = n_bytes

    def check(self) -> None:
        """Raise StoreFullError where there is no room for it: it counts among those under way already."""
        self._room.check(0)

    def note(self, n_bytes: int) -> bool:
        """Count bytes that arrive; return whether the disk has to be looked at before more come."""
        n_kept = min(n_bytes, self.pending_bytes)
        self.pending_bytes -= n_kept
        self._room.note_arrived(n_kept)
        self._unannounced_bytes += n_bytes - n_kept
        if self._unannounced_bytes < _LOOK_EVERY_BYTES:
            return False
        self._unannounced_bytes = 0
        return True

    async def watch(self, body: AsyncIterator[bytes]) -> AsyncIterator[bytes]:
        """Pass the bytes of a body on; raise StoreFullError where more come than were announced, and fill the disk."""
        async for chunk in body:
            if self.note(len(chunk)):
                await anyio.to_thread.run_sync(self._room.check_reserve)
            yield chunk

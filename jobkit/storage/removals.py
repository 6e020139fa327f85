"""Objects whose key follows from their bytes: how a sweep removes one that is not being uploaded again.

Such an object may be written again, with the same bytes, while a sweep is about to delete it as unreferenced. So a
sweep claims a key in the database before it checks the object's age for the last time, and releases it after the
deletion. The writer of an object waits until there is no such claim, and then checks that the object exists, before a
row may name it. An object that is written

- before that last check is young, and the sweep leaves it;
- between the check and the deletion has a claim or is missing, and the client is asked to send it again;
- after the deletion stays.

Tested in `tests/dispatcher/test_unreferenced_objects.py`.
"""

import time
from collections.abc import Iterable
from datetime import timedelta

from sqlalchemy import delete, select
from sqlalchemy.orm import Session

from jobkit.database.clock import shared_now
from jobkit.database.session import Database
from jobkit.database.tables import MeshRow, ModelRow, RemovalRow
from jobkit.database.view_tables import ViewRow
from jobkit.errors import ObjectNotFoundError, RowConflictError, StoreUnavailableError
from jobkit.storage.base import ObjectStore
from jobkit.storage.damage import forget_damaged, is_known_damaged

# A sweep starts no deletion later than this after it claimed the key.
START_S = 60.0
# When a claim of a sweep that was killed is void; a deletion that was started is over by then, whatever the store does.
CLAIM_S = 600.0
# How long a writer waits for the end of a claim, which takes a moment unless a sweep was killed.
CLAIM_WAIT_S = 10.0
_PAUSE_S = 0.05


def named_keys(session: Session, keys: set[str]) -> set[str]:
    """Return those of the keys that a mesh, a model or a view names."""
    queries = [select(table.key).where(table.key.in_(keys)) for table in (MeshRow, ModelRow, ViewRow)]
    return {key for query in queries for key in session.scalars(query) if key is not None}


def claim(database: Database, keys: Iterable[str]) -> list[str]:
    """Claim those keys that no mesh, model, view or other sweep names; return them."""
    requested_keys = set(keys)
    try:
        with database.write() as session:
            now = shared_now(session)
            session.execute(delete(RemovalRow).where(RemovalRow.until < now))
            used_keys = named_keys(session, requested_keys)
            used_keys |= set(session.scalars(select(RemovalRow.key).where(RemovalRow.key.in_(requested_keys))))
            free_keys = sorted(requested_keys - used_keys)
            session.add_all(RemovalRow(key=key, until=now + timedelta(seconds=CLAIM_S)) for key in free_keys)
    except RowConflictError:
        return []  # another sweep claimed one of them at the same moment; the next sweep tries again
    return free_keys


def release(database: Database, keys: Iterable[str]) -> None:
    """End claims."""
    with database.write() as session:
        session.execute(delete(RemovalRow).where(RemovalRow.key.in_(list(keys))))


def assure(database: Database, store: ObjectStore, key: str, claim_wait_s: float = CLAIM_WAIT_S) -> None:
    """Make sure that no sweep removes an object that was just written; to be called before a row names it.

    A record of damage is deleted: its bytes have just been written again.

    Parameters
    ----------
    database : Database
    store : ObjectStore
    key : str
    claim_wait_s : float
        How long to wait for a sweep that claims the key, in seconds.

    Raises
    ------
    StoreUnavailableError
        If a sweep removed it at the same moment, or was killed before it could: it has to be written again.
    """
    deadline = time.monotonic() + claim_wait_s
    while _is_claimed(database, key):
        if time.monotonic() > deadline:
            raise StoreUnavailableError("the same bytes are being removed as unreferenced; send them again later")
        time.sleep(_PAUSE_S)
    with database.read() as session:
        was_damaged = is_known_damaged(session, key)
    if was_damaged:
        with database.write() as session:
            forget_damaged(session, key)
    try:
        store.size(key)
    except ObjectNotFoundError as error:
        raise StoreUnavailableError("the bytes were removed while they arrived; send them again") from error


def _is_claimed(database: Database, key: str) -> bool:
    with database.read() as session:
        until = session.scalars(select(RemovalRow.until).where(RemovalRow.key == key)).one_or_none()
        return until is not None and until > shared_now(session)

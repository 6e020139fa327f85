"""Objects whose key follows from their bytes: how a sweep removes one without taking it from an upload.

Such an object may be written again, with the same bytes, while a sweep is about to delete it as unreferenced. So a
sweep claims a key in the database before it looks at the object's age for the last time, and lets go of it after the
deletion. The writer of an object waits for such a claim to go, and then looks whether the object is there, before a row
may name it. Of an object written

- before that last look: the sweep sees that it is young, and leaves it;
- between the look and the deletion: the writer meets the claim or misses the object, and is asked to send it again;
- after the deletion: nothing happens to it.

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
from jobkit.errors import ObjectNotFoundError, RowConflictError, StoreUnavailableError
from jobkit.storage.base import ObjectStore
from jobkit.storage.damage import forget_damaged, is_known_damaged

# A sweep starts no deletion later than this after it claimed the key.
START_S = 60.0
# When a claim of a sweep that was killed is void; a deletion that was started is over by then, whatever the store does.
CLAIM_S = 600.0
# How long a writer waits for a claim to go, which takes a moment unless a sweep was killed.
PATIENCE_S = 10.0
_PAUSE_S = 0.05


def named_keys(session: Session, keys: set[str]) -> set[str]:
    """Return those of the keys that a mesh or a model names."""
    queries = [select(table.key).where(table.key.in_(keys)) for table in (MeshRow, ModelRow)]
    return {key for query in queries for key in session.scalars(query)}


def claim(database: Database, keys: Iterable[str]) -> list[str]:
    """Claim those keys that no mesh, model or other sweep names; return them."""
    asked = set(keys)
    try:
        with database.write() as session:
            now = shared_now(session)
            session.execute(delete(RemovalRow).where(RemovalRow.until < now))
            named = named_keys(session, asked)
            named |= set(session.scalars(select(RemovalRow.key).where(RemovalRow.key.in_(asked))))
            free = sorted(asked - named)
            session.add_all(RemovalRow(key=key, until=now + timedelta(seconds=CLAIM_S)) for key in free)
    except RowConflictError:
        return []  # another sweep claimed one of them at the same moment; the next turn will do
    return free


def release(database: Database, keys: Iterable[str]) -> None:
    """End claims."""
    with database.write() as session:
        session.execute(delete(RemovalRow).where(RemovalRow.key.in_(list(keys))))


def assure(database: Database, store: ObjectStore, key: str, patience_s: float = PATIENCE_S) -> None:
    """Make sure that an object that was just written stays; to be called before a row names it.

    What was known of damage to it is forgotten: its bytes have just come again.

    Parameters
    ----------
    database : Database
    store : ObjectStore
    key : str
    patience_s : float
        How long to wait for a sweep that is at the key, in seconds.

    Raises
    ------
    StoreUnavailableError
        If a sweep took it away at the same moment, or was killed at it: it has to be written again.
    """
    deadline = time.monotonic() + patience_s
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

"""Objects whose bytes are known to be others than those that were stored: the findings of the scrub."""

from dataclasses import dataclass
from datetime import datetime

from sqlalchemy import delete
from sqlalchemy.orm import Session

from jobkit.database.session import Database
from jobkit.database.tables import DamagedRow
from jobkit.errors import ObjectDamagedError

OBJECT_KINDS = ("mesh", "model", "result")


@dataclass(frozen=True)
class NamedObject:
    """An object as a row names it; `kind` is one of OBJECT_KINDS."""

    kind: str
    key: str
    sha256: str


def note_damaged(session: Session, named_object: NamedObject, now: datetime) -> bool:
    """Record that the object is damaged; return whether that is new."""
    row = session.get(DamagedRow, named_object.key, with_for_update=True)
    if row is not None:
        row.checked_at = now
        return False
    session.add(
        DamagedRow(
            key=named_object.key, kind=named_object.kind, sha256=named_object.sha256, found_at=now, checked_at=now
        )
    )
    return True


def forget_damaged(session: Session, key: str) -> None:
    """Delete the record of the object: its bytes are right, or it is missing."""
    session.execute(delete(DamagedRow).where(DamagedRow.key == key))


def is_known_damaged(session: Session, key: str) -> bool:
    """Tell whether the latest check of the object found it damaged."""
    return session.get(DamagedRow, key) is not None


def refuse_damaged(database: Database, key: str) -> None:
    """Raise ObjectDamagedError where the object is known to be damaged."""
    with database.read() as session:
        if is_known_damaged(session, key):
            raise ObjectDamagedError("the bytes in the store are not those that were stored")

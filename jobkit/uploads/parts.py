"""Parts of resumable uploads: the objects that hold acknowledged bytes.

Tested in `tests/jobkit/uploads/test_uploads.py`.
"""

from collections.abc import Collection, Sequence
from dataclasses import asdict, dataclass

from sqlalchemy import delete, select
from sqlalchemy.orm import Session

from jobkit.database.session import Database
from jobkit.database.upload_tables import UploadPartRow

PART_PREFIX = "uploads"
PART_BYTES = 8 << 20
# Parts up to this size are put together; see `mergeable`.
_SMALL_BYTES = PART_BYTES // 2


@dataclass(frozen=True)
class UploadPart:
    """Bytes of an upload from `start` on, and the object that holds them."""

    start: int
    size_bytes: int
    key: str
    sha256: str

    @property
    def end(self) -> int:
        """Offset of the first byte behind it."""
        return self.start + self.size_bytes


def mergeable(parts: Sequence[UploadPart]) -> list[UploadPart]:
    """Return the last parts that the next one should take in, so that small requests leave few small objects.

    Those are at least two small parts, each no larger than all behind it together: a byte is copied about as often as
    a part can double before it is no longer small.
    """
    found: list[UploadPart] = []
    size = _SMALL_BYTES
    for part in reversed(parts):
        if part.size_bytes > min(size, _SMALL_BYTES):
            break
        size = part.size_bytes if not found else size + part.size_bytes
        found.insert(0, part)
    return found if len(found) > 1 else []


def named_parts(database: Database, keys: Collection[str]) -> set[str]:
    """Return those of the keys that a part of an upload names."""
    with database.read() as session:
        return set(session.scalars(select(UploadPartRow.key).where(UploadPartRow.key.in_(keys))))


def parts_of(session: Session, upload_id: str) -> list[UploadPart]:
    """Return the parts of an upload in their order."""
    query = select(UploadPartRow).where(UploadPartRow.upload_id == upload_id).order_by(UploadPartRow.start)
    return [UploadPart(row.start, row.size_bytes, row.key, row.sha256) for row in session.scalars(query)]


def add_parts(session: Session, upload_id: str, parts: Sequence[UploadPart]) -> None:
    """Let an upload name parts."""
    session.add_all(UploadPartRow(upload_id=upload_id, **asdict(part)) for part in parts)


def drop_parts(session: Session, upload_ids: Sequence[str]) -> list[str]:
    """Let uploads name no parts any more; return the keys that no other upload names.

    The rows of those uploads have to be locked: another one may come to name the same objects at this moment.
    """
    is_theirs = UploadPartRow.upload_id.in_(upload_ids)
    keys = set(session.scalars(select(UploadPartRow.key).where(is_theirs)))
    session.execute(delete(UploadPartRow).where(is_theirs))
    return sorted(keys - set(session.scalars(select(UploadPartRow.key).where(UploadPartRow.key.in_(keys)))))

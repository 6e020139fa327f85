"""Resumable uploads: which bytes have arrived, and in which objects they lie.

Bytes arrive in parts of up to 8 MiB, each an object of its own, whole and on the disk before a transaction names it and
moves the offset. So the offset never runs ahead of the bytes, and what a killed process leaves behind belongs to no
upload: it is an object without a row, which the sweep removes. Nothing is ever truncated or overwritten.

Two requests that write the same bytes at the same time each make parts of their own. The offset moves by an UPDATE that
states where it was, so one of the two is acknowledged, and the other one is refused. There is no lock that could
outlive its process.
"""

import copy
from collections.abc import Sequence
from dataclasses import dataclass, replace
from datetime import datetime, timedelta
from typing import Self

from sqlalchemy import Select, delete, func, select, update
from sqlalchemy.orm import Session

from jobkit.database.clock import shared_now
from jobkit.database.idempotency import Idempotency, forget_made, make_once
from jobkit.database.quotas import admit_bytes
from jobkit.database.session import Database
from jobkit.database.upload_tables import UploadPartRow, UploadRow
from jobkit.errors import (
    TooLargeError,
    TooManyUploadsError,
    UploadFinalError,
    UploadNotFinishedError,
    UploadNotFoundError,
    UploadOffsetError,
)
from jobkit.uploads.parts import UploadPart, add_parts, drop_parts, parts_of
from quadpatch_client.schema import Format, Upload, UploadKind, UploadLinks, UploadProblem, UploadState
from quadpatch_rules.ids import new_upload_id

# How long what was joined is kept.
_JOINED_FOR = timedelta(hours=1)
# Uploads of one transaction.
EXPIRED_AT_ONCE = 50


@dataclass(frozen=True)
class NewUpload:
    """What a client says about an upload that it starts; `joins` are the ids of what a final one joins."""

    kind: UploadKind
    size_bytes: int
    filename: str | None = None
    format: Format | None = None
    sha256: str | None = None
    upload_metadata: str | None = None
    upload_concat: str | None = None
    joins: tuple[str, ...] = ()


class Uploads:
    """All resumable uploads of a database.

    Parameters
    ----------
    database : Database
    hours : float
        How long an upload is kept after its last bytes came.
    most : int
        Open uploads at the same time.
    max_bytes : int
        Of one upload.
    """

    def __init__(self, database: Database, hours: float, most: int, max_bytes: int) -> None:
        self._database = database
        self._kept_for = timedelta(hours=hours)
        self._most = most
        self._max_bytes = max_bytes

    def of(self, database: Database) -> Self:
        """Return the uploads of another view of the database."""
        view = copy.copy(self)
        view._database = database
        return view

    def create(self, new: NewUpload, idempotency: Idempotency | None) -> tuple[Upload, bool]:
        """Start an upload, or show what the same request has started before; return it, and whether it is new.

        Raises
        ------
        TooLargeError
            If it is larger than the limit.
        TooManyUploadsError
            If there are too many.
        StorageQuotaError
            If the tenant would store more than it may.
        UploadNotFoundError, UploadNotFinishedError
            If what it joins is not there, or no partial upload that is whole.
        """

        def make(session: Session) -> tuple[Upload, str]:
            upload = self._make(session, new)
            return upload, upload.id

        def show(session: Session, upload_id: str) -> Upload:
            return _to_upload(_existing(session, upload_id))

        return make_once(self._database, idempotency, make, show)

    def get(self, upload_id: str) -> Upload:
        """Return an upload; raise UploadNotFoundError."""
        with self._database.read() as session:
            return _to_upload(_existing(session, upload_id))

    def parts(self, upload_id: str) -> list[UploadPart]:
        """Return the parts that hold the bytes of an upload, in their order."""
        with self._database.read() as session:
            return parts_of(session, upload_id)

    def acknowledge(
        self, upload_id: str, offset: int, parts: Sequence[UploadPart], replaced: Sequence[UploadPart] = ()
    ) -> Upload:
        """Add parts to an upload, and move its offset to their end.

        Parameters
        ----------
        upload_id : str
        offset : int
            Where it was when the bytes came.
        parts : sequence of UploadPart
            Objects that are stored, in their order.
        replaced : sequence of UploadPart
            Parts whose bytes the first of the new ones begins with.

        Raises
        ------
        UploadNotFoundError
        UploadOffsetError
            If other bytes were acknowledged meanwhile, or the upload has ended.
        """
        end = parts[-1].end
        with self._database.write() as session:
            now = shared_now(session)
            values = {"offset_bytes": end, "updated_at": now, "expires_at": now + self._kept_for}
            row = _existing(session, upload_id)
            if row.kind == UploadKind.PARTIAL and end == row.size_bytes:
                values["state"] = UploadState.COMPLETED.value
            is_as_before = (UploadRow.offset_bytes == offset) & (UploadRow.state == UploadState.OPEN.value)
            result = session.execute(update(UploadRow).where(UploadRow.id == upload_id, is_as_before).values(**values))
            if result.rowcount != 1:  # type: ignore[attr-defined]
                raise offset_error(upload_id, offset)
            starts = [part.start for part in replaced]
            session.execute(
                delete(UploadPartRow).where(UploadPartRow.upload_id == upload_id, UploadPartRow.start.in_(starts))
            )
            add_parts(session, upload_id, parts)
            session.flush()
            session.refresh(row)
            return _to_upload(row)

    def complete(self, upload_id: str, mesh_id: str) -> list[str]:
        """Note which mesh an upload became; return the keys of objects that are not needed any more.

        Partial uploads that a final one has joined are kept for an hour: a client whose line broke joins them again.
        """
        return self._end(upload_id, {"state": UploadState.COMPLETED.value, "mesh_id": mesh_id})

    def fail(self, upload_id: str, problem: UploadProblem) -> list[str]:
        """Give an upload up; return the keys of objects that are not needed any more."""
        return self._end(upload_id, {"state": UploadState.FAILED.value, "problem": problem.model_dump(mode="json")})

    def delete(self, upload_id: str) -> list[str]:
        """Remove an upload; return the keys of objects that are not needed any more. Raises UploadNotFoundError."""
        with self._database.write() as session:
            _existing(session, upload_id, is_locked=True)
            return _remove(session, [upload_id])

    def _make(self, session: Session, new: NewUpload) -> Upload:
        now = shared_now(session)
        holds_bytes = (UploadRow.state == UploadState.OPEN.value) | (UploadRow.kind == UploadKind.PARTIAL.value)
        is_open = holds_bytes & (UploadRow.expires_at > now)
        n_open = session.scalar(select(func.count()).select_from(UploadRow).where(is_open)) or 0
        if n_open >= self._most:
            raise TooManyUploadsError(f"{n_open} uploads are open, which is the limit; come back later")
        parts = _joined_parts(session, new.joins)
        size = sum(part.size_bytes for part in parts) if new.kind is UploadKind.FINAL else new.size_bytes
        if size > self._max_bytes:
            raise TooLargeError(f"the upload has {size} bytes; the limit is {self._max_bytes}")
        row = UploadRow(
            id=new_upload_id(),
            kind=new.kind.value,
            state=UploadState.OPEN.value,
            size_bytes=size,
            offset_bytes=size if new.kind is UploadKind.FINAL else 0,
            upload_metadata=new.upload_metadata,
            upload_concat=new.upload_concat,
            filename=new.filename,
            format=new.format,
            sha256=new.sha256,
            created_at=now,
            updated_at=now,
            expires_at=now + self._kept_for,
        )
        session.add(row)
        session.flush()
        add_parts(session, row.id, parts)
        session.flush()
        admit_bytes(session, size)
        return _to_upload(row)

    def _end(self, upload_id: str, values: dict[str, object]) -> list[str]:
        with self._database.write() as session:
            now = shared_now(session)
            is_open = (UploadRow.id == upload_id) & (UploadRow.state == UploadState.OPEN.value)
            result = session.execute(update(UploadRow).where(is_open).values(**values, updated_at=now))
            if result.rowcount != 1:  # type: ignore[attr-defined]
                return []
            is_joined = (UploadRow.kind == UploadKind.PARTIAL.value) & UploadRow.id.in_(_sharing(upload_id))
            is_joined &= UploadRow.expires_at > now + _JOINED_FOR
            session.execute(update(UploadRow).where(is_joined).values(expires_at=now + _JOINED_FOR))
            return drop_parts(session, [upload_id])


def expire_uploads(database: Database, now: datetime) -> tuple[int, list[str]]:
    """Remove uploads that have expired; return how many, and the keys of objects that are not needed any more.

    At most a batch of them: there are more where as many were removed as `EXPIRED_AT_ONCE`.
    """
    query = select(UploadRow.id).where(UploadRow.expires_at < now).order_by(UploadRow.expires_at).limit(EXPIRED_AT_ONCE)
    with database.write() as session:
        ids = list(session.scalars(query.with_for_update(skip_locked=True)))
        return len(ids), _remove(session, ids)


def offset_error(upload_id: str, offset: int) -> UploadOffsetError:
    """Make the error of bytes that come for another offset than the upload has."""
    return UploadOffsetError(f"upload {upload_id} is not at offset {offset}; ask for its offset by HEAD")


def refuse_final(upload: Upload) -> None:
    """Raise UploadFinalError for an upload that takes no bytes of its own."""
    if upload.kind is UploadKind.FINAL:
        raise UploadFinalError(f"upload {upload.id} joins others and takes no bytes of its own")


def _existing(session: Session, upload_id: str, *, is_locked: bool = False) -> UploadRow:
    query = select(UploadRow).where(UploadRow.id == upload_id, UploadRow.expires_at > shared_now(session))
    row = session.scalars(query.with_for_update() if is_locked else query).one_or_none()
    if row is None:
        raise UploadNotFoundError(f"there is no upload {upload_id}, or no longer")
    return row


def _joined_parts(session: Session, upload_ids: Sequence[str]) -> list[UploadPart]:
    """Return the parts of partial uploads one after the other. Their rows are locked: none is removed meanwhile."""
    # In one order everywhere, so that two transactions can't deadlock.
    for upload_id in sorted(set(upload_ids)):
        row = _existing(session, upload_id, is_locked=True)
        if row.kind != UploadKind.PARTIAL or row.state != UploadState.COMPLETED:
            raise UploadNotFinishedError(f"upload {upload_id} is no partial upload whose bytes have all arrived")
    parts: list[UploadPart] = []
    start = 0
    for upload_id in upload_ids:
        for part in parts_of(session, upload_id):
            parts.append(replace(part, start=start))
            start += part.size_bytes
    return parts


def _sharing(upload_id: str) -> Select[str]:
    """Choose the other uploads that name objects of an upload: those that it joins, and those that join the same."""
    keys = select(UploadPartRow.key).where(UploadPartRow.upload_id == upload_id)
    return select(UploadPartRow.upload_id).where(UploadPartRow.key.in_(keys), UploadPartRow.upload_id != upload_id)


def _remove(session: Session, upload_ids: Sequence[str]) -> list[str]:
    keys = drop_parts(session, upload_ids)
    for upload_id in upload_ids:
        forget_made(session, upload_id)
    session.execute(delete(UploadRow).where(UploadRow.id.in_(upload_ids)))
    return keys


def _to_upload(row: UploadRow) -> Upload:
    names = Upload.model_fields.keys() - {"links"}
    mesh = None if row.mesh_id is None else f"/v1/meshes/{row.mesh_id}"
    links = UploadLinks(self=f"/v1/uploads/{row.id}", mesh=mesh)
    return Upload.model_validate({name: getattr(row, name) for name in names} | {"links": links})

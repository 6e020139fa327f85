"""Uploads: raw or multipart bodies, streamed into the store as they arrive.

Tested in `tests/service/routes/test_meshes.py`.
"""

from collections.abc import AsyncIterator, Mapping
from dataclasses import dataclass, field
from http import HTTPStatus
from urllib.parse import unquote

from fastapi import Request
from python_multipart.multipart import parse_options_header
from starlette.concurrency import run_in_threadpool

from jobkit.database.quotas import check_bytes
from jobkit.errors import TooLargeError
from jobkit.storage.base import ObjectStore, ObjectWriter, StoredObject
from service.digests import CheckedBody, StatedDigests, decoder_of, refuse_coding
from service.multipart import PartData, PartStart, malformed_multipart, read_parts
from service.problems import ProblemError, invalid_request
from service.services import Services

MAX_FIELD_BYTES = 1 << 20
# The frame of a multipart body around its file.
_FRAME_BYTES = 2 << 20
_RAW_TYPES = ("", "application/octet-stream", "application/sla", "application/vnd.ms-pki.stl", "text/plain")


@dataclass(frozen=True)
class UploadRules:
    """What an upload may look like.

    Attributes
    ----------
    file_part : str
        Name of the multipart part that holds the file.
    field_parts : frozenset of str
        Names of further parts that are allowed.
    prefix : str
        Of the key in the store.
    max_bytes : int
        Largest file.
    allows_raw : bool
        Whether the body itself may be the file.
    """

    file_part: str
    field_parts: frozenset[str]
    prefix: str
    max_bytes: int
    allows_raw: bool = True


@dataclass(frozen=True)
class Upload:
    """A file that lies in the store."""

    stored: StoredObject
    filename: str | None
    content_type: str
    fields: Mapping[str, bytes] = field(default_factory=dict)


async def receive_upload(request: Request, services: Services, rules: UploadRules) -> Upload:
    """Stream the request's body into the store.

    Raises
    ------
    TooLargeError
        If the file is larger than the limit; at once where the client has stated its size.
    StoreFullError, StorageQuotaError
        If the disk has no room for it, or the tenant would store more than it may.
    ProblemError
        415 for a body of another type or coding, or a part with a coding, 400 for an empty file, a broken
        multipart body, bytes that are not in their coding or a digest that does not fit, 422 for missing or unknown
        parts.
    """
    decoder = decoder_of(request.headers)
    body = CheckedBody(request, decoder)
    kind, _ = parse_options_header(request.headers.get("content-type", ""))
    is_multipart = kind == b"multipart/form-data"
    stated = request.headers.get("content-length", "")
    most = rules.max_bytes + (_FRAME_BYTES if is_multipart else 0)
    if stated.isdecimal() and int(stated) > most:
        raise TooLargeError(f"the body has {stated} bytes; the limit is {rules.max_bytes}")
    media_type = kind.decode("latin-1")
    is_raw = rules.allows_raw and (media_type in _RAW_TYPES or media_type.startswith("model/"))
    if not (is_multipart or is_raw):
        accepted = "multipart/form-data" + (", application/octet-stream or model/*" if rules.allows_raw else "")
        raise ProblemError(
            HTTPStatus.UNSUPPORTED_MEDIA_TYPE,
            "unsupported_media_type",
            f"the body must be {accepted}; it is {media_type or 'of no stated type'}",
        )
    n_bytes = int(stated) if stated.isdecimal() else 0
    await run_in_threadpool(_check_quota, services, n_bytes)
    receive = _receive_multipart if is_multipart else _receive_raw
    with services.room.kept(n_bytes) as room:
        await run_in_threadpool(room.check)
        return await receive(request, _Arriving(body, room.watch(body.stream())), services.store, rules)


@dataclass(frozen=True)
class _Arriving:
    """A body, and its bytes as they are watched."""

    body: CheckedBody
    chunks: AsyncIterator[bytes]


def _check_quota(services: Services, n_bytes: int) -> None:
    """Refuse a file that the tenant may not store before it is sent in vain; its row decides when all of it is here."""
    with services.database.read() as session:
        check_bytes(session, n_bytes)


def upload_of(request: Request, stored: StoredObject) -> Upload:
    """Return stored bytes with what a request, whose body they are, says of them."""
    _, options = parse_options_header(request.headers.get("content-disposition", ""))
    filename = options.get(b"filename")
    media_type, _ = parse_options_header(request.headers.get("content-type", ""))
    name = None if filename is None else unquote(filename.decode("utf-8", "replace"))
    return Upload(stored, name, media_type.decode("latin-1"))


async def _receive_raw(request: Request, arriving: _Arriving, store: ObjectStore, rules: UploadRules) -> Upload:
    is_empty = True
    with store.writer(rules.prefix, rules.max_bytes) as writer:
        async for chunk in arriving.chunks:
            is_empty = is_empty and not chunk
            await run_in_threadpool(writer.write, chunk)
        if is_empty:
            raise _empty_file()
        arriving.body.check()
        stored = await run_in_threadpool(writer.commit)
    return upload_of(request, stored)


async def _receive_multipart(request: Request, arriving: _Arriving, store: ObjectStore, rules: UploadRules) -> Upload:
    with store.writer(rules.prefix, rules.max_bytes) as writer:
        sorter = _PartSorter(rules, writer)
        async for event in read_parts(request.headers["content-type"], arriving.chunks):
            if isinstance(event, PartStart):
                sorter.start(event)
            elif isinstance(event, PartData):
                await run_in_threadpool(sorter.add, event.data)
            else:
                sorter.end()
        if not sorter.has_file:
            raise _part_error(rules.file_part, "Field required", "missing")
        if sorter.is_empty:
            raise _empty_file()
        arriving.body.check()
        stored = await run_in_threadpool(writer.commit)
    return Upload(stored, sorter.filename, "", {name: bytes(value) for name, value in sorter.fields.items()})


class _PartSorter:
    """Sends the file's bytes to the store and keeps the small fields."""

    def __init__(self, rules: UploadRules, writer: ObjectWriter) -> None:
        self._rules = rules
        self._writer = writer
        self._field: bytearray | None = None
        self._digests = StatedDigests("the part", ())
        self.fields: dict[str, bytearray] = {}
        self.filename: str | None = None
        self.has_file = False
        self.is_empty = True

    def start(self, part: PartStart) -> None:
        """Begin a part; refuse unknown, repeated and coded ones."""
        is_file = part.name == self._rules.file_part
        if not is_file and part.name not in self._rules.field_parts:
            raise _part_error(part.name, "Extra inputs are not permitted", "extra_forbidden")
        if part.name in self.fields or (is_file and self.has_file):
            raise malformed_multipart(f"it has more than one part {part.name!r}")
        refuse_coding(part.headers)
        self._digests = StatedDigests(f"the part {part.name!r}", part.headers.items())
        if is_file:
            self._field, self.has_file, self.filename = None, True, part.filename
        else:
            self._field = self.fields[part.name] = bytearray()

    def add(self, data: bytes | bytearray) -> None:
        """Take bytes of the part that began last."""
        self._digests.update(data)
        if self._field is None:
            self.is_empty = self.is_empty and not data
            self._writer.write(bytes(data))
            return
        self._field += data
        if len(self._field) > MAX_FIELD_BYTES:
            raise TooLargeError(f"a field of the body has more than {MAX_FIELD_BYTES} bytes, which is the limit")

    def end(self) -> None:
        """Hold the part that began last against the digests that its headers state."""
        self._digests.check()


def _empty_file() -> ProblemError:
    return ProblemError(HTTPStatus.BAD_REQUEST, "empty_file", "the file has no bytes")


def _part_error(name: str, message: str, code: str) -> ProblemError:
    return invalid_request([{"loc": ("body", name), "msg": message, "type": code}])

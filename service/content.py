"""Stored bytes over HTTP: ranges (RFC 9110), strong entity tags, digests (RFC 9530), file names.

What lies in the store under one key never changes, so its sha256 is its entity tag. Bytes that are damaged
there are never sent whole: the answer breaks off before its end.
"""

import re
from dataclasses import dataclass
from http import HTTPStatus
from pathlib import PurePath
from urllib.parse import quote

from starlette.requests import Request
from starlette.responses import Response, StreamingResponse

from jobkit.storage.damage import refuse_damaged
from jobkit.storage.digests import digest_field, verified_chunks
from quadpatch_rules.tasks import DONE, FILL, Task
from service.head_requests import is_head
from service.problems import ProblemError
from service.services import Services

_RANGE = re.compile(r"^bytes=(?:(\d{1,18})-(\d{0,18})|-(\d{1,18}))$")
_UNSAFE = re.compile(r"[^A-Za-z0-9._ -]")
OCTETS = "application/octet-stream"


@dataclass(frozen=True)
class Content:
    """A stored object as it is to be sent.

    Attributes
    ----------
    key, sha256 : str
    size_bytes : int
    filename : str
        Proposed to the client that saves it.
    media_type : str
    """

    key: str
    sha256: str
    size_bytes: int
    filename: str
    media_type: str = OCTETS


def content_response(request: Request, services: Services, content: Content) -> Response:
    """Send the object, or the range of it that is asked for, or just that it has not changed.

    Raises
    ------
    ObjectDamagedError
        If the scrub found that its bytes are not those that were stored.
    ObjectNotFoundError
        If the store has lost it.
    ProblemError
        412 if an If-Match header names other bytes, 416 if the range lies behind the end.
    """
    headers = {
        "ETag": f'"{content.sha256}"',
        "Repr-Digest": digest_field(content.sha256),
        "Accept-Ranges": "bytes",
        "Cache-Control": "private, max-age=31536000, immutable",
        "Content-Disposition": content_disposition(content.filename),
    }
    _check_if_match(request, headers["ETag"])
    if etag_matches(request.headers.get("if-none-match"), headers["ETag"]):
        return Response(status_code=HTTPStatus.NOT_MODIFIED, headers=headers)
    refuse_damaged(services.database, content.key)
    span = _requested_range(request, content)
    status, start, length = HTTPStatus.OK, 0, content.size_bytes
    if span is not None:
        status, (start, length) = HTTPStatus.PARTIAL_CONTENT, span
        headers["Content-Range"] = f"bytes {start}-{start + length - 1}/{content.size_bytes}"
    headers["Content-Length"] = str(length)
    if is_head(request.scope):
        services.store.size(content.key)  # raises where the store has lost the object
        return Response(None, status, headers, content.media_type)
    chunks = services.store.read(content.key, start, length)
    if span is None:
        chunks = verified_chunks(chunks, content.sha256)
    return StreamingResponse(chunks, status, headers, content.media_type)


def etag_matches(header: str | None, etag: str) -> bool:
    """Return whether an If-None-Match header names the tag; compared weakly, as RFC 9110 asks."""
    if header is None:
        return False
    tags = [tag.strip().removeprefix("W/") for tag in header.split(",")]
    return header.strip() == "*" or etag.removeprefix("W/") in tags


def precondition_failed(detail: str) -> ProblemError:
    """Return the answer to an If-Match header that does not hold."""
    return ProblemError(HTTPStatus.PRECONDITION_FAILED, "precondition_failed", detail)


def _check_if_match(request: Request, etag: str) -> None:
    """Compare strongly, as RFC 9110 asks: a weak tag never matches."""
    header = request.headers.get("if-match")
    if header is not None and header.strip() != "*" and etag not in [tag.strip() for tag in header.split(",")]:
        raise precondition_failed(f"the entity tag of the bytes is {etag}, which If-Match does not name")


def content_disposition(filename: str) -> str:
    """Return the header that proposes a name: plain for old readers, and whole in UTF-8 where it is not ASCII."""
    plain = _UNSAFE.sub("_", filename)
    header = f'attachment; filename="{plain}"'
    return header if plain == filename else f"{header}; filename*=UTF-8''{quote(filename, safe='')}"


def result_name(filename: str | None, mesh_id: str, suffix: str, task: Task = FILL) -> str:
    """Return the name of a result: that of the upload, marked by what was done to it."""
    stem = PurePath(filename or "").stem or f"mesh-{mesh_id[:12]}"
    return f"{stem}-{DONE[task]}{suffix}"


def _requested_range(request: Request, content: Content) -> tuple[int, int] | None:
    header = request.headers.get("range")
    condition = request.headers.get("if-range")
    if header is None or (condition is not None and condition != f'"{content.sha256}"'):
        return None
    match = _RANGE.match(header.strip())
    if match is None:
        return None  # several ranges, or another unit: RFC 9110 lets a server send the whole instead
    first, last, tail = match.groups()
    if tail is not None:
        start, end = max(content.size_bytes - int(tail), 0), content.size_bytes - 1
        is_possible = int(tail) > 0 and content.size_bytes > 0
    else:
        start, end = int(first), min(int(last) if last else content.size_bytes - 1, content.size_bytes - 1)
        if last and int(last) < start:
            return None  # not a range at all, and so to be ignored
        is_possible = start < content.size_bytes
    if not is_possible:
        raise ProblemError(
            HTTPStatus.REQUESTED_RANGE_NOT_SATISFIABLE,
            "range_not_satisfiable",
            f"{header} lies outside of the {content.size_bytes} bytes",
            {"Content-Range": f"bytes */{content.size_bytes}"},
        )
    return start, end - start + 1

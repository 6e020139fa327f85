"""The protocol tus 1.0: its headers, and what holds for all of its requests (https://tus.io/protocols/resumable-upload).

Tested in `tests/service/test_tus.py`.
"""

import base64
import binascii
import hashlib
import re
from collections.abc import Mapping
from dataclasses import dataclass
from http import HTTPStatus
from typing import get_args
from urllib.parse import urlsplit

from starlette.datastructures import MutableHeaders
from starlette.requests import Request
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from quadpatch_client.schema import Format
from quadpatch_rules.ids import SHA256_PATTERN, UPLOAD_ID_PATTERN
from service.formats import clean_filename, stated_format
from service.problems import ProblemError, TusStatus, invalid_request, problem_response

VERSION = "1.0.0"
EXTENSIONS = "creation,creation-with-upload,checksum,termination,expiration,concatenation"
CHECKSUMS = ("sha256", "sha1")
CONTENT_TYPE = "application/offset+octet-stream"
MAX_METADATA = 4096
# Partial uploads that one final upload joins; each is named by a path of 40 characters.
MAX_JOINED = 256
_PATH = "/v1/uploads"
_OVERRIDES = ("PATCH", "DELETE")
# Besides the POST that starts an upload. The upload as JSON, by GET, is no part of the protocol.
_VERSIONED = ("PATCH", "DELETE", "HEAD")
_CHECKSUM = re.compile(r"([a-z0-9-]+) ([A-Za-z0-9+/]+={0,2})")


class TusMiddleware:
    """Names the version of the protocol in every answer, and refuses other ones.

    A request with `X-HTTP-Method-Override` is treated as one of that method.
    """

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on, or answer it with 412."""
        if scope["type"] != "http" or not (scope["path"] + "/").startswith(_PATH + "/"):
            await self._app(scope, receive, send)
            return
        request = Request(scope)
        override = request.headers.get("x-http-method-override", "").upper()
        if request.method == "POST" and override in _OVERRIDES:
            scope["method"] = override

        async def send_with_version(message: Message) -> None:
            if message["type"] == "http.response.start":
                MutableHeaders(scope=message)["Tus-Resumable"] = VERSION
            await send(message)

        is_known = (scope["method"], scope["path"]) == ("POST", _PATH) or scope["method"] in _VERSIONED
        if not is_known or request.headers.get("tus-resumable") == VERSION:
            await self._app(scope, receive, send_with_version)
            return
        detail = f"send Tus-Resumable: {VERSION}, the version of the protocol that is spoken here"
        error = ProblemError(
            HTTPStatus.PRECONDITION_FAILED, "unsupported_tus_version", detail, {"Tus-Version": VERSION}
        )
        await problem_response(Request(scope), error)(scope, receive, send_with_version)


@dataclass(frozen=True)
class Metadata:
    """What `Upload-Metadata` says of a file."""

    filename: str | None
    format: Format | None
    sha256: str | None


def read_metadata(field: str | None) -> Metadata:
    """Read `Upload-Metadata`: `filename`, `format` (else from `filetype`, or the name), `sha256`; others are ignored.

    Raises
    ------
    ProblemError
        422 if it is not as the protocol writes it, or a value is none of those that there are.
    """
    values = dict(_pairs(field or ""))
    name = clean_filename(values.get("filename") or values.get("name"))
    given = next((known for known in get_args(Format) if known == values.get("format")), None)
    if "format" in values and given is None:
        raise _header_error("Upload-Metadata", f"format must be one of {', '.join(get_args(Format))}")
    sha256 = values.get("sha256", "").lower() or None
    if sha256 is not None and not re.match(SHA256_PATTERN, sha256):
        raise _header_error("Upload-Metadata", "sha256 must be 64 hexadecimal digits")
    return Metadata(name, stated_format(given, name, values.get("filetype", "")), sha256)


def read_joined(field: str) -> tuple[str, ...]:
    """Return the ids of the uploads that `final;/v1/uploads/… /v1/uploads/…` joins.

    Raises
    ------
    ProblemError
        422 if it names something else, nothing, or too much.
    """
    ids = []
    for url in field.removeprefix("final;").split():
        folder, _, upload_id = urlsplit(url).path.rpartition("/")
        if folder != _PATH or not re.match(UPLOAD_ID_PATTERN, upload_id):
            raise _header_error("Upload-Concat", "it must be `partial`, or `final;` and the paths of partial uploads")
        ids.append(upload_id)
    if not 0 < len(ids) <= MAX_JOINED:
        raise _header_error("Upload-Concat", f"it must name 1 to {MAX_JOINED} partial uploads")
    return tuple(ids)


class Checksum:
    """A check of the bytes of one request against its `Upload-Checksum`.

    Parameters
    ----------
    field : str
        The header.

    Raises
    ------
    ProblemError
        400 if it can't be read, or names another algorithm than there are.
    """

    def __init__(self, field: str) -> None:
        match = _CHECKSUM.fullmatch(field)
        if match is None or match[1] not in CHECKSUMS:
            raise ProblemError(
                HTTPStatus.BAD_REQUEST,
                "unsupported_checksum",
                f"Upload-Checksum must be one of {', '.join(CHECKSUMS)}, a space, and the digest in base64",
                {"Tus-Checksum-Algorithm": ",".join(CHECKSUMS)},
            )
        self._running = hashlib.new(match[1], usedforsecurity=False)
        self._expected = _decoded(match[2])

    def update(self, data: bytes) -> None:
        """Add bytes that arrived."""
        self._running.update(data)

    def check(self) -> None:
        """Raise ProblemError, 460, where other bytes arrived."""
        if self._running.digest() != self._expected:
            raise ProblemError(
                TusStatus.CHECKSUM_MISMATCH,
                "checksum_mismatch",
                "the bytes that arrived have another checksum than Upload-Checksum states; send them again",
            )


def _pairs(field: str) -> Mapping[str, str]:
    pairs: dict[str, str] = {}
    for pair in field.split(",") if field.strip() else []:
        key, _, value = pair.strip().partition(" ")
        decoded = _decoded(value)
        if not key or key in pairs or decoded is None:
            raise _header_error("Upload-Metadata", "it must be pairs of a key and a value in base64, each key once")
        pairs[key] = decoded.decode("utf-8", "replace")
    return pairs


def _decoded(text: str) -> bytes | None:
    try:
        return base64.b64decode(text, validate=True)
    except (ValueError, binascii.Error):
        return None


def _header_error(name: str, message: str) -> ProblemError:
    return invalid_request([{"loc": ("header", name), "msg": message, "type": "value_error"}])

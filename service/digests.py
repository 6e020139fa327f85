"""What a client says about the bytes of a body or of a part of it: coding and digests (RFC 9110, RFC 9530).

Tested in `tests/attacks/test_e_stored.py`.
"""

import base64
import binascii
import hashlib
import re
from collections.abc import AsyncIterator, Iterable, Mapping
from http import HTTPStatus

from fastapi import Request

from service.problems import ProblemError

DIGEST_HEADERS = ("content-digest", "repr-digest")
# Those that RFC 9530 calls active; others are ignored, as it requires.
_ALGORITHMS = {"sha-256": "sha256", "sha-512": "sha512"}
# Transfer encodings of mail that leave bytes as they are.
_PLAIN = ("", "7bit", "8bit", "binary")
_MEMBER = re.compile(r"([a-z*][a-z0-9_.*-]*)=:([A-Za-z0-9+/=]*):")


def refuse_coding(headers: Mapping[str, str]) -> None:
    """Refuse a body, or a part of one, that is compressed or coded: it would be stored, hashed and read as it is.

    Parameters
    ----------
    headers : mapping
        Of the request, or of the part; looked up by names in lower case.

    Raises
    ------
    ProblemError
        415 with the one coding that is taken.
    """
    coding = headers.get("content-encoding", "").strip().lower()
    transfer = headers.get("content-transfer-encoding", "").strip().lower()
    if coding not in ("", "identity") or transfer not in _PLAIN:
        raise ProblemError(
            HTTPStatus.UNSUPPORTED_MEDIA_TYPE,
            "unsupported_encoding",
            "bytes under a Content-Encoding or Content-Transfer-Encoding are not taken; send the file as it is",
            {"Accept-Encoding": "identity"},
        )


class StatedDigests:
    """A check of arriving bytes against the digests that headers state.

    Without a coding the content is the representation, so both headers speak of the same bytes.

    Parameters
    ----------
    subject : str
        What the headers speak of, for messages.
    headers : sequence of (str, str)
        Names in lower case; other headers than `DIGEST_HEADERS` are ignored.

    Raises
    ------
    ProblemError
        400 if a header can't be read.
    """

    def __init__(self, subject: str, headers: Iterable[tuple[str, str]]) -> None:
        self._subject = subject
        digest_headers = [(name, value) for name, value in headers if name in DIGEST_HEADERS]
        self._stated = [(name, *stated) for name, value in digest_headers for stated in _read_digests(name, value)]
        self._hashes = {algorithm: hashlib.new(_ALGORITHMS[algorithm]) for _, algorithm, _ in self._stated}

    def update(self, data: bytes | bytearray) -> None:
        """Add bytes that arrived."""
        for running in self._hashes.values():
            running.update(data)

    def check(self) -> None:
        """Compare what arrived with what was stated; raise ProblemError, 400, where they differ."""
        for name, algorithm, value in self._stated:
            if self._hashes[algorithm].digest() != value:
                raise ProblemError(
                    HTTPStatus.BAD_REQUEST,
                    "digest_mismatch",
                    f"{self._subject} that arrived has another {algorithm} than its {name.title()} states; "
                    "send it again",
                )


class CheckedBody:
    """The body of a request, checked against the digests that its headers state.

    Parameters
    ----------
    request : Request

    Raises
    ------
    ProblemError
        400 if a header can't be read.
    """

    def __init__(self, request: Request) -> None:
        self._request = request
        self._digests = StatedDigests("the body", request.headers.items())

    async def stream(self) -> AsyncIterator[bytes]:
        """Yield the body as it arrives."""
        async for chunk in self._request.stream():
            self._digests.update(chunk)
            yield chunk

    def check(self) -> None:
        """Compare what arrived with what was stated; raise ProblemError, 400, where they differ."""
        self._digests.check()


def _read_digests(name: str, field: str) -> list[tuple[str, bytes]]:
    digests = []
    for member in field.split(","):
        if not member.strip():
            continue
        match = _MEMBER.fullmatch(member.strip())
        try:
            if match is None:
                raise ValueError
            value = base64.b64decode(match[2], validate=True)
        except (ValueError, binascii.Error) as error:
            raise ProblemError(
                HTTPStatus.BAD_REQUEST, "malformed_digest", f"{name.title()} is not as RFC 9530 writes it"
            ) from error
        if match[1] in _ALGORITHMS:
            digests.append((match[1], value))
    return digests

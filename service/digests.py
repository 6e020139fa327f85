"""What a client says about the bytes of a body or of a part of it: coding and digests (RFC 9110, RFC 9530).

`Content-Digest` and `Repr-Digest` speak of the bytes as they are sent, under their coding if they have one;
`Unencoded-Digest` (draft-ietf-httpbis-unencoded-digest) speaks of those that come out of it.

Tested in `tests/attacks/test_e_stored.py`.
"""

import base64
import binascii
import hashlib
import re
from collections.abc import AsyncIterator, Iterable, Mapping
from http import HTTPStatus

from fastapi import Request
from starlette.concurrency import run_in_threadpool
from starlette.datastructures import Headers

from service.content_coding import DECODERS, Decoder
from service.problems import ProblemError

DIGEST_HEADERS = ("content-digest", "repr-digest")
_UNENCODED = ("unencoded-digest",)
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
    if headers.get("content-encoding", "").strip().lower() not in ("", "identity"):
        raise unsupported_coding("identity")
    _refuse_transfer_coding(headers)


class StatedDigests:
    """A check of arriving bytes against the digests that headers state.

    Parameters
    ----------
    subject : str
        What the headers speak of, for messages.
    headers : sequence of (str, str)
        Names in lower case; others than `names` are ignored.
    names : tuple of str
        The headers that speak of these bytes.

    Raises
    ------
    ProblemError
        400 if a header can't be read.
    """

    def __init__(
        self, subject: str, headers: Iterable[tuple[str, str]], names: tuple[str, ...] = DIGEST_HEADERS + _UNENCODED
    ) -> None:
        self._subject = subject
        digest_headers = [(name, value) for name, value in headers if name in names]
        self._stated = [(name, *stated) for name, value in digest_headers for stated in _read_digests(name, value)]
        self._hashes = {algorithm: hashlib.new(_ALGORITHMS[algorithm]) for _, algorithm, _ in self._stated}

    def update(self, data: bytes | bytearray) -> None:
        """Add bytes that arrived."""
        for running in self._hashes.values():
            running.update(data)

    @property
    def are_stated(self) -> bool:
        """Whether there is anything to compare with."""
        return bool(self._stated)

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
    """The body of a request, out of its coding, checked against the digests that its headers state.

    Parameters
    ----------
    request : Request
    decoder : Decoder, optional
        Of its coding; None: it has none.

    Raises
    ------
    ProblemError
        400 if a header can't be read.
    """

    def __init__(self, request: Request, decoder: Decoder | None = None) -> None:
        self._request = request
        self._decoder = decoder
        self._sent = StatedDigests("the body", request.headers.items(), DIGEST_HEADERS)
        self._decoded = StatedDigests("the body, decoded,", request.headers.items(), _UNENCODED)

    async def stream(self) -> AsyncIterator[bytes]:
        """Yield the body as it arrives; raise ProblemError, 400, where it is not in its coding."""
        async for chunk in self._request.stream():
            self._sent.update(chunk)
            if self._decoder is None:
                self._decoded.update(chunk)
                yield chunk
                continue
            self._decoder.feed(chunk)
            while piece := await run_in_threadpool(self._decoder.read):
                self._decoded.update(piece)
                yield piece
        if self._decoder is not None:
            self._decoder.finish()

    def check(self) -> None:
        """Compare what arrived with what was stated; raise ProblemError, 400, where they differ."""
        self._sent.check()
        self._decoded.check()


def decoder_of(headers: Mapping[str, str]) -> Decoder | None:
    """Return what undoes the coding of a body, None where it has none; raise ProblemError, 415, for other codings."""
    _refuse_transfer_coding(headers)
    coding = headers.get("content-encoding", "").strip().lower()
    if coding in ("", "identity"):
        return None
    if coding not in DECODERS:
        raise unsupported_coding(", ".join([*DECODERS, "identity"]))
    return DECODERS[coding]()


def announced_sha256(headers: Headers) -> str | None:
    """Return the sha256 in hex that headers state of a body that is a file; None where they don't."""
    if headers.get("content-type", "").lower().startswith("multipart/"):
        return None
    has_coding = headers.get("content-encoding", "").strip().lower() not in ("", "identity")
    names = _UNENCODED if has_coding else ("repr-digest", *_UNENCODED)
    digests = [stated for name in names for stated in _read_digests(name, headers.get(name, ""))]
    return next((value.hex() for algorithm, value in digests if algorithm == "sha-256"), None)


def unsupported_coding(accepted: str) -> ProblemError:
    """Make the answer to bytes under another coding than those that are taken."""
    return ProblemError(
        HTTPStatus.UNSUPPORTED_MEDIA_TYPE,
        "unsupported_encoding",
        f"bytes under that Content-Encoding or Content-Transfer-Encoding are not taken here; possible: {accepted}",
        {"Accept-Encoding": accepted},
    )


def _refuse_transfer_coding(headers: Mapping[str, str]) -> None:
    if headers.get("content-transfer-encoding", "").strip().lower() not in _PLAIN:
        raise unsupported_coding("identity")


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

"""What a client says about the bytes of its body: their coding, and their digests (RFC 9110, RFC 9530)."""

import base64
import binascii
import hashlib
import re
from collections.abc import AsyncIterator
from http import HTTPStatus

from fastapi import Request

from service.problems import ProblemError

DIGEST_HEADERS = ("content-digest", "repr-digest")
# Those that RFC 9530 calls active; others are passed over, as it asks.
_ALGORITHMS = {"sha-256": "sha256", "sha-512": "sha512"}
_MEMBER = re.compile(r"([a-z*][a-z0-9_.*-]*)=:([A-Za-z0-9+/=]*):")


def refuse_coding(request: Request) -> None:
    """Refuse a body that is compressed: it would be stored, hashed and read as what it is not.

    Raises
    ------
    ProblemError
        415 with the one coding that is taken.
    """
    coding = request.headers.get("content-encoding", "").strip().lower()
    if coding not in ("", "identity"):
        raise ProblemError(
            HTTPStatus.UNSUPPORTED_MEDIA_TYPE,
            "unsupported_encoding",
            "a body with a Content-Encoding is not taken; send the file as it is",
            {"Accept-Encoding": "identity"},
        )


class CheckedBody:
    """The body of a request, held against the digests that its headers state.

    Without a coding the body is the representation, so both headers speak of the same bytes.

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
        self._stated = [
            (name, algorithm, value) for name in DIGEST_HEADERS for algorithm, value in _stated_digests(request, name)
        ]
        self._hashes = {algorithm: hashlib.new(_ALGORITHMS[algorithm]) for _, algorithm, _ in self._stated}

    async def stream(self) -> AsyncIterator[bytes]:
        """Yield the body as it arrives."""
        async for chunk in self._request.stream():
            for running in self._hashes.values():
                running.update(chunk)
            yield chunk

    def check(self) -> None:
        """Hold what arrived against what was stated; raise ProblemError, 400, where they differ."""
        for name, algorithm, value in self._stated:
            if self._hashes[algorithm].digest() != value:
                raise ProblemError(
                    HTTPStatus.BAD_REQUEST,
                    "digest_mismatch",
                    f"the body that arrived has another {algorithm} than its {name.title()} states; send it again",
                )


def _stated_digests(request: Request, name: str) -> list[tuple[str, bytes]]:
    found = []
    for member in ",".join(request.headers.getlist(name)).split(","):
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
            found.append((match[1], value))
    return found

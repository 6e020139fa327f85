"""Codings of bodies that are undone as they arrive, a piece at a time: gzip (RFC 1952) and zstd (RFC 8878).

The reader bounds what comes out: no piece is larger than `PIECE_BYTES`, however much a chunk expands to.

Tested in `tests/service/test_content_coding.py`.
"""

import zlib
from collections.abc import Callable, Mapping
from http import HTTPStatus
from typing import Protocol

from backports import zstd

from service.problems import ProblemError

PIECE_BYTES = 1 << 20
# As large as RFC 9659 lets windows be for HTTP: 8 MiB.
_WINDOW_LOG = 23
_GZIP = 16 + zlib.MAX_WBITS


class Decoder(Protocol):
    """Undoes a coding; gets the bytes chunk by chunk."""

    def feed(self, data: bytes) -> None:
        """Take the next chunk; to be called when `read` has returned nothing."""
        ...

    def read(self) -> bytes:
        """Return the next piece of what comes out; nothing: the next chunk is needed. Raises ProblemError, 400."""
        ...

    def finish(self) -> None:
        """Raise ProblemError, 400, where the bytes end too early."""
        ...


class GzipDecoder:
    """Undoes gzip; one member may follow another."""

    def __init__(self) -> None:
        self._inner = zlib.decompressobj(_GZIP)
        self._pending = b""
        self._has_begun = False

    def feed(self, data: bytes) -> None:
        """Take the next chunk."""
        self._pending += data

    def read(self) -> bytes:
        """Return the next piece."""
        while self._pending:
            if self._inner.eof:
                self._inner = zlib.decompressobj(_GZIP)
            self._has_begun = True
            try:
                piece = self._inner.decompress(self._pending, PIECE_BYTES)
            except zlib.error as error:
                raise _malformed("gzip") from error
            self._pending = self._inner.unused_data if self._inner.eof else self._inner.unconsumed_tail
            if piece:
                return piece
        return b""

    def finish(self) -> None:
        """Check that the last member is whole."""
        if self._has_begun and not self._inner.eof:
            raise _malformed("gzip")


class ZstdDecoder:
    """Undoes zstd; one frame may follow another."""

    def __init__(self) -> None:
        self._inner = _new_zstd()
        self._pending = b""

    def feed(self, data: bytes) -> None:
        """Take the next chunk."""
        self._pending = data

    def read(self) -> bytes:
        """Return the next piece."""
        while self._pending or not (self._inner.needs_input or self._inner.eof):
            if self._inner.eof:
                self._inner = _new_zstd()
            try:
                piece = self._inner.decompress(self._pending, PIECE_BYTES)
            except zstd.ZstdError as error:
                raise _malformed("zstd") from error
            self._pending = self._inner.unused_data if self._inner.eof else b""
            if piece:
                return piece
        return b""

    def finish(self) -> None:
        """Check that the last frame is whole."""
        if not self._inner.eof:
            raise _malformed("zstd")


DECODERS: Mapping[str, Callable[[], Decoder]] = {"gzip": GzipDecoder, "zstd": ZstdDecoder}


def _new_zstd() -> zstd.ZstdDecompressor:
    return zstd.ZstdDecompressor(options={zstd.DecompressionParameter.window_log_max: _WINDOW_LOG})


def _malformed(coding: str) -> ProblemError:
    return ProblemError(HTTPStatus.BAD_REQUEST, "malformed_encoding", f"the body is no {coding}, or ends early")

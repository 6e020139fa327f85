"""Multipart bodies as a stream of parts, a chunk at a time: nothing is kept here but headers."""

from collections.abc import AsyncIterator, Mapping
from dataclasses import dataclass, field
from http import HTTPStatus
from typing import TYPE_CHECKING

from python_multipart.exceptions import FormParserError
from python_multipart.multipart import MultipartParser, parse_options_header

from service.problems import ProblemError

if TYPE_CHECKING:
    from python_multipart.multipart import MultipartCallbacks

MAX_PARTS = 8
# Before the first part and after the last one; a chunk that holds the border is not counted byte by byte.
MAX_OUTSIDE_BYTES = 256 << 10
_SLICE_BYTES = 64 << 10


@dataclass(frozen=True)
class PartStart:
    """A part begins; `filename` is None for a plain field, `headers` go by names in lower case."""

    name: str
    filename: str | None
    headers: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class PartData:
    """Bytes of the part that began last."""

    data: bytearray


@dataclass(frozen=True)
class PartEnd:
    """The part is whole: its digests can be checked."""


PartEvent = PartStart | PartData | PartEnd


async def read_parts(content_type: str, chunks: AsyncIterator[bytes]) -> AsyncIterator[PartEvent]:
    """Yield what a multipart body is made of, as it arrives.

    Raises
    ------
    ProblemError
        400 if the body is no multipart body, ends early, or has too many parts.
    """
    _, options = parse_options_header(content_type)
    boundary = options.get(b"boundary")
    if not boundary:
        raise malformed_multipart("the content type names no boundary")
    events: list[PartEvent] = []
    collector = _Collector(events)
    try:
        parser = MultipartParser(boundary, collector.callbacks())
        async for chunk in _slices(chunks):
            if collector.is_whole:
                collector.count_outside(len(chunk))
                continue
            parser.write(chunk)
            if not collector.has_begun:
                collector.count_outside(len(chunk))
            for event in events:
                yield event
            events.clear()
        parser.finalize()
    except FormParserError as error:
        raise malformed_multipart("it does not follow the format, or ends early") from error
    if not collector.is_whole:
        raise malformed_multipart("it ends early")


async def _slices(chunks: AsyncIterator[bytes]) -> AsyncIterator[bytes]:
    """Cut chunks into slices, as small as what is counted outside of parts needs."""
    async for chunk in chunks:
        for start in range(0, len(chunk), _SLICE_BYTES):
            yield chunk[start : start + _SLICE_BYTES]


def malformed_multipart(reason: str) -> ProblemError:
    """Return the answer to a multipart body that is none."""
    return ProblemError(HTTPStatus.BAD_REQUEST, "malformed_multipart", f"the multipart body is not valid: {reason}")


class _Collector:
    """Turns the parser's callbacks into events."""

    def __init__(self, events: list[PartEvent]) -> None:
        self._events = events
        self._field, self._value = b"", b""
        self._headers: dict[bytes, bytes] = {}
        self._n_parts = 0
        self._n_outside = 0
        self.is_whole = False

    @property
    def has_begun(self) -> bool:
        """Whether a part has begun."""
        return self._n_parts > 0

    def count_outside(self, n_bytes: int) -> None:
        """Count bytes outside of all parts, which mean nothing, up to a limit."""
        self._n_outside += n_bytes
        if self._n_outside > MAX_OUTSIDE_BYTES:
            raise malformed_multipart(f"more than {MAX_OUTSIDE_BYTES} bytes lie outside of its parts")

    def callbacks(self) -> "MultipartCallbacks":
        """Return what the parser calls."""
        return {
            "on_part_begin": self._on_part_begin,
            "on_header_field": self._on_header_field,
            "on_header_value": self._on_header_value,
            "on_header_end": self._on_header_end,
            "on_headers_finished": self._on_headers_finished,
            "on_part_data": self._on_part_data,
            "on_part_end": self._on_part_end,
            "on_end": self._on_end,
        }

    def _on_part_begin(self) -> None:
        self._headers = {}
        self._n_parts += 1
        if self._n_parts > MAX_PARTS:
            raise malformed_multipart(f"it has more than {MAX_PARTS} parts")

    def _on_header_field(self, data: bytes, start: int, end: int) -> None:
        self._field += data[start:end]

    def _on_header_value(self, data: bytes, start: int, end: int) -> None:
        self._value += data[start:end]

    def _on_header_end(self) -> None:
        # A header that comes twice is a list, as everywhere in HTTP.
        name = self._field.lower()
        self._headers[name] = b", ".join([*filter(None, [self._headers.get(name)]), self._value])
        self._field, self._value = b"", b""

    def _on_headers_finished(self) -> None:
        _, options = parse_options_header(self._headers.get(b"content-disposition", b""))
        name, filename = options.get(b"name"), options.get(b"filename")
        if name is None:
            raise malformed_multipart("a part has no name")
        decoded = None if filename is None else filename.decode("utf-8", "replace")
        headers = {field.decode("latin-1"): value.decode("latin-1") for field, value in self._headers.items()}
        self._events.append(PartStart(name.decode("utf-8", "replace"), decoded, headers))

    def _on_part_data(self, data: bytes, start: int, end: int) -> None:
        last = self._events[-1] if self._events else None
        if isinstance(last, PartData):  # the parser hands over each line that might have been a boundary
            last.data.extend(data[start:end])
        else:
            self._events.append(PartData(bytearray(data[start:end])))

    def _on_part_end(self) -> None:
        self._events.append(PartEnd())

    def _on_end(self) -> None:
        self.is_whole = True

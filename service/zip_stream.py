"""A ZIP file that is sent while it is written: no file of it, and nothing of the whole, is held in memory.

Entries are deflated at level 0, which stores their bytes: readers that don't seek find the end of a deflated entry, and
not that of a stored one whose size comes after it. Large files and archives are ZIP64.

Tested in `tests/service/test_zip_stream.py`.
"""

import zipfile
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

# Above it an entry says its size in 64 bits, with room for what level 0 adds.
_LARGE_BYTES = 1 << 30


@dataclass(frozen=True)
class Entry:
    """A file of the archive; `size_bytes` may be larger than the chunks together, not smaller."""

    name: str
    size_bytes: int
    chunks: Iterable[bytes]


class _Sink:
    """Takes what is written until it is taken; it can't seek or tell."""

    def __init__(self) -> None:
        self._pending: list[bytes] = []

    def write(self, data: bytes) -> int:
        self._pending.append(bytes(data))
        return len(data)

    def flush(self) -> None:
        """Do nothing: what is written is there."""

    def close(self) -> None:
        """Do nothing: what is written stays."""

    def take(self) -> Iterator[bytes]:
        yield from self._pending
        self._pending.clear()


def zip_stream(entries: Iterable[Entry]) -> Iterator[bytes]:
    """Yield the bytes of an archive.

    Raises
    ------
    Exception
        What the chunks of an entry raise; the archive then lacks its directory, and no reader takes it for whole.
    """
    sink = _Sink()
    with zipfile.ZipFile(sink, "w", zipfile.ZIP_DEFLATED, compresslevel=0) as archive:
        for entry in entries:
            with archive.open(entry.name, "w", force_zip64=entry.size_bytes > _LARGE_BYTES) as file:
                for chunk in entry.chunks:
                    file.write(chunk)
                    yield from sink.take()
            yield from sink.take()
    yield from sink.take()

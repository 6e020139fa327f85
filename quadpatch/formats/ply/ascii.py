"""Bodies of ascii PLY files.

Rows are found by counting words, so a row may stand on several lines. Values are cast to the type that the header
declares, as every other reader does; a value that its type can't hold is an error, not a surprise.

Tested in `tests/quadpatch/formats/ply/test_reader.py`.
"""

import numpy as np

from quadpatch.errors import ReadError
from quadpatch.formats.ply.header import Element, Header, value_range
from quadpatch.formats.ply.rows import ListColumn, Rows, Values, check_room
from quadpatch.formats.polygons import list_range
from quadpatch.formats.text import parse_numbers
from quadpatch.types import FloatArray, IntArray


def read_ascii_body(data: bytes, header: Header) -> tuple[Rows, ...]:
    """Read all elements behind a header.

    Parameters
    ----------
    data : bytes
        The whole file.
    header : Header
        Of an ascii file.

    Raises
    ------
    ReadError
        If a word is no number, or the words run out.
    """
    words = parse_numbers(data[header.size :])
    rows: list[Rows] = []
    at = 0
    for element in header.elements:
        check_room(element, len(element.properties), len(words) - at, "words")
        read = _read_uniform(words, at, element) or _read_mixed(words, at, element)
        rows.append(read)
        at = read.stop
    return tuple(rows)


def _read_uniform(words: FloatArray, at: int, element: Element) -> Rows | None:
    """Rows that are all as long as the first one, None if they are not."""
    places = _first_places(words, at, element)
    if places is None:
        return None
    starts, lengths, width = places
    stop = at + width * element.count
    if stop > len(words):
        return None
    table = words[at:stop].reshape(element.count, width)
    if any((table[:, starts[index]] != length).any() for index, length in lengths.items()):
        return None
    columns: list[Values | ListColumn] = []
    for index, prop in enumerate(element.properties):
        if index in lengths:
            first = starts[index] + 1
            values = table[:, first : first + lengths[index]].reshape(-1)
            counts = np.full(element.count, lengths[index], dtype=np.int64)
            columns.append(ListColumn(counts, _cast(values, prop.code, element)))
        else:
            columns.append(_cast(table[:, starts[index]], prop.code, element))
    return Rows(element, at, stop, None, tuple(columns))


def _first_places(words: FloatArray, at: int, element: Element) -> tuple[list[int], dict[int, int], int] | None:
    """Word of each property within the first row, the lengths of its lists, and its width."""
    starts: list[int] = []
    lengths: dict[int, int] = {}
    width = 0
    for index, prop in enumerate(element.properties):
        starts.append(width)
        if prop.count_code is not None:
            length = words[at + width] if at + width < len(words) else 0.0
            if element.count and not (0 <= length <= len(words) and length == int(length)):
                return None
            lengths[index] = int(length) if element.count else 0
            width += lengths[index]
        width += 1
    return starts, lengths, width


def _read_mixed(words: FloatArray, at: int, element: Element) -> Rows:
    """Rows with lists of different lengths, found by walking from one to the next."""
    place, ends = _walk(words, at, element)
    columns: list[Values | ListColumn] = []
    for index, prop in enumerate(element.properties):
        if prop.count_code is None:
            columns.append(_cast(words[place[:, index]], prop.code, element))
        else:
            counts = words[place[:, index]].astype(np.int64)
            values = words[list_range(place[:, index] + 1, counts)]
            columns.append(ListColumn(counts, _cast(values, prop.code, element)))
    return Rows(element, at, int(ends[-1]), ends, tuple(columns))


def _walk(words: FloatArray, at: int, element: Element) -> tuple[IntArray, IntArray]:
    is_list = [prop.count_code is not None for prop in element.properties]
    places: list[int] = []
    ends: list[int] = []
    where = f"PLY element {element.name[:40]!r}"
    for row in range(element.count):
        for listed in is_list:
            places.append(at)
            if at >= len(words):
                raise ReadError(f"{where} ends in row {row:,} of {element.count:,}")
            if listed:
                length = words[at]
                if not (0 <= length <= len(words) - at and length == int(length)):
                    raise ReadError(f"{where}, row {row:,}: {length:g} is no list length")
                at += int(length)
            at += 1
        ends.append(at)
    if at > len(words):
        raise ReadError(f"{where} ends in row {element.count - 1:,} of {element.count:,}")
    return np.array(places, dtype=np.int64).reshape(element.count, -1), np.array(ends, dtype=np.int64)


def _cast(values: FloatArray, code: str, element: Element) -> Values:
    """Cast words to the declared type; int64 beyond 2**53 is not exact, which no mesh index reaches."""
    if code == "f8":
        return values
    if code == "f4":
        with np.errstate(over="ignore"):  # beyond float32 is infinite, and refused as such if it is a coordinate
            return values.astype(np.float32)
    low, high = value_range(code)
    fits = (values >= low) & (values <= high) & (values == np.trunc(values))
    if not fits.all():
        wrong = float(values[np.argmin(fits)])
        raise ReadError(f"PLY element {element.name[:40]!r}: {wrong:g} does not fit its integer property")
    # float(2**63 - 1) rounds up to 2**63, which the comparison above lets through and the cast would wrap.
    return np.minimum(values, np.nextafter(float(high), 0)).astype(code) if code[1] == "8" else values.astype(code)

"""Bodies of binary PLY files, of either byte order.

Fast path: if the lists of the first row are as long as those of all others, the element is one structured array,
and no byte is looked at twice. Otherwise rows are walked to find where they begin, one list length at a time, and
the columns are gathered from there in one go each.

Tested in `tests/quadpatch/formats/ply/test_reader.py`.
"""

import struct
from typing import Any

import numpy as np

from quadpatch.errors import ReadError
from quadpatch.formats.ply.header import Element, Header
from quadpatch.formats.ply.rows import ListColumn, Rows, Values, check_room
from quadpatch.formats.polygons import list_range
from quadpatch.types import IntArray

_STRUCT_CODES = {"i1": "b", "u1": "B", "i2": "h", "u2": "H", "i4": "i", "u4": "I", "i8": "q", "u8": "Q"}


def read_binary_body(data: bytes, header: Header) -> tuple[Rows, ...]:
    """Read all elements behind a header.

    Parameters
    ----------
    data : bytes
        The whole file.
    header : Header
        Of a binary file.

    Raises
    ------
    ReadError
        If a count or a list runs past the end of the file.
    """
    rows: list[Rows] = []
    at = header.size
    for element in header.elements:
        smallest = sum(int(prop.count_code[1]) if prop.count_code else int(prop.code[1]) for prop in element.properties)
        check_room(element, smallest, len(data) - at, "bytes")
        read = _read_uniform(data, at, element, header.order) or _read_mixed(data, at, element, header.order)
        rows.append(read)
        at = read.stop
    return tuple(rows)


def row_dtype(element: Element, order: str, lengths: dict[int, int]) -> np.dtype[Any]:
    """Structured type of a row: fields `p0`, `p1`, ... and, for lists, `n0`, ... in front of them.

    Parameters
    ----------
    element : Element
    order : str
        `<` or `>`.
    lengths : dict
        Length of each list by the position of its property.
    """
    fields: list[Any] = []
    for index, prop in enumerate(element.properties):
        if prop.count_code is None:
            fields.append((f"p{index}", order + prop.code))
        else:
            fields.append((f"n{index}", order + prop.count_code))
            fields.append((f"p{index}", order + prop.code, (lengths[index],)))
    return np.dtype(fields)


def _read_uniform(data: bytes, at: int, element: Element, order: str) -> Rows | None:
    """Rows that are all as long as the first one, None if they are not."""
    lengths = _first_lengths(data, at, element, order) if element.count else dict.fromkeys(_lists(element), 0)
    if lengths is None:
        return None
    dtype = row_dtype(element, order, lengths)
    stop = at + dtype.itemsize * element.count
    if stop > len(data):
        return None
    if element.count == 0 or dtype.itemsize == 0:
        table = np.zeros(element.count if dtype.itemsize else 0, dtype)
    else:
        table = np.frombuffer(data, dtype, element.count, at)
    # Row k begins where row 0 and k equal lengths say, so equal counts at these places prove the layout.
    if any((table[f"n{index}"] != length).any() for index, length in lengths.items()):
        return None
    columns: list[Values | ListColumn] = []
    for index, prop in enumerate(element.properties):
        values = table[f"p{index}"]
        if prop.count_code is None:
            columns.append(values)
        else:
            columns.append(ListColumn(np.broadcast_to(np.int64(lengths[index]), len(table)), values))
    return Rows(element, at, stop, None, tuple(columns))


def _lists(element: Element) -> list[int]:
    return [index for index, prop in enumerate(element.properties) if prop.count_code is not None]


def _first_lengths(data: bytes, at: int, element: Element, order: str) -> dict[int, int] | None:
    lengths: dict[int, int] = {}
    for index, prop in enumerate(element.properties):
        if prop.count_code is None:
            at += int(prop.code[1])
            continue
        size = int(prop.count_code[1])
        length = int.from_bytes(data[at : at + size], "little" if order == "<" else "big")
        at += size + length * int(prop.code[1])
        # A negative count looks huge here; the walk names the row it stands in.
        if at > len(data):
            return None
        lengths[index] = length
    return lengths


def _read_mixed(data: bytes, at: int, element: Element, order: str) -> Rows:
    """Rows with lists of different lengths."""
    count_starts, ends = _walk(data, at, element, order)
    starts = np.concatenate([[at], ends[:-1]]).astype(np.int64)
    raw = np.frombuffer(data, np.uint8)
    columns: list[Values | ListColumn] = []
    cursor = starts
    list_number = 0
    for prop in element.properties:
        if prop.count_code is None:
            columns.append(_gather(raw, cursor, order + prop.code))
            cursor = cursor + int(prop.code[1])
            continue
        cursor = count_starts[:, list_number]
        list_number += 1
        counts = _gather(raw, cursor, order + prop.count_code).astype(np.int64)
        item = int(prop.code[1])
        cursor = cursor + int(prop.count_code[1])
        within = list_range(np.zeros_like(counts), counts)
        items = np.repeat(cursor, counts) + within * item
        columns.append(ListColumn(counts, _gather(raw, items, order + prop.code)))
        cursor = cursor + counts * item
    return Rows(element, at, int(ends[-1]), ends, tuple(columns))


def _walk(data: bytes, at: int, element: Element, order: str) -> tuple[IntArray, IntArray]:
    """Find the byte of every list's count, (n, n_lists), and the end of every row, (n,).

    The one loop over rows in this reader: where a row begins is known only after the one before it.
    """
    steps, tail = _steps(element, order)
    if len(steps) == 1 and steps[0][2] == 1 and element.properties[_lists(element)[0]].count_code == "u1":
        return _walk_short_lists(data, at, element, (steps[0][0], steps[0][3], tail))
    offsets: list[int] = []
    ends: list[int] = []
    for row in range(element.count):
        for gap, unpack, count_size, item_size in steps:
            at += gap
            if at + count_size > len(data):
                raise ReadError(f"PLY element {element.name[:40]!r} ends in row {row:,} of {element.count:,}")
            (length,) = unpack(data, at)
            if length < 0:
                raise ReadError(f"PLY element {element.name[:40]!r}, row {row:,}: a list of {length} values")
            offsets.append(at)
            at += count_size + length * item_size
        at += tail
        ends.append(at)
    if at > len(data):
        raise ReadError(f"PLY element {element.name[:40]!r}: its {element.count:,} rows run past the end of the file")
    return np.array(offsets, dtype=np.int64).reshape(element.count, -1), np.array(ends, dtype=np.int64)


def _walk_short_lists(data: bytes, at: int, element: Element, sizes: tuple[int, int, int]) -> tuple[IntArray, IntArray]:
    """Walk rows with one list whose length is one byte, as nearly all mixed files have it, ten times faster."""
    gap, item, tail = sizes
    offsets: list[int] = []
    try:
        at += gap
        for _ in range(element.count):
            offsets.append(at)
            at += 1 + data[at] * item + tail + gap
    except IndexError:
        row = len(offsets) - 1
        raise ReadError(f"PLY element {element.name[:40]!r} ends in row {row:,} of {element.count:,}") from None
    if at - gap > len(data):
        raise ReadError(f"PLY element {element.name[:40]!r}: its {element.count:,} rows run past the end of the file")
    starts = np.array(offsets, dtype=np.int64)
    ends = np.append(starts[1:], at) - gap
    return starts[:, np.newaxis], ends


def _steps(element: Element, order: str) -> tuple[list[tuple[int, Any, int, int]], int]:
    steps: list[tuple[int, Any, int, int]] = []
    gap = 0
    for prop in element.properties:
        if prop.count_code is None:
            gap += int(prop.code[1])
        else:
            count = struct.Struct(order + _STRUCT_CODES[prop.count_code])
            steps.append((gap, count.unpack_from, count.size, int(prop.code[1])))
            gap = 0
    return steps, gap


def _gather(raw: Values, starts: IntArray, code: str) -> Values:
    """Values of one type at arbitrary bytes."""
    dtype = np.dtype(code)
    if len(starts) == 0:
        return np.zeros(0, dtype)
    # A view that holds the value beginning at every single byte; only those asked for are touched.
    anywhere = np.ndarray((len(raw) - dtype.itemsize + 1,), dtype, raw.data, strides=(1,))
    return anywhere[starts]

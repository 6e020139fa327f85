"""Rows of PLY elements as bytes, binary or ascii.

Tested in `tests/quadpatch/formats/ply/test_writer.py`.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from quadpatch.formats.ply.header import Element, Header, value_range
from quadpatch.formats.ply.rows import Values
from quadpatch.formats.text import to_words
from quadpatch.mesh.passes import parts_of

# Rows that are copied together.
_CHUNK = 1 << 14


@dataclass(frozen=True)
class Table:
    """Rows to be written.

    Attributes
    ----------
    count : int
        Rows.
    columns : tuple
        One array for each property of the element: (count,) for a number, (count, k) for a list of k values.
    marks : dict
        Arrays (count,) of `filled`, `hole_id` and `confidence`, for elements that lack a property of that name.
    """

    count: int
    columns: tuple[Values, ...]
    marks: dict[str, Values]


def encode_rows(element: Element, table: Table, marks: list[str], header: Header) -> bytes:
    """Encode rows as a file of this header stores them.

    Parameters
    ----------
    element : Element
        As it was read, without the marks.
    table : Table
    marks : list of str
        Names of the marks to put behind the element's own values.
    header : Header
    """
    if header.is_ascii:
        return _encode_ascii(element, table, marks, header.line_end)
    fields: list[tuple[str, Any, Any]] = []
    for index, (prop, column) in enumerate(zip(element.properties, table.columns, strict=True)):
        if prop.count_code is not None:
            fields.append((f"n{index}", header.order + prop.count_code, column.shape[1]))
        fields.append((f"p{index}", (header.order + prop.code, column.shape[1:]), fit(column, prop.code)))
    fields += [(name, header.order + table.marks[name].dtype.str[1:], table.marks[name]) for name in marks]
    dtype = np.dtype([(name, *code) if isinstance(code, tuple) else (name, code) for name, code, _ in fields])
    rows = np.zeros(table.count, dtype)
    for name, _, values in fields:
        rows[name] = values
    return rows.tobytes()


def _encode_ascii(element: Element, table: Table, marks: list[str], line_end: bytes) -> bytes:
    words: list[list[str]] = []
    for prop, column in zip(element.properties, table.columns, strict=True):
        if prop.count_code is not None:
            words.append([str(column.shape[1])] * table.count)
        # Not reshape(count, -1): of no rows at all, -1 can be anything.
        for values in column.T if column.ndim > 1 else [column]:
            words.append(to_words(fit(values, prop.code)))
    words += [to_words(table.marks[name]) for name in marks]
    end = line_end.decode()
    return "".join(" ".join(row) + end for row in zip(*words, strict=True)).encode()


def fit(values: Values, code: str) -> Values:
    """Cast to a file's type: rounded and held in range for integers, infinite beyond the range of floats."""
    if code[0] == "f":
        with np.errstate(over="ignore"):
            return np.asarray(values.astype(code))
    low, high = value_range(code)
    if values.dtype.kind in "iu":
        return np.asarray(np.clip(values, low, high).astype(code))
    rounded = np.nan_to_num(np.rint(values), nan=0.0)
    # The float below a 64-bit bound is the largest that casts without wrapping.
    top = np.nextafter(float(high), 0.0) if code[1] == "8" else high
    return np.asarray(np.clip(rounded, low, top).astype(code))


def insert_behind(data: memoryview, ends: Values, suffix: bytes) -> Iterable[bytes | memoryview]:
    """Insert the same bytes behind every row; return the whole in pieces.

    Parameters
    ----------
    data : memoryview
    ends : (n,) int64
        Where each row ends in `data`, ascending.
    suffix : bytes
    """
    n_rows = len(ends)
    if n_rows and len(data) == n_rows * int(ends[0]) and (np.diff(ends) == ends[0]).all():
        return insert_behind_equal(data, n_rows, suffix)
    added = np.frombuffer(suffix, np.uint8)
    return [insert_rows(np.frombuffer(data, np.uint8), ends, np.broadcast_to(added, (n_rows, len(added))))]


def insert_behind_equal(data: memoryview, n_rows: int, suffix: bytes) -> Iterator[memoryview]:
    """Insert the same bytes behind every one of some rows of the same size, which are all of the data."""
    size = len(data) // n_rows
    old = np.frombuffer(data, f"V{size}")
    for part in parts_of(n_rows, _CHUNK):
        # Bytes of a row are copied as one item.
        table = np.zeros(part.stop - part.start, [("old", old.dtype), ("added", f"V{len(suffix)}")])
        table["old"], table["added"] = old[part], np.void(suffix)
        yield table.view(np.uint8).data


def insert_rows(data: Values, ends: Values, pieces: Values) -> bytes:
    """Insert bytes of its own behind every row.

    Parameters
    ----------
    data : (n_bytes,) uint8
    ends : (n,) int64
        Where each row ends in `data`, ascending.
    pieces : (n, size) uint8
    """
    n_rows, size = pieces.shape
    result = np.zeros(len(data) + n_rows * size, np.uint8)
    is_old = np.ones(len(result), dtype=bool)
    places = (ends + size * np.arange(n_rows))[:, np.newaxis] + np.arange(size)
    is_old[places] = False
    result[is_old] = data
    result[places] = pieces
    return result.tobytes()

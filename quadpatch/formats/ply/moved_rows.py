"""Writing PLY: the file that was read, with vertices at other positions and with further vertex properties.

Coordinates of vertices that moved are written in the file's own type, and so are their normals `nx`, `ny`, `nz`,
computed anew; every other byte of the rows stays. A property that is handed over takes the place of the values of that
name if the type is the same. Where it is another one, the old property is left out and the new one stands at the end
of the row, where further properties go. In ascii files numbers are words, and only words that change are touched.

Tested in `tests/quadpatch/formats/test_moving.py`.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quadpatch.errors import FormatError
from quadpatch.formats.moved_normals import moved_vertex_normals
from quadpatch.formats.ply.encoding import fit, insert_rows
from quadpatch.formats.ply.file import PlyFile
from quadpatch.formats.ply.header import rewrite_header, without_properties
from quadpatch.formats.ply.rows import ListColumn, Rows, Values
from quadpatch.formats.ply.vertex_attributes import ply_vertex_attributes
from quadpatch.formats.scan import Moved, Scan
from quadpatch.formats.text import to_words, word_ends, word_starts
from quadpatch.formats.words import replace_words
from quadpatch.types import BoolArray, IntArray

_WORDS = {
    **{"i1": "char", "u1": "uchar", "i2": "short", "u2": "ushort"},
    **{"i4": "int", "u4": "uint", "f4": "float", "f8": "double"},
}


@dataclass(frozen=True)
class _Changes:
    """What becomes of the vertex rows: columns replaced by their position, columns left out, and new ones."""

    replaced: dict[int, tuple[BoolArray, Values]]
    dropped: list[int]
    added: dict[str, Values]


def property_word(values: NDArray[Any]) -> str:
    """Return the PLY word for the type of an array; raise ValueError for one that PLY does not know."""
    code = "u1" if values.dtype == np.bool_ else values.dtype.str[1:]
    if code not in _WORDS:
        raise ValueError(f"PLY has no numbers of the type {values.dtype}")
    return _WORDS[code]


def move_in_ply(scan: Scan, file: PlyFile, moved: Moved) -> bytes:
    """Hand a PLY file back with vertices at other positions.

    Parameters
    ----------
    scan : Scan
        As `read_ply` made it.
    file : PlyFile
        What it was read from.
    moved : Moved

    Raises
    ------
    FormatError
        If the file has a list of the name of a property that is handed over.
    """
    rows = file.element("vertex")
    assert rows is not None  # read_ply refuses a file without vertices
    changes = _changes(scan, file, rows, moved)
    names = {rows.element.properties[index].name for index in changes.dropped}
    added = [(property_word(values), name) for name, values in changes.added.items()]
    head = rewrite_header(without_properties(file.header, rows.element, names), {}, {"vertex": added})
    body = _ascii_body if file.header.is_ascii else _binary_body
    return head + body(file, rows, changes)


def _changes(scan: Scan, file: PlyFile, rows: Rows, moved: Moved) -> _Changes:
    is_moved = moved.is_moved(scan)
    given = {name: moved.vertices[:, axis] for axis, name in enumerate("xyz")}
    stored = ply_vertex_attributes(scan, file).normals
    if stored is not None:
        normals = moved_vertex_normals(scan, stored, moved)
        given |= {name: normals[:, axis] for axis, name in enumerate(("nx", "ny", "nz"))}
    replaced = {}
    for name, column in given.items():
        index = rows.element.find(name)
        if index is not None:
            replaced[index] = (is_moved, fit(column[is_moved], rows.element.properties[index].code))
    dropped: list[int] = []
    added: dict[str, Values] = {}
    everywhere = np.ones(len(is_moved), dtype=bool)
    for name, values in moved.properties.items():
        plain = values.astype(np.uint8) if values.dtype == np.bool_ else values
        index = rows.element.find(name)
        if index is not None and isinstance(rows.columns[index], ListColumn):
            raise FormatError(f"the PLY file has lists as vertex property {name!r}, which is to be written: rename it")
        if index is not None and rows.element.properties[index].code == plain.dtype.str[1:]:
            replaced[index] = (everywhere, plain)
            continue
        dropped += [] if index is None else [index]
        added[name] = plain
    return _Changes(replaced, dropped, added)


def _binary_body(file: PlyFile, rows: Rows, changes: _Changes) -> bytes:
    order = file.header.order
    body = np.frombuffer(file.data, np.uint8)[rows.start : rows.stop].copy()
    for index, (chosen, values) in changes.replaced.items():
        places = rows.places(index, in_words=False)[chosen] - rows.start
        stored = _as_bytes(values, order)
        body[places[:, np.newaxis] + np.arange(stored.shape[1])] = stored
    ends = rows.row_ends() - rows.start
    is_kept = np.ones(len(body), dtype=bool)
    for index in changes.dropped:
        size = int(rows.element.properties[index].code[1])
        is_kept[(rows.places(index, in_words=False) - rows.start)[:, np.newaxis] + np.arange(size)] = False
        ends = ends - size * np.arange(1, len(ends) + 1)
    pieces = [_as_bytes(values, order) for values in changes.added.values()]
    new = insert_rows(body[is_kept], ends, np.concatenate(pieces, axis=1)) if pieces else body[is_kept].tobytes()
    return file.data[file.header.size : rows.start] + new + file.data[rows.stop :]


def _as_bytes(values: Values, order: str) -> NDArray[np.uint8]:
    """Bytes of numbers (n,) in an order, (n, size) uint8."""
    stored = np.ascontiguousarray(values.astype(order + values.dtype.str[1:]))
    return stored.view(np.uint8).reshape(len(values), stored.itemsize)


def _ascii_body(file: PlyFile, rows: Rows, changes: _Changes) -> bytes:
    body = file.data[file.header.size :]
    starts, stops = word_starts(np.frombuffer(body, np.uint8)), word_ends(body)
    # Of each stretch: first byte, byte behind it, what it becomes.
    spans: list[tuple[IntArray, IntArray, list[str]]] = []
    for index, (chosen, values) in changes.replaced.items():
        column = rows.columns[index]
        assert not isinstance(column, ListColumn)
        differs = column[chosen] != values
        places = rows.places(index, in_words=True)[chosen][differs]
        spans.append((starts[places], stops[places], to_words(values[differs])))
    for index in changes.dropped:
        places = rows.places(index, in_words=True)
        spans.append((starts[places], stops[places], [""] * len(places)))
    if changes.added:
        ends = stops[rows.row_ends() - 1]
        words = [to_words(values) for values in changes.added.values()]
        spans.append((ends, ends, ["".join(f" {word}" for word in row) for row in zip(*words, strict=True)]))
    first, behind = (np.concatenate([span[k] for span in spans]) for k in (0, 1))
    return replace_words(body, first, behind, [word for span in spans for word in span[2]])

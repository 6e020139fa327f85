"""Writing PLY: the file that was read, with rows appended.

Header lines, elements and rows stay byte for byte what they were; only counts are raised. Three properties mark what
is invented, on the vertices and on the element that holds the triangles:

=========== ======= ============ =====================
property    type    measured row new row
=========== ======= ============ =====================
filled      uchar   0            1
hole_id     int     -1           id of the hole
confidence  float   1            0..1
=========== ======= ============ =====================

With a texture page, faces also have `texnumber` (int; 0, and for faces on the page its number), and a comment names its
file. They stand behind the old values of each row. A property of that name that is already there, as in a file that is
repaired again, keeps its old values and takes the new rows'.

Files of triangle strips get one further row of strips for each hole, each triangle its own strip: readers of strips
know no `face` element beside them, and the old row, often one single strip over the whole mesh, stays untouched.
"""

import itertools
from collections.abc import Iterator

import numpy as np

from quadpatch.formats.ply.encoding import encode_rows, insert_behind, insert_behind_equal
from quadpatch.formats.ply.file import PlyFile
from quadpatch.formats.ply.header import rewrite_header
from quadpatch.formats.ply.new_rows import MARKS, PAGE_MARK, new_carrier_rows, new_vertex_rows
from quadpatch.formats.ply.rows import Rows
from quadpatch.formats.ply.texture_files import NUMBER, page_comment
from quadpatch.formats.scan import Fill, Scan
from quadpatch.formats.text import word_ends


def append_to_ply(scan: Scan, file: PlyFile, fill: Fill) -> Iterator[bytes | memoryview]:
    """Hand a PLY file back with a fill appended.

    Parameters
    ----------
    scan : Scan
        As `read_ply` made it.
    file : PlyFile
        What it was read from.
    fill : Fill

    Returns
    -------
    iterator of bytes-like
        The file, piece by piece: of a large one there is never a second copy in memory.

    Raises
    ------
    FormatError
        If the file's index type can't name the new vertices.
    """
    new = {"vertex": new_vertex_rows(scan, file, fill), file.carrier: new_carrier_rows(scan, file, fill)}
    added = {rows.element.name: _missing_marks(rows) for rows in file.rows if rows.element.name in new}
    comment = b""
    if fill.page is not None:
        comment = page_comment(fill.page, file.header.line_end)
        if all(rows.element.find(NUMBER) is None for rows in file.rows if rows.element.name == file.carrier):
            added[file.carrier].append(("int", NUMBER))
    counts = {}
    tails: dict[str, bytes] = {}
    for rows in file.rows:
        name = rows.element.name
        if name in new:
            tables = new[name]
            counts[name] = rows.element.count + sum(table.count for table in tables)
            tails[name] = b"".join(
                encode_rows(rows.element, table, [mark for _, mark in added[name]], file.header) for table in tables
            )
    head = rewrite_header(file.header, counts, added, comment)
    pieces = _ascii_pieces if file.header.is_ascii else _binary_pieces
    return itertools.chain([head], pieces(file, added, tails))


def _missing_marks(rows: Rows) -> list[tuple[str, str]]:
    return [(word, name) for word, _, name, _ in MARKS if rows.element.find(name) is None]


def _suffix(file: PlyFile, added: list[tuple[str, str]]) -> bytes:
    """Encode the marks of a measured row."""
    names = [name for _, name in added]
    values = [(code, value) for _, code, name, value in (*MARKS, PAGE_MARK) if name in names]
    if file.header.is_ascii:
        return "".join(f" {value}" for _, value in values).encode()
    return b"".join(np.array(value, dtype=file.header.order + code).tobytes() for code, value in values)


def _binary_pieces(
    file: PlyFile, added: dict[str, list[tuple[str, str]]], tails: dict[str, bytes]
) -> Iterator[bytes | memoryview]:
    whole = memoryview(file.data)
    at = file.header.size
    for rows in file.rows:
        old = whole[rows.start : rows.stop]
        suffix = _suffix(file, added.get(rows.element.name, []))
        if not suffix:
            yield old
        elif rows.ends is None and rows.element.count:
            yield from insert_behind_equal(old, rows.element.count, suffix)
        else:
            yield from insert_behind(old, rows.row_ends() - rows.start, suffix)
        yield tails.get(rows.element.name, b"")
        at = rows.stop
    yield whole[at:]


def _ascii_pieces(
    file: PlyFile, added: dict[str, list[tuple[str, str]]], tails: dict[str, bytes]
) -> Iterator[bytes | memoryview]:
    body = file.data[file.header.size :]
    ends = word_ends(body)
    at = 0
    for rows in file.rows:
        stop = _line_stop(body, int(ends[rows.stop - 1])) if rows.stop > rows.start else at
        old = memoryview(body)[at:stop]
        suffix = _suffix(file, added.get(rows.element.name, []))
        row_ends = ends[rows.row_ends() - 1] - at if rows.stop > rows.start else ends[:0]
        yield from insert_behind(old, row_ends, suffix) if suffix else [old]
        tail = tails.get(rows.element.name, b"")
        if tail and len(old) and bytes(old[-1:]) not in (b"\n", b"\r"):
            yield file.header.line_end
        yield tail
        at = stop
    yield body[at:]


def _line_stop(body: bytes, end: int) -> int:
    """Byte behind the line end that follows a word, or behind the word where other words follow in its line."""
    stop = end
    while body[stop : stop + 1] in (b" ", b"\t", b"\v", b"\f"):
        stop += 1
    if body[stop : stop + 2] == b"\r\n":
        return stop + 2
    return stop + 1 if body[stop : stop + 1] in (b"\n", b"\r") else end

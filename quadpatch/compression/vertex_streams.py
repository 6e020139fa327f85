"""Kept vertices and triangles as streams: triangles in the order of the file, vertices next to an earlier neighbour.

Triangles are written as differences, each of the three columns for itself, and packed by LZMA with a fixed window, so
that a file can ask for no more memory than its triangles take.

References
----------
I. Pavlov, "LZMA specification", 2015.

Tested in `tests/quadpatch/compression/test_qpz_file.py`.
"""

import lzma

import numpy as np

from quadpatch.compression.content import KeptVertices
from quadpatch.compression.entropy import IntReader, IntWriter
from quadpatch.compression.header import Counts
from quadpatch.compression.lattice import LARGEST
from quadpatch.errors import ReadError
from quadpatch.formats.limits import check_indices
from quadpatch.types import BoolArray, IntArray, Triangles

_FILTERS = [{"id": lzma.FILTER_LZMA2, "preset": 6, "dict_size": 1 << 24, "lc": 0, "lp": 2, "pb": 2}]
_WORD = np.dtype("<i4")


def write_triangles(triangles: Triangles) -> bytes:
    """Pack triangles (n, 3), order and corners as they are."""
    first = np.diff(triangles[:, 0], prepend=0)
    others = triangles[:, 1:] - triangles[:, :1]
    # The sign goes to the lowest bit, so that small differences of either sign have three zero bytes.
    differences = np.concatenate([first, others[:, 0], others[:, 1]])
    folded = np.where(differences < 0, -2 * differences - 1, 2 * differences).astype("<u4")
    return lzma.compress(folded.tobytes(), format=lzma.FORMAT_RAW, filters=_FILTERS)


def read_triangles(packed: bytes, n_triangles: int, n_vertices: int) -> Triangles:
    """Unpack triangles.

    Raises
    ------
    ReadError, IndexRangeError
        If the bytes are not those of so many triangles over so many vertices.
    """
    n_bytes = 3 * n_triangles * _WORD.itemsize
    decoder = lzma.LZMADecompressor(format=lzma.FORMAT_RAW, filters=_FILTERS)
    try:
        # One byte more than wanted shows that there are too many, without unpacking them.
        raw = decoder.decompress(packed, n_bytes + 1)
    except (lzma.LZMAError, EOFError) as error:
        raise ReadError("the packed triangles of the .qpz file are damaged") from error
    if len(raw) != n_bytes or not decoder.eof or decoder.unused_data:
        raise ReadError("the .qpz file does not hold as many triangles as it claims")
    folded = np.frombuffer(raw, "<u4").astype(np.int64)
    differences = np.where(folded & 1, -(folded + 1) // 2, folded // 2).reshape(3, -1)
    first = np.cumsum(differences[0])
    triangles = np.stack([first, first + differences[1], first + differences[2]], axis=1)
    check_indices(triangles, n_vertices)
    return np.ascontiguousarray(triangles)


def write_kept(writer: IntWriter, kept: KeptVertices, n_patches: int, span: int) -> None:
    """Write the places of vertices; `span` is the count of columns of a patch."""
    parent = earlier_neighbours(kept.triangles, len(kept.patch))
    follows = _follows(kept.patch, parent)
    writer.write(follows.astype(np.int64), signed=False)
    writer.write(kept.patch[~follows], signed=False)
    differences = kept.place - _references(kept, parent, follows, (n_patches, span))
    for axis in range(3):
        writer.write(differences[follows, axis])
    for axis in range(3):
        writer.write(differences[~follows, axis])


def read_kept(reader: IntReader, triangles: Triangles, counts: Counts) -> KeptVertices:
    """Undo `write_kept`.

    Raises
    ------
    ReadError
        If a place is none of its patch.
    """
    n, span = counts.kept_vertices, counts.parts << counts.levels
    parent = earlier_neighbours(triangles, n)
    follows = reader.read(n, signed=False)
    if int(follows.max(initial=0)) > 1 or (follows.astype(bool) & (parent < 0)).any():
        raise ReadError("a vertex of the .qpz file follows none")
    is_child = follows.astype(bool)
    own = reader.read(n - int(follows.sum()), signed=False)
    if int(own.max(initial=0)) > counts.quads:
        raise ReadError("a vertex of the .qpz file lies on no patch")
    patch, place = np.zeros(n, np.int64), np.zeros((n, 3), np.int64)
    patch[~is_child] = own
    for members in (is_child, ~is_child):
        for axis in range(3):
            place[members, axis] = reader.read(int(members.sum()))
    on_patch = ~is_child & (patch < counts.quads)
    place[on_patch, :2] += span // 2
    _add_up(patch, place, np.where(is_child, parent, -1))
    flat = place[patch < counts.quads, :2]
    if (np.abs(place) >= LARGEST).any() or int(flat.min(initial=0)) < 0 or int(flat.max(initial=0)) > span:
        raise ReadError("a vertex of the .qpz file lies beyond its patch")
    return KeptVertices(triangles, patch, place)


def earlier_neighbours(triangles: Triangles, n_vertices: int) -> IntArray:
    """For each vertex the last one before it that shares a triangle with it, -1 for none."""
    one, other = triangles.ravel(), np.roll(triangles, -1, axis=1).ravel()
    parent = np.full(n_vertices, -1, np.int64)
    np.maximum.at(parent, np.maximum(one, other), np.where(one == other, -1, np.minimum(one, other)))
    return parent


def _follows(patch: IntArray, parent: IntArray) -> BoolArray:
    return np.asarray((parent >= 0) & (patch == patch[np.maximum(parent, 0)]))


def _references(kept: KeptVertices, parent: IntArray, follows: BoolArray, size: tuple[int, int]) -> IntArray:
    """Find what each place is written as a difference from: the neighbour's place, else the middle of the patch."""
    n_patches, span = size
    middle = np.array([span // 2, span // 2, 0])
    alone = np.where((kept.patch < n_patches)[:, np.newaxis], middle, 0)
    return np.where(follows[:, np.newaxis], kept.place[np.maximum(parent, 0)], alone)


def _add_up(patch: IntArray, place: IntArray, parent: IntArray) -> None:
    """Sum places, and hand patches on, along the chains of parents, by doubling the length of the jumps."""
    jump = parent.copy()
    root = np.where(parent >= 0, parent, np.arange(len(parent)))
    while (jump >= 0).any():
        below = np.flatnonzero(jump >= 0)
        place[below] += place[jump[below]]
        root[below] = root[jump[below]]
        jump[below] = jump[jump[below]]
    patch[:] = patch[root]

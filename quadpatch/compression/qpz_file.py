"""The bytes of a `.qpz` file, from its content and back.

Every count is held against the limits of a mesh reader before memory is taken for it, and against what the coded bytes
can hold. Same content, same bytes.
"""

from itertools import pairwise

import numpy as np

from quadpatch.compression.connectivity import KINDS, Walk, decode_polygons
from quadpatch.compression.content import SELF, KeptVertices, Pieces, QpzContent
from quadpatch.compression.entropy import IntReader, IntWriter
from quadpatch.compression.header import Counts, Header, read_header, write_header
from quadpatch.compression.kept_vertices import MAX_PARTS
from quadpatch.compression.lattice import LARGEST, places_of, residuals
from quadpatch.compression.patch_dictionary import MAX_ATOMS, EmbeddedAtoms
from quadpatch.compression.vertex_streams import read_kept, read_triangles, write_kept, write_triangles
from quadpatch.errors import ReadError, TooLargeError
from quadpatch.formats.limits import ReadLimits
from quadpatch.types import IntArray

MAX_LEVELS = 6
# Coefficients are below this in size.
_LARGEST_CODE = 1 << 24
_MOST_COEFFICIENTS = 400_000_000
# Coefficients, and cosine coefficients of atoms, share a stream with those of like importance.
_BANDS = (0, 1, 2, 3, 5, 8, 12, 17, 24, 34, 48, 68, 96, 136, 192, 256, 512, 1024, 4096, 1 << 14)


def encode_content(content: QpzContent, parts: int) -> bytes:
    """Put a content into the bytes of a file; `parts` of a cell are those of its kept vertices, 0 without."""
    writer = IntWriter()
    _write_walk(writer, content.walk)
    _write_places(writer, residuals(content.places, content.walk.predictors))
    if content.embedded is not None:
        writer.write(content.embedded.exponents, signed=False)
        _write_bands(writer, content.embedded.coefficients.T)
    _write_bands(writer, content.codes)
    for where in (content.corrected, content.removed):
        writer.write(np.diff(where, prepend=-1) - 1, signed=False)
    writer.write(content.corrections)
    writer.write(content.border_moves)
    _write_walk(writer, content.pieces.walk)
    _write_places(writer, residuals(content.pieces.places, content.pieces.walk.predictors))
    packed = b""
    if content.kept is not None:
        packed = write_triangles(content.kept.triangles)
        write_kept(writer, content.kept, len(content.walk.polygons), parts << content.levels)
    models, coded = writer.finish()
    sizes = (len(models), len(coded), len(packed))
    header = Header(content.lengths, content.unit, content.dictionary, _counts(content, parts), sizes)
    return write_header(header, models + coded + packed)


def decode_content(data: bytes, limits: ReadLimits) -> tuple[QpzContent, int]:
    """Read the content of a file, and the parts of a cell of its kept vertices.

    Raises
    ------
    MeshError
        ReadError, FormatError or TooLargeError; nothing else, whatever the bytes are.
    """
    header, body = read_header(data)
    counts = header.counts
    _check_limits(counts, limits)
    models, coded = header.sizes[0], header.sizes[0] + header.sizes[1]
    reader = IntReader(body[:models], body[models:coded])
    walk = _read_walk(reader, (counts.quads, counts.crossed, counts.kinds, counts.names), 4)
    places = _read_places(reader, walk)
    embedded = _read_embedded(reader, counts) if header.dictionary.kind == SELF else None
    codes = _below(_read_bands(reader, (counts.quads, counts.atoms)), _LARGEST_CODE)
    corrected, removed = (_ascending(reader, n) for n in (counts.corrections, counts.removed))
    corrections = _below(reader.read(counts.corrections), _LARGEST_CODE)
    moves = _below(reader.read(3 * counts.border), LARGEST).reshape(-1, 3)
    piece_counts = (counts.piece_triangles, counts.piece_crossed, counts.piece_kinds, counts.piece_names)
    piece_walk = _read_walk(reader, piece_counts, 3)
    pieces = Pieces(piece_walk, _read_places(reader, piece_walk))
    kept = _read_kept(reader, counts, body[coded:])
    reader.close()
    found = QpzContent(
        header.lengths, header.unit, counts.levels, header.dictionary, embedded, walk, places, codes,
        corrected, corrections, removed, moves, pieces, kept,
    )  # fmt: skip
    return found, counts.parts


def _counts(content: QpzContent, parts: int) -> Counts:
    walk, piece, kept = content.walk, content.pieces.walk, content.kept
    return Counts(
        content.levels, len(walk.polygons), len(walk.crossed), len(walk.kinds), len(walk.names),
        content.codes.shape[1], 0 if content.embedded is None else len(content.embedded.exponents),
        len(content.corrected), len(content.removed), len(content.border_moves),
        len(piece.polygons), len(piece.crossed), len(piece.kinds), len(piece.names),
        0 if kept is None else len(kept.patch), 0 if kept is None else len(kept.triangles), parts,
    )  # fmt: skip


def _check_limits(counts: Counts, limits: ReadLimits) -> None:
    """Refuse counts that no memory should be taken for."""
    if not 0 <= counts.levels <= MAX_LEVELS or counts.quads < 1:
        raise ReadError(f"a .qpz file of {counts.quads} quads and {counts.levels} levels")
    n_cells = counts.quads << (2 * counts.levels)
    limits.check_vertices(max(n_cells, counts.kept_vertices, 3 * counts.piece_triangles))
    limits.check_triangles(max(2 * n_cells, counts.kept_triangles))
    n_bins = ((1 << counts.levels) + 1) ** 2
    if counts.embedded > MAX_ATOMS or counts.atoms * counts.quads > _MOST_COEFFICIENTS or counts.parts > MAX_PARTS:
        raise TooLargeError("the .qpz file claims more atoms or coefficients than are read")
    if counts.embedded >= n_bins or bool(counts.kept_vertices) != bool(counts.parts):
        raise ReadError("the counts of the .qpz file contradict each other")


def _write_walk(writer: IntWriter, walk: Walk) -> None:
    for numbers in (walk.crossed, walk.kinds, walk.names):
        writer.write(np.array(numbers, np.int64), signed=False)


def _read_walk(reader: IntReader, counts: tuple[int, int, int, int], n_corners: int) -> Walk:
    """Read a walk over `counts[0]` polygons."""
    crossed, kinds, names = (reader.read(n, signed=False) for n in counts[1:])
    if (len(crossed) and int(crossed.max()) > 1) or (len(kinds) and int(kinds.max()) >= KINDS):
        raise ReadError("the connectivity of the .qpz file is damaged")
    walk = Walk(crossed=crossed.tolist(), kinds=kinds.tolist(), names=names.tolist())
    decode_polygons(walk, counts[0], n_corners)
    return walk


def _write_places(writer: IntWriter, differences: IntArray) -> None:
    """Write the first place apart, since it is no difference."""
    writer.write(differences[:1])
    writer.write(differences[1:])


def _read_places(reader: IntReader, walk: Walk) -> IntArray:
    n = len(walk.predictors)
    first, others = reader.read(3 * min(n, 1)), reader.read(3 * max(n - 1, 0))
    return places_of(np.concatenate([first, others]).reshape(-1, 3), walk.predictors)


def _write_bands(writer: IntWriter, table: IntArray) -> None:
    for low, high in _bands(table.shape[1]):
        writer.write(table[:, low:high])


def _read_bands(reader: IntReader, shape: tuple[int, int]) -> IntArray:
    table = np.zeros(shape, np.int64)
    for low, high in _bands(shape[1]):
        table[:, low:high] = reader.read(shape[0] * (high - low)).reshape(shape[0], high - low)
    return table


def _bands(n: int) -> list[tuple[int, int]]:
    return list(pairwise([*(end for end in _BANDS if end < n), n]))


def _read_embedded(reader: IntReader, counts: Counts) -> EmbeddedAtoms:
    exponents = reader.read(counts.embedded, signed=False)
    if len(exponents) and int(exponents.max()) > 30:
        raise ReadError("the dictionary of the .qpz file is damaged")
    n_bins = ((1 << counts.levels) + 1) ** 2
    coefficients = _below(_read_bands(reader, (counts.embedded, n_bins)), _LARGEST_CODE)
    return EmbeddedAtoms(exponents, np.ascontiguousarray(coefficients.T))


def _ascending(reader: IntReader, n: int) -> IntArray:
    return np.cumsum(_below(reader.read(n, signed=False), LARGEST >> 8) + 1) - 1


def _below(values: IntArray, limit: int) -> IntArray:
    if values.size and int(np.abs(values).max()) >= limit:
        raise ReadError("the .qpz file holds a number that is too large")
    return values


def _read_kept(reader: IntReader, counts: Counts, packed: bytes) -> KeptVertices | None:
    if not counts.kept_vertices:
        if packed or counts.kept_triangles:
            raise ReadError("the .qpz file has triangles without vertices")
        return None
    triangles = read_triangles(packed, counts.kept_triangles, counts.kept_vertices)
    return read_kept(reader, triangles, counts)

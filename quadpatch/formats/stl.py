"""STL, binary and ascii: reading, and handing back with facets appended or moved.

Every facet has three vertices of its own, so a scan has three vertices for each triangle; `quadpatch.mesh.weld` joins
them. Binary facets that were invented have the attribute byte count 1 (measured ones keep theirs); it is no colour in
the conventions of VisCAM and SolidView, which mark colours by bit 15. Ascii facets have no place for a mark: the
invented ones are those behind the measured ones, inside the last solid, because many readers stop at the first
`endsolid`.

The word `solid` at the beginning says nothing: binary files have it as often as ascii ones.
`quadpatch.formats.stl_layout` tells them apart.

Facets of which a corner moves get their normal anew; one that is stored as zero stays, since programs that leave it out
leave it out everywhere.
"""

import re
from dataclasses import dataclass

import numpy as np

from quadpatch.errors import EmptyMeshError, ReadError
from quadpatch.formats.attributes import positions, triangle_normals
from quadpatch.formats.limits import ReadLimits, check_vertices, to_float64
from quadpatch.formats.moved_normals import NORMAL_DIGITS
from quadpatch.formats.scan import Fill, Moved, Scan, VertexAttributes, WithoutImages
from quadpatch.formats.stl_layout import FACET, HEADER_SIZE, check_layout, is_ascii_stl
from quadpatch.formats.text import line_end_of, parse_numbers, to_words
from quadpatch.formats.words import replace_numbers, words_from
from quadpatch.mesh.normals import triangle_normals as normals_of
from quadpatch.types import BoolArray, FloatArray

_VERTEX_LINE = re.compile(rb"(?<![^\s])vertex[ \t]+([^\s]+[ \t]+[^\s]+[ \t]+[^\s]+)", re.IGNORECASE)
_NORMAL = re.compile(rb"(?<![^\s])facet[ \t]+normal[ \t]+([^\s]+[ \t]+[^\s]+[ \t]+[^\s]+)", re.IGNORECASE)
_WORDS = re.compile(rb"(?<![^\s])(endfacet|facet|endloop)(?![^\s])", re.IGNORECASE)
_END_SOLID = re.compile(rb"(?<![^\s])endsolid(?![^\s])", re.IGNORECASE)
# A name runs to the end of its line, or to the first facet where all of the text stands in one line.
_NAME = re.compile(
    rb"((?:\A(?:\xef\xbb\xbf)?|(?<=[\r\n])|(?<=endfacet[ \t]))[^\S\r\n]*(?:end)?solid)([^\r\n]*?)"
    rb"(?=[\r\n]|\Z|(?<=\s)facet\s+normal(?:\s+[^\s]+){3}\s+outer\s+loop\s+vertex\s)",
    re.IGNORECASE,
)


@dataclass(frozen=True)
class BinaryStl(WithoutImages):
    """A binary STL file as it was read."""

    data: bytes
    n_facets: int

    def append(self, scan: Scan, fill: Fill) -> bytes:
        """Raise the count and append facets; all other bytes stay."""
        stop = HEADER_SIZE + FACET.itemsize * self.n_facets
        count = np.array(self.n_facets + len(fill.triangles), dtype="<u4").tobytes()
        corners = positions(scan, fill, fill.triangles)
        new = encode_facets(corners, triangle_normals(scan, fill), np.ones(len(fill.triangles), dtype=bool))
        return self.data[: HEADER_SIZE - 4] + count + self.data[HEADER_SIZE:stop] + new + self.data[stop:]

    def move(self, scan: Scan, moved: Moved) -> bytes:
        """Replace corners that moved, and the normals of their facets; all other bytes stay."""
        facets = np.frombuffer(self.data, FACET, self.n_facets, HEADER_SIZE).copy()
        facets["normal"] = _moved_normals(to_float64(facets["normal"]), scan, moved)
        corner_moved = moved.is_moved(scan).reshape(-1, 3)
        facets["vertices"][corner_moved] = moved.vertices.reshape(-1, 3, 3)[corner_moved]
        return self.data[:HEADER_SIZE] + facets.tobytes() + self.data[HEADER_SIZE + facets.nbytes :]

    def vertex_colours(self, scan: Scan) -> None:
        """None; see `vertex_attributes`."""

    def vertex_attributes(self, scan: Scan) -> VertexAttributes:
        """Nothing: the colour conventions of STL differ from program to program."""
        return VertexAttributes()


@dataclass(frozen=True)
class AsciiStl(WithoutImages):
    """An ascii STL file as it was read."""

    data: bytes

    def append(self, scan: Scan, fill: Fill) -> bytes:
        """Insert facets in front of the last `endsolid`."""
        line_end = line_end_of(self.data)
        ends = list(_END_SOLID.finditer(_without_names(self.data)))
        at = ends[-1].start() if ends else len(self.data)
        head = self.data[:at]
        if not head.endswith((b"\n", b"\r")):
            head += line_end.encode()
        return head + _ascii_facets(scan, fill, line_end).encode() + self.data[at:]

    def move(self, scan: Scan, moved: Moved) -> bytes:
        """Replace the numbers of corners that moved, and of the normals of their facets; all other text stays."""
        text = _without_names(self.data)
        found = list(_NORMAL.finditer(text))
        is_moved = moved.is_moved(scan)
        corners = words_from(text, np.array([match.start(1) for match in _VERTEX_LINE.finditer(text)]), 3)
        spans, before, after, rows = corners, scan.vertices, moved.vertices, is_moved
        if len(found) == len(scan.triangles):
            places = words_from(text, np.array([match.start(1) for match in found]), 3)
            stored = parse_numbers(b"\n".join(match[1] for match in found)).reshape(-1, 3)
            fresh = _moved_normals(stored, scan, moved)
            spans = np.concatenate([places[0], spans[0]]), np.concatenate([places[1], spans[1]])
            before, after = np.concatenate([stored, before]), np.concatenate([fresh, after])
            rows = np.concatenate([is_moved.reshape(-1, 3).any(axis=1), rows])
        return replace_numbers(self.data, spans, before, after, rows)

    def vertex_colours(self, scan: Scan) -> None:
        """None: ascii STL knows no colours."""

    def vertex_attributes(self, scan: Scan) -> VertexAttributes:
        """Nothing: ascii STL knows no colours."""
        return VertexAttributes()


def read_stl(data: bytes, limits: ReadLimits) -> Scan:
    """Read an STL file, binary or ascii.

    Parameters
    ----------
    data : bytes
        The whole file.
    limits : ReadLimits

    Raises
    ------
    MeshError
        ReadError, EmptyMeshError, NotFiniteError, CoordinateRangeError or TooLargeError.
    """
    return _read_ascii(data, limits) if is_ascii_stl(data) else _read_binary(data, limits)


def _read_binary(data: bytes, limits: ReadLimits) -> Scan:
    n_facets = check_layout(data)
    _check_counts(n_facets, limits)
    facets = np.frombuffer(data, FACET, n_facets, HEADER_SIZE)
    vertices = to_float64(facets["vertices"].reshape(-1, 3))
    return _scan(vertices, BinaryStl(data, n_facets), limits)


def _check_counts(n_facets: int, limits: ReadLimits) -> None:
    if n_facets == 0:
        raise EmptyMeshError("the STL file has no facet")
    limits.check_triangles(n_facets)
    limits.check_vertices(3 * n_facets)


def _scan(vertices: FloatArray, source: BinaryStl | AsciiStl, limits: ReadLimits) -> Scan:
    check_vertices(vertices, limits.allow_missing)
    return Scan(vertices, np.arange(len(vertices), dtype=np.int64).reshape(-1, 3), "stl", source=source)


def _read_ascii(data: bytes, limits: ReadLimits) -> Scan:
    text = _without_names(data)
    lines = _VERTEX_LINE.findall(text)
    words = [word.lower() for word in _WORDS.findall(text)]
    n_facets = words.count(b"endfacet")
    if len(lines) != 3 * n_facets or words.count(b"facet") != n_facets or words.count(b"endloop") != n_facets:
        raise ReadError(
            f"the STL text has {words.count(b'facet'):,} facets with {len(lines):,} readable vertices, and "
            f"{n_facets:,} of them end: each facet must have three vertices and an end"
        )
    _check_counts(n_facets, limits)
    numbers = parse_numbers(b"\n".join(lines))
    if len(numbers) != 9 * n_facets:
        raise ReadError(f"the STL text has {len(numbers):,} coordinates for {3 * n_facets:,} vertices")
    return _scan(numbers.reshape(-1, 3), AsciiStl(data), limits)


def _without_names(data: bytes) -> bytes:
    """Put blanks in the place of the names of solids, which may hold any word; all else stays where it is."""
    return _NAME.sub(lambda match: match[1] + b" " * len(match[2]), data)


def _moved_normals(stored: FloatArray, scan: Scan, moved: Moved) -> FloatArray:
    """Return normals (m, 3): those of the moved facets that have one and an area anew, all others as they are."""
    fresh = np.round(normals_of(moved.vertices, scan.triangles), NORMAL_DIGITS) + 0.0
    has_moved = np.asarray(moved.is_moved(scan).reshape(-1, 3).any(axis=1) & stored.any(axis=1) & fresh.any(axis=1))
    return np.where(has_moved[:, np.newaxis], fresh, stored)


def _ascii_facets(scan: Scan, fill: Fill, line_end: str) -> str:
    corners = positions(scan, fill, fill.triangles)
    table = np.concatenate([triangle_normals(scan, fill), corners.reshape(-1, 9)], axis=1)
    words = np.array(to_words(table.ravel()), dtype=object).reshape(-1, 12)
    lines = ("  facet normal {} {} {}", "    outer loop", *["      vertex {} {} {}"] * 3, "    endloop", "  endfacet")
    template = line_end.join(lines) + line_end
    return "".join(template.format(*row) for row in words)


def encode_facets(corners: FloatArray, normals: FloatArray, invented: BoolArray) -> bytes:
    """Encode binary facets.

    Parameters
    ----------
    corners : (m, 3, 3) float64
    normals : (m, 3) float64
    invented : (m,) bool
        True sets the attribute byte count to 1.
    """
    facets = np.zeros(len(corners), FACET)
    facets["normal"], facets["vertices"], facets["attribute"] = normals, corners, invented
    return facets.tobytes()


def encode_stl(corners: FloatArray, normals: FloatArray, invented: BoolArray) -> bytes:
    """Encode a whole binary STL file; parameters as of `encode_facets`."""
    header = b"Quadpatch: attribute 1 marks invented facets".ljust(HEADER_SIZE - 4)
    return header + np.array(len(corners), dtype="<u4").tobytes() + encode_facets(corners, normals, invented)

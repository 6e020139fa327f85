"""OFF: reading, and handing back with lines appended or with vertices at other positions.

Read are OFF, COFF, NOFF, CNOFF and STOFF text files, with or without the keyword, with comments, and with colours
behind vertices and faces whether the keyword announces them or not. Every line of the file comes back as it was but
the counts. Invented vertices and faces are those behind the measured ones; the format has no place for another mark.
New vertices get extended colours, normals and texture coordinates, new faces the colour of the nearest measured face.
Where vertices move, their coordinates change, and their normals are computed anew.
"""

import re
from dataclasses import dataclass

import numpy as np

from quadpatch.errors import EmptyMeshError, FormatError, ReadError
from quadpatch.formats.attributes import extend_colours, extend_over_vertices, nearest_rim_triangle, vertex_normals
from quadpatch.formats.limits import ReadLimits, check_indices, check_triangles, check_vertices
from quadpatch.formats.lines import Lines, split_lines
from quadpatch.formats.moved_normals import moved_vertex_normals
from quadpatch.formats.polygons import list_range, triangulate_polygons
from quadpatch.formats.scan import Fill, Moved, Scan, VertexAttributes, WithoutImages
from quadpatch.formats.text import decode_text, encode_like, line_end_of, to_integers, to_lines, to_words
from quadpatch.formats.words import replace_numbers, words_from
from quadpatch.types import FloatArray, IntArray

_KEYWORD = re.compile(rb"(ST)?(C)?(N)?(4)?(n)?OFF(?![^\s])[ \t]*(BINARY)?")
_COUNTS = re.compile(rb"(?<![^\s])[0-9]+([ \t]+)[0-9]+")
_LINE_END = re.compile(rb"\r\n|\n|\r")
# Numbers of a colour: with or without alpha.
_COLOUR_WIDTHS = (3, 4)


@dataclass(frozen=True)
class OffSource(WithoutImages):
    """An OFF file as it was read.

    Attributes
    ----------
    text : bytes
        The file, decoded.
    codec : str
        Encoding that it had.
    start : bytes
        First bytes of the file, with its byte order mark.
    counts_at : int
        Byte at which the line of the counts begins.
    vertices_end, faces_end : int
        Bytes behind the last vertex line and the last face line.
    counts : tuple of int
        Vertices and faces.
    extras : (n, k) float64
        What stands behind the coordinates of a vertex.
    n_normal, n_texture : int
        How many of the first and the last columns of `extras` are a normal and texture coordinates.
    vertex_lines, face_lines : Lines
    triangle_face : (m,) int64
    """

    text: bytes
    codec: str
    start: bytes
    counts_at: int
    vertices_end: int
    faces_end: int
    counts: tuple[int, int]
    extras: FloatArray
    n_normal: int
    n_texture: int
    vertex_lines: Lines
    face_lines: Lines
    triangle_face: IntArray

    def append(self, scan: Scan, fill: Fill) -> bytes:
        """Raise the counts and add lines behind the last vertex and the last face."""
        line_end = line_end_of(self.text)
        new = rb"%d\g<1>%d" % (self.counts[0] + len(fill.vertices), self.counts[1] + len(fill.triangles))
        head = self.text[: self.counts_at]
        counts = re.sub(_COUNTS, new, self.text[self.counts_at : self.vertices_end], count=1)
        pieces = [
            head + counts,
            self._vertex_lines(scan, fill, line_end).encode(),
            self.text[self.vertices_end : self.faces_end],
            self._face_lines(scan, fill, line_end).encode(),
            self.text[self.faces_end :],
        ]
        if not self.text[: self.faces_end].endswith((b"\n", b"\r")):
            pieces.insert(3, line_end.encode())
        return encode_like(self.start, b"".join(pieces), self.codec)

    def move(self, scan: Scan, moved: Moved) -> bytes:
        """Replace the numbers of vertices that moved, and those of their normals."""
        before, after = scan.vertices, moved.vertices
        if self.n_normal:
            stored = self.extras[:, : self.n_normal]
            fresh = moved_vertex_normals(scan, stored, moved)
            before, after = np.concatenate([before, stored], axis=1), np.concatenate([after, fresh], axis=1)
        spans = words_from(self.vertex_lines.raw, self.vertex_lines.starts, before.shape[1])
        return encode_like(
            self.start, replace_numbers(self.text, spans, before, after, moved.is_moved(scan)), self.codec
        )

    def _vertex_lines(self, scan: Scan, fill: Fill, line_end: str) -> str:
        extras = extend_over_vertices(fill, self.extras)
        if self._colours().shape[1] in _COLOUR_WIDTHS:
            last = self.extras.shape[1] - self.n_texture
            extras[:, self.n_normal : last] = extend_colours(fill, self._colours(), self._top_colour())
        if self.n_normal:
            extras[:, : self.n_normal] = vertex_normals(scan, fill)
        # Colours were written as whole numbers in some files, and as fractions in others.
        stop = extras.shape[1] - self.n_texture
        old = self.extras[:, self.n_normal : stop]
        is_whole = bool((old == np.trunc(old)).all() and (old > 1).any())
        columns = [to_words(fill.vertices[:, axis]) for axis in range(3)]
        for number, column in enumerate(extras.T):
            is_colour = self.n_normal <= number < stop
            values = np.rint(column).astype(np.int64) if is_colour and is_whole else column.astype(np.float32)
            columns.append(to_words(values))
        return "".join(" ".join(row) + line_end for row in zip(*columns, strict=True))

    def _face_lines(self, scan: Scan, fill: Fill, line_end: str) -> str:
        nearest = self.triangle_face[nearest_rim_triangle(scan, fill)]
        tails = {face: self._colour(face) for face in np.unique(nearest).tolist()}
        lines = to_lines("3", fill.triangles, "\n").splitlines()
        return "".join(line + tails[face] + line_end for line, face in zip(lines, nearest.tolist(), strict=True))

    def _colour(self, face: int) -> str:
        """Return what stands behind the vertices of a face."""
        words = self.face_lines.text(face).decode("latin-1").split()
        return "".join(f" {word}" for word in words[1 + int(float(words[0])) :])

    def _colours(self) -> FloatArray:
        """Columns (n, k) between normals and texture coordinates: colours where they are three or four."""
        return self.extras[:, self.n_normal : self.extras.shape[1] - self.n_texture]

    def _top_colour(self) -> float:
        """Full intensity: colours are fractions of 1, or whole numbers up to 255."""
        return 1.0 if self._colours().max(initial=0.0) <= 1 else 255.0

    def vertex_attributes(self, scan: Scan) -> VertexAttributes:
        """Colours, normals and texture coordinates of the vertices."""
        normals = self.extras[:, :3] if self.n_normal else None
        texture = self.extras[:, -self.n_texture :][scan.triangles] if self.n_texture else None
        return VertexAttributes(self.vertex_colours(scan), normals, texture)

    def vertex_colours(self, scan: Scan) -> FloatArray | None:
        """Colours of the vertices."""
        colours, top = self._colours(), self._top_colour()
        if colours.shape[1] not in _COLOUR_WIDTHS:
            return None
        return np.concatenate([colours, np.full((len(colours), 1), top)], axis=1)[:, :4] * (255.0 / top)


def read_off(data: bytes, limits: ReadLimits) -> Scan:
    """Read an OFF text file.

    Parameters
    ----------
    data : bytes
        The whole file.
    limits : ReadLimits

    Raises
    ------
    MeshError
        ReadError, FormatError, EmptyMeshError, NotFiniteError, IndexRangeError or TooLargeError.
    """
    text, codec = decode_text(data)
    lines = split_lines(text)
    keyword, counts_line = _parse_keyword(lines)
    n_vertices, n_faces = _parse_counts(lines, counts_line, keyword)
    limits.check_vertices(n_vertices)
    limits.check_triangles(n_faces)
    first = counts_line + 1
    room = len(lines.starts) - first
    if n_vertices + n_faces > room:
        raise ReadError(
            f"the OFF file declares {n_vertices:,} vertices and {n_faces:,} faces; {room:,} lines are left for them"
        )
    if n_vertices == 0 or n_faces == 0:
        raise EmptyMeshError(f"the OFF file has {n_vertices} vertices and {n_faces} faces")
    vertex_lines = lines.select(slice(first, first + n_vertices))
    face_lines = lines.select(slice(first + n_vertices, first + n_vertices + n_faces))
    table = _parse_vertices(vertex_lines)
    vertices = np.ascontiguousarray(table[:, :3])
    check_vertices(vertices, limits.allow_missing)
    counts, corners = _parse_faces(face_lines)
    check_indices(corners, n_vertices)
    triangles, triangle_face = triangulate_polygons(vertices, counts, corners)
    check_triangles(triangles, limits)
    n_normal = 3 if keyword and keyword.group(3) and table.shape[1] >= 6 else 0
    source = OffSource(
        text=text,
        codec=codec,
        start=data[:4],
        counts_at=int(lines.starts[counts_line]),
        vertices_end=_behind_line(text, int(vertex_lines.stops[-1])),
        faces_end=_behind_line(text, int(face_lines.stops[-1])),
        counts=(n_vertices, n_faces),
        extras=table[:, 3:],
        n_normal=n_normal,
        n_texture=2 if keyword and keyword.group(1) and table.shape[1] >= 5 + n_normal else 0,
        vertex_lines=vertex_lines,
        face_lines=face_lines,
        triangle_face=triangle_face,
    )
    return Scan(vertices, triangles, "off", source=source)


def _behind_line(text: bytes, at: int) -> int:
    """Byte behind the end of the line that a byte is in."""
    end = _LINE_END.search(text, at)
    return end.end() if end else len(text)


def _parse_keyword(lines: Lines) -> tuple[re.Match[bytes] | None, int]:
    """Match the keyword, and say which line holds the counts."""
    first = lines.text(0) if len(lines.starts) else b""
    keyword = _KEYWORD.match(first)
    if keyword is None:
        return None, 0
    if keyword.group(4) or keyword.group(5) or keyword.group(6):
        raise FormatError(f"OFF files of the kind {keyword.group().decode()!r} are not read, only 3D text")
    return keyword, 0 if first[keyword.end() :].strip() else 1


def _parse_counts(lines: Lines, counts_line: int, keyword: re.Match[bytes] | None) -> tuple[int, int]:
    line = lines.text(counts_line) if counts_line < len(lines.starts) else b""
    words = line[keyword.end() if keyword and counts_line == 0 else 0 :].split()
    if len(words) < 2 or not all(re.fullmatch(rb"[0-9]{1,18}", word) for word in words[:2]):
        shown = line[:60].decode("latin-1")
        raise ReadError(f"an OFF file states its vertices and faces in front of them; found {shown!r}")
    return int(words[0]), int(words[1])


def _parse_vertices(lines: Lines) -> FloatArray:
    words = lines.word_counts()
    uneven = np.flatnonzero((words != words[0]) | (words < 3))
    if len(uneven):
        wrong = int(uneven[0])
        raise ReadError(f"OFF vertex {wrong} has {words[wrong]} numbers; the first one has {words[0]}")
    return lines.numbers().reshape(len(words), -1)


def _parse_faces(lines: Lines) -> tuple[IntArray, IntArray]:
    """Corner counts, and corners one behind the other."""
    words = lines.word_counts()
    numbers = lines.numbers()
    starts = np.cumsum(words) - words
    sizes = numbers[starts]
    wrong = np.flatnonzero(~((sizes >= 0) & (sizes == np.trunc(sizes)) & (sizes < words)))
    if len(wrong):
        shown = lines.text(int(wrong[0]))[:60].decode("latin-1")
        raise ReadError(f"OFF face {wrong[0]} is {shown!r}, which is no count and so many vertices")
    counts = sizes.astype(np.int64)
    return counts, to_integers(numbers[list_range(starts + 1, counts)], "OFF faces")

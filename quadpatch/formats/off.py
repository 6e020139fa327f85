"""OFF: reading, and handing back with lines appended.

Read are OFF, COFF, NOFF, CNOFF and STOFF text files, with or without the keyword, with comments, and with colours
behind vertices and faces whether the keyword announces them or not. Every line of the file comes back as it was but
the counts. Invented vertices and faces are those behind the measured ones; the format has no place for another mark.
New vertices get spread colours, normals and texture coordinates, new faces the colour of the nearest measured face.
"""

import re
from dataclasses import dataclass

import numpy as np

from quadpatch.errors import EmptyMeshError, FormatError, ReadError
from quadpatch.formats.attributes import nearest_rim_triangle, spread_over_vertices, vertex_normals
from quadpatch.formats.limits import ReadLimits, check_indices, check_triangles, check_vertices
from quadpatch.formats.polygons import triangulate_polygons
from quadpatch.formats.scan import Appearance, Fill, Scan
from quadpatch.formats.text import decode_text, line_end_of, parse_integers, parse_numbers, to_lines, to_words
from quadpatch.types import FloatArray, IntArray

_KEYWORD = re.compile(rb"(ST)?(C)?(N)?(4)?(n)?OFF(?![^\s])[ \t]*(BINARY)?")


@dataclass(frozen=True)
class OffSource:
    """An OFF file as it was read.

    Attributes
    ----------
    lines : list of bytes
        All lines with their ends.
    codec : str
        Encoding that the lines had.
    counts_line, vertices_stop, faces_stop : int
        Line of the counts, and lines behind the last vertex and the last face.
    counts : tuple of int
        Vertices and faces.
    extras : (n, k) float64
        What stands behind the coordinates of a vertex.
    n_normal, n_texture : int
        How many of the first and the last columns of `extras` are a normal and texture coordinates.
    face_tails : list of bytes
        What stands behind the indices of each face.
    triangle_face : (m,) int64
    """

    lines: list[bytes]
    codec: str
    counts_line: int
    vertices_stop: int
    faces_stop: int
    counts: tuple[int, int]
    extras: FloatArray
    n_normal: int
    n_texture: int
    face_tails: list[bytes]
    triangle_face: IntArray

    def append(self, scan: Scan, fill: Fill) -> bytes:
        """Raise the counts and add lines behind the last vertex and the last face."""
        line_end = line_end_of(b"".join(self.lines[:2]))
        extras = spread_over_vertices(fill, self.extras)
        if self.n_normal:
            extras[:, : self.n_normal] = vertex_normals(scan, fill)
        # Colours were written as whole numbers in some files, and as fractions in others.
        whole = ((self.extras == np.trunc(self.extras)).all(axis=0)) & (self.extras > 1).any(axis=0)
        columns = [to_words(fill.vertices[:, axis]) for axis in range(3)]
        for column, is_whole in zip(extras.T, whole, strict=True):
            columns.append(to_words(np.rint(column).astype(np.int64) if is_whole else column.astype(np.float32)))
        vertices = "".join(" ".join(row) + line_end for row in zip(*columns, strict=True))
        nearest = self.triangle_face[nearest_rim_triangle(scan, fill)]
        faces = to_lines("3", fill.triangles, "\n").splitlines()
        tails = [self.face_tails[face].decode("latin-1") for face in nearest]
        new_faces = "".join(face + tail + line_end for face, tail in zip(faces, tails, strict=True))
        text = self._with_counts(len(fill.vertices), len(fill.triangles))
        pieces = [
            *text[: self.vertices_stop],
            _ended(text[self.vertices_stop - 1], vertices, line_end),
            *text[self.vertices_stop : self.faces_stop],
            _ended(text[self.faces_stop - 1], new_faces, line_end),
            *text[self.faces_stop :],
        ]
        return self._encode(b"".join(pieces))

    def _with_counts(self, n_vertices: int, n_faces: int) -> list[bytes]:
        text = list(self.lines)
        new = b"%d\\g<1>%d" % (self.counts[0] + n_vertices, self.counts[1] + n_faces)
        text[self.counts_line] = re.sub(rb"(?<![^\s])[0-9]+([ \t]+)[0-9]+", new, text[self.counts_line], count=1)
        return text

    def _encode(self, text: bytes) -> bytes:
        return text if self.codec == "utf-8" else ("\ufeff" + text.decode()).encode(self.codec)

    def appearance(self, scan: Scan) -> Appearance:
        """Colours, normals and texture coordinates of the vertices."""
        stop = self.extras.shape[1] - self.n_texture
        colours = self.extras[:, self.n_normal : stop]
        found = None
        if colours.shape[1] in (3, 4):
            # Fractions of 1, or whole numbers up to 255.
            scale = 255.0 if colours.max(initial=0.0) <= 1 else 1.0
            opaque = np.full((len(colours), 1), 255.0 / scale)
            found = np.concatenate([colours, opaque], axis=1)[:, :4] * scale
        normals = self.extras[:, :3] if self.n_normal else None
        texture = self.extras[:, stop:][scan.triangles] if self.n_texture else None
        return Appearance(found, normals, texture)


def _ended(line_before: bytes, new: str, line_end: str) -> bytes:
    """Text to put behind a line, which may lack its own end at the end of the file."""
    missing = "" if line_before.endswith((b"\n", b"\r")) or not new else line_end
    return (missing + new).encode("latin-1")


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
    lines = text.splitlines(keepends=True)
    bare = [line.split(b"#", 1)[0].strip() for line in lines]
    full = [number for number, line in enumerate(bare) if line]
    keyword, counts_at = _parse_keyword(bare, full)
    n_vertices, n_faces = _parse_counts(bare[full[counts_at]] if counts_at < len(full) else b"", keyword)
    limits.check_vertices(n_vertices)
    limits.check_triangles(n_faces)
    first = counts_at + 1
    if n_vertices + n_faces > len(full) - first:
        raise ReadError(
            f"the OFF file declares {n_vertices:,} vertices and {n_faces:,} faces; "
            f"{len(full) - first:,} lines are left for them"
        )
    if n_vertices == 0 or n_faces == 0:
        raise EmptyMeshError(f"the OFF file has {n_vertices} vertices and {n_faces} faces")
    vertex_lines, face_lines = full[first : first + n_vertices], full[first + n_vertices :][:n_faces]
    table = _parse_vertices([bare[number] for number in vertex_lines])
    vertices = np.ascontiguousarray(table[:, :3])
    check_vertices(vertices)
    counts, corners, tails = _parse_faces([bare[number] for number in face_lines])
    check_indices(corners, n_vertices)
    triangles, triangle_face = triangulate_polygons(vertices, counts, corners)
    check_triangles(triangles, limits)
    n_normal = 3 if keyword and keyword.group(3) and table.shape[1] >= 6 else 0
    n_texture = 2 if keyword and keyword.group(1) and table.shape[1] >= 5 + n_normal else 0
    stops = full[counts_at], vertex_lines[-1] + 1, face_lines[-1] + 1
    kept = OffSource(
        lines, codec, *stops, (n_vertices, n_faces), table[:, 3:], n_normal, n_texture, tails, triangle_face
    )
    return Scan(vertices, triangles, "off", source=kept)


def _parse_keyword(bare: list[bytes], full: list[int]) -> tuple[re.Match[bytes] | None, int]:
    """Match the keyword, and say which of the lines that are not empty holds the counts."""
    keyword = _KEYWORD.match(bare[full[0]]) if full else None
    if keyword is None:
        return None, 0
    if keyword.group(4) or keyword.group(5) or keyword.group(6):
        raise FormatError(
            f"OFF files of the kind {keyword.group().decode()!r} are not read, only three-dimensional text"
        )
    return keyword, 0 if bare[full[0]][keyword.end() :].strip() else 1


def _parse_counts(line: bytes, keyword: re.Match[bytes] | None) -> tuple[int, int]:
    words = (line[keyword.end() :] if keyword and _KEYWORD.match(line) else line).split()
    if len(words) < 2 or not all(re.fullmatch(rb"[0-9]{1,18}", word) for word in words[:2]):
        shown = line[:60].decode("latin-1")
        raise ReadError(f"an OFF file states its vertices and faces in front of them; found {shown!r}")
    return int(words[0]), int(words[1])


def _parse_vertices(lines: list[bytes]) -> FloatArray:
    width = len(lines[0].split())
    numbers = parse_numbers(b"\n".join(lines))
    uneven = next((i for i, line in enumerate(lines) if len(line.split()) != width), None)
    if uneven is not None or width < 3:
        wrong = uneven or 0
        raise ReadError(f"OFF vertex {wrong} has {len(lines[wrong].split())} numbers; the first one has {width}")
    return numbers.reshape(len(lines), width)


def _parse_faces(lines: list[bytes]) -> tuple[IntArray, IntArray, list[bytes]]:
    """Corner counts, corners one behind the other, and what follows them in each line."""
    counts: list[int] = []
    corners: list[bytes] = []
    tails: list[bytes] = []
    for number, line in enumerate(lines):
        words = line.split()
        if not re.fullmatch(rb"[0-9]{1,9}", words[0]) or int(words[0]) >= len(words):
            raise ReadError(f"OFF face {number} is {line[:60].decode('latin-1')!r}: a count and so many vertices")
        size = int(words[0])
        counts.append(size)
        corners.extend(words[1 : size + 1])
        tails.append(b"".join(b" " + word for word in words[size + 1 :]))
    return np.array(counts, dtype=np.int64), parse_integers(b" ".join(corners), "OFF faces"), tails

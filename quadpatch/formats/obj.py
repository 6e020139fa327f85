"""OBJ: reading.

Read are `v` (with colours behind the coordinates), `vt`, `vn` and `f` with polygons, negative indices, line
continuations and any text encoding that has a byte order mark. Materials are names only; no other file is opened.
Lines of other keywords mean nothing to a repair and come back as they were (see `obj_source`).
"""

import re
from dataclasses import dataclass

import numpy as np

from quadpatch.errors import EmptyMeshError, IndexRangeError, ReadError
from quadpatch.formats.limits import ReadLimits, check_indices, check_triangles, check_vertices
from quadpatch.formats.obj_source import ObjSource
from quadpatch.formats.polygons import triangulate_polygons
from quadpatch.formats.scan import Scan
from quadpatch.formats.text import decode_text, parse_integers, parse_numbers
from quadpatch.types import FloatArray, IntArray, Triangles, Vertices

_KEYWORDS = {b"v": 1, b"vt": 2, b"vn": 3, b"f": 4, b"fo": 4, b"usemtl": 5}
_VERTEX, _TEXTURE, _NORMAL, _FACE, _MATERIAL = 1, 2, 3, 4, 5


@dataclass(frozen=True)
class _Lines:
    """Lines of an OBJ file: what stands behind each keyword, and which keyword it is (0 for all others)."""

    bodies: list[bytes]
    kinds: IntArray

    def of(self, kind: int) -> list[bytes]:
        """Bodies of the lines of one kind, without comments."""
        found = [self.bodies[i] for i in np.flatnonzero(self.kinds == kind)]
        return [body.split(b"#", 1)[0] if b"#" in body else body for body in found]

    def count_before(self, kind: int) -> IntArray:
        """How many lines of one kind stand before each face, (n_faces,)."""
        return np.asarray(np.cumsum(self.kinds == kind)[self.kinds == _FACE], dtype=np.int64)


@dataclass(frozen=True)
class _Corners:
    """Corners of all faces: zero-based indices, -1 for none, and how many corners each face has."""

    vertex: IntArray
    texture: IntArray
    normal: IntArray
    sizes: IntArray


def read_obj(data: bytes, limits: ReadLimits) -> Scan:
    """Read an OBJ file.

    Parameters
    ----------
    data : bytes
        The whole file.
    limits : ReadLimits

    Raises
    ------
    MeshError
        ReadError, EmptyMeshError, NotFiniteError, IndexRangeError or TooLargeError.
    """
    text, codec = decode_text(data)
    lines = _split(text)
    limits.check_vertices(int((lines.kinds == _VERTEX).sum()))
    vertices, colours = _parse_vertices(lines.of(_VERTEX))
    check_vertices(vertices)
    texture = _parse_table(lines.of(_TEXTURE), "vt", 1, 2)
    normals = _parse_table(lines.of(_NORMAL), "vn", 3, 3)
    corners = _parse_faces(lines, (len(vertices), len(texture), len(normals)))
    triangles, places, face = _cut(vertices, corners)
    check_triangles(triangles, limits)
    source = ObjSource(
        data=data,
        codec=codec,
        colours=colours,
        texture=texture,
        normals=normals,
        corner_texture=corners.texture[places],
        corner_normal=corners.normal[places],
        materials=[body.strip() for body in _raw(lines, _MATERIAL)],
        triangle_material=(lines.count_before(_MATERIAL) - 1)[face],
    )
    return Scan(vertices, triangles, "obj", source=source)


def _split(text: bytes) -> _Lines:
    if b"\\" in text:
        text = re.sub(rb"\\[ \t]*(\r\n|\n|\r)", b" ", text)
    parts = [line.split(None, 1) for line in text.splitlines()]
    kinds = [_KEYWORDS.get(part[0], 0) if part else 0 for part in parts]
    return _Lines([part[1] if len(part) > 1 else b"" for part in parts], np.array(kinds, dtype=np.int64))


def _raw(lines: _Lines, kind: int) -> list[bytes]:
    return [lines.bodies[i] for i in np.flatnonzero(lines.kinds == kind)]


def _parse_vertices(bodies: list[bytes]) -> tuple[Vertices, FloatArray | None]:
    """Coordinates, and colours of those vertices that have six numbers or more; a fourth number is a weight."""
    table = _parse_table(bodies, "v", 3, 6)
    colours = table[:, 3:]
    return np.ascontiguousarray(table[:, :3]), None if np.isnan(colours).any(axis=1).all() else colours


def _parse_table(bodies: list[bytes], keyword: str, least: int, width: int) -> FloatArray:
    """First numbers of each line, (n, width) float64, NaN where a line has fewer."""
    words = np.array([len(body.split()) for body in bodies], dtype=np.int64)
    if (words < least).any():
        line = int(np.argmax(words < least))
        raise ReadError(f"OBJ line `{keyword}` number {line + 1} has {words[line]} numbers instead of {least}")
    numbers = parse_numbers(b"\n".join(bodies))
    if len(words) and (words == words[0]).all() and words[0] >= width:
        return numbers.reshape(len(words), -1)[:, :width]
    starts = np.cumsum(words) - words
    table = np.full((len(words), width), np.nan)
    for column in range(width):
        has = words > column
        table[has, column] = numbers[starts[has] + column]
    return table


def _parse_faces(lines: _Lines, counts: tuple[int, int, int]) -> _Corners:
    bodies = lines.of(_FACE)
    if not bodies:
        raise EmptyMeshError("the OBJ file has no face: points and lines are no surface")
    sizes = np.array([len(body.split()) for body in bodies], dtype=np.int64)
    joined = b" ".join(bodies)
    if b"/" in joined:
        # An index that is left out is written as 0, which OBJ uses for nothing else.
        joined = re.sub(rb"/(?=[\s/]|$)", b"/0", joined)
    slashes = np.array([word.count(b"/") for word in joined.split()], dtype=np.int64)
    if (slashes > 2).any():
        raise ReadError("an OBJ face has a corner of more than three indices")
    numbers = parse_integers(joined.replace(b"/", b" "), "OBJ faces")
    starts = np.cumsum(slashes + 1) - slashes - 1
    if len(numbers) != len(slashes) + slashes.sum():
        raise ReadError("an OBJ face has a corner without a vertex")
    columns = []
    for column, kind in enumerate((_VERTEX, _TEXTURE, _NORMAL)):
        has = slashes >= column
        raw = np.zeros(len(starts), dtype=np.int64)
        raw[has] = numbers[starts[has] + column]
        before = np.repeat(lines.count_before(kind), sizes)
        columns.append(np.where(raw > 0, raw - 1, np.where(raw < 0, before + raw, -1)))
    vertex, texture, normal = columns
    if (numbers[starts] == 0).any():
        raise IndexRangeError("an OBJ face names vertex 0; the first vertex is 1")
    check_indices(vertex, counts[0])
    # Wrong texture and normal indices do not touch the geometry: such corners count as bare.
    return _Corners(vertex, _in_range(texture, counts[1]), _in_range(normal, counts[2]), sizes)


def _in_range(indices: IntArray, count: int) -> IntArray:
    return np.where((indices >= 0) & (indices < count), indices, -1)


def _cut(vertices: Vertices, corners: _Corners) -> tuple[Triangles, IntArray, IntArray]:
    """Triangles, the places of their corners among all corners, and the face of each triangle."""
    numbered = np.arange(len(corners.vertex), dtype=np.int64)
    points = vertices if (corners.sizes == 3).all() else vertices[corners.vertex]
    places, face = triangulate_polygons(points, corners.sizes, numbered)
    return corners.vertex[places], places, face

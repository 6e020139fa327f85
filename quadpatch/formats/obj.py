"""OBJ: reading.

Read are `v` (with colours behind the coordinates), `vt`, `vn` and `f` with polygons, negative indices, line
continuations and any text encoding that has a byte order mark. Materials are names; their libraries are opened where a
repair asks for images (`quadpatch.formats.obj_materials`).
Lines of other keywords mean nothing to a repair and come back as they were (see `obj_source`).
"""

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from quadpatch.errors import EmptyMeshError, IndexRangeError, ReadError
from quadpatch.formats.limits import ReadLimits, check_indices, check_triangles, check_vertices
from quadpatch.formats.lines import Lines
from quadpatch.formats.obj_source import ObjSource
from quadpatch.formats.obj_statements import (
    FACE,
    LIBRARY,
    MATERIAL,
    NORMAL,
    TEXTURE,
    VERTEX,
    ObjStatements,
    split_statements,
)
from quadpatch.formats.polygons import triangulate_polygons
from quadpatch.formats.scan import Scan
from quadpatch.formats.text import decode_text, parse_integers, word_starts
from quadpatch.types import FloatArray, IntArray, Triangles, Vertices

_SLASH = 47


@dataclass(frozen=True)
class _Corners:
    """Corners of all faces: zero-based indices, -1 for none, and how many corners each face has."""

    vertex: IntArray
    texture: IntArray
    normal: IntArray
    sizes: IntArray


def read_obj(data: bytes, limits: ReadLimits, folder: Path | None = None) -> Scan:
    """Read an OBJ file.

    Parameters
    ----------
    data : bytes
        The whole file.
    limits : ReadLimits
    folder : Path, optional
        Where material libraries and images may lie; None allows none.

    Raises
    ------
    MeshError
        ReadError, EmptyMeshError, NotFiniteError, IndexRangeError or TooLargeError.
    """
    text, codec = decode_text(data)
    statements = split_statements(text)
    limits.check_vertices(int((statements.kinds == VERTEX).sum()))
    vertices, colours = _parse_vertices(statements.of(VERTEX))
    check_vertices(vertices, limits.allow_missing)
    texture = _parse_table(statements.of(TEXTURE), "vt", 1, 2)
    normals = _parse_table(statements.of(NORMAL), "vn", 3, 3)
    corners = _parse_faces(statements, (len(vertices), len(texture), len(normals)))
    triangles, places, face = _cut(vertices, corners)
    check_triangles(triangles, limits)
    materials, libraries = statements.of(MATERIAL), statements.of(LIBRARY)
    source = ObjSource(
        data=data,
        codec=codec,
        colours=colours,
        texture=texture,
        normals=normals,
        corner_texture=corners.texture[places],
        corner_normal=corners.normal[places],
        materials=[materials.text(line).strip() for line in range(len(materials.starts))],
        triangle_material=(statements.count_before(MATERIAL) - 1)[face],
        libraries=[libraries.text(line).strip() for line in range(len(libraries.starts))],
        folder=folder,
    )
    return Scan(vertices, triangles, "obj", source=source)


def _parse_vertices(lines: Lines) -> tuple[Vertices, FloatArray | None]:
    """Coordinates, and colours of those vertices that have six numbers or more; a fourth number is a weight."""
    table = _parse_table(lines, "v", 3, 6)
    colours = table[:, 3:]
    return np.ascontiguousarray(table[:, :3]), None if np.isnan(colours).any(axis=1).all() else colours


def _parse_table(lines: Lines, keyword: str, least: int, width: int) -> FloatArray:
    """First numbers of each line, (n, width) float64, NaN where a line has fewer."""
    words = lines.word_counts()
    if (words < least).any():
        line = int(np.argmax(words < least))
        raise ReadError(f"OBJ line `{keyword}` number {line + 1} has {words[line]} numbers instead of {least}")
    numbers = lines.numbers()
    if len(words) and (words == words[0]).all() and words[0] >= width:
        return numbers.reshape(len(words), -1)[:, :width]
    starts = np.cumsum(words) - words
    table = np.full((len(words), width), np.nan)
    for column in range(width):
        has = words > column
        table[has, column] = numbers[starts[has] + column]
    return table


def _parse_faces(statements: ObjStatements, counts: tuple[int, int, int]) -> _Corners:
    lines = statements.of(FACE)
    sizes = lines.word_counts()
    if sizes.sum() == 0:
        raise EmptyMeshError("the OBJ file has no face: points and lines are no surface")
    text = lines.joined()
    if b"/" in text:
        # An index that is left out is written as 0, which OBJ uses for nothing else.
        text = re.sub(rb"/(?=[\s/]|$)", b"/0", text)
    slashes = _slashes_of_words(text)
    if (slashes > 2).any():
        raise ReadError("an OBJ face has a corner of more than three indices")
    numbers = parse_integers(text.replace(b"/", b" "), "OBJ faces")
    starts = np.cumsum(slashes + 1) - slashes - 1
    if len(numbers) != len(slashes) + slashes.sum():
        raise ReadError("an OBJ face has a corner without a vertex")
    columns = []
    for column, kind in enumerate((VERTEX, TEXTURE, NORMAL)):
        has = slashes >= column
        raw = np.zeros(len(starts), dtype=np.int64)
        raw[has] = numbers[starts[has] + column]
        before = np.repeat(statements.count_before(kind), sizes)
        columns.append(np.where(raw > 0, raw - 1, np.where(raw < 0, before + raw, -1)))
    vertex, texture, normal = columns
    if (numbers[starts] == 0).any():
        raise IndexRangeError("an OBJ face names vertex 0; the first vertex is 1")
    check_indices(vertex, counts[0])
    # Wrong texture and normal indices do not touch the geometry: such corners count as bare.
    return _Corners(vertex, _in_range(texture, counts[1]), _in_range(normal, counts[2]), sizes)


def _slashes_of_words(text: bytes) -> IntArray:
    raw = np.frombuffer(text, np.uint8)
    slashes = np.flatnonzero(raw == _SLASH)
    # Slashes stand inside words, so those in front of the next word are those of this one.
    before = np.searchsorted(slashes, word_starts(raw))
    return np.diff(before, append=len(slashes))


def _in_range(indices: IntArray, count: int) -> IntArray:
    return np.where((indices >= 0) & (indices < count), indices, -1)


def _cut(vertices: Vertices, corners: _Corners) -> tuple[Triangles, IntArray, IntArray]:
    """Triangles, the places of their corners among all corners, and the face of each triangle."""
    numbered = np.arange(len(corners.vertex), dtype=np.int64)
    points = vertices if (corners.sizes == 3).all() else vertices[corners.vertex]
    places, face = triangulate_polygons(points, corners.sizes, numbered)
    return corners.vertex[places], places, face

"""Reading PLY: ascii and both binary orders, any elements and properties, polygons and triangle strips.

The vertices are the `vertex` element; the triangles are those of `face` and of `tristrips`, in the order in which the
file holds them. Everything else in the file is kept as bytes, and the writer hands it back.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from quadpatch.errors import EmptyMeshError, FormatError, ReadError
from quadpatch.formats.limits import ReadLimits, check_indices, check_triangles, check_vertices, to_float64
from quadpatch.formats.marks import next_hole_id
from quadpatch.formats.ply.ascii import read_ascii_body
from quadpatch.formats.ply.binary import read_binary_body
from quadpatch.formats.ply.file import INDEX_NAMES, PlyFile
from quadpatch.formats.ply.header import Element, parse_header
from quadpatch.formats.ply.moved_rows import move_in_ply
from quadpatch.formats.ply.rows import Rows
from quadpatch.formats.ply.texture_files import page_file, ply_surface_texture
from quadpatch.formats.ply.vertex_attributes import ply_vertex_attributes, ply_vertex_colours
from quadpatch.formats.ply.writer import append_to_ply
from quadpatch.formats.polygons import triangulate_polygons, triangulate_strips
from quadpatch.formats.scan import Fill, Moved, Scan, VertexAttributes
from quadpatch.formats.surface_texture import SurfaceTexture, TexturePage
from quadpatch.mesh.passes import parts_of
from quadpatch.types import FloatArray, IntArray, Triangles, Vertices

# Vertices that are looked at together.
_CHUNK = 1 << 15


@dataclass(frozen=True)
class PlySource:
    """A PLY file as it was read, and where its texture images may lie."""

    file: PlyFile
    folder: Path | None = None

    def append(self, scan: Scan, fill: Fill) -> Iterator[bytes | memoryview]:
        """Hand the file back with rows appended."""
        return append_to_ply(scan, self.file, fill)

    def move(self, scan: Scan, moved: Moved) -> bytes:
        """Hand the file back with vertices at other positions."""
        return move_in_ply(scan, self.file, moved)

    def vertex_colours(self, scan: Scan) -> FloatArray | None:
        """Say what colours the file has."""
        return ply_vertex_colours(self.file)

    def vertex_attributes(self, scan: Scan) -> VertexAttributes:
        """Say what colours, normals and texture coordinates the file has."""
        return ply_vertex_attributes(scan, self.file)

    def surface_texture(self, scan: Scan) -> SurfaceTexture | None:
        """Images that comments name."""
        return ply_surface_texture(self.file, self.folder)

    def side_files(self, page: TexturePage) -> dict[str, bytes]:
        """Return the page."""
        return {page_file(page): page.png}


def read_ply(data: bytes, limits: ReadLimits, folder: Path | None = None) -> Scan:
    """Read a PLY file.

    Parameters
    ----------
    data : bytes
        The whole file.
    limits : ReadLimits
    folder : Path, optional
        Where texture images may lie; None allows none.

    Raises
    ------
    MeshError
        ReadError, FormatError, EmptyMeshError, NotFiniteError, IndexRangeError or TooLargeError.
    """
    header = parse_header(data)
    for element in header.elements:
        _check_count(element, limits)
    rows = read_ascii_body(data, header) if header.is_ascii else read_binary_body(data, header)
    by_name = {read.element.name: read for read in rows}
    vertices = _vertices(by_name.get("vertex"))
    check_vertices(vertices, limits.allow_missing)
    triangles, polygon, carrier = _triangles(by_name, vertices)
    check_triangles(triangles, limits)
    file = PlyFile(data, header, rows, carrier, polygon, len(triangles))
    marks = [column for read in rows if (column := read.scalar("hole_id")) is not None]
    return Scan(vertices, triangles, "ply", source=PlySource(file, folder), next_hole_id=next_hole_id(marks))


def _check_count(element: Element, limits: ReadLimits) -> None:
    if element.name == "vertex":
        limits.check_vertices(element.count)
    else:
        limits.check_triangles(element.count)


def _vertices(rows: Rows | None) -> Vertices:
    if rows is None:
        raise EmptyMeshError("the PLY file has no element `vertex`")
    columns = [column for name in "xyz" if (column := rows.scalar(name)) is not None]
    if len(columns) < 3:
        raise ReadError("the PLY element `vertex` lacks a number x, y or z")
    vertices = np.empty((len(columns[0]), 3))
    # Column after column of a few rows at a time: a whole column touches all memory of the others.
    for part in parts_of(len(vertices), _CHUNK):
        for axis, column in enumerate(columns):
            vertices[part, axis] = to_float64(column[part])
    return vertices


def _triangles(by_name: dict[str, Rows], vertices: Vertices) -> tuple[Triangles, IntArray | None, str]:
    pieces: list[Triangles] = []
    face_rows: list[IntArray | None] = []
    carrier = ""
    for name, rows in by_name.items():
        if name not in ("face", "tristrips"):
            continue
        corners = rows.list_column(*INDEX_NAMES)
        if corners is None:
            raise ReadError(f"the PLY element `{name}` has no list {' or '.join(INDEX_NAMES)}")
        carrier = name
        indices = corners.whole_numbers()
        if name == "face":
            check_indices(indices, len(vertices))
            if (corners.counts == 3).all():
                triangles, row = indices.reshape(-1, 3), None
            else:
                triangles, row = triangulate_polygons(vertices, corners.counts, indices)
        else:
            check_indices(indices[indices >= 0], len(vertices))
            triangles = triangulate_strips(corners.counts, indices)
            row = np.full(len(triangles), -1, dtype=np.int64)
        pieces.append(triangles)
        face_rows.append(row)
    if not pieces:
        _raise_no_faces(by_name)
    if len(pieces) == 1:
        return pieces[0], face_rows[0], carrier
    rows_of = [np.arange(len(piece)) if row is None else row for piece, row in zip(pieces, face_rows, strict=True)]
    return np.concatenate(pieces), np.concatenate(rows_of), carrier


def _raise_no_faces(by_name: dict[str, Rows]) -> None:
    if "range_grid" in by_name:
        raise FormatError("the PLY file holds a range grid and no faces: triangulate it before it is sent")
    raise EmptyMeshError("the PLY file has vertices but no element `face` or `tristrips`: a point cloud is no mesh")

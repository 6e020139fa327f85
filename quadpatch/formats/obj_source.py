"""An OBJ file as it was read, and its way back with lines appended, or with vertices at other positions.

All lines stay. Behind them come the new `v`, `vt` and `vn` lines and a group `quadpatch_filled` with the new faces,
which use the material of the nearest measured face. New vertices have colours where the measured ones do; new faces
have texture coordinates and normals where the faces around their hole do. With a texture page they use copies of the
materials, in a library of their own.

Where vertices move, the numbers of their `v` lines change, and those of the `vn` lines that a corner at one of them
names: they become the mean normal of all faces whose corners name them.

Tested in `tests/quadpatch/formats/test_obj.py`.
"""

from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import numpy as np

from quadpatch.formats.attributes import extend_colours, nearest_rim_triangle, normals_at
from quadpatch.formats.moved_normals import normals_of_groups
from quadpatch.formats.obj_materials import (
    ObjMaterial,
    coordinates_in_images,
    library_with_page,
    page_name,
    read_materials,
)
from quadpatch.formats.obj_statements import NORMAL, VERTEX, split_statements
from quadpatch.formats.scan import Fill, Moved, Scan, VertexAttributes
from quadpatch.formats.surface_texture import SurfaceTexture, TexturePage
from quadpatch.formats.text import decode_text, encode_like, line_end_of, to_lines
from quadpatch.formats.texture import extend_over_corners
from quadpatch.formats.words import replace_numbers, words_from
from quadpatch.types import BoolArray, FloatArray, IntArray

GROUP = "quadpatch_filled"


@dataclass(frozen=True)
class ObjSource:
    """An OBJ file as it was read.

    Attributes
    ----------
    data : bytes
        The whole file.
    codec : str
        Encoding of its text.
    colours : (n, 3) float64 or None
        Behind the coordinates of the vertices, NaN where a vertex has none.
    texture : (n_vt, 2) float64
    normals : (n_vn, 3) float64
    corner_texture, corner_normal : (m, 3) int64
        Zero-based, -1 for none.
    materials : list of bytes
        Names, one for each `usemtl` line.
    triangle_material : (m,) int64
        Into `materials`, -1 for none.
    libraries : list of bytes
        What stands in each `mtllib` line.
    folder : Path or None
        Where these may lie; None allows none.
    """

    data: bytes
    codec: str
    colours: FloatArray | None
    texture: FloatArray
    normals: FloatArray
    corner_texture: IntArray
    corner_normal: IntArray
    materials: list[bytes]
    triangle_material: IntArray
    libraries: list[bytes] = field(default_factory=list)
    folder: Path | None = None

    def vertex_attributes(self, scan: Scan) -> VertexAttributes:
        """Colours, normals of the first corner that names each vertex, and texture coordinates."""
        texture = self._texture_of_corners() if len(self.texture) else None
        normals = None
        if (self.corner_normal >= 0).any():
            first = self._first_normal(scan, len(scan.vertices))
            normals = np.where(first[:, np.newaxis] >= 0, self.normals[first], 0.0)
        return VertexAttributes(self.vertex_colours(scan), normals, texture)

    def vertex_colours(self, scan: Scan) -> FloatArray | None:
        """Colours behind the coordinates."""
        if self.colours is None:
            return None
        scaled = self.colours * (255.0 / self._top_colour())
        return np.concatenate([scaled, np.full((len(scaled), 1), 255.0)], axis=1)

    def _top_colour(self) -> float:
        """Full intensity: colours are fractions of 1, or whole numbers up to 255."""
        return 1.0 if self.colours is None or np.nanmax(self.colours) <= 1 else 255.0

    def _texture_of_corners(self) -> FloatArray:
        has = self.corner_texture >= 0
        texture = np.full((*self.corner_texture.shape, 2), np.nan)
        texture[has] = np.nan_to_num(self.texture)[self.corner_texture[has]]
        return texture

    def _first_normal(self, scan: Scan, n_vertices: int) -> IntArray:
        """Return the normal index of the first corner that names each vertex, -1 for none."""
        first = np.full(n_vertices, -1, dtype=np.int64)
        vertex, normal = scan.triangles.ravel()[::-1], self.corner_normal.ravel()[::-1]
        first[vertex[normal >= 0]] = normal[normal >= 0]
        return first

    def surface_texture(self, scan: Scan) -> SurfaceTexture | None:
        """Images of the materials' colours; a material is one name."""
        if not len(self.texture) or not self.materials or not self.libraries:
            return None
        found = [material for _, material in self._materials_by_number]
        number = {name: i for i, (name, _) in enumerate(self._materials_by_number)}
        of_line = np.array([number.get(name, -1) for name in self.materials] + [-1])
        material = of_line[self.triangle_material]
        coordinates = coordinates_in_images(self._texture_of_corners(), material, found)
        return SurfaceTexture(coordinates, material, tuple(entry.image for entry in found))

    @cached_property
    def _materials_by_number(self) -> list[tuple[bytes, ObjMaterial]]:
        """Materials of the libraries that the file uses, in the order in which it does."""
        known = read_materials(self.libraries, self.folder)
        return [(name, known[name]) for name in dict.fromkeys(self.materials) if name in known]

    def side_files(self, page: TexturePage) -> dict[str, bytes]:
        """Return the page, and a library with the materials that have it."""
        used = [self._materials_by_number[i] for i in sorted({*page.material.tolist()} - {-1})]
        return {f"{page.stem}.png": page.png, f"{page.stem}.mtl": library_with_page(used, page)}

    def move(self, scan: Scan, moved: Moved) -> bytes:
        """Replace the numbers of vertices that moved, and those of their normals."""
        text, codec = decode_text(self.data)
        statements = split_statements(text)
        is_moved = moved.is_moved(scan)
        normals, is_stale = self._moved_normals(scan, moved, is_moved)
        spans = [words_from(lines.raw, lines.starts, 3) for lines in map(statements.of, (VERTEX, NORMAL))]
        new = replace_numbers(
            text,
            (np.concatenate([span[0] for span in spans]), np.concatenate([span[1] for span in spans])),
            np.concatenate([scan.vertices, self.normals]),
            np.concatenate([moved.vertices, normals]),
            np.concatenate([is_moved, is_stale]),
        )
        return encode_like(self.data, new, codec)

    def _moved_normals(self, scan: Scan, moved: Moved, is_moved: BoolArray) -> tuple[FloatArray, BoolArray]:
        """Return the normals (n_vn, 3) at the new positions, and which of them a corner at a moved vertex names."""
        is_stale = np.zeros(len(self.normals), dtype=bool)
        named = is_moved[scan.triangles] & (self.corner_normal >= 0)
        if not named.any():
            return self.normals, is_stale
        fresh = normals_of_groups(scan, self.corner_normal, self.normals, moved)
        is_stale[self.corner_normal[named]] = True
        return fresh, is_stale & fresh.any(axis=1)

    def append(self, scan: Scan, fill: Fill) -> bytes:
        """Append lines to the file."""
        line_end = line_end_of(decode_text(self.data)[0])
        texture_lines, texture = self._texture(scan, fill, line_end)
        normal_lines, normal = self._normals(scan, fill, line_end)
        faces = face_lines(fill.triangles + 1, texture, normal, line_end)
        materials = self._materials(scan, fill)
        text = [self._vertex_lines(fill, line_end).encode(), texture_lines.encode(), normal_lines.encode()]
        if fill.page is not None:
            text.append(f"mtllib {fill.page.stem}.mtl{line_end}".encode())
        text.append(f"g {GROUP}{line_end}".encode())
        current = b""
        for face, material in zip(faces, materials, strict=True):
            if material not in (current, b""):
                text.append(b"usemtl " + material + line_end.encode())
                current = material
            text.append(face.encode())
        return self._behind(b"".join(text), line_end)

    def _behind(self, text: bytes, line_end: str) -> bytes:
        encoded_end = line_end.encode(self.codec)
        gap = b"" if self.data.endswith(encoded_end) or not self.data else encoded_end
        # Names in an older 8-bit encoding pass through as they are where the file is no UTF-16.
        encoded = text if self.codec == "utf-8" else text.decode().encode(self.codec)
        return self.data + gap + encoded

    def _materials(self, scan: Scan, fill: Fill) -> list[bytes]:
        """Name of the material of each new triangle, empty for none."""
        nearest = self.triangle_material[nearest_rim_triangle(scan, fill)].tolist()
        names = [self.materials[i] if i >= 0 else b"" for i in nearest]
        if fill.page is None:
            return names
        painted = fill.page.material.tolist()
        copies = {i: page_name(self._materials_by_number[i][0], fill.page) for i in {*painted} - {-1}}
        return [copies.get(i, name) for i, name in zip(painted, names, strict=True)]

    def _vertex_lines(self, fill: Fill, line_end: str) -> str:
        if self.colours is None:
            return to_lines("v", fill.vertices, line_end)
        colours = np.round(extend_colours(fill, self.colours, self._top_colour()), 6)
        return to_lines("v", np.concatenate([fill.vertices, colours], axis=1), line_end)

    def _texture(self, scan: Scan, fill: Fill, line_end: str) -> tuple[str, IntArray]:
        """Lines `vt`, and the one-based index of each new corner, 0 for none."""
        index = np.zeros(fill.triangles.shape, dtype=np.int64)
        if not (self.corner_texture >= 0).any():
            return "", index
        extended = extend_over_corners(scan, fill, self._texture_of_corners())
        if fill.page is not None:
            extended = np.where(np.isfinite(fill.page.coordinates), fill.page.coordinates, extended)
        has = np.asarray(np.isfinite(extended).all(axis=2))
        keys = np.column_stack([fill.triangles[has].astype(np.float64), extended[has]])
        points, inverse = np.unique(keys, axis=0, return_inverse=True)
        index[has] = len(self.texture) + 1 + inverse.reshape(-1)
        # A face has texture at all corners or at none.
        index[~has.all(axis=1)] = 0
        return to_lines("vt", np.round(points[:, 1:], 9), line_end), index

    def _normals(self, scan: Scan, fill: Fill, line_end: str) -> tuple[str, IntArray]:
        """Lines `vn`, and the one-based index of each new corner, 0 for none; rim vertices keep their normal."""
        if not (self.corner_normal >= 0).any():
            return "", np.zeros(fill.triangles.shape, dtype=np.int64)
        first = self._first_normal(scan, len(scan.vertices) + len(fill.vertices))
        used = np.unique(fill.triangles)
        bare = used[first[used] < 0]
        first[bare] = len(self.normals) + np.arange(len(bare))
        return to_lines("vn", np.round(normals_at(scan, fill, bare), 9), line_end), first[fill.triangles] + 1


def face_lines(vertex: IntArray, texture: IntArray, normal: IntArray, line_end: str) -> list[str]:
    """Write lines `f` of one-based indices; 0 leaves an index out."""
    if not texture.any() and not normal.any():
        return to_lines("f", vertex, line_end).splitlines(keepends=True)
    lines = []
    for corners in zip(vertex.tolist(), texture.tolist(), normal.tolist(), strict=True):
        words = [_corner(*corner) for corner in zip(*corners, strict=True)]
        lines.append("f " + " ".join(words) + line_end)
    return lines


def _corner(vertex: int, texture: int, normal: int) -> str:
    if normal:
        return f"{vertex}/{texture or ''}/{normal}"
    return f"{vertex}/{texture}" if texture else str(vertex)

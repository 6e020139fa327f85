"""A 3MF package as it was read, and its way back with a fill added.

All entries stay, and in the models all text. A hole of an object that is built once is closed in that object: new
`vertex` and `triangle` elements stand behind its own, so what was a solid with a hole is a solid. An object that is
built several times can't be changed for one of its places; its fills become an object `quadpatch_filled` of type
`surface`. New triangles carry `hole` and `confidence` in the namespace `urn:quadpatch`, which other programs skip, and
the material or colour of the nearest measured triangle, or a place in a texture page.
"""

import re
from dataclasses import dataclass

import numpy as np

from quadpatch.formats.attributes import joined_vertices, nearest_rim_triangle
from quadpatch.formats.scan import Fill, Moved, Scan, VertexAttributes, WithoutImages
from quadpatch.formats.scene_parts import Part, PartFill, split_by_part
from quadpatch.formats.surface_texture import SurfaceTexture, TexturePage
from quadpatch.formats.text import to_words
from quadpatch.formats.threemf.images import entries_of_page, free_id, page_resources, threemf_surface_texture
from quadpatch.formats.threemf.model import Model, ModelObject
from quadpatch.formats.threemf.moved_vertices import move_in_threemf
from quadpatch.formats.threemf.package import Package
from quadpatch.types import FloatArray, IntArray, Triangles, Vertices

FILL_NAME = "quadpatch_filled"
_CORE = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"


@dataclass(frozen=True)
class Origin:
    """Where a part comes from: path of its model part, id of its object."""

    path: str
    object_id: str


@dataclass(frozen=True)
class ThreemfSource(WithoutImages):
    """A 3MF package as it was read.

    Attributes
    ----------
    package : Package
    models : dict
        Model parts by path.
    parts : list of Part
        Objects with a mesh, as often as they are built.
    origins : list of Origin
        One for each part.
    """

    package: Package
    models: dict[str, Model]
    parts: list[Part]
    origins: list[Origin]

    def _entry(self, part: int) -> ModelObject:
        origin = self.origins[part]
        return self.models[origin.path].objects[origin.object_id]

    def vertex_attributes(self, scan: Scan) -> VertexAttributes:
        """Colours alone."""
        return VertexAttributes(self.vertex_colours(scan))

    def vertex_colours(self, scan: Scan) -> FloatArray | None:
        """Colour that the first triangle gives each vertex, from colour groups and base materials."""
        if not any(model.colours for model in self.models.values()):
            return None
        colours = np.full((len(scan.vertices), 4), np.nan)
        for number, part in enumerate(self.parts):
            table = colours[part.first : part.first + len(part.vertices)]
            groups = self.models[self.origins[number].path].colours
            _colour_vertices(self._entry(number), groups, table)
        return None if np.isnan(colours).all() else colours

    def surface_texture(self, scan: Scan) -> SurfaceTexture | None:
        """Images of groups of texture coordinates."""
        entries = [
            (origin.path, self._entry(number), self.parts[number].is_mirrored)
            for number, origin in enumerate(self.origins)
        ]
        return threemf_surface_texture(self.package, self.models, entries)

    def move(self, scan: Scan, moved: Moved) -> bytes:
        """Hand the package back with vertices at other positions."""
        return move_in_threemf(self, scan, moved)

    def append(self, scan: Scan, fill: Fill) -> bytes:
        """Add the fill to the objects that have the holes."""
        inserts: dict[str, list[tuple[int, str]]] = {}
        properties = self._properties(scan, fill)
        pieces = split_by_part(scan, fill, self.parts) if len(fill.triangles) else []
        in_objects = [piece for piece in pieces if self.origins.count(self.origins[piece.part]) == 1]
        added = {} if fill.page is None else self._add_page(in_objects, fill.page, inserts, properties)
        for piece in in_objects:
            inserts.setdefault(self.origins[piece.part].path, []).extend(self._in_object(piece, fill, properties))
        root = self.package.root
        for piece in pieces:
            if self.origins.count(self.origins[piece.part]) > 1:
                inserts.setdefault(root, []).extend(self._own_object(piece, scan, fill, len(inserts.get(root, []))))
        models = {path: _insert(self.models[path].text, at) for path, at in inserts.items()}
        return self.package.with_changed({**models, **added})

    def _add_page(
        self,
        pieces: list[PartFill],
        page: TexturePage,
        inserts: dict[str, list[tuple[int, str]]],
        properties: list[str],
    ) -> dict[str, bytes]:
        """Add a page to the model parts whose objects have fills on it; returns the further entries of the package."""
        is_on_page = page.material >= 0
        paths = [self.origins[piece.part].path for piece in pieces if is_on_page[piece.rows].any()]
        for path in dict.fromkeys(paths):
            model = self.models[path]
            group = free_id(model.text) + 1
            rows, corners = self._on_page([p for p in pieces if self.origins[p.part].path == path], page)
            places, index = np.unique(corners.reshape(-1, 2), axis=0, return_inverse=True)
            inserts.setdefault(path, []).append((model.resources_start, page_resources(places, page, group - 1)))
            for row, (p1, p2, p3) in zip(rows.tolist(), index.reshape(-1, 3).tolist(), strict=True):
                properties[row] = f' pid="{group}" p1="{p1}" p2="{p2}" p3="{p3}"'
        return entries_of_page(self.package, page, list(dict.fromkeys(paths))) if paths else {}

    def _on_page(self, pieces: list[PartFill], page: TexturePage) -> tuple[IntArray, FloatArray]:
        """Rows (k,) of fills that lie on a page, and their coordinates (k, 3, 2) as the parts turn their triangles."""
        rows = [piece.rows[page.material[piece.rows] >= 0] for piece in pieces]
        orders = [[0, 2, 1] if self.parts[piece.part].is_mirrored else [0, 1, 2] for piece in pieces]
        corners = [page.coordinates[chosen][:, order] for chosen, order in zip(rows, orders, strict=True)]
        return np.concatenate(rows), np.concatenate(corners)

    def _in_object(self, piece: PartFill, fill: Fill, properties: list[str]) -> list[tuple[int, str]]:
        part, entry = self.parts[piece.part], self._entry(piece.part)
        text = self.models[self.origins[piece.part].path].text
        own = (piece.vertex >= part.first) & (piece.vertex < part.first + len(part.vertices))
        number = np.where(own, piece.vertex - part.first, len(part.vertices) + np.cumsum(~own) - 1)
        prefix = _prefix(text, entry.triangles_end)
        triangles = _triangle_text(number[piece.triangles], piece, fill, prefix, properties)
        return [
            (entry.vertices_end, _vertex_text(piece.positions[~own], prefix)),
            (entry.triangles_end, triangles),
        ]

    def _own_object(self, piece: PartFill, scan: Scan, fill: Fill, so_far: int) -> list[tuple[int, str]]:
        root = self.models[self.package.root]
        # A page has two ids.
        number = free_id(root.text) + (0 if fill.page is None else 2) + so_far
        # In the coordinates of the scene, with the triangles turned as the fill has them.
        vertex, corners = np.unique(fill.triangles[piece.rows], return_inverse=True)
        positions = joined_vertices(scan, fill)[vertex]
        triangles = _triangle_text(corners.reshape(-1, 3), piece, fill, "", None)
        mesh = f"<vertices>{_vertex_text(positions, '')}</vertices><triangles>{triangles}</triangles>"
        entry = f'<object xmlns="{_CORE}" id="{number}" name="{FILL_NAME}" type="surface"><mesh>{mesh}</mesh></object>'
        return [(root.resources_end, entry), (root.build_end, f'<item xmlns="{_CORE}" objectid="{number}"/>')]

    def _properties(self, scan: Scan, fill: Fill) -> list[str]:
        """Attributes that give each new triangle the material of the nearest measured one."""
        firsts = np.cumsum([0, *(len(self._entry(i).triangles) for i in range(len(self.parts)))])
        nearest = nearest_rim_triangle(scan, fill)
        part = np.searchsorted(firsts, nearest, side="right") - 1
        texts = []
        for number, row in zip(part.tolist(), (nearest - firsts[part]).tolist(), strict=True):
            pid, p1, _, _ = self._entry(number).properties[row]
            pairs = [("pid", pid), ("p1", p1)]
            texts.append("".join(f' {key}="{value}"' for key, value in pairs if value and value.isdecimal()))
        return texts


def _colour_vertices(entry: ModelObject, groups: dict[str, list[str]], table: FloatArray) -> None:
    known: dict[tuple[str, str], FloatArray | None] = {}
    # Back to front, so that the first triangle of the file stays.
    for corners, (pid, *indices) in zip(entry.triangles[::-1].tolist(), entry.properties[::-1], strict=True):
        group = pid or entry.default_pid
        first = indices[0] or (None if pid else entry.default_index)
        if group is None or first is None:
            continue
        for vertex, index in zip(corners, (first, indices[1] or first, indices[2] or first), strict=True):
            if (group, index) not in known:
                known[group, index] = _parse_colour(groups.get(group, []), index)
            colour = known[group, index]
            if colour is not None:
                table[vertex] = colour


def _parse_colour(group: list[str], index: str) -> FloatArray | None:
    word = group[int(index)] if index.isdecimal() and len(index) < 10 and int(index) < len(group) else ""
    if not re.fullmatch(r"#[0-9A-Fa-f]{6}([0-9A-Fa-f]{2})?", word):
        return None
    return np.array(list(bytes.fromhex((word[1:] + "FF")[:8])), dtype=np.float64)


def _prefix(text: bytes, at: int) -> str:
    """Namespace prefix of the closing tag at a place, with its colon."""
    found = re.match(rb"</([\w.-]+:)?", text[at : at + 100])
    return found.group(1).decode() if found and found.group(1) else ""


def _vertex_text(positions: Vertices, prefix: str) -> str:
    columns = [to_words(column) for column in positions.T]
    return "".join(f'<{prefix}vertex x="{x}" y="{y}" z="{z}"/>' for x, y, z in zip(*columns, strict=True))


def _triangle_text(corners: Triangles, piece: PartFill, fill: Fill, prefix: str, properties: list[str] | None) -> str:
    text = []
    for (a, b, c), row in zip(corners.tolist(), piece.rows.tolist(), strict=True):
        mark = f'q:hole="{fill.triangle_hole_id[row]}" q:confidence="{fill.triangle_confidence[row]:.6g}"'
        material = properties[row] if properties else ""
        text.append(f'<{prefix}triangle v1="{a}" v2="{b}" v3="{c}"{material} xmlns:q="urn:quadpatch" {mark}/>')
    return "".join(text)


def _insert(text: bytes, inserts: list[tuple[int, str]]) -> bytes:
    """Put pieces into a text, those at one place in the order in which they are given."""
    pieces: list[bytes] = []
    at = 0
    for place, piece in sorted(inserts, key=lambda pair: pair[0]):
        pieces += [text[at:place], piece.encode()]
        at = place
    return b"".join([*pieces, text[at:]])

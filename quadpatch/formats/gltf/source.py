"""A glTF file as it was read, and its way back with a fill added.

The document, its buffers and everything in them stay. Each node whose mesh has a filled hole gets a child node and
mesh called `quadpatch_filled`, in the node's own coordinates, with one primitive for each material around the holes.
The new primitives have normals, colours and texture coordinates where their surroundings have them, and the attributes
`_HOLE_ID` and `_CONFIDENCE` on every vertex. Those on a texture page have copies of the materials around, with the page
for their base colour and without other images. Rim vertices are repeated with the bits they have in the measured mesh.
"""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from quadpatch.formats.attributes import extend_colours, nearest_rim_triangle
from quadpatch.formats.gltf.container import GltfFile, dump_gltf
from quadpatch.formats.gltf.images import add_page_materials, gltf_surface_texture
from quadpatch.formats.gltf.moved_scene import move_in_gltf
from quadpatch.formats.gltf.primitive import Corners, Store, build_primitive
from quadpatch.formats.scan import Fill, Moved, Scan, VertexAttributes, WithoutImages
from quadpatch.formats.scene_parts import Part, is_invertible, split_by_part
from quadpatch.formats.surface_texture import SurfaceTexture
from quadpatch.formats.texture import extend_over_corners
from quadpatch.mesh.weld import weld
from quadpatch.types import BoolArray, FloatArray, IntArray

FILL_NAME = "quadpatch_filled"


@dataclass(frozen=True)
class Primitive:
    """One placed primitive.

    Attributes
    ----------
    part : int
    vertices, triangles : (int, int)
        First of them in the scan, and how many.
    material : object
        Number of its material as the document has it, None for none.
    attributes : dict
        NORMAL (k, 3), COLOR_0 (k, 3 or 4) and TEXCOORD_0 (k, 2), in the part's coordinates.
    """

    part: int
    vertices: tuple[int, int]
    triangles: tuple[int, int]
    material: object
    attributes: dict[str, FloatArray]

    def shifted(self, part: int, vertices: int, triangles: int) -> "Primitive":
        """Move to a place in the scan."""
        return replace(
            self,
            part=part,
            vertices=(self.vertices[0] + vertices, self.vertices[1]),
            triangles=(self.triangles[0] + triangles, self.triangles[1]),
        )


@dataclass(frozen=True)
class GltfSource(WithoutImages):
    """A glTF file as it was read.

    Attributes
    ----------
    file : GltfFile
    parts : list of Part
        Nodes with a mesh.
    nodes : list of int
        Their numbers in the document.
    primitives : list of Primitive
    """

    file: GltfFile
    parts: list[Part]
    nodes: list[int]
    primitives: list[Primitive]

    def vertex_attributes(self, scan: Scan) -> VertexAttributes:
        """Colours, normals in the scene, and texture coordinates with v upwards."""
        texture = self._gather(scan, "TEXCOORD_0", 2)
        normals = self.scene_normals(scan)
        if texture is not None:
            texture = texture * np.array([1.0, -1.0]) + np.array([0.0, 1.0])
        return VertexAttributes(
            self.vertex_colours(scan),
            None if normals is None else np.nan_to_num(normals),
            None if texture is None else texture[scan.triangles],
        )

    def vertex_colours(self, scan: Scan) -> FloatArray | None:
        """Colours of the vertices."""
        colours = self._gather(scan, "COLOR_0", 4)
        return None if colours is None else colours * 255.0

    def scene_normals(self, scan: Scan) -> FloatArray | None:
        """Return the normals (n, 3) in the scene, NaN where a primitive lacks them; None where all do."""
        return self._gather(scan, "NORMAL", 3, in_scene=True)

    def surface_texture(self, scan: Scan) -> SurfaceTexture | None:
        """Images of base colours."""
        return gltf_surface_texture(self.file, self.primitives, scan)

    def as_binary(self) -> "GltfSource":
        """Return the same as a `.glb`."""
        return replace(self, file=self.file.as_binary())

    def move(self, scan: Scan, moved: Moved) -> bytes:
        """Hand the file back with vertices at other positions."""
        return move_in_gltf(self, scan, moved)

    def _gather(self, scan: Scan, name: str, width: int, in_scene: bool = False) -> FloatArray | None:
        """Join an attribute of all primitives, NaN where one lacks it; None where all do."""
        if not any(name in primitive.attributes for primitive in self.primitives):
            return None
        # Colours of three numbers are opaque: the fourth column stands at 1 before they are put in.
        table = np.full((len(scan.vertices), width), np.nan)
        for primitive in self.primitives:
            if name in primitive.attributes:
                values = primitive.attributes[name]
                if in_scene:
                    values = _turn(values, self.parts[primitive.part].matrix)
                rows = slice(primitive.vertices[0], sum(primitive.vertices))
                table[rows] = 1.0
                table[rows, : values.shape[1]] = values
        return table

    def append(self, scan: Scan, fill: Fill) -> bytes:
        """Add child nodes with the fill."""
        if len(fill.triangles) == 0:
            return dump_gltf(self.file)
        corners = self._corners(scan, fill)
        primitive_of_row = self._primitive_of(nearest_rim_triangle(scan, fill))
        materials = [self.primitives[i].material for i in primitive_of_row.tolist()]
        store = Store.of(self.file)
        if fill.page is not None:
            painted = add_page_materials(store, fill.page)
            materials = [painted.get(old, new) for old, new in zip(fill.page.material.tolist(), materials, strict=True)]
        for piece in split_by_part(scan, fill, self.parts):
            built = []
            for material, rows in self._by_material([materials[row] for row in piece.rows.tolist()]):
                entry = build_primitive(store, piece, rows, corners)
                built.append(entry if material is None else {**entry, "material": material})
            self._attach(store, self.nodes[piece.part], built)
        return dump_gltf(store.finished())

    def _by_material(self, materials: list[object]) -> list[tuple[object, BoolArray]]:
        """Materials and the rows that have each, in order of appearance."""
        different = list(dict.fromkeys(map(str, materials)))
        names = np.array(list(map(str, materials)), dtype=object)
        return [(materials[int(np.argmax(names == name))], np.asarray(names == name)) for name in different]

    def _primitive_of(self, triangles: IntArray) -> IntArray:
        firsts = np.array([primitive.triangles[0] for primitive in self.primitives])
        return np.searchsorted(firsts, triangles, side="right") - 1

    def _corners(self, scan: Scan, fill: Fill) -> Corners:
        """Attributes of all vertices and new corners that the new primitives draw on."""
        colours = self._gather(scan, "COLOR_0", 4)
        if colours is not None:
            colours = np.concatenate([colours, extend_colours(fill, colours, 1.0)])
        texture = self._gather(scan, "TEXCOORD_0", 2)
        extended = None
        if texture is not None:
            # Vertices are repeated along seams of the atlas: joined, each rim vertex finds all its charts.
            welded = weld(scan.vertices, scan.triangles)
            joined = replace(scan, triangles=welded.to_file[welded.from_file[scan.triangles]])
            extended = extend_over_corners(joined, fill, texture[scan.triangles])
            if fill.page is not None:
                # glTF counts v downwards.
                on_page = fill.page.coordinates * np.array([1.0, -1.0]) + np.array([0.0, 1.0])
                extended = np.where(np.isfinite(on_page), on_page, extended)
        normals = self._gather(scan, "NORMAL", 3)
        return Corners(fill, len(scan.vertices), colours, extended, normals)

    @staticmethod
    def _attach(store: Store, parent: int, primitives: list[dict[str, Any]]) -> None:
        mesh = store.add("meshes", {"name": FILL_NAME, "primitives": primitives})
        child = store.add("nodes", {"name": FILL_NAME, "mesh": mesh})
        nodes = store.document["nodes"]
        nodes[parent] = {**nodes[parent], "children": [*nodes[parent].get("children", []), child]}


def _turn(normals: FloatArray, matrix: FloatArray) -> FloatArray:
    """Take normals along with a transform of the surface they stand on."""
    if not is_invertible(matrix):
        return normals
    turned = normals @ np.linalg.inv(matrix[:3, :3])
    lengths = np.linalg.norm(turned, axis=1, keepdims=True)
    return np.asarray(np.divide(turned, lengths, out=np.zeros_like(turned), where=lengths > 0))

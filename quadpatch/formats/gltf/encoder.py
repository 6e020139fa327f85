"""Writing a mesh from another format as glTF 2.0.

Coordinates are float32, the only type that glTF knows, and keep their numbers: a node of each mesh is scaled to metres
where the length unit is known. The measured surface is one mesh, the invented one another, `quadpatch_filled`.
"""

from typing import Any

import numpy as np

from quadpatch.formats.gltf.container import GltfFile, dump_gltf
from quadpatch.formats.gltf.primitive import Store, split_vertices
from quadpatch.formats.gltf.source import FILL_NAME
from quadpatch.formats.whole import Whole
from quadpatch.types import BoolArray

METRES = {
    "micron": 1e-6,
    "millimeter": 1e-3,
    "centimeter": 1e-2,
    "inch": 0.0254,
    "foot": 0.3048,
    "meter": 1.0,
}


def encode_as_glb(whole: Whole) -> bytes:
    """Encode as one binary file."""
    return dump_gltf(_build(whole, is_binary=True))


def encode_as_gltf(whole: Whole) -> bytes:
    """Encode as JSON with the arrays in it."""
    return dump_gltf(_build(whole, is_binary=False))


def _build(whole: Whole, is_binary: bool) -> GltfFile:
    asset: dict[str, Any] = {"version": "2.0", "generator": "Quadpatch"}
    # The empty first buffer of a binary file is its binary chunk.
    buffers = [{"byteLength": 0}] if is_binary else []
    document = {"asset": asset, "scene": 0, **({"buffers": buffers} if buffers else {})}
    store = Store(GltfFile(document, [b""] * len(buffers), [], is_binary))
    scale = METRES.get(whole.unit or "meter", 1.0)
    roots = []
    for name, chosen in (("measured", ~whole.invented), (FILL_NAME, whole.invented)):
        if chosen.any():
            mesh = store.add("meshes", {"name": name, "primitives": [_primitive(store, whole, chosen)]})
            sized = {} if scale == 1.0 else {"scale": [scale] * 3}
            roots.append(store.add("nodes", {"name": name, "mesh": mesh, **sized}))
    store.add("scenes", {"nodes": roots})
    return store.finished()


def _primitive(store: Store, whole: Whole, chosen: BoolArray) -> dict[str, Any]:
    looks = whole.appearance
    texture = None if looks.texture is None else np.nan_to_num(looks.texture[chosen])
    vertex, wedges, triangles = split_vertices(whole.triangles[chosen], texture)
    attributes = {"POSITION": store.add_array(whole.vertices[vertex], "f4")}
    if looks.normals is not None:
        attributes["NORMAL"] = store.add_array(looks.normals[vertex], "f4")
    if looks.colours is not None:
        attributes["COLOR_0"] = store.add_array(looks.colours[vertex] / 255.0, "f4")
    if texture is not None:
        # glTF counts v downwards.
        attributes["TEXCOORD_0"] = store.add_array(wedges * [1.0, -1.0] + [0.0, 1.0], "f4")
    if whole.invented[chosen].all():
        attributes["_HOLE_ID"] = store.add_array(whole.vertex_hole[vertex], "f4")
        attributes["_CONFIDENCE"] = store.add_array(whole.vertex_confidence[vertex], "f4")
    return {"attributes": attributes, "indices": store.add_array(triangles.ravel(), "u4", is_index=True), "mode": 4}

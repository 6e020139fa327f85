"""Writing a mesh from another format as glTF 2.0.

Coordinates are float32, the only type that glTF knows, and keep their numbers: a node of each mesh is scaled to metres
where the length unit is known. The measured surface is one mesh, the invented one another, `quadpatch_filled`.

Tested in `tests/quadpatch/formats/test_conversion.py`.
"""

from typing import Any

import numpy as np

from quadpatch.formats.gltf.container import GltfFile, dump_gltf
from quadpatch.formats.gltf.primitive import Store, split_vertices
from quadpatch.formats.gltf.source import FILL_NAME
from quadpatch.formats.merged_scene import MergedScene
from quadpatch.formats.units import METRES
from quadpatch.types import BoolArray


def encode_as_glb(scene: MergedScene) -> bytes:
    """Encode as one binary file."""
    return dump_gltf(_build(scene, is_binary=True))


def encode_as_gltf(scene: MergedScene) -> bytes:
    """Encode as JSON with the arrays in it."""
    return dump_gltf(_build(scene, is_binary=False))


def _build(scene: MergedScene, is_binary: bool) -> GltfFile:
    asset: dict[str, Any] = {"version": "2.0", "generator": "Quadpatch"}
    # The empty first buffer of a binary file is its binary chunk.
    buffers = [{"byteLength": 0}] if is_binary else []
    document = {"asset": asset, "scene": 0, **({"buffers": buffers} if buffers else {})}
    store = Store(GltfFile(document, [b""] * len(buffers), [], is_binary))
    scale = METRES.get(scene.unit or "meter", 1.0)
    roots = []
    for name, chosen in (("measured", ~scene.invented), (FILL_NAME, scene.invented)):
        if chosen.any():
            mesh = store.add("meshes", {"name": name, "primitives": [_primitive(store, scene, chosen)]})
            sized = {} if scale == 1.0 else {"scale": [scale] * 3}
            roots.append(store.add("nodes", {"name": name, "mesh": mesh, **sized}))
    store.add("scenes", {"nodes": roots})
    return store.finished()


def _primitive(store: Store, scene: MergedScene, chosen: BoolArray) -> dict[str, Any]:
    given = scene.vertex_attributes
    texture = None if given.texture is None else np.nan_to_num(given.texture[chosen])
    vertex, wedges, triangles = split_vertices(scene.triangles[chosen], texture)
    attributes = {"POSITION": store.add_array(scene.vertices[vertex], "f4")}
    if given.normals is not None:
        attributes["NORMAL"] = store.add_array(given.normals[vertex], "f4")
    if given.colours is not None:
        attributes["COLOR_0"] = store.add_array(given.colours[vertex] / 255.0, "f4")
    if texture is not None:
        # glTF counts v downwards.
        attributes["TEXCOORD_0"] = store.add_array(wedges * [1.0, -1.0] + [0.0, 1.0], "f4")
    if scene.invented[chosen].all():
        attributes["_HOLE_ID"] = store.add_array(scene.vertex_hole_id[vertex], "f4")
        attributes["_CONFIDENCE"] = store.add_array(scene.vertex_confidence[vertex], "f4")
    return {"attributes": attributes, "indices": store.add_array(triangles.ravel(), "u4", is_index=True), "mode": 4}

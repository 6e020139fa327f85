"""glTF files built entry by entry, independently of the code under test."""

import base64
import json
import struct
from typing import Any

import numpy as np

from quadpatch.types import FloatArray, IntArray


def glb(document: dict[str, Any], binary: bytes) -> bytes:
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    binary += bytes(-len(binary) % 4)
    body = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(binary), 0x004E4942) + binary
    return b"glTF" + struct.pack("<II", 2, 12 + len(body)) + body


def scene(
    vertices: FloatArray, triangles: IntArray, *nodes: dict[str, Any], more: dict[str, FloatArray] | None = None
) -> tuple[dict[str, Any], bytes]:
    """One mesh of float32 vertices with uint16 indices and further attributes, placed by nodes."""
    binary = b""
    views: list[dict[str, Any]] = []
    accessors: list[dict[str, Any]] = []
    attributes: dict[str, int] = {}
    arrays = {"POSITION": vertices, **(more or {})}
    for name, values in arrays.items():
        attributes[name] = len(accessors)
        kind = {2: "VEC2", 3: "VEC3", 4: "VEC4"}[values.shape[1]]
        accessors.append({"bufferView": len(views), "componentType": 5126, "count": len(values), "type": kind})
        data = values.astype("<f4").tobytes()
        views.append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(data)})
        binary += data
    data = triangles.astype("<u2").tobytes()
    accessors.append({"bufferView": len(views), "componentType": 5123, "count": triangles.size, "type": "SCALAR"})
    views.append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(data)})
    binary += data
    primitive = {"attributes": attributes, "indices": len(accessors) - 1, "material": 0}
    document = {
        "asset": {"version": "2.0", "extras": {"station": 7}},
        "scene": 0,
        "scenes": [{"nodes": list(range(len(nodes)))}],
        "nodes": list(nodes),
        "meshes": [{"primitives": [primitive]}],
        "materials": [{"name": "skin"}],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"byteLength": len(binary)}],
    }
    return document, binary


def as_gltf(document: dict[str, Any], binary: bytes) -> bytes:
    """The same as JSON with the buffer in it."""
    uri = "data:application/octet-stream;base64," + base64.b64encode(binary).decode()
    return json.dumps({**document, "buffers": [{"byteLength": len(binary), "uri": uri}]}).encode()


def chunks(data: bytes) -> tuple[dict[str, Any], bytes]:
    """Document and binary chunk of a `.glb`."""
    size = struct.unpack("<I", data[12:16])[0]
    document: dict[str, Any] = json.loads(data[20 : 20 + size])
    return document, data[28 + size :]


def quarter_turn() -> list[float]:
    """Quaternion of a quarter turn around x."""
    return [float(np.sqrt(0.5)), 0.0, 0.0, float(np.sqrt(0.5))]

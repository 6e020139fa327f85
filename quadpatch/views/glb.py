"""Surfaces for a viewer as binary glTF: positions about an origin, small normals, colours, values of vertices.

Positions are float32 differences to the origin, which the scene states in double precision: a scan in the coordinates
of a survey keeps its shape. Normals are bytes (`KHR_mesh_quantization`). Colours are linear, as glTF has them.

References
----------
Khronos Group, "glTF 2.0 Specification", 2021; "KHR_mesh_quantization", 2020.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from quadpatch.formats.gltf.container import GltfFile, dump_gltf
from quadpatch.formats.gltf.primitive import Store
from quadpatch.mesh.normals import unit, vertex_normals
from quadpatch.mesh.weld import first_of_equal
from quadpatch.types import FloatArray, TriangleMesh

_QUANTIZATION = "KHR_mesh_quantization"
_MOST_SHORT_INDICES = 1 << 16


@dataclass(frozen=True)
class Part:
    """One part of a surface.

    Attributes
    ----------
    name : str
    mesh : TriangleMesh
    colours : (n_vertices, 3) float64 or None
        Linear red, green, blue, 0..1.
    values : dict of (n_vertices,) float64
        By the names of their attributes, which begin with an underscore.
    """

    name: str
    mesh: TriangleMesh
    colours: FloatArray | None = None
    values: Mapping[str, FloatArray] = field(default_factory=dict)


def encode_parts(parts: Sequence[Part], origin: FloatArray, extras: Mapping[str, Any]) -> bytes:
    """Encode parts as one GLB; those without a triangle are left out.

    Parameters
    ----------
    parts : sequence of Part
        At least one has a triangle. Vertices at equal positions get one normal.
    origin : (3,) float64
        In mesh units.
    extras : mapping
        Of the scene, JSON-ready; `origin` and `ranges`, of the values of all parts by their names, are added.
    """
    parts = [part for part in parts if len(part.mesh.triangles)]
    asset = {"version": "2.0", "generator": "Quadpatch"}
    used = {"extensionsUsed": [_QUANTIZATION], "extensionsRequired": [_QUANTIZATION]}
    store = Store(GltfFile({"asset": asset, **used, "scene": 0, "buffers": [{"byteLength": 0}]}, [b""], [], True))
    nodes = []
    for part, normals in zip(parts, _normals(parts), strict=True):
        mesh = store.add("meshes", {"name": part.name, "primitives": [_primitive(store, part, normals, origin)]})
        nodes.append(store.add("nodes", {"name": part.name, "mesh": mesh}))
    stated = {**extras, "origin": origin.tolist(), "ranges": _ranges(parts)}
    store.add("scenes", {"nodes": nodes, "extras": stated})
    return dump_gltf(store.finished())


def _primitive(store: Store, part: Part, normals: FloatArray, origin: FloatArray) -> dict[str, Any]:
    attributes = {
        "POSITION": store.add_array(part.mesh.vertices - origin, "f4"),
        "NORMAL": store.add_fractions(normals, "i1"),
    }
    if part.colours is not None:
        opaque = np.column_stack([part.colours, np.ones(len(part.colours))])
        attributes["COLOR_0"] = store.add_fractions(opaque, "u2")
    attributes |= {name: store.add_array(values, "f4") for name, values in part.values.items()}
    code = "u2" if len(part.mesh.vertices) < _MOST_SHORT_INDICES else "u4"
    indices = store.add_array(part.mesh.triangles.ravel(), code, is_index=True)
    return {"attributes": attributes, "indices": indices, "mode": 4}


def _normals(parts: Sequence[Part]) -> list[FloatArray]:
    """Give unit normals (n, 3) of each part; vertices at one position, of whatever part, have one normal."""
    starts = np.cumsum([0, *(len(part.mesh.vertices) for part in parts)])
    vertices = np.concatenate([part.mesh.vertices for part in parts])
    triangles = np.concatenate([part.mesh.triangles + start for part, start in zip(parts, starts, strict=False)])
    first = first_of_equal(vertices)
    normals = unit(vertex_normals(vertices, first[triangles]))[first]
    # glTF wants unit vectors even where a triangle has no area.
    normals[(normals == 0).all(axis=1)] = (0.0, 0.0, 1.0)
    return np.split(normals, starts[1:-1])


def _ranges(parts: Sequence[Part]) -> dict[str, list[float]]:
    ranges: dict[str, list[float]] = {}
    for part in parts:
        for name, values in part.values.items():
            low, high = ranges.get(name, [np.inf, -np.inf])
            ranges[name] = [min(low, float(values.min())), max(high, float(values.max()))]
    return ranges

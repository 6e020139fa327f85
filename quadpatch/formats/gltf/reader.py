"""glTF 2.0 (`.glb` and `.gltf`): reading a scene as one mesh.

All meshes of the default scene are placed by their nodes and joined; unit is the metre. Triangles, strips and fans are
read, points and lines left out. Morph targets and skins are kept in the file and do not move the geometry.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from quadpatch.errors import EmptyMeshError, FormatError, IndexRangeError, MeshError, ReadError
from quadpatch.formats.gltf.accessors import get_count, get_entry, get_list, get_object, read_accessor
from quadpatch.formats.gltf.container import GltfFile, load_gltf
from quadpatch.formats.gltf.images import coordinate_sets
from quadpatch.formats.gltf.moved_scene import SURFACE_MODES
from quadpatch.formats.gltf.scene import placed_nodes
from quadpatch.formats.gltf.source import GltfSource, Primitive
from quadpatch.formats.limits import ReadLimits, check_triangles, check_vertices, to_float64
from quadpatch.formats.marks import next_hole_id
from quadpatch.formats.polygons import triangulate_strips
from quadpatch.formats.scan import Scan
from quadpatch.formats.scene_parts import Part, place
from quadpatch.types import FloatArray, IntArray, Triangles

_TRIANGLES, _STRIP, _FAN = SURFACE_MODES


@dataclass(frozen=True)
class _Mesh:
    """One mesh of the document: its primitives' positions, triangles into all of them, and attributes."""

    positions: FloatArray
    triangles: Triangles
    primitives: list[Primitive]


def read_gltf(data: bytes, limits: ReadLimits, folder: Path | None = None) -> Scan:
    """Read a glTF file.

    Parameters
    ----------
    data : bytes
        The whole file.
    limits : ReadLimits
    folder : Path, optional
        Where buffers in files of their own may lie; None allows none.

    Raises
    ------
    MeshError
        ReadError, FormatError, EmptyMeshError, NotFiniteError, IndexRangeError or TooLargeError.
    """
    file = load_gltf(data, folder, limits)
    parts: list[Part] = []
    nodes: list[int] = []
    vertices: list[FloatArray] = []
    triangles: list[Triangles] = []
    primitives: list[Primitive] = []
    first = n_triangles = 0
    for node, matrix, mesh in _placed_meshes(file, limits):
        if len(mesh.triangles) == 0:
            continue
        part = Part(first, mesh.positions, matrix)
        parts.append(part)
        nodes.append(node)
        vertices.append(place(mesh.positions, matrix))
        turned = mesh.triangles[:, [0, 2, 1]] if part.is_mirrored else mesh.triangles
        triangles.append(turned + first)
        primitives += [primitive.shifted(len(parts) - 1, first, n_triangles) for primitive in mesh.primitives]
        first += len(mesh.positions)
        n_triangles += len(mesh.triangles)
        # A small mesh may be placed a million times.
        limits.check_vertices(first)
        limits.check_triangles(n_triangles)
    if not parts:
        raise EmptyMeshError("the glTF scene has no triangle")
    all_vertices, all_triangles = np.concatenate(vertices), np.concatenate(triangles)
    check_vertices(all_vertices, limits.allow_missing)
    check_triangles(all_triangles, limits)
    kind = "glb" if file.is_binary else "gltf"
    source = GltfSource(file, parts, nodes, primitives)
    return Scan(all_vertices, all_triangles, kind, "meter", source, next_hole_id(_hole_marks(file, limits)))


def _placed_meshes(file: GltfFile, limits: ReadLimits) -> Iterator[tuple[int, FloatArray, _Mesh]]:
    """Yield nodes with their transform and mesh; a mesh is read once, however often it is placed."""
    meshes: dict[object, _Mesh] = {}
    for node, matrix in placed_nodes(file.document):
        index = get_entry(file.document, "nodes", node).get("mesh")
        if not isinstance(index, int) or index not in meshes:
            meshes[index] = _read_mesh(file, index, limits)
        yield node, matrix, meshes[index]


def _read_mesh(file: GltfFile, index: object, limits: ReadLimits) -> _Mesh:
    positions: list[FloatArray] = [np.zeros((0, 3))]
    triangles: list[Triangles] = [np.zeros((0, 3), dtype=np.int64)]
    primitives: list[Primitive] = []
    first = n_triangles = 0
    for primitive in get_list(get_entry(file.document, "meshes", index), "primitives"):
        if not isinstance(primitive, dict):
            raise ReadError("a glTF primitive is no object")
        mode = get_count(primitive, "mode", _TRIANGLES)
        if mode not in SURFACE_MODES:
            continue
        points, corners = _read_primitive(file, primitive, mode, limits)
        attributes = _read_attributes(file, primitive, len(points), limits)
        material = primitive.get("material")
        primitives.append(Primitive(0, (first, len(points)), (n_triangles, len(corners)), material, attributes))
        positions.append(points)
        triangles.append(corners + first)
        first += len(points)
        n_triangles += len(corners)
        limits.check_vertices(first)
        limits.check_triangles(n_triangles)
    return _Mesh(np.concatenate(positions), np.concatenate(triangles), primitives)


def _read_primitive(
    file: GltfFile, primitive: dict[str, Any], mode: int, limits: ReadLimits
) -> tuple[FloatArray, Triangles]:
    for extension in get_object(primitive, "extensions"):
        if extension.endswith("_mesh_compression"):
            raise FormatError(f"glTF compressed by {extension[:40]} is not read: send it uncompressed")
    attributes = get_object(primitive, "attributes")
    if "POSITION" not in attributes:
        raise ReadError("a glTF primitive has no POSITION")
    positions = to_float64(read_accessor(file, attributes["POSITION"], (3,), limits))
    if primitive.get("indices") is None:
        corners = np.arange(len(positions), dtype=np.int64)
    else:
        stored = read_accessor(file, primitive["indices"], (1,), limits)[:, 0]
        if stored.dtype.kind != "u":
            raise ReadError("glTF indices are no unsigned integers")
        corners = stored.astype(np.int64)
    if corners.size and corners.max() >= len(positions):
        raise IndexRangeError(
            f"a glTF triangle names vertex {corners.max()}; its primitive has the vertices 0 to {len(positions) - 1}"
        )
    return positions, _cut(corners, mode)


def _cut(corners: IntArray, mode: int) -> Triangles:
    if mode == _STRIP:
        return triangulate_strips(np.array([len(corners)]), corners)
    if mode == _FAN:
        first = np.repeat(corners[:1], max(len(corners) - 2, 0))
        return np.stack([first, corners[1:-1], corners[2:]], axis=1)
    if len(corners) % 3:
        raise ReadError(f"a glTF primitive of triangles has {len(corners):,} corners, which is no multiple of 3")
    return corners.reshape(-1, 3)


def _read_attributes(
    file: GltfFile, primitive: dict[str, Any], n_vertices: int, limits: ReadLimits
) -> dict[str, FloatArray]:
    """Read normals, first colours and texture coordinates; an attribute of another length counts as absent."""
    wanted: list[tuple[str, tuple[int, ...]]] = [("NORMAL", (3,)), ("COLOR_0", (3, 4))]
    wanted += [(name, (2,)) for name in coordinate_sets(file.document, primitive.get("material"))]
    attributes = get_object(primitive, "attributes")
    found: dict[str, FloatArray] = {}
    for name, width in wanted:
        if name not in attributes:
            continue
        values = to_float64(read_accessor(file, attributes[name], width, limits))
        if len(values) == n_vertices:
            # A wrong normal is no reason to refuse a scan; it counts as zero.
            found[name] = np.where(np.isfinite(values), values, 0.0)
    return found


def _hole_marks(file: GltfFile, limits: ReadLimits) -> Iterator[FloatArray]:
    """Read the numbers of the holes that an earlier repair filled."""
    for mesh in get_list(file.document, "meshes"):
        for primitive in get_list(mesh, "primitives") if isinstance(mesh, dict) else []:
            attributes = get_object(primitive, "attributes") if isinstance(primitive, dict) else {}
            if "_HOLE_ID" not in attributes:
                continue
            try:
                yield to_float64(read_accessor(file, attributes["_HOLE_ID"], (1,), limits))[:, 0]
            except MeshError:
                # Of another program, which may call anything so.
                continue

"""A glTF file handed back with vertices at other positions.

The arrays of positions and normals change (`quadpatch.formats.gltf.moved_arrays`). The rest of the document and of its
buffers stays, but for meshes whose primitives need other arrays than before; a mesh that is placed several times, and
moved differently at each place, is repeated.

Tested in `tests/quadpatch/formats/test_moving.py`.
"""

from collections import defaultdict
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from quadpatch.formats.gltf.accessors import get_entry, get_list
from quadpatch.formats.gltf.container import dump_gltf
from quadpatch.formats.gltf.moved_arrays import Key, MovedArrays
from quadpatch.formats.gltf.primitive import Store
from quadpatch.formats.moved_normals import moved_vertex_normals
from quadpatch.formats.scan import Moved, Scan
from quadpatch.formats.scene_parts import MovedPart, moved_parts
from quadpatch.types import FloatArray

if TYPE_CHECKING:
    from quadpatch.formats.gltf.source import GltfSource, Primitive

# Modes of primitives that are surface: triangles, strips, fans.
SURFACE_MODES = (4, 5, 6)

# Of one primitive: which array each attribute has from now on.
Arrays = tuple[tuple[str, Key], ...]


@dataclass
class _Plan:
    """Arrays of every primitive of a mesh, for each different way in which nodes need it; and the nodes' choices.

    Attributes
    ----------
    variants : dict
        By mesh, the arrays of all its primitives, and the number of this variant.
    choices : dict
        Mesh and variant by node.
    """

    variants: dict[int, dict[tuple[Arrays, ...], int]] = field(default_factory=dict)
    choices: dict[int, tuple[int, int]] = field(default_factory=dict)

    def choose(self, node: int, mesh: int, arrays: tuple[Arrays, ...]) -> None:
        """Let a node use a mesh with these arrays."""
        variants = self.variants.setdefault(mesh, {})
        self.choices[node] = (mesh, variants.setdefault(arrays, len(variants)))


def move_in_gltf(source: "GltfSource", scan: Scan, moved: Moved) -> bytes:
    """Hand a glTF file back with vertices at other positions.

    Parameters
    ----------
    source : GltfSource
    scan : Scan
    moved : Moved

    Raises
    ------
    StageError
        If a part that moved is flattened by its transform.
    """
    if not moved.is_moved(scan).any():
        return source.file.data if source.file.is_whole else dump_gltf(source.file)
    arrays = MovedArrays(source.file)
    plan = _Plan()
    normals = source.scene_normals(scan)
    fresh = None if normals is None else moved_vertex_normals(scan, np.nan_to_num(normals), moved)
    read = defaultdict(list)
    for primitive in source.primitives:
        read[primitive.part].append(primitive)
    for number, (node, placed) in enumerate(zip(source.nodes, moved_parts(source.parts, scan, moved), strict=True)):
        mesh = int(get_entry(source.file.document, "nodes", node)["mesh"])
        turned = None if fresh is None else _into_part(placed, fresh)
        entries = get_list(get_entry(source.file.document, "meshes", mesh), "primitives")
        surface = zip(filter(is_surface, entries), read[number], strict=True)
        plan.choose(node, mesh, tuple(_claim(arrays, *pair, placed, turned) for pair in surface))
    store, numbers = arrays.written()
    _rewrite_meshes(store, plan, numbers)
    return dump_gltf(store.finished())


def _into_part(placed: MovedPart, normals: FloatArray) -> FloatArray:
    """Take normals of the scene, (n, 3), back to those of a part's vertices in its own coordinates, (k, 3)."""
    part = placed.part
    own = normals[part.first : part.first + len(part.vertices)]
    if (part.matrix == np.eye(4)).all():
        return own
    turned = own @ part.matrix[:3, :3]
    lengths = np.linalg.norm(turned, axis=1, keepdims=True)
    return np.asarray(np.divide(turned, lengths, out=np.zeros_like(turned), where=lengths > 0))


def is_surface(entry: dict[str, Any]) -> bool:
    """Tell whether a primitive is surface, and no points or lines."""
    return entry.get("mode", SURFACE_MODES[0]) in SURFACE_MODES


def _claim(
    arrays: MovedArrays,
    entry: dict[str, Any],
    primitive: "Primitive",
    placed: MovedPart,
    normals: FloatArray | None,
) -> Arrays:
    """Ask for the positions and normals of one primitive."""
    first = primitive.vertices[0] - placed.part.first
    rows = slice(first, first + primitive.vertices[1])
    named, is_used = entry["attributes"], placed.is_used[rows]
    key = arrays.claim(named["POSITION"], placed.part.vertices[rows], placed.positions[rows], is_used)
    found = [("POSITION", key)]
    stored = primitive.attributes.get("NORMAL")
    if normals is not None and stored is not None:
        is_new = placed.is_moved[rows, np.newaxis] & normals[rows].any(axis=1, keepdims=True)
        fresh = np.where(is_new, normals[rows], stored)
        found.append(("NORMAL", arrays.claim(named["NORMAL"], stored, fresh, is_used)))
    return tuple(found)


def _rewrite_meshes(store: Store, plan: _Plan, numbers: dict[Key, int]) -> None:
    """Give meshes the arrays that they need, and nodes that need another variant a mesh of their own."""
    document = store.document
    meshes = document["meshes"] = list(document["meshes"])
    nodes = document["nodes"] = list(document["nodes"])
    written: dict[tuple[int, int], int] = {}
    for mesh, variants in plan.variants.items():
        entry = meshes[mesh]
        for arrays, variant in variants.items():
            changed = _with_arrays(entry, arrays, numbers)
            if variant == 0:
                meshes[mesh] = changed
            else:
                meshes.append(changed)
            written[mesh, variant] = mesh if variant == 0 else len(meshes) - 1
    for node, choice in plan.choices.items():
        if written[choice] != nodes[node]["mesh"]:
            nodes[node] = {**nodes[node], "mesh": written[choice]}


def _with_arrays(mesh: dict[str, Any], arrays: tuple[Arrays, ...], numbers: dict[Key, int]) -> dict[str, Any]:
    primitives = []
    waiting = iter(arrays)
    for entry in mesh["primitives"]:
        if is_surface(entry):
            new = {name: numbers[key] for name, key in next(waiting)}
            primitives.append({**entry, "attributes": {**entry["attributes"], **new}})
        else:
            primitives.append(entry)
    return {**mesh, "primitives": primitives}

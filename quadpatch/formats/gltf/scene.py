"""The node tree of a glTF document, flattened.

Tested in `tests/quadpatch/formats/gltf/test_reader.py`.
"""

from typing import Any

import numpy as np

from quadpatch.errors import ReadError
from quadpatch.formats.gltf.accessors import get_entry, get_list
from quadpatch.types import FloatArray


def placed_nodes(document: dict[str, Any]) -> list[tuple[int, FloatArray]]:
    """List the nodes of the default scene that carry a mesh.

    Parameters
    ----------
    document : dict

    Returns
    -------
    list of (int, (4, 4) float64)
        Node and its transform to the scene, by the number of the node, so that nodes appended later come last.

    Raises
    ------
    ReadError
        If a node is met twice: glTF nodes form trees.
    """
    placed: list[tuple[int, FloatArray]] = []
    seen: set[int] = set()
    waiting = [(root, np.eye(4)) for root in _roots(document)]
    while waiting:
        number, parent = waiting.pop()
        node = get_entry(document, "nodes", number)
        if number in seen:
            raise ReadError(f"glTF node {number} is reached twice: it is its own ancestor or has two parents")
        seen.add(number)
        with np.errstate(over="ignore", invalid="ignore"):  # what overflows is refused as not finite
            matrix = parent @ _local_matrix(node)
        if "mesh" in node:
            placed.append((number, matrix))
        waiting += [(child, matrix) for child in get_list(node, "children")]
    return sorted(placed, key=lambda pair: pair[0])


def _roots(document: dict[str, Any]) -> list[Any]:
    if get_list(document, "scenes"):
        return get_list(get_entry(document, "scenes", document.get("scene", 0)), "nodes")
    nodes = [node for node in get_list(document, "nodes") if isinstance(node, dict)]
    children = {child for node in nodes for child in get_list(node, "children") if isinstance(child, int)}
    return [number for number in range(len(get_list(document, "nodes"))) if number not in children]


def _local_matrix(node: dict[str, Any]) -> FloatArray:
    if "matrix" in node:
        # Stored column by column.
        return _numbers(node, "matrix", np.eye(4).ravel()).reshape(4, 4).T
    matrix = np.eye(4)
    matrix[:3, :3] = _rotation(_numbers(node, "rotation", np.array([0.0, 0.0, 0.0, 1.0])))
    matrix[:3, :3] *= _numbers(node, "scale", np.ones(3))
    matrix[:3, 3] = _numbers(node, "translation", np.zeros(3))
    return matrix


def _numbers(node: dict[str, Any], key: str, default: FloatArray) -> FloatArray:
    values = node.get(key)
    if values is None:
        return default
    ok = isinstance(values, list) and all(isinstance(value, int | float) and abs(value) < 1e300 for value in values)
    if not ok or len(values) != len(default):
        raise ReadError(f"a glTF node has a {key} that is not {len(default)} numbers")
    return np.array(values, dtype=np.float64)


def _rotation(quaternion: FloatArray) -> FloatArray:
    """Rotation matrix of a quaternion x, y, z, w."""
    x, y, z, w = quaternion / max(float(np.linalg.norm(quaternion)), np.finfo(np.float64).tiny)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )

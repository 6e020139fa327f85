"""The filters of a network's first convolution, read from its file: what it looks for in a height map.

The file is read as `quadpatch.inpainters.onnx_parts` reads it; no network is opened.
"""

from collections.abc import Iterator

import numpy as np

from quadpatch.errors import ModelError
from quadpatch.inpainters.onnx_parts import fields
from quadpatch.types import FloatArray

# Numbers of fields (onnx.proto, IR version 10).
_MODEL_GRAPH, _GRAPH_NODE, _GRAPH_TENSOR = 7, 1, 5
_NODE_INPUT, _NODE_OPERATOR = 1, 4
_TENSOR_DIMENSION, _TENSOR_TYPE, _TENSOR_FLOATS, _TENSOR_NAME, _TENSOR_BYTES = 1, 2, 4, 8, 9
_FLOAT32 = 1
_FILTER_AXES = 4
_LARGEST_SIDE = 64


def first_filters(data: bytes, name: str) -> FloatArray:
    """Read the filters (n_filters, n_channels, rows, columns) of the first convolution.

    Parameters
    ----------
    data : bytes
        The whole file, which `check_parts` has taken.
    name : str
        Of the file, for messages.

    Raises
    ------
    ModelError
        If there is no convolution, or its filters are no float32 numbers.
    """
    graph = next((value for number, value in _messages(memoryview(data), name) if number == _MODEL_GRAPH), None)
    parts = [] if graph is None else list(_messages(graph, name))
    nodes = (_texts(value, name) for number, value in parts if number == _GRAPH_NODE)
    inputs = next((inputs for operator, inputs in nodes if operator == b"Conv" and len(inputs) > 1), None)
    if inputs is None:
        raise ModelError(f"{name}: the network has no convolution to be drawn")
    for number, value in parts:
        if number == _GRAPH_TENSOR and (filters := _filters(value, inputs[1], name)) is not None:
            return filters
    raise ModelError(f"{name}: the filters of the network's first convolution are no numbers of its file")


def _messages(message: memoryview, name: str) -> Iterator[tuple[int, memoryview]]:
    return ((number, value) for number, value in fields(message, name) if isinstance(value, memoryview))


def _texts(node: memoryview, name: str) -> tuple[bytes, list[bytes]]:
    """Operator of a node, and the names of its inputs."""
    entries = [(number, bytes(value)) for number, value in _messages(node, name) if number <= _NODE_OPERATOR]
    operator = next((value for number, value in entries if number == _NODE_OPERATOR), b"")
    return operator, [value for number, value in entries if number == _NODE_INPUT]


def _filters(tensor: memoryview, wanted: bytes, name: str) -> FloatArray | None:
    """Read a tensor, if it is the wanted one and holds filters."""
    entries = list(fields(tensor, name))
    known = dict(entries)
    if known.get(_TENSOR_NAME, b"") != wanted:
        return None
    shape = _dimensions(entries, name)
    numbers = known.get(_TENSOR_BYTES, known.get(_TENSOR_FLOATS))
    is_filters = len(shape) == _FILTER_AXES and 0 < max(shape[2:]) <= _LARGEST_SIDE
    if known.get(_TENSOR_TYPE) != _FLOAT32 or not isinstance(numbers, memoryview) or not is_filters:
        return None
    if len(numbers) != 4 * int(np.prod(shape)):
        return None
    values = np.frombuffer(numbers, "<f4").astype(np.float64).reshape(shape)
    return values if np.isfinite(values).all() and values.size else None


def _dimensions(entries: list[tuple[int, int | memoryview]], name: str) -> list[int]:
    """Sizes along the axes, which are written one by one or packed."""
    found: list[int] = []
    for number, value in entries:
        if number == _TENSOR_DIMENSION:
            found += [value] if isinstance(value, int) else _unpacked(value, name)
    return found


def _unpacked(packed: memoryview, name: str) -> list[int]:
    """Read varints that stand behind each other."""
    # As fields of a message: each one behind a tag of its own.
    tagged = bytearray()
    for i, byte in enumerate(packed):
        if i == 0 or not packed[i - 1] & 0x80:
            tagged.append(_TENSOR_DIMENSION << 3)
        tagged.append(byte)
    return [value for _, value in fields(memoryview(bytes(tagged)), name) if isinstance(value, int)]

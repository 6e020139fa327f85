"""What a network file is made of, read from its bytes: whose operators, and whether its weights lie in it.

A serialised ONNX ModelProto is a tree of protobuf messages. A field is a tag (a varint: the field's number and its wire
type) and a value. Only the messages that hold operators or weights are walked, subgraphs of attributes among them, and
weights are skipped by their length. `onnx` itself is not needed, and what a reader of it would follow is not followed.
"""

from collections.abc import Iterator

from quadpatch.errors import ModelError

_VARINT, _EIGHT_BYTES, _LENGTH, _FOUR_BYTES = 0, 1, 2, 5
_FIXED = {_EIGHT_BYTES: 8, _FOUR_BYTES: 4}
_MAX_VARINT_BYTES = 10
# Subgraphs lie in attributes of nodes of graphs: three messages a level. onnxruntime itself gives up far earlier.
MAX_DEPTH = 64
# Which fields of a message hold which messages (onnx.proto, IR version 10).
_CHILDREN: dict[str, dict[int, str]] = {
    "model": {7: "graph", 20: "training", 25: "function"},
    "graph": {1: "node", 5: "tensor", 15: "sparse tensor"},
    "node": {5: "attribute"},
    "attribute": {
        5: "tensor",
        6: "graph",
        10: "tensor",
        11: "graph",
        22: "sparse tensor",
        23: "sparse tensor",
    },
    "sparse tensor": {1: "tensor", 2: "tensor"},
    "tensor": {},
}
_REFUSED = {"training": "a training loop", "function": "functions of its own"}
_NODE_DOMAIN = 7
_TENSOR_EXTERNAL_DATA, _TENSOR_DATA_LOCATION = 13, 14
_STANDARD_DOMAINS = (b"", b"ai.onnx")


def check_parts(data: bytes, name: str) -> None:
    """Refuse a network with operators of others, functions of its own, or weights outside of its file.

    Parameters
    ----------
    data : bytes
        The whole file.
    name : str
        Of the file, for messages.

    Raises
    ------
    ModelError
        If a part is refused, or the bytes are no tree of messages.
    """
    waiting = [("model", memoryview(data), 0)]
    while waiting:
        kind, message, depth = waiting.pop()
        if depth > MAX_DEPTH:
            raise ModelError(f"{name}: the network is nested over {MAX_DEPTH} messages deep")
        for number, value in fields(message, name):
            _check_field(kind, number, value, name)
            child = _CHILDREN[kind].get(number)
            if child in _REFUSED:
                raise ModelError(f"{name}: the network has {_REFUSED[child]}, which is not taken")
            if child is not None and isinstance(value, memoryview):
                waiting.append((child, value, depth + 1))


def _check_field(kind: str, number: int, value: int | memoryview, name: str) -> None:
    domain = bytes(value) if kind == "node" and number == _NODE_DOMAIN and isinstance(value, memoryview) else b""
    if domain not in _STANDARD_DOMAINS:
        raise ModelError(f"{name}: the network uses operators that are not ONNX's own")
    is_outside = number == _TENSOR_EXTERNAL_DATA or (number == _TENSOR_DATA_LOCATION and value != 0)
    if kind == "tensor" and is_outside:
        raise ModelError(f"{name}: weights of the network lie outside of its file")


def fields(message: memoryview, name: str) -> Iterator[tuple[int, int | memoryview]]:
    """Yield number and value of each field; fixed-width values, which nothing here needs, come as 0."""
    start = 0
    while start < len(message):
        tag, start = _varint(message, start, name)
        number, wire_type = divmod(tag, 8)
        if wire_type == _VARINT:
            value, start = _varint(message, start, name)
            yield number, value
            continue
        length = _FIXED.get(wire_type, 0)
        if wire_type == _LENGTH:
            length, start = _varint(message, start, name)
        elif not length:
            raise ModelError(f"{name} is no ONNX network: a field has the wire type {wire_type}")
        end = start + length
        if end > len(message):
            raise ModelError(f"{name} is no ONNX network: a field ends behind its message")
        yield number, message[start:end] if wire_type == _LENGTH else 0
        start = end


def _varint(message: memoryview, start: int, name: str) -> tuple[int, int]:
    """Read seven bits from each byte, the lowest first; the highest bit says that more follow."""
    value = 0
    for i, byte in enumerate(message[start : start + _MAX_VARINT_BYTES]):
        value |= (byte & 0x7F) << (7 * i)
        if not byte & 0x80:
            return value, start + i + 1
    raise ModelError(f"{name} is no ONNX network: it is cut off or damaged")

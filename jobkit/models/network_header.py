"""The card inside an ONNX network, read without onnx and without reading the network.

A serialised ModelProto is a row of fields: a tag (a varint, the field's number and its wire type) and a value. The card
stands under the key `card` in field 14, `metadata_props`, of which every entry is a message of two strings. The large
field, the graph, is skipped by its length.
"""

from collections.abc import Iterator
from pathlib import Path
from typing import Any, BinaryIO

from jobkit.errors import UnusableModelError
from quadpatch_rules.strict_json import read_json

_GRAPH, _OPSET_IMPORT, _METADATA_PROPS = 7, 8, 14
_REFUSED = {20: "a training loop", 25: "functions of its own"}
_STANDARD_DOMAINS = (b"", b"ai.onnx")
_VARINT, _EIGHT_BYTES, _LENGTH, _FOUR_BYTES = 0, 1, 2, 5
# A model has a dozen fields; a file that claims thousands is no model.
MAX_FIELDS = 1000
MAX_ENTRY_BYTES = 1 << 20
_MAX_VARINT_BYTES = 10


def read_network_card(path: Path) -> dict[str, Any] | None:
    """Return the card in the metadata of a network.

    Returns
    -------
    dict or None
        None where there is no card, or the file is no network: the worker checks it in depth.
    """
    with path.open("rb") as file:
        try:
            return _find_card(file, path.stat().st_size)
        except ValueError:
            return None


def check_network(path: Path) -> None:
    """Refuse what can't be a network that an engine runs: bytes that only begin like one, operators of other vendors.

    It does not tell whether the network runs, or what it answers: the engine finds that out.

    Raises
    ------
    UnusableModelError
        If the file is no row of fields with a graph and standard operators.
    """
    has_graph, domains = False, list[bytes]()
    with path.open("rb") as file:
        try:
            for number, length in _messages(file, path.stat().st_size):
                has_graph = has_graph or (number == _GRAPH and length > 0)
                if number in _REFUSED:
                    raise UnusableModelError(f"the network has {_REFUSED[number]}, which is not taken")
                if number == _OPSET_IMPORT:
                    domains.append(_domain(file.read(min(length, MAX_ENTRY_BYTES))))
        except ValueError as error:
            raise UnusableModelError("the artifact is no ONNX network: it is cut off or damaged") from error
    if not has_graph or not domains:
        raise UnusableModelError("the artifact is no ONNX network: it has no graph, or names no operators")
    if any(domain not in _STANDARD_DOMAINS for domain in domains):
        raise UnusableModelError("the network uses operators that are not ONNX's own")


def _find_card(file: BinaryIO, size: int) -> dict[str, Any] | None:
    for number, length in _messages(file, size):
        if number != _METADATA_PROPS or length > MAX_ENTRY_BYTES:
            continue
        key, value = _entry(file.read(length))
        if key == b"card":
            card = read_json(value)
            return card if isinstance(card, dict) else None
    return None


def _messages(file: BinaryIO, size: int) -> Iterator[tuple[int, int]]:
    """Yield number and length of each field that has a length, with the file at its first byte."""
    for _ in range(MAX_FIELDS):
        if file.tell() >= size:
            return
        number, wire_type = divmod(_varint(file), 8)
        if wire_type == _VARINT:
            _varint(file)
            continue
        length = {_EIGHT_BYTES: 8, _FOUR_BYTES: 4}.get(wire_type) or (_varint(file) if wire_type == _LENGTH else -1)
        end = file.tell() + length
        if not file.tell() <= end <= size:
            raise ValueError("a field ends behind the file")
        if wire_type == _LENGTH:
            yield number, length
        file.seek(end)
    raise ValueError("it has more fields than a model")


def _domain(data: bytes) -> bytes:
    """Return the domain in one import of operators: field 1 is its name, field 2 the version."""
    domain, start = b"", 0
    while start < len(data):
        tag, start = _varint_at(data, start)
        value, start = _varint_at(data, start)
        if tag % 8 == _LENGTH:
            domain, start = data[start : start + value], start + value
        elif tag % 8 != _VARINT:
            raise ValueError("no import of operators")
    return domain


def _entry(data: bytes) -> tuple[bytes, bytes]:
    """Part one metadata entry: field 1 is the key, field 2 the value."""
    fields, start = {1: b"", 2: b""}, 0
    while start < len(data):
        tag, start = _varint_at(data, start)
        length, start = _varint_at(data, start)
        if tag % 8 != _LENGTH or length > len(data) - start:
            raise ValueError("no string")
        fields[tag // 8] = data[start : start + length]
        start += length
    return fields[1], fields[2]


def _varint(file: BinaryIO) -> int:
    data = b""
    while not data or data[-1] & 0x80:
        byte = file.read(1)
        if not byte or len(data) == _MAX_VARINT_BYTES:
            raise ValueError("no number")
        data += byte
    return _varint_at(data, 0)[0]


def _varint_at(data: bytes, start: int) -> tuple[int, int]:
    """Read seven bits from each byte, the lowest first; the highest bit says that more follow."""
    value = 0
    for i in range(_MAX_VARINT_BYTES):
        if start + i >= len(data):
            break
        value |= (data[start + i] & 0x7F) << (7 * i)
        if not data[start + i] & 0x80:
            return value, start + i + 1
    raise ValueError("no number")

"""The card inside an ONNX network, read without onnx and without reading the network.

A serialised ModelProto is a row of fields: a tag (a varint, the field's number and its wire type) and a value. The card
stands under the key `card` in field 14, `metadata_props`, of which every entry is a message of two strings. The large
field, the graph, is skipped by its length.
"""

from pathlib import Path
from typing import Any, BinaryIO

from jobkit.strict_json import read_json

_METADATA_PROPS = 14
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
        None where there is no card, or the file is no network: whoever runs it checks it in depth.
    """
    with path.open("rb") as file:
        try:
            return _find_card(file, path.stat().st_size)
        except ValueError:
            return None


def _find_card(file: BinaryIO, size: int) -> dict[str, Any] | None:
    for _ in range(MAX_FIELDS):
        if file.tell() >= size:
            return None
        number, wire_type = divmod(_varint(file), 8)
        if wire_type == _VARINT:
            _varint(file)
            continue
        length = {_EIGHT_BYTES: 8, _FOUR_BYTES: 4}.get(wire_type) or (_varint(file) if wire_type == _LENGTH else -1)
        if not 0 <= length <= size - file.tell():
            raise ValueError("a field ends behind the file")
        if number != _METADATA_PROPS or wire_type != _LENGTH or length > MAX_ENTRY_BYTES:
            file.seek(length, 1)
            continue
        key, value = _entry(file.read(length))
        if key == b"card":
            card = read_json(value)
            return card if isinstance(card, dict) else None
    return None


def _entry(data: bytes) -> tuple[bytes, bytes]:
    """Part one metadata entry: field 1 is the key, field 2 the value."""
    found, start = {1: b"", 2: b""}, 0
    while start < len(data):
        tag, start = _varint_at(data, start)
        length, start = _varint_at(data, start)
        if tag % 8 != _LENGTH or length > len(data) - start:
            raise ValueError("no string")
        found[tag // 8] = data[start : start + length]
        start += length
    return found[1], found[2]


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

r"""The header of a `.qpz` file: fields of fixed size, texts, and counts as variable-length whole numbers.

::

    magic        4 bytes  b"QPZ\x1a"
    version      1 byte   1
    reserved     1 byte   0
    digest       16 bytes BLAKE2b of all that follows
    lengths      6 float64, little endian: max_error, origin x y z, place_step, code_step
    unit         text
    dictionary   1 byte kind, and for a model text name@version and 32 bytes SHA-256
    counts       17 numbers, see `Counts`
    sizes        3 numbers: bytes of models, of coded numbers, of packed triangles; these bytes follow

A text is its length in bytes and UTF-8; a number has seven bits in every byte, low ones first, and the top bit set in
all but its last byte.

Tested in `tests/quadpatch/compression/test_qpz_file.py`.
"""

import hashlib
import math
import struct
from dataclasses import dataclass, fields

from quadpatch.compression.content import DICTIONARY_KINDS, MODEL, DictionaryReference, Lengths
from quadpatch.errors import FormatError, ReadError

MAGIC = b"QPZ\x1a"
VERSION = 1
_DIGEST_BYTES = 16
_FIXED = struct.Struct("<4sBB16s")
_LENGTHS = struct.Struct("<6d")
_LONGEST_TEXT = 300
_LONGEST_NUMBER = 9
# Larger lengths are no lengths of a scan; smaller steps are none either.
_LARGEST_LENGTH = 1e30
_SMALLEST_STEP = 1e-80


@dataclass(frozen=True)
class Counts:
    """How much of each kind a file holds; `docs/qpz.md` says what they are."""

    levels: int
    quads: int
    crossed: int
    kinds: int
    names: int
    atoms: int
    embedded: int
    corrections: int
    removed: int
    border: int
    piece_triangles: int
    piece_crossed: int
    piece_kinds: int
    piece_names: int
    kept_vertices: int
    kept_triangles: int
    parts: int


@dataclass(frozen=True)
class Header:
    """What a file says before its numbers."""

    lengths: Lengths
    unit: str
    dictionary: DictionaryReference
    counts: Counts
    sizes: tuple[int, int, int]


def write_header(header: Header, body: bytes) -> bytes:
    """Return a whole file: the header, and the bytes that follow it."""
    lengths = header.lengths
    parts = [
        _LENGTHS.pack(lengths.max_error, *lengths.origin, lengths.place_step, lengths.code_step),
        _text(header.unit),
        bytes([DICTIONARY_KINDS.index(header.dictionary.kind)]),
    ]
    if header.dictionary.kind == MODEL:
        parts += [_text(header.dictionary.name), header.dictionary.sha256]
    parts += [_number(getattr(header.counts, entry.name)) for entry in fields(Counts)]
    parts += [_number(size) for size in header.sizes]
    rest = b"".join([*parts, body])
    return _FIXED.pack(MAGIC, VERSION, 0, _digest(rest)) + rest


def read_header(data: bytes) -> tuple[Header, bytes]:
    """Read the header of a file.

    Returns
    -------
    header : Header
    body : bytes
        What follows it, as long as `sizes` say.

    Raises
    ------
    FormatError
        If the version is not known.
    ReadError
        If these are no bytes of such a file, or damaged ones.
    """
    if len(data) < _FIXED.size or data[:4] != MAGIC:
        raise ReadError("this is no .qpz file")
    _, version, reserved, digest = _FIXED.unpack_from(data)
    if version != VERSION or reserved:
        raise FormatError(f"a .qpz file of version {version}; version {VERSION} is read")
    rest = data[_FIXED.size :]
    if _digest(rest) != digest:
        raise ReadError("the .qpz file is damaged: its digest does not fit")
    reader = _Fields(rest)
    lengths = _checked(_LENGTHS.unpack(reader.take(_LENGTHS.size)))
    unit = reader.text()
    dictionary = _dictionary(reader)
    counts = Counts(*(reader.number() for _ in fields(Counts)))
    sizes = (reader.number(), reader.number(), reader.number())
    body = reader.rest()
    if len(body) != sum(sizes):
        raise ReadError(f"the .qpz file has {len(body):,} bytes of numbers and claims {sum(sizes):,}")
    return Header(lengths, unit, dictionary, counts, sizes), body


def _dictionary(reader: "_Fields") -> DictionaryReference:
    number = reader.take(1)[0]
    if number >= len(DICTIONARY_KINDS):
        raise ReadError(f"the .qpz file names a dictionary of the unknown kind {number}")
    kind = DICTIONARY_KINDS[number]
    if kind != MODEL:
        return DictionaryReference(kind)
    return DictionaryReference(MODEL, reader.text(), reader.take(32))


def _checked(values: tuple[float, ...]) -> Lengths:
    max_error, x, y, z, place_step, code_step = values
    steps = (max_error, place_step, code_step)
    if not all(_SMALLEST_STEP < step < _LARGEST_LENGTH for step in steps):
        raise ReadError("the .qpz file has a step that is no length")
    if not all(math.isfinite(value) and abs(value) < _LARGEST_LENGTH for value in (x, y, z)):
        raise ReadError("the .qpz file has an origin that is no place")
    return Lengths(max_error, (x, y, z), place_step, code_step)


def _digest(rest: bytes) -> bytes:
    return hashlib.blake2b(rest, digest_size=_DIGEST_BYTES).digest()


def _text(text: str) -> bytes:
    encoded = text.encode()[:_LONGEST_TEXT]
    return _number(len(encoded)) + encoded


def _number(value: int) -> bytes:
    result = bytearray()
    while value > 0x7F:
        result.append(value & 0x7F | 0x80)
        value >>= 7
    return bytes([*result, value])


class _Fields:
    """Reads one field after the other; ReadError where they end too early."""

    def __init__(self, data: bytes) -> None:
        self._data = data
        self._next = 0

    def take(self, count: int) -> bytes:
        """Read so many bytes."""
        found = self._data[self._next : self._next + count]
        if len(found) < count:
            raise ReadError("the .qpz file ends within its header")
        self._next += count
        return found

    def number(self) -> int:
        """Read a number below 2**63."""
        value = 0
        for place in range(_LONGEST_NUMBER):
            byte = self.take(1)[0]
            value |= (byte & 0x7F) << (7 * place)
            if byte < 0x80:
                return value
        raise ReadError("a number in the header of the .qpz file is too long")

    def text(self) -> str:
        """Read a text."""
        length = self.number()
        if length > _LONGEST_TEXT:
            raise ReadError("a text in the header of the .qpz file is too long")
        try:
            return self.take(length).decode()
        except UnicodeDecodeError as error:
            raise ReadError("a text in the header of the .qpz file is no UTF-8") from error

    def rest(self) -> bytes:
        """Read all that is left."""
        return self._data[self._next :]

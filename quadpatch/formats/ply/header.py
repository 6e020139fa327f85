"""PLY headers: elements, their properties, and the lines as they stood in the file.

The lines are kept byte for byte, so that a header can be written again with raised counts and nothing else changed.
Lines end in LF, CR LF or, in very old files, CR; which one is seen from the first line, because a binary body may
itself begin with a byte that looks like a line end.

Tested in `tests/quadpatch/formats/ply/test_reader.py`.
"""

import re
from dataclasses import dataclass, replace

import numpy as np

from quadpatch.errors import FormatError, ReadError

_CODES = {
    **{"char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4"},
    **{"float": "f4", "double": "f8", "int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2"},
    **{"int32": "i4", "uint32": "u4", "int64": "i8", "uint64": "u8", "float32": "f4", "float64": "f8"},
}
_ORDERS = {"ascii": "ascii", "binary_little_endian": "<", "binary_big_endian": ">"}
_LONGEST_HEADER = 1 << 20
# Elements and properties together. Scans declare a few dozen; reading takes time for each, whatever the body holds.
_MOST_DECLARATIONS = 4096


@dataclass(frozen=True)
class Property:
    """One property: numpy `code` without byte order (`f4`), and `count_code` if it is a list."""

    name: str
    code: str
    count_code: str | None = None


@dataclass(frozen=True)
class Element:
    """One element: `line` and `last_line` are where its `element` and its last `property` line stand."""

    name: str
    count: int
    properties: tuple[Property, ...]
    line: int
    last_line: int

    def find(self, *names: str) -> int | None:
        """Position of the first property with one of these names, None if there is none."""
        return next((i for i, prop in enumerate(self.properties) if prop.name in names), None)


@dataclass(frozen=True)
class Header:
    """A parsed header.

    Attributes
    ----------
    lines : tuple of bytes
        Every line with its line end, `ply` to `end_header`.
    line_end : bytes
    order : str
        `ascii`, or `<` or `>` as numpy writes byte orders.
    elements : tuple of Element
    size : int
        Bytes up to the body.
    """

    lines: tuple[bytes, ...]
    line_end: bytes
    order: str
    elements: tuple[Element, ...]
    size: int

    @property
    def is_ascii(self) -> bool:
        """Whether the body is text."""
        return self.order == "ascii"


def parse_header(data: bytes) -> Header:
    """Parse the header of a PLY file.

    Parameters
    ----------
    data : bytes
        The file.

    Raises
    ------
    ReadError
        Naming the line that is no PLY.
    FormatError
        For an encoding or version that is unknown.
    """
    lines, line_end = _header_lines(data)
    order, n_declarations = None, 0
    elements: list[Element] = []
    for number, line in enumerate(lines[1:-1], start=1):
        words = line.decode("latin-1").split()
        keyword = words[0] if words else "comment"
        if keyword == "format":
            order = _parse_format(words)
        elif keyword in ("element", "property"):
            n_declarations += 1
            if n_declarations > _MOST_DECLARATIONS:
                raise ReadError(f"the PLY header declares more than {_MOST_DECLARATIONS} elements and properties")
            _parse_declaration(words, number, elements)
        elif keyword not in ("comment", "obj_info"):
            raise ReadError(f"PLY header line {number + 1}: unknown keyword {keyword[:40]!r}")
    if order is None:
        raise ReadError("the PLY header has no format line")
    _check_names("elements", [element.name for element in elements])
    for element in elements:
        _check_names(f"properties of {element.name[:40]!r}", [prop.name for prop in element.properties])
    return Header(tuple(lines), line_end, order, tuple(elements), sum(map(len, lines)))


def _check_names(what: str, names: list[str]) -> None:
    if len(set(names)) < len(names):
        raise ReadError(f"two {what} in the PLY header have the same name: {', '.join(names)[:200]}")


def _header_lines(data: bytes) -> tuple[list[bytes], bytes]:
    start = re.match(rb"ply[ \t]*(\r\n|\n|\r)", data[:64])
    if start is None:
        raise ReadError("the file does not begin with a line `ply`")
    line_end = start.group(1)
    separator = b"\r" if line_end == b"\r" else b"\n"
    lines: list[bytes] = []
    at = 0
    while not lines or lines[-1].strip() != b"end_header":
        stop = data.find(separator, at, _LONGEST_HEADER) + 1
        if stop == 0:
            # A mesh of zero elements may end right behind the keyword.
            if data[at:_LONGEST_HEADER].strip() != b"end_header":
                raise ReadError("the PLY header has no end_header line")
            stop = len(data)
        lines.append(data[at:stop])
        at = stop
    return lines, line_end


def _parse_format(words: list[str]) -> str:
    if len(words) != 3 or words[1] not in _ORDERS or words[2] != "1.0":
        raise FormatError(f"PLY {' '.join(words)[:80]!r} is not read; known are {', '.join(_ORDERS)}, version 1.0")
    return _ORDERS[words[1]]


def _parse_declaration(words: list[str], number: int, elements: list[Element]) -> None:
    if words[0] == "element":
        elements.append(_parse_element(words, number))
    elif not elements:
        raise ReadError(f"PLY header line {number + 1}: a property before the first element")
    else:
        properties = (*elements[-1].properties, _parse_property(words, number))
        elements[-1] = replace(elements[-1], properties=properties, last_line=number)


def _parse_element(words: list[str], number: int) -> Element:
    if len(words) != 3 or not re.fullmatch(r"[0-9]{1,18}", words[2]):
        raise ReadError(f"PLY header line {number + 1}: {' '.join(words)[:80]!r} is no `element NAME COUNT`")
    return Element(words[1], int(words[2]), (), number, number)


def _parse_property(words: list[str], number: int) -> Property:
    where = f"PLY header line {number + 1}: {' '.join(words)[:80]!r}"
    is_list = len(words) == 5 and words[1] == "list"
    if not is_list and len(words) != 3:
        raise ReadError(f"{where} is no property")
    types = words[2:4] if is_list else words[1:2]
    unknown = [word for word in types if word not in _CODES]
    if unknown:
        raise ReadError(f"{where} has the unknown type {unknown[0]!r}")
    codes = [_CODES[word] for word in types]
    if is_list and codes[0][0] == "f":
        raise ReadError(f"{where} counts its values with a fraction")
    return Property(words[-1], codes[-1], codes[0] if is_list else None)


def without_properties(header: Header, element: Element, names: set[str]) -> Header:
    """Leave the lines of some properties out of a header, for one that is written again; sizes stay as they were."""
    lines = list(header.lines)
    declared = [i for i in range(element.line + 1, element.last_line + 1) if lines[i].split()[:1] == [b"property"]]
    for number, prop in zip(declared, element.properties, strict=True):
        if prop.name in names:
            lines[number] = b""
    return replace(header, lines=tuple(lines))


def rewrite_header(
    header: Header, counts: dict[str, int], added: dict[str, list[tuple[str, str]]], comment: bytes = b""
) -> bytes:
    """Write a header again with other counts and further properties.

    Parameters
    ----------
    header : Header
    counts : dict
        New row counts by element name.
    added : dict
        (type word, property name) pairs to append, by element name.
    comment : bytes
        A line to put in front of the last, with its line end.

    Returns
    -------
    bytes
        All other lines as they were.
    """
    lines = list(header.lines)
    for element in header.elements:
        if element.name in counts:
            count = str(counts[element.name]).encode()
            lines[element.line] = re.sub(rb"[0-9]+(\s*)$", count + rb"\g<1>", lines[element.line])
        for type_word, name in added.get(element.name, []):
            lines[element.last_line] += f"property {type_word} {name}".encode() + header.line_end
    return b"".join([*lines[:-1], comment, lines[-1]])


def value_range(code: str) -> tuple[int, int]:
    """Lowest and highest value of an integer code such as `u1`."""
    limits = np.iinfo(np.dtype(code))
    return int(limits.min), int(limits.max)

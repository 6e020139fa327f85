"""The long lists of a 3MF model, taken out of its text before the XML parser sees them.

Nearly all of a model are `vertex` and `triangle` elements that look alike. Where every element of a list has the usual
form, a regular expression reads the list five times faster than XML events do; any other list is left to the parser.
"""

import re
from collections.abc import Iterator
from typing import NamedTuple

from quadpatch.errors import ReadError
from quadpatch.formats.text import parse_numbers
from quadpatch.types import FloatArray

Material = tuple[str | None, str | None, str | None, str | None]
PLAIN: Material = (None, None, None, None)

_OPENING = re.compile(rb"<((?:[\w.-]+:)?)(vertices|triangles)[ \t\r\n]*>")
_ATTRIBUTE = re.compile(rb'(pid|p1|p2|p3)[ \t\r\n]*=[ \t\r\n]*"([0-9]+)"')
_SPACE = rb"[ \t\r\n]+"
_NUMBER = rb'="([-+.0-9eE]+)"'
_ELEMENTS = {
    b"vertices": re.compile(
        rb"<(?:[\w.-]+:)?vertex%b" % _SPACE + _SPACE.join(name + _NUMBER for name in (b"x", b"y", b"z")) + rb"\s*/>"
    ),
    b"triangles": re.compile(
        rb"<(?:[\w.-]+:)?triangle%b" % _SPACE
        + _SPACE.join(name + _NUMBER for name in (b"v1", b"v2", b"v3"))
        + rb"((?:%b(?:pid|p1|p2|p3)=\"[0-9]+\")*)\s*/>" % _SPACE
    ),
}


class Block(NamedTuple):
    """A list of the usual form: name, bytes from behind its opening to its closing tag, rows of three, materials."""

    name: str
    start: int
    stop: int
    table: FloatArray
    materials: list[Material]


def find_blocks(text: bytes) -> Iterator[Block]:
    """Find the lists of the usual form in a model.

    Parameters
    ----------
    text : bytes
        XML; whether a list stands where it counts, and not in a comment, is for the parser to say.

    Yields
    ------
    Block
    """
    at = 0
    while opening := _OPENING.search(text, at):
        name = opening.group(2)
        start = opening.end()
        stop = text.find(b"</" + opening.group(1) + name, start)
        if stop < 0:
            return
        at = stop
        found = _ELEMENTS[name].findall(text, start, stop)
        # Every tag is one of the usual form, or the parser has to read the list.
        if not found or text.count(b"<", start, stop) != len(found):
            continue
        try:
            numbers = parse_numbers(b" ".join(number for row in found for number in row[:3]))
        except ReadError:
            continue
        materials = [_material(row[3]) if row[3] else PLAIN for row in found] if name == b"triangles" else []
        yield Block(name.decode(), start, stop, numbers.reshape(-1, 3), materials)


def _material(attributes: bytes) -> Material:
    found = {name.decode(): value.decode() for name, value in _ATTRIBUTE.findall(attributes)}
    return found.get("pid"), found.get("p1"), found.get("p2"), found.get("p3")

"""A 3MF package handed back with vertices at other positions.

The `x`, `y` and `z` of vertices that moved change; all other text stays. An object that is built several times has one
list of vertices: where its places moved differently, there is no way to write that into the package.

Tested in `tests/quadpatch/formats/test_moving.py`.
"""

import re
from typing import TYPE_CHECKING

import numpy as np

from quadpatch.errors import StageError
from quadpatch.formats.scan import Moved, Scan
from quadpatch.formats.scene_parts import moved_parts
from quadpatch.formats.threemf.model import ModelObject
from quadpatch.formats.words import replace_numbers
from quadpatch.types import BoolArray, FloatArray, IntArray, Vertices

if TYPE_CHECKING:
    from quadpatch.formats.threemf.source import Origin, ThreemfSource

_CLOSING = re.compile(rb"</((?:[\w.-]+:)?)vertices")
# What may hold anything: comments, character data, instructions. Or the tag of a vertex with its attributes.
_VERTEX = re.compile(
    rb"<!--.*?-->|<!\[CDATA\[.*?\]\]>|<\?.*?\?>|<(?:[\w.-]+:)?vertex((?:\s+[\w:.-]+\s*=\s*(?:\"[^\"]*\"|'[^']*'))*)\s*/?>",
    re.DOTALL,
)
_COORDINATE = re.compile(rb"(?<=\s)([xyz])\s*=\s*[\"']\s*([^\"'\s]+)\s*[\"']")


def move_in_threemf(source: "ThreemfSource", scan: Scan, moved: Moved) -> bytes:
    """Hand a 3MF package back with vertices at other positions.

    Parameters
    ----------
    source : ThreemfSource
    scan : Scan
    moved : Moved

    Raises
    ------
    StageError
        If the package can't hold the moved vertices.
    """
    wanted = _wanted(source, scan, moved)
    texts = {path: model.text for path, model in source.models.items()}
    changed: dict[str, bytes] = {}
    # Objects at the end of a text first: the places of those in front of them stay.
    entries = {origin: source.models[origin.path].objects[origin.object_id] for origin in wanted}
    for origin in sorted(wanted, key=lambda origin: -entries[origin].vertices_end):
        positions, is_moved = wanted[origin]
        if is_moved.any():
            text = changed.get(origin.path, texts[origin.path])
            changed[origin.path] = _replaced(text, entries[origin], positions, is_moved)
    return source.package.with_changed(changed) if changed else source.package.data


def _wanted(source: "ThreemfSource", scan: Scan, moved: Moved) -> dict["Origin", tuple[Vertices, BoolArray]]:
    """Positions of every object in its own coordinates, and which of them moved."""
    wanted: dict[Origin, tuple[Vertices, BoolArray]] = {}
    for origin, placed in zip(source.origins, moved_parts(source.parts, scan, moved), strict=True):
        positions, is_moved, is_used = placed.positions, placed.is_moved, placed.is_used
        if origin in wanted:
            held, held_moved = wanted[origin]
            if (np.abs(held - positions)[is_used] > 2 * placed.rounding).any():
                name = origin.object_id[:40]
                raise StageError(f"the package builds object {name!r} several times, and its places moved differently")
            is_moved = is_moved | held_moved
        wanted[origin] = positions, is_moved
    return wanted


def _replaced(text: bytes, entry: ModelObject, positions: FloatArray, is_moved: BoolArray) -> bytes:
    starts, stops = _coordinate_spans(text, entry)
    return replace_numbers(text, (starts, stops), entry.vertices, positions, is_moved)


def _coordinate_spans(text: bytes, entry: ModelObject) -> tuple[IntArray, IntArray]:
    """First byte of each coordinate of an object and the byte behind it, each (n, 3)."""
    closing = _CLOSING.match(text, entry.vertices_end)
    opening = -1 if closing is None else text.rfind(b"<" + closing[1] + b"vertices", 0, entry.vertices_end)
    spans: list[tuple[int, int]] = []
    for tag in _VERTEX.finditer(text, max(opening, 0), entry.vertices_end):
        if tag[1] is not None:
            found = {match[1]: match.span(2) for match in _COORDINATE.finditer(text, *tag.span(1))}
            spans += [found.get(name, (0, 0)) for name in (b"x", b"y", b"z")]
    table = np.array(spans, dtype=np.int64).reshape(-1, 3, 2)
    if len(table) != len(entry.vertices) or not table[..., 1].all():
        raise StageError("the package lists its vertices in a way that is read but can't be changed in place")
    return table[..., 0], table[..., 1]

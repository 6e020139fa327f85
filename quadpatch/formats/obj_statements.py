"""The lines of an OBJ file by their keyword."""

import re
from dataclasses import dataclass

import numpy as np

from quadpatch.formats.lines import Lines, split_lines
from quadpatch.types import IntArray

VERTEX, TEXTURE, NORMAL, FACE, MATERIAL, LIBRARY = 1, 2, 3, 4, 5, 6
_KEYWORDS = {VERTEX: b"v", TEXTURE: b"vt", NORMAL: b"vn", FACE: b"f", MATERIAL: b"usemtl", LIBRARY: b"mtllib"}
_CONTINUATION = re.compile(rb"\\[ \t]*(\r\n|\n|\r)")


@dataclass(frozen=True)
class ObjStatements:
    """Lines of an OBJ file, and which keyword each has (0 for all others)."""

    lines: Lines
    kinds: IntArray

    def of(self, kind: int) -> Lines:
        """Return what stands behind the keyword in the lines of one kind."""
        return self.lines.select(self.kinds == kind).behind(len(_KEYWORDS[kind]))

    def count_before(self, kind: int) -> IntArray:
        """How many lines of one kind stand before each face, (n_faces,)."""
        return np.asarray(np.cumsum(self.kinds == kind)[self.kinds == FACE], dtype=np.int64)


def split_statements(text: bytes) -> ObjStatements:
    """Find the lines of an OBJ text, continued ones joined; every byte keeps its place."""
    if b"\\" in text:
        text = _CONTINUATION.sub(lambda match: b" " * len(match[0]), text)
    lines = split_lines(text, keep_comments_of=(b"usemtl", b"mtllib"))
    kinds = np.zeros(len(lines.starts), dtype=np.int64)
    for kind, keyword in _KEYWORDS.items():
        kinds[lines.begin_with(keyword)] = kind
    return ObjStatements(lines, kinds)

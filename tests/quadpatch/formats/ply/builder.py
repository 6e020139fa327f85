"""PLY files written value by value with `struct`, independently of the code under test."""

import struct
from dataclasses import dataclass
from typing import Any

from hypothesis import strategies as st

WORDS = {
    "b": ("char", "int8"),
    "B": ("uchar", "uint8"),
    "h": ("short", "int16"),
    "H": ("ushort", "uint16"),
    "i": ("int", "int32"),
    "I": ("uint", "uint32"),
    "f": ("float", "float32"),
    "d": ("double", "float64"),
}
RANGES = {"b": (-128, 127), "B": (0, 255), "h": (-(2**15), 2**15 - 1), "H": (0, 2**16 - 1)}
RANGES |= {"i": (-(2**31), 2**31 - 1), "I": (0, 2**32 - 1)}


@dataclass
class Prop:
    """A property and its values: numbers, or lists where it has a count code."""

    name: str
    code: str
    count_code: str | None
    values: list[Any]


@dataclass
class Ply:
    """A PLY file to be written."""

    order: str
    line_end: str
    elements: list[tuple[str, int, list[Prop]]]
    comments: list[str]

    def encode(self) -> bytes:
        """Write the file."""
        words = {"ascii": "ascii", "<": "binary_little_endian", ">": "binary_big_endian"}
        lines = ["ply", f"format {words[self.order]} 1.0", *self.comments]
        for name, count, props in self.elements:
            lines.append(f"element {name} {count}")
            for prop in props:
                kind = WORDS[prop.code][0]
                listed = f"list {WORDS[prop.count_code][1]} " if prop.count_code else ""
                lines.append(f"property {listed}{kind} {prop.name}")
        head = self.line_end.join([*lines, "end_header", ""]).encode()
        rows = b"".join(self._row(props, row) for _, count, props in self.elements for row in range(count))
        return head + rows

    def _row(self, props: list[Prop], row: int) -> bytes:
        if self.order == "ascii":
            words: list[str] = []
            for prop in props:
                value = prop.values[row]
                words += [str(len(value)), *map(repr, value)] if prop.count_code else [repr(value)]
            return (" ".join(words) + self.line_end).encode()
        parts: list[bytes] = []
        for prop in props:
            value = prop.values[row]
            if prop.count_code:
                parts.append(struct.pack(f"{self.order}{prop.count_code}", len(value)))
                parts.append(struct.pack(f"{self.order}{len(value)}{prop.code}", *value))
            else:
                parts.append(struct.pack(f"{self.order}{prop.code}", value))
        return b"".join(parts)


def numbers(code: str) -> st.SearchStrategy:
    if code in RANGES:
        return st.integers(*RANGES[code])
    # Short decimals are the same number as float32, float64 and text.
    return st.integers(-(2**20), 2**20).map(lambda n: n / 64)


@st.composite
def properties(draw: st.DrawFn, names: list[str], count: int) -> Prop:
    name = draw(st.sampled_from(names))
    names.remove(name)
    code = draw(st.sampled_from(sorted(WORDS)))
    if draw(st.booleans()):
        return Prop(name, code, None, draw(st.lists(numbers(code), min_size=count, max_size=count)))
    length = (
        st.lists(numbers(code), max_size=3) if draw(st.booleans()) else st.lists(numbers(code), min_size=2, max_size=2)
    )
    return Prop(name, code, draw(st.sampled_from("BHib")), draw(st.lists(length, min_size=count, max_size=count)))


@st.composite
def ply_files(draw: st.DrawFn) -> tuple[Ply, list[list[float]], list[list[int]]]:
    """A file with elements and properties of any kind around its mesh; the mesh's vertices and triangles."""
    n_vertices = draw(st.integers(3, 8))
    vertices = draw(st.lists(st.lists(numbers("f"), min_size=3, max_size=3), min_size=n_vertices, max_size=n_vertices))
    corner = st.integers(0, n_vertices - 1)
    faces = draw(st.lists(st.lists(corner, min_size=3, max_size=3), min_size=1, max_size=6))
    names = ["quality", "flags", "red", "nx", "s", "custom", "extra"]
    vertex = [
        Prop(axis, "fd"[draw(st.integers(0, 1))], None, [row[i] for row in vertices]) for i, axis in enumerate("xyz")
    ]
    vertex += draw(st.lists(properties(names, n_vertices), max_size=3))
    names = ["flags", "texnumber", "quality", "custom", "extra"]
    index = Prop(draw(st.sampled_from(["vertex_indices", "vertex_index"])), draw(st.sampled_from("BHiI")), "B", faces)
    face = [index, *draw(st.lists(properties(names, len(faces)), max_size=3))]
    elements = [
        ("vertex", n_vertices, draw(st.permutations(vertex))),
        ("face", len(faces), draw(st.permutations(face))),
    ]
    for name in draw(st.lists(st.sampled_from(["edge", "camera", "material"]), unique=True, max_size=2)):
        count = draw(st.integers(0, 3))
        props = draw(st.lists(properties(["a", "b", "c"], count), min_size=1, max_size=2))
        elements.insert(draw(st.integers(0, len(elements))), (name, count, props))
    comments = draw(st.lists(st.sampled_from(["comment made by hand", "obj_info num_cols 512", "comment"]), max_size=2))
    order = draw(st.sampled_from(["ascii", "<", ">"]))
    ply = Ply(order, draw(st.sampled_from(["\n", "\r\n"])), elements, comments)
    return ply, vertices, faces

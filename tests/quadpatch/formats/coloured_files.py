"""Files of all formats that hold colours of vertices."""

from collections.abc import Callable

import numpy as np

from quadpatch.formats.limits import ReadLimits
from quadpatch.formats.merged_scene import merge_scene
from quadpatch.formats.ply.reader import read_ply
from quadpatch.formats.scan import Scan
from quadpatch.formats.writing import ENCODERS
from quadpatch.types import FloatArray, TriangleMesh
from tests.quadpatch.formats.fills import EMPTY


def coloured_ply(mesh: TriangleMesh, colours: FloatArray, word: str = "uchar", names: str = "red green blue") -> bytes:
    """Write colours (n, 3), 0..255, as whole numbers (`uchar`, `ushort`) or as fractions (`float`)."""
    code, top = {"uchar": ("u1", 255), "ushort": ("<u2", 65535), "float": ("<f4", 1)}[word]
    used, triangles = np.unique(mesh.triangles, return_inverse=True)
    rows = np.zeros(len(used), [("x", "<f8", 3), ("c", code, 3)])
    scaled = colours[used] * (top / 255)
    rows["x"], rows["c"] = mesh.vertices[used], scaled if word == "float" else np.rint(scaled)
    faces = np.zeros(len(mesh.triangles), [("n", "u1"), ("v", "<i4", 3)])
    faces["n"], faces["v"] = 3, triangles.reshape(-1, 3)
    lines = ["ply", "format binary_little_endian 1.0", f"element vertex {len(rows)}"]
    lines += [f"property double {axis}" for axis in "xyz"] + [f"property {word} {name}" for name in names.split()]
    lines += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header", ""]
    return "\n".join(lines).encode() + rows.tobytes() + faces.tobytes()


def _encoded(suffix: str) -> Callable[[TriangleMesh, FloatArray], bytes]:
    def write(mesh: TriangleMesh, colours: FloatArray) -> bytes:
        return ENCODERS[suffix](merge_scene(read_ply(coloured_ply(mesh, colours), ReadLimits()), EMPTY))

    return write


def _whole_obj(mesh: TriangleMesh, colours: FloatArray) -> bytes:
    used, triangles = np.unique(mesh.triangles, return_inverse=True)
    rows = zip(mesh.vertices[used].tolist(), np.rint(colours[used]).astype(int).tolist(), strict=True)
    text = [f"v {x} {y} {z} {r} {g} {b}" for (x, y, z), (r, g, b) in rows]
    text += [f"f {a} {b} {c}" for a, b, c in (triangles.reshape(-1, 3) + 1).tolist()]
    return "\n".join([*text, ""]).encode()


# By a name that ends with the suffix.
FILES: dict[str, Callable[[TriangleMesh, FloatArray], bytes]] = {
    "bytes.ply": coloured_ply,
    "words.ply": lambda mesh, colours: coloured_ply(mesh, colours, "ushort"),
    "fractions.ply": lambda mesh, colours: coloured_ply(mesh, colours, "float", "r g b"),
    "diffuse.ply": lambda mesh, colours: coloured_ply(mesh, colours, "uchar", "diffuse_red diffuse_green diffuse_blue"),
    "fractions.obj": _encoded("obj"),
    "whole.obj": _whole_obj,
    "scan.off": _encoded("off"),
    "scan.glb": _encoded("glb"),
}


def colours_of(scan: Scan) -> FloatArray:
    """Red, green and blue (n, 3) of the vertices of a file."""
    assert scan.source is not None
    colours = scan.source.vertex_colours(scan)
    assert colours is not None
    return colours[:, :3]

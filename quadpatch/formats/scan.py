"""What a file held, and what a repair adds to it.

A `Scan` keeps the file's own vertices and faces in the file's order, together with whatever the writer of that
format needs to hand them back bit for bit. A `Fill` only ever adds: it names measured vertices by their index in
the file and new vertices by the indices after them.
"""

from dataclasses import dataclass, field

from quadpatch.types import FloatArray, IntArray, Triangles, Vertices


@dataclass(frozen=True)
class Scan:
    """A mesh file in memory.

    Attributes
    ----------
    vertices : (n, 3) float64
        As in the file, in the file's order and unit, not welded.
    triangles : (m, 3) int64
        The file's faces, polygons and strips cut into triangles.
    format : str
        `ply`, `stl`, `obj`, `off`, `glb`, `gltf` or `3mf`.
    unit : str or None
        Length unit that the file states (`millimeter`, `meter`, ...), None where it states none.
    source : object
        What the writer of the format needs; private to `quadpatch.formats`.
    """

    vertices: Vertices
    triangles: Triangles
    format: str
    unit: str | None = None
    source: object = field(default=None, repr=False)


@dataclass(frozen=True)
class Fill:
    """Invented surface, to be appended to a scan.

    Attributes
    ----------
    vertices : (k, 3) float64
        New vertices only.
    triangles : (l, 3) int64
        Into the scan's vertices followed by `vertices`.
    vertex_hole, vertex_confidence : (k,) int64, (k,) float64
        Hole id and confidence 0..1 of every new vertex.
    triangle_hole, triangle_confidence : (l,) int64, (l,) float64
        The same of every new triangle.
    """

    vertices: Vertices
    triangles: Triangles
    vertex_hole: IntArray
    vertex_confidence: FloatArray
    triangle_hole: IntArray
    triangle_confidence: FloatArray

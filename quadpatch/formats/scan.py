"""What a file held, what a repair adds to it, and where other tasks move it.

A `Scan` keeps the file's own vertices and faces in the file's order, together with whatever the writer of that
format needs to hand them back bit for bit. A `Fill` only ever adds: it names measured vertices by their index in
the file and new vertices by the indices after them. `Moved` adds and removes nothing.

Tested in `tests/quadpatch/formats/test_reading.py`.
"""

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from quadpatch.formats.surface_texture import SurfaceTexture, TexturePage
from quadpatch.types import BoolArray, FloatArray, IntArray, Triangles, Vertices

# A file, whole or piece by piece.
FileBytes = bytes | Iterable[bytes | memoryview]


@dataclass(frozen=True)
class VertexAttributes:
    """How the measured surface looks, in the terms that all formats share.

    Attributes
    ----------
    colours : (n, 4) float64 or None
        Red, green, blue, alpha of every vertex, 0..255; NaN where a vertex has none.
    normals : (n, 3) float64 or None
        Of every vertex.
    texture : (m, 3, 2) float64 or None
        Texture coordinates of every triangle's corners, v upwards; NaN where a corner has none.
    """

    colours: FloatArray | None = None
    normals: FloatArray | None = None
    texture: FloatArray | None = None


class WithoutImages:
    """A source that has no texture images, and no files beside it."""

    def surface_texture(self, scan: "Scan") -> SurfaceTexture | None:
        """None; see `Source`."""

    def side_files(self, page: TexturePage) -> dict[str, bytes]:
        """None; see `Source`."""
        return {}


class Source(Protocol):
    """What a reader leaves for the writer of its format."""

    def append(self, scan: "Scan", fill: "Fill") -> FileBytes:
        """Hand the file back with a fill appended."""

    def move(self, scan: "Scan", moved: "Moved") -> bytes:
        """Hand the file back with some vertices at other positions."""

    def vertex_colours(self, scan: "Scan") -> FloatArray | None:
        """Say what colours the vertices have: those of `vertex_attributes` alone."""

    def vertex_attributes(self, scan: "Scan") -> VertexAttributes:
        """Say how the surface looks, for writing it in another format."""

    def surface_texture(self, scan: "Scan") -> SurfaceTexture | None:
        """Say what images lie on the surface; None for none. Raises TextureError where no page could be added."""

    def side_files(self, page: TexturePage) -> dict[str, bytes]:
        """Files, by name, that have to lie beside one that was handed back with a page."""


@dataclass(frozen=True)
class Scan:
    """A mesh file in memory.

    Attributes
    ----------
    vertices : (n, 3) float64
        As in the file, in the file's order and unit, not welded. Finite, or NaN in all three coordinates where the
        reader was told to allow missing vertices.
    triangles : (m, 3) int64
        The file's faces, polygons and strips cut into triangles.
    format : str
        `ply`, `stl`, `obj`, `off`, `glb`, `gltf` or `3mf`.
    unit : str or None
        Length unit that the file states (`millimeter`, `meter`, ...), None where it states none.
    source : Source or None
        The file as it was, private to `quadpatch.formats`; None for a mesh that came from no file.
    next_hole_id : int
        First number for the marks of new holes: above 0 where an earlier repair left marks with numbers.
    """

    vertices: Vertices
    triangles: Triangles
    format: str
    unit: str | None = None
    source: Source | None = field(default=None, repr=False)
    next_hole_id: int = 0


@dataclass(frozen=True)
class Fill:
    """Invented surface, to be appended to a scan.

    Attributes
    ----------
    vertices : (k, 3) float64
        New vertices only.
    triangles : (l, 3) int64
        Into the scan's vertices followed by `vertices`.
    vertex_hole_id, vertex_confidence : (k,) int64, (k,) float64
        Hole id and confidence 0..1 of every new vertex.
    triangle_hole_id, triangle_confidence : (l,) int64, (l,) float64
        The same of every new triangle.
    vertex_colours : (k, 3) float64 or None
        Red, green, blue of every new vertex, 0..255; NaN where it gets those that its rim extends, None where all do.
    page : TexturePage or None
        Image for new triangles; the others get texture coordinates that their rim extends.
    """

    vertices: Vertices
    triangles: Triangles
    vertex_hole_id: IntArray
    vertex_confidence: FloatArray
    triangle_hole_id: IntArray
    triangle_confidence: FloatArray
    vertex_colours: FloatArray | None = None
    page: TexturePage | None = None


@dataclass(frozen=True)
class Moved:
    """New positions of a scan's vertices, and what is told about each.

    Attributes
    ----------
    vertices : (n, 3) float64
        In the scan's order. A vertex that stays has the scan's own three numbers, or three NaN as there.
    properties : dict of (n,) arrays
        Of type float32, uint8, int32 or another one that PLY knows; by name, without white space.
    """

    vertices: Vertices
    properties: dict[str, NDArray[Any]] = field(default_factory=dict)

    def is_moved(self, scan: Scan) -> BoolArray:
        """Whether each vertex of the scan is at another position, (n,) bool; -0.0 and 0.0 are one number."""
        differs = (self.vertices != scan.vertices) & ~(np.isnan(self.vertices) & np.isnan(scan.vertices))
        return np.asarray(differs.any(axis=1))

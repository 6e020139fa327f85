"""A scan and its fill, or a scan that moved, as one mesh, for writing it in another format than its own.

Tested in `tests/quadpatch/formats/test_conversion.py`.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quadpatch.formats.attributes import extend_colours, joined_vertices, triangle_normals, vertex_normals
from quadpatch.formats.moved_normals import moved_vertex_normals
from quadpatch.formats.scan import Fill, Moved, Scan, VertexAttributes
from quadpatch.formats.texture import extend_over_corners
from quadpatch.types import BoolArray, FloatArray, IntArray, Triangles, Vertices
from quadpatch_rules.option_words import CarriedAttribute


@dataclass(frozen=True)
class MergedScene:
    """Measured surface and invented surface behind it.

    Attributes
    ----------
    vertices : (n, 3) float64
    triangles : (m, 3) int64
    vertex_attributes : VertexAttributes
        Of all vertices and triangles; colours without NaN.
    vertex_hole_id, vertex_confidence : (n,) int64, (n,) float64
        -1 and 1 for measured vertices.
    triangle_hole_id, triangle_confidence : (m,) int64, (m,) float64
        -1 and 1 for measured triangles.
    n_measured : int
        Measured triangles; they come first.
    unit : str or None
        Length unit, where the scan's file states one.
    is_marked : bool
        Whether formats that can mark what is invented do so, even where nothing is.
    vertex_properties : dict of (n,) arrays
        Further numbers of the vertices, by name; PLY has a place for them.
    """

    vertices: Vertices
    triangles: Triangles
    vertex_attributes: VertexAttributes
    vertex_hole_id: IntArray
    vertex_confidence: FloatArray
    triangle_hole_id: IntArray
    triangle_confidence: FloatArray
    n_measured: int
    unit: str | None
    is_marked: bool = True
    vertex_properties: dict[str, NDArray[Any]] = field(default_factory=dict)

    @property
    def invented(self) -> BoolArray:
        """True for invented triangles, (m,) bool."""
        return np.arange(len(self.triangles)) >= self.n_measured

    def with_attributes(self, names: Sequence[CarriedAttribute] | None) -> "MergedScene":
        """Return the same with some of its vertex attributes; None takes all."""
        if names is None:
            return self
        has = self.vertex_attributes
        colours, normals = has.colours if "colours" in names else None, has.normals if "normals" in names else None
        texture = has.texture if "texture_coordinates" in names else None
        return replace(self, vertex_attributes=VertexAttributes(colours, normals, texture))

    @property
    def facet_normals(self) -> FloatArray:
        """Unit normals of all triangles, (m, 3); zero for those without area."""
        return triangle_normals(Scan(self.vertices, self.triangles, ""), _as_fill(self.vertices, self.triangles))


def _as_fill(vertices: Vertices, triangles: Triangles) -> Fill:
    nothing = np.zeros(0)
    return Fill(np.zeros((0, 3)), triangles, nothing.astype(np.int64), nothing, nothing.astype(np.int64), nothing)


def merge_scene(scan: Scan, fill: Fill) -> MergedScene:
    """Join a scan and its fill, and extend the scan's vertex attributes over the fill.

    Parameters
    ----------
    scan : Scan
    fill : Fill
    """
    attributes = VertexAttributes() if scan.source is None else scan.source.vertex_attributes(scan)
    colours, normals, texture = attributes.colours, attributes.normals, attributes.texture
    if colours is not None:
        extended = extend_colours(fill, colours, 255.0)
        # Vertices without a colour among coloured ones are white.
        colours = np.nan_to_num(np.concatenate([colours, extended]), nan=255.0).clip(0, 255)
    if normals is not None:
        normals = np.concatenate([normals, vertex_normals(scan, fill)])
    if texture is not None:
        texture = np.concatenate([texture, extend_over_corners(scan, fill, texture)])
    n_vertices, n_triangles = len(scan.vertices), len(scan.triangles)
    return MergedScene(
        vertices=joined_vertices(scan, fill),
        triangles=np.concatenate([scan.triangles, fill.triangles]),
        vertex_attributes=VertexAttributes(colours, normals, texture),
        vertex_hole_id=np.concatenate([np.full(n_vertices, -1), fill.vertex_hole_id]),
        vertex_confidence=np.concatenate([np.ones(n_vertices), fill.vertex_confidence]),
        triangle_hole_id=np.concatenate([np.full(n_triangles, -1), fill.triangle_hole_id]),
        triangle_confidence=np.concatenate([np.ones(n_triangles), fill.triangle_confidence]),
        n_measured=n_triangles,
        unit=scan.unit,
    )


def moved_scene(scan: Scan, moved: Moved) -> MergedScene:
    """Take a scan with its vertices at other positions, and the normals of those that moved anew.

    Parameters
    ----------
    scan : Scan
    moved : Moved
    """
    scene = merge_scene(scan, _as_fill(scan.vertices, np.zeros((0, 3), dtype=np.int64)))
    attributes = scene.vertex_attributes
    if attributes.normals is not None:
        normals = moved_vertex_normals(scan, np.nan_to_num(attributes.normals), moved)
        attributes = replace(attributes, normals=normals)
    return replace(
        scene,
        vertices=moved.vertices,
        vertex_attributes=attributes,
        is_marked=False,
        vertex_properties=moved.properties,
    )

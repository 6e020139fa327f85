"""Fewer triangles for the eye: measured surface is reduced, invented surface stays as it is.

Vertices of equal positions become one. A scan of many more triangles than are wanted is clustered first, since the
collapse of edges would take minutes for millions of them: all vertices within one cell of a grid become one at their
mean, but for those on borders, unless these are long. Edges of what is left are collapsed by their quadric error;
borders, and with them the seams of invented surface, do not move.

References
----------
J. Rossignac, P. Borrel, "Multi-resolution 3D approximations for rendering complex scenes", Modeling in Computer
Graphics, 1993.
M. Garland, P. Heckbert, "Surface simplification using quadric error metrics", SIGGRAPH, 1997.
"""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from quadpatch.mesh.edge_survey import survey_edges
from quadpatch.mesh.meshlab import CollapseOptions, collapse_edges
from quadpatch.mesh.normals import area_vectors, length
from quadpatch.mesh.passes import extent, parts_of
from quadpatch.mesh.topology import compacted
from quadpatch.mesh.weld import first_of_equal
from quadpatch.types import BoolArray, FloatArray, IntArray, TriangleMesh, Triangles

# A scan with so many times the wanted triangles is clustered first, to so many times the wanted ones.
_CLUSTERED_FROM, _CLUSTERED_TO = 4.0, 1.3
# Invented surface of at most this share of the wanted triangles stays as it is.
_KEPT_SHARE = 0.6
# In a clustered scan, borders of at most this share of the wanted triangles stay as they are.
_BORDER_SHARE = 0.25
# Triangles of a surface after clustering, for each square of a cell that fits into its area: measured on scans.
_TRIANGLES_PER_CELL = 2.65
# Triangles that an area is estimated from, and cells for each vertex up to which a table of them is made.
_SAMPLED, _DENSE = 100_000, 8
# Vertices, or triangles, that are looked at together: what is made of them fits into the processor's cache.
_CHUNK = 1 << 14


@dataclass(frozen=True)
class Reduction:
    """A reduced surface in two parts.

    Attributes
    ----------
    measured, invented : TriangleMesh
        Vertices on the seam stand in both, at equal positions.
    measured_colours, invented_colours : (n, c) float64 or None
        Of their vertices, in the terms of the input.
    invented_source : (m,) int64
        The triangle of the input that each invented triangle was.
    """

    measured: TriangleMesh
    invented: TriangleMesh
    measured_colours: FloatArray | None
    invented_colours: FloatArray | None
    invented_source: IntArray


def reduce_surface(
    mesh: TriangleMesh,
    is_invented: BoolArray,
    n_triangles: int,
    colours: FloatArray | None = None,
    *,
    is_bounded: bool = False,
) -> Reduction:
    """Reduce a surface to about so many triangles.

    Parameters
    ----------
    mesh : TriangleMesh
        Finite.
    is_invented : (n_triangles,) bool
    n_triangles : int
    colours : (n_vertices, c) float64, optional
        NaN where a vertex has none.
    is_bounded : bool
        Whether invented surface and borders are reduced as well: for meshes that consist of little else.

    Raises
    ------
    StageError
        If MeshLab refuses the mesh.
    """
    n_invented = int(is_invented.sum())
    keeps = n_invented <= _KEPT_SHARE * n_triangles and not is_bounded
    if not keeps:
        label = _cells_of(mesh, n_triangles)
    elif len(mesh.triangles) - n_invented > _CLUSTERED_FROM * n_triangles:
        label = _clustered(mesh, is_invented, n_triangles)
    else:
        label = first_of_equal(mesh.vertices)
    joined, joined_colours, triangles, source = _joined(mesh, label, colours)
    is_new = is_invented[source]
    n_wanted = max(n_triangles - n_invented, n_triangles // 4)
    measured = _part(joined, joined_colours, triangles[~is_new])
    if keeps and len(measured[0].triangles) > n_wanted:
        measured = _collapsed(*measured, n_wanted)
    invented = _part(joined, joined_colours, triangles[is_new])
    return Reduction(measured[0], invented[0], measured[1], invented[1], source[is_new])


def _clustered(mesh: TriangleMesh, is_invented: BoolArray, n_triangles: int) -> IntArray:
    """Label vertices (n_vertices,): by their cells, but each one of invented surface and of the border apart."""
    # A file that repeats vertices has more of them than triangles; without, equal positions need not be looked for.
    is_repeated = len(mesh.vertices) > len(mesh.triangles) or is_invented.any()
    label = first_of_equal(mesh.vertices) if is_repeated else np.arange(len(mesh.vertices))
    triangles = label[mesh.triangles] if is_repeated else mesh.triangles
    border = survey_edges(triangles, len(label)).on_boundary
    is_apart = border if border.sum() <= _BORDER_SHARE * n_triangles else np.zeros(len(label), bool)
    is_apart[triangles[is_invented]] = True
    cells = _cells_of(mesh, int(_CLUSTERED_TO * n_triangles))
    return np.where(is_apart[label], cells.max(initial=-1) + 1 + label, cells)


def _cells_of(mesh: TriangleMesh, n_triangles: int) -> IntArray:
    """Cell (n_vertices,) of each vertex, in a grid whose cells leave about so many triangles of the surface."""
    low, high = extent(mesh.vertices)
    cell = np.sqrt(_TRIANGLES_PER_CELL * _estimated_area(mesh) / max(n_triangles, 1))
    # Lines without an area have a length even so; and a cell can't be so small that its number is no integer.
    cell = max(cell, float((high - low).max()) / 1e6, np.finfo(np.float64).tiny)
    sides = np.floor((high - low) / cell).astype(np.int64) + 1
    keys = np.zeros(len(mesh.vertices), np.int64)
    steps = np.array([sides[1] * sides[2], sides[2], 1])
    for part in parts_of(len(keys), _CHUNK):
        keys[part] = ((mesh.vertices[part] - low) / cell).astype(np.int64) @ steps
    n_cells = int(sides[0]) * int(sides[1]) * int(sides[2])
    if n_cells > _DENSE * len(keys):
        return np.asarray(np.unique(keys, return_inverse=True)[1], np.int64)
    return compacted(keys, n_cells)[1]


def _estimated_area(mesh: TriangleMesh) -> float:
    step = max(1, len(mesh.triangles) // _SAMPLED)
    some = mesh.triangles[::step]
    return float(length(area_vectors(mesh.vertices, some)).sum()) / 2 * (len(mesh.triangles) / max(len(some), 1))


def _joined(
    mesh: TriangleMesh, label: IntArray, colours: FloatArray | None
) -> tuple[FloatArray, FloatArray | None, Triangles, IntArray]:
    """Join vertices of one label: vertices (k, 3), colours (k, c), triangles (l, 3), and which they were (l,)."""
    n_labels = int(label.max(initial=-1)) + 1
    kept, triangles = _spanning(label, mesh.triangles)
    used, triangles = compacted(triangles, n_labels)
    first = _first_of_corners(triangles, len(used))
    number = np.full(n_labels, -1)
    number[used] = np.arange(len(used))
    member = number[label]
    return (
        _means(mesh.vertices, member, len(used)),
        None if colours is None else _means(colours, member, len(used)),
        triangles[first],
        kept[first],
    )


def _spanning(label: IntArray, triangles: Triangles) -> tuple[IntArray, Triangles]:
    """Find the triangles (l,) whose corners have three labels, and these labels (l, 3)."""
    found, corners = [np.zeros(0, np.int64)], [np.zeros((0, 3), np.int64)]
    for part in parts_of(len(triangles), _CHUNK):
        labels = label[triangles[part]]
        a, b, c = labels.T
        kept = np.flatnonzero((a != b) & (b != c) & (c != a))
        found.append(part.start + kept)
        corners.append(labels[kept])
    return np.concatenate(found), np.concatenate(corners)


def _first_of_corners(triangles: Triangles, n_vertices: int) -> IntArray:
    """Find the first triangle (l,) of each set of corners: clusters leave many of each."""
    ordered = np.sort(triangles, axis=1)
    if n_vertices < 1 << 21:
        keys = (ordered[:, 0] * n_vertices + ordered[:, 1]) * n_vertices + ordered[:, 2]
        return np.sort(np.unique(keys, return_index=True)[1])
    return np.sort(np.unique(ordered, axis=0, return_index=True)[1])


def _means(values: FloatArray, member: IntArray, n: int) -> FloatArray:
    """Average the rows (m, c) of each of n members (m,), -1 for none; those that are NaN do not count."""
    is_counted = (member >= 0) & np.isfinite(values).all(axis=1)
    if not is_counted.all():
        member, values = member[is_counted], values[is_counted]
    count = np.bincount(member, minlength=n)
    totals = [np.bincount(member, weights=column, minlength=n) for column in values.T]
    return np.asarray(np.stack(totals, axis=1) / np.where(count, count, np.nan)[:, None])


def _part(
    vertices: FloatArray, colours: FloatArray | None, triangles: Triangles
) -> tuple[TriangleMesh, FloatArray | None]:
    used, local = compacted(triangles, len(vertices))
    return TriangleMesh(vertices[used], local), None if colours is None else colours[used]


def _collapsed(
    mesh: TriangleMesh, colours: FloatArray | None, n_triangles: int
) -> tuple[TriangleMesh, FloatArray | None]:
    """Collapse edges; a vertex gets the colour of the nearest one before."""
    collapsed = collapse_edges(mesh, n_triangles, CollapseOptions(keeps_border=True))
    nearest = None if colours is None else colours[cKDTree(mesh.vertices).query(collapsed.vertices)[1]]
    return _part(collapsed.vertices, nearest, collapsed.triangles)

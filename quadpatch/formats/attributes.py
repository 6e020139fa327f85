"""Attributes of invented vertices and triangles, taken from the measured ones around the hole.

Continuous attributes (colours, texture coordinates, qualities) are extended harmonically from the rim, unless the fill
brings colours of its own; labels (flags,
materials, texture numbers) are those of the nearest rim vertex or rim triangle; normals are those of the new surface.
"""

import numpy as np
from scipy.spatial import cKDTree

from quadpatch.formats.scan import Fill, Scan
from quadpatch.mesh.harmonic import extend_harmonically
from quadpatch.mesh.topology import touching
from quadpatch.types import FloatArray, IntArray, Triangles, Vertices


def triangle_edges(triangles: Triangles) -> IntArray:
    """Directed edges of triangles, (3 m, 2) int64."""
    return np.stack([triangles.ravel(), triangles[:, [1, 2, 0]].ravel()], axis=1)


def extend_over_vertices(fill: Fill, values: FloatArray) -> FloatArray:
    """Extend values of measured vertices over the new ones.

    Parameters
    ----------
    fill : Fill
    values : (n_measured, d) float64
        NaN and infinities count as unknown.

    Returns
    -------
    (n_new, d) float64
        Within the range of the rim's values; 0 where no rim vertex has one.
    """
    n_measured, n_new = len(values), len(fill.vertices)
    # Only the vertices that the fill touches take part.
    used, local = np.unique(fill.triangles, return_inverse=True)
    measured = used < n_measured
    table = np.full((len(used), values.shape[1]), np.nan)
    table[measured] = values[used[measured]]
    edges = triangle_edges(local.reshape(-1, 3))
    known = np.isfinite(table)
    extended = np.zeros_like(table)
    # Columns that are known at the same vertices, usually all of them, share one factorisation.
    patterns, pattern = np.unique(known, axis=1, return_inverse=True)
    for number in range(patterns.shape[1]):
        columns = np.flatnonzero(pattern.reshape(-1) == number)
        extended[:, columns] = extend_harmonically(edges, patterns[:, number], table[:, columns])
    result = np.zeros((n_new, values.shape[1]))
    result[used[~measured] - n_measured] = np.nan_to_num(extended[~measured])
    return result


def extend_colours(fill: Fill, colours: FloatArray, top: float) -> FloatArray:
    """Extend colours of measured vertices over the new ones, or take those that the fill brings.

    Parameters
    ----------
    fill : Fill
    colours : (n_measured, c) float64
        Red, green, blue, and what else stands behind them; NaN where a vertex has none.
    top : float
        Full intensity.

    Returns
    -------
    (n_new, c) float64
    """
    extended = extend_over_vertices(fill, colours)
    if fill.vertex_colours is not None:
        brought = fill.vertex_colours * (top / 255.0)
        extended[:, :3] = np.where(np.isfinite(brought), brought, extended[:, :3])
    return extended


def rim_vertices(fill: Fill, n_measured: int) -> IntArray:
    """Measured vertices that the fill is joined to, sorted."""
    used = np.unique(fill.triangles)
    return used[used < n_measured]


def nearest_rim_vertex(scan: Scan, fill: Fill) -> IntArray:
    """Measured vertex next to each new one, (n_new,) int64; 0 for a fill that touches no measured vertex."""
    rim = rim_vertices(fill, len(scan.vertices))
    if len(rim) == 0 or len(fill.vertices) == 0:
        return np.zeros(len(fill.vertices), dtype=np.int64)
    _, nearest = cKDTree(scan.vertices[rim]).query(fill.vertices)
    return np.asarray(rim[nearest], dtype=np.int64)


def rim_triangles(scan: Scan, fill: Fill) -> IntArray:
    """Measured triangles with a corner on a rim, sorted."""
    on_rim = np.zeros(len(scan.vertices), dtype=bool)
    on_rim[rim_vertices(fill, len(scan.vertices))] = True
    return np.flatnonzero(touching(scan.triangles, on_rim))


def nearest_rim_triangle(scan: Scan, fill: Fill) -> IntArray:
    """Measured triangle next to each new one, by centroid, (l,) int64; 0 where no measured triangle is near."""
    near = rim_triangles(scan, fill)
    if len(near) == 0 or len(fill.triangles) == 0:
        return np.zeros(len(fill.triangles), dtype=np.int64)
    centroids = positions(scan, fill, fill.triangles).mean(axis=1)
    _, nearest = cKDTree(scan.vertices[scan.triangles[near]].mean(axis=1)).query(centroids)
    return np.asarray(near[nearest], dtype=np.int64)


def positions(scan: Scan, fill: Fill, vertices: IntArray) -> FloatArray:
    """Return the positions (..., 3) of some vertices (...), measured ones followed by the new ones."""
    n_measured = len(scan.vertices)
    is_new = vertices >= n_measured
    found = np.zeros((*vertices.shape, 3))
    found[is_new] = fill.vertices[vertices[is_new] - n_measured]
    found[~is_new] = scan.vertices[vertices[~is_new]]
    return found


def joined_vertices(scan: Scan, fill: Fill) -> Vertices:
    """Measured vertices followed by the new ones."""
    return np.concatenate([scan.vertices, fill.vertices])


def triangle_normals(scan: Scan, fill: Fill) -> FloatArray:
    """Return unit normals of the new triangles, (l, 3); zero for triangles without area."""
    return _unit(_area_vectors(scan, fill))


def vertex_normals(scan: Scan, fill: Fill) -> FloatArray:
    """Return unit normals of the new vertices, (n_new, 3)."""
    return normals_at(scan, fill, len(scan.vertices) + np.arange(len(fill.vertices)))


def normals_at(scan: Scan, fill: Fill, wanted: IntArray) -> FloatArray:
    """Return unit normals of the new surface at some of its vertices, (len(wanted), 3).

    They are the mean over the new triangles around a vertex, weighted by area. All triangles around a new vertex are
    new, so its normal is the whole one; that of a rim vertex leaves the measured side out.
    """
    used, corner = np.unique(fill.triangles, return_inverse=True)
    areas = np.repeat(_area_vectors(scan, fill), 3, axis=0)
    sums = [np.bincount(corner.reshape(-1), areas[:, axis], minlength=len(used)) for axis in range(3)]
    normals = _unit(np.stack(sums, axis=1, dtype=np.float64))
    result = np.zeros((len(wanted), 3))
    is_used = np.isin(wanted, used)
    result[is_used] = normals[np.searchsorted(used, wanted[is_used])]
    return result


def _area_vectors(scan: Scan, fill: Fill) -> FloatArray:
    a, b, c = np.moveaxis(positions(scan, fill, fill.triangles), 1, 0)
    return np.asarray(np.cross(b - a, c - a))


def _unit(vectors: FloatArray) -> FloatArray:
    # Scaling first keeps the squares of very long and very short vectors in range.
    largest = np.abs(vectors).max(axis=1, keepdims=True, initial=0.0)
    scaled = np.divide(vectors, largest, out=np.zeros_like(vectors), where=largest > 0)
    lengths = np.linalg.norm(scaled, axis=1, keepdims=True)
    return np.asarray(np.divide(scaled, lengths, out=np.zeros_like(scaled), where=lengths > 0))

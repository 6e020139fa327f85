"""Charts: fills cut into pieces that lie flat in a texture page without overlap.

A chart is a connected piece of a fill whose normals lie within a cone; it is laid out by looking at it along the axis
of the cone. No triangle is turned over, and lengths shrink by the cosine of the slope at most. Most fills are one
chart; those around a tube, or over a corner, are several. Colours are painted from surface points, so the border
between two charts of a fill shows no seam.
"""

from dataclasses import dataclass

import numpy as np

from quadpatch.mesh.averages import mean_by
from quadpatch.mesh.normals import area_vectors, length, unit
from quadpatch.mesh.topology import components, neighbouring_triangles
from quadpatch.types import BoolArray, FloatArray, IntArray, Triangles, Vertices

# Cosine of the steepest slope of a triangle against the axis of its chart.
_LEAST_FACING = 0.35


@dataclass(frozen=True)
class Charts:
    """Pieces of a surface.

    Attributes
    ----------
    of_triangle : (m,) int64
        Chart of each triangle, counted from 0.
    axes : (n_charts, 3) float64
        Unit vectors that all triangles of a chart face, those without area aside.
    """

    of_triangle: IntArray
    axes: FloatArray

    def __len__(self) -> int:
        """Count of charts."""
        return len(self.axes)

    def halved(self, vertices: Vertices, triangles: Triangles, which: IntArray) -> "Charts":
        """Cut some charts (k,) in two across their longest direction."""
        middles = vertices[triangles].mean(axis=1)
        of_triangle = self.of_triangle.copy()
        for number, chart in enumerate(which.tolist()):
            rows = np.flatnonzero(self.of_triangle == chart)
            centred = middles[rows] - middles[rows].mean(axis=0)
            along = centred @ np.linalg.svd(centred, full_matrices=False)[2][0]
            of_triangle[rows[np.argsort(along, kind="stable")[len(rows) // 2 :]]] = len(self) + number
        return Charts(of_triangle, np.concatenate([self.axes, self.axes[which]]))


def divide_into_charts(vertices: Vertices, triangles: Triangles, group: IntArray) -> Charts:
    """Divide triangles into charts.

    Parameters
    ----------
    vertices : (n, 3) float64
    triangles : (m, 3) int64
    group : (m,) int64
        Triangles of different groups are in different charts.
    """
    areas = area_vectors(vertices, triangles)
    pairs = neighbouring_triangles(triangles)[0]
    pairs = pairs[group[pairs[:, 0]] == group[pairs[:, 1]]]
    of_triangle = np.zeros(len(triangles), np.int64)
    axes: list[FloatArray] = [np.zeros((0, 3))]
    rest = np.arange(len(triangles))
    n_charts = 0
    # Every round takes what faces along the axis of each connected piece out of it, one triangle at least.
    while len(rest):
        piece = _pieces(rest, pairs, len(triangles))
        axis = _axes(areas[rest], piece)
        facing = _faces(areas[rest], axis[piece])
        taken = rest[facing]
        chart = _pieces(taken, pairs, len(triangles))
        first = np.unique(chart, return_index=True)[1]
        of_triangle[taken] = n_charts + chart
        axes.append(axis[piece[facing][first]])
        n_charts += len(first)
        rest = rest[~facing]
    return Charts(of_triangle, np.concatenate(axes))


def flatten(vertices: Vertices, triangles: Triangles, charts: Charts) -> FloatArray:
    """Lay each chart out in a plane: coordinates (m, 3, 2) of the corners of triangles, in mesh units.

    Counter-clockwise triangles stay so. The longest direction of each chart is its first axis.
    """
    z = charts.axes
    x = unit(np.cross(np.eye(3)[np.abs(z).argmin(axis=1)], z))
    planes = np.stack([x, np.cross(z, x)], axis=1)
    chart, n = np.repeat(charts.of_triangle, 3), len(charts)
    points = vertices[triangles.ravel()]
    points = points - _mean(chart, points, n)[chart]
    flat = np.einsum("kij,kj->ki", planes[chart], points)
    spread = [mean_by(chart, flat[:, i] * flat[:, j], n) for i, j in ((0, 0), (0, 1), (1, 1))]
    angle = 0.5 * np.arctan2(2 * spread[1], spread[0] - spread[2])
    cosine, sine = np.cos(angle)[chart], np.sin(angle)[chart]
    turned = np.stack([cosine * flat[:, 0] + sine * flat[:, 1], cosine * flat[:, 1] - sine * flat[:, 0]], axis=1)
    return turned.reshape(-1, 3, 2)


def _pieces(rows: IntArray, pairs: IntArray, n: int) -> IntArray:
    """Find the connected piece of each of some triangles (k,), ascending, counted from 0."""
    position = np.full(n, -1)
    position[rows] = np.arange(len(rows))
    links = position[pairs]
    return components(links[(links >= 0).all(axis=1)], len(rows))


def _axes(areas: FloatArray, piece: IntArray) -> FloatArray:
    """Axis of each piece: its mean normal, or that of its largest triangle where no triangle faces along the mean."""
    n, size = int(piece.max()) + 1, length(areas)
    axes = unit(_mean(piece, areas, n))
    is_proper = _faces(areas, axes[piece]) & (size > 0)
    is_hidden = np.bincount(piece, is_proper, minlength=n) == 0
    is_hidden |= ~axes.any(axis=1)
    order = np.lexsort([size, piece])
    largest = order[np.searchsorted(piece[order], np.arange(n), side="right") - 1]
    axes[is_hidden] = unit(areas[largest[is_hidden]])
    # Pieces without area lie in any plane.
    axes[~axes.any(axis=1)] = (0.0, 0.0, 1.0)
    return np.asarray(axes)


def _faces(areas: FloatArray, axes: FloatArray) -> BoolArray:
    return np.asarray(np.einsum("ij,ij->i", areas, axes) >= _LEAST_FACING * length(areas))


def _mean(group: IntArray, vectors: FloatArray, n: int) -> FloatArray:
    return np.stack([mean_by(group, column, n) for column in vectors.T], axis=1)

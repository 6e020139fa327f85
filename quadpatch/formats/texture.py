"""Texture coordinates of invented triangles where the file gives them for each corner.

A rim vertex on a seam of the texture atlas has one coordinate in each chart. A hole takes the chart that most corners
around it use; rim vertices that are not in that chart take part in the harmonic spreading as unknowns, so a hole is
never stretched across the atlas from one chart to another.
"""

import numpy as np

from quadpatch.formats.attributes import rim_triangles, triangle_edges
from quadpatch.formats.scan import Fill, Scan
from quadpatch.mesh.harmonic import extend_harmonically
from quadpatch.mesh.topology import components
from quadpatch.types import FloatArray, IntArray


def extend_over_corners(scan: Scan, fill: Fill, coordinates: FloatArray) -> FloatArray:
    """Spread the texture coordinates of measured corners over the new triangles.

    Parameters
    ----------
    scan : Scan
    fill : Fill
    coordinates : (m, 3, 2) float64
        Of each corner of the measured triangles; NaN where the file has none.

    Returns
    -------
    (l, 3, 2) float64
        Of each corner of the new triangles; NaN around holes whose rim has no texture.
    """
    near = rim_triangles(scan, fill)
    corner_vertex = scan.triangles[near].ravel()
    corner_value = coordinates[near].reshape(-1, 2)
    corner_chart = _charts(corner_vertex, corner_value)
    # A vertex shared by two holes may need another chart in each: nodes are pairs of hole and vertex.
    n_all = len(scan.vertices) + len(fill.vertices)
    pair = fill.triangle_hole_id[:, np.newaxis] * n_all + fill.triangles
    nodes, node = np.unique(pair, return_inverse=True)
    corner = _corners_in_main_chart(nodes // n_all, nodes % n_all, corner_vertex, corner_chart)
    known = np.asarray(corner >= 0)
    values = np.zeros((len(nodes), 2))
    values[known] = corner_value[corner[known]]
    extended = extend_harmonically(triangle_edges(node.reshape(-1, 3)), known, values)
    return np.asarray(extended[node.reshape(-1, 3)])


def _charts(corner_vertex: IntArray, corner_value: FloatArray) -> IntArray:
    """Chart of each corner, -1 without texture: triangles that share a vertex and its coordinates are in one chart."""
    textured = np.asarray(np.isfinite(corner_value).all(axis=1))
    keys = np.column_stack([corner_vertex.astype(np.float64), np.where(textured[:, np.newaxis], corner_value, 0.0)])
    _, point = np.unique(keys, axis=0, return_inverse=True)
    point = point.reshape(-1)
    size = int(point.max(initial=-1)) + 1
    first, second = point[0::3], point[1::3]
    starts, ends = np.concatenate([first, first]), np.concatenate([second, point[2::3]])
    chart = components(np.stack([starts, ends], axis=1), size)
    return np.where(textured, chart[point], -1)


def _corners_in_main_chart(
    hole: IntArray, vertex: IntArray, corner_vertex: IntArray, corner_chart: IntArray
) -> IntArray:
    """Measured corner that gives each node its coordinates, -1 for nodes that have none in their hole's chart."""
    order = np.argsort(corner_vertex, kind="stable")
    low = np.searchsorted(corner_vertex[order], vertex, side="left")
    counts = np.searchsorted(corner_vertex[order], vertex, side="right") - low
    node = np.repeat(np.arange(len(vertex)), counts)
    place = np.arange(len(node)) - np.repeat(np.cumsum(counts) - counts, counts) + np.repeat(low, counts)
    corner = order[place]
    textured = corner_chart[corner] >= 0
    node, corner = node[textured], corner[textured]
    holes, hole_number = np.unique(hole, return_inverse=True)
    main = _most_used(hole_number.reshape(-1)[node], corner_chart[corner], len(holes))
    fits = corner_chart[corner] == main[hole_number.reshape(-1)[node]]
    result = np.full(len(vertex), -1, dtype=np.int64)
    # Written back to front, so that the first corner of the file stays.
    result[node[fits][::-1]] = corner[fits][::-1]
    return result


def _most_used(group: IntArray, chart: IntArray, n_groups: int) -> IntArray:
    """Most frequent chart of each group, -1 for groups without one; the lower number wins a draw."""
    main = np.full(n_groups, -1, dtype=np.int64)
    pairs, uses = np.unique(np.stack([group, chart], axis=1), axis=0, return_counts=True)
    # Ascending by use, and among equals descending by chart, so the last one written is the one that wins.
    order = np.lexsort([-pairs[:, 1], uses])
    main[pairs[order, 0]] = pairs[order, 1]
    return main

"""Which triangles of a repaired file are invented, and in which hole each lies.

Formats mark invented triangles in different ways, and some by their order alone. What all have in common is told by the
report: how many triangles were added, and the box of each rim.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from quadpatch.mesh.topology import components, directed_edges, edge_keys, neighbouring_triangles
from quadpatch.mesh.weld import first_of_equal
from quadpatch.types import BoolArray, FloatArray, IntArray, TriangleMesh, Triangles, Vertices


def is_behind(n_triangles: int, report: Mapping[str, Any]) -> BoolArray:
    """Mark the invented triangles (n_triangles,) of a file that has them behind all others."""
    n_invented = sum(row["new_triangles"] for row in report["holes"])
    return np.asarray(np.arange(n_triangles) >= n_triangles - n_invented)


def is_added(repaired: TriangleMesh, source: TriangleMesh) -> BoolArray:
    """Mark the triangles (n,) of a repaired mesh whose corners no triangle of its source has."""
    return np.asarray(~np.isin(_corner_bytes(repaired), _corner_bytes(source)))


def _corner_bytes(mesh: TriangleMesh) -> FloatArray:
    """One value (n,) for the corners of each triangle, to be compared: positions as float32, in their order."""
    corners = np.ascontiguousarray(mesh.vertices[mesh.triangles].reshape(-1, 9).astype(np.float32))
    return corners.view(f"V{corners.itemsize * 9}").ravel()


def holes_of(vertices: Vertices, triangles: Triangles, rows: Sequence[Mapping[str, Any]]) -> IntArray:
    """Find the hole that each invented triangle lies in.

    Triangles that share edges belong to one hole: the one whose rim has the box of the edges that they share with no
    other. A bridge counts for the first of its two holes.

    Parameters
    ----------
    vertices : (n, 3) float64
        In the report's unit of length; those at equal positions count as one.
    triangles : (m, 3) int64
        Invented ones alone.
    rows : sequence of mapping
        `holes` of a report; those with new triangles are looked at.

    Returns
    -------
    (m,) int64
        Ids of holes; -1 where no row has new triangles.
    """
    filled = [row for row in rows if row["new_triangles"]]
    if not filled or not len(triangles):
        return np.full(len(triangles), -1)
    triangles = first_of_equal(vertices)[triangles]
    piece = components(neighbouring_triangles(triangles)[0], len(triangles))
    by_id = {row["id"]: row for row in rows}
    tree = cKDTree([_box_of(row, by_id) for row in filled])
    nearest = tree.query(_rim_boxes(vertices, triangles, piece))[1]
    return np.array([row["id"] for row in filled])[nearest][piece]


def _box_of(row: Mapping[str, Any], by_id: Mapping[int, Mapping[str, Any]]) -> FloatArray:
    """Corners (6,) of the box of a rim, or of both rims of a bridge."""
    ids = row["bridge"]["holes"] if row.get("bridge") else [row["id"]]
    boxes = [by_id[id_]["bounding_box"] for id_ in ids]
    low = np.min([box["min"] for box in boxes], axis=0)
    return np.concatenate([low, np.max([box["max"] for box in boxes], axis=0)])


def _rim_boxes(vertices: Vertices, triangles: Triangles, piece: IntArray) -> FloatArray:
    """Corners (k, 6) of the boxes of the borders of k pieces; of a closed one those of all its vertices."""
    edges = directed_edges(triangles)
    _, inverse, count = np.unique(edge_keys(edges, len(vertices)), return_inverse=True, return_counts=True)
    is_border = count[inverse] == 1
    of_edge = np.repeat(piece, 3)
    is_closed = np.bincount(of_edge, is_border) == 0
    chosen = is_border | is_closed[of_edge]
    ends, of_end = edges[chosen].ravel(), np.repeat(of_edge[chosen], 2)
    low, high = np.full((len(is_closed), 3), np.inf), np.full((len(is_closed), 3), -np.inf)
    np.minimum.at(low, of_end, vertices[ends])
    np.maximum.at(high, of_end, vertices[ends])
    return np.concatenate([low, high], axis=1)

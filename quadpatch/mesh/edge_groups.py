"""Faces around every edge: which of the directed edges of a mesh are the same edge."""

from dataclasses import dataclass

import numpy as np

from quadpatch.mesh.topology import directed_edges, edge_keys, order_of
from quadpatch.types import IntArray, Triangles


@dataclass(frozen=True)
class EdgeGroups:
    """The directed edges of a mesh, sorted so that equal ones stand side by side.

    Attributes
    ----------
    edges : (3 n_triangles, 2) int64
        As `directed_edges` has them: edge ``3 t + k`` is of triangle t.
    order : (3 n_triangles,) int64
        Positions in `edges`, one edge behind the other, in the order of the triangles within each.
    starts : (n_edges,) int64
        Where each edge begins in `order`.
    edge : (3 n_triangles,) int64
        Number of the edge that each directed edge is.
    count : (n_edges,) int64
        Faces of each edge.
    """

    edges: IntArray
    order: IntArray
    starts: IntArray
    edge: IntArray
    count: IntArray

    @property
    def pairs(self) -> IntArray:
        """Two directed edges of every edge with exactly two faces, (p, 2) int64."""
        starts = self.starts[self.count == 2]
        return np.stack([self.order[starts], self.order[starts + 1]], axis=1)

    def ends(self) -> IntArray:
        """Vertices of each edge, (n_edges, 2) int64."""
        return self.edges[self.order[self.starts]]


def group_edges(triangles: Triangles, n_vertices: int) -> EdgeGroups:
    """Sort the directed edges of triangles (m, 3) by the edge that they are."""
    edges = directed_edges(triangles)
    keys = edge_keys(edges, max(n_vertices, 1))
    order = order_of(keys, max(n_vertices, 1) ** 2)
    begins = np.ones(len(keys), dtype=bool)
    begins[1:] = keys[order][1:] != keys[order][:-1]
    starts = np.flatnonzero(begins)
    edge = np.zeros(len(keys), np.int64)
    edge[order] = np.cumsum(begins) - 1
    return EdgeGroups(edges, order, starts, edge, np.diff(np.append(starts, len(keys))))

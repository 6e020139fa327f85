"""The cotangent Laplacian of many shapes of the same triangles.

Which vertices are linked, where the entries of a matrix stand, and in which order the free vertices are eliminated
depend on the triangles alone. They are found once; a shape then costs its cotangents, and no sort.

Tested in `tests/quadpatch/filling/test_fairing.py`.
"""

from functools import cached_property

import numpy as np
from scipy import sparse

from quadpatch.filling.banded_solver import EliminationOrder
from quadpatch.mesh.edge_groups import group_edges
from quadpatch.types import BoolArray, FloatArray, IntArray, Triangles, Vertices

# Cotangents beyond this come from slivers and would drown every other weight.
_MAX_COTANGENT = 50.0


class Connectivity:
    """What the Laplacians of all shapes of the same triangles have in common.

    Matrices have the fixed vertices first, then the free ones as they are eliminated.

    Parameters
    ----------
    triangles : (m, 3) int64
    free : (n,) bool
        Vertices that may move.

    Attributes
    ----------
    order : EliminationOrder
        In which free vertices are eliminated.
    place : (n,) int64
        Vertex of each row and column.
    n_fixed : int
    """

    def __init__(self, triangles: Triangles, free: BoolArray) -> None:
        self.triangles, self.free = triangles, free
        self.n_fixed = int((~free).sum())
        groups = group_edges(triangles, len(free))
        self._edge, self._ends = groups.edge, groups.ends()
        self.order = EliminationOrder.of(_links(self._ends, free))
        self.place = np.concatenate([np.flatnonzero(~free), np.flatnonzero(free)[np.argsort(self.order.position)]])

    @cached_property
    def _entries(self) -> "sparse.csr_array[np.int64]":
        """Where each entry of a matrix comes from: from an edge, in either direction, or from a vertex."""
        n, (start, end) = len(self.free), self._ends.T
        number = np.zeros(n, _index_type(n + 2 * len(start)))
        number[self.place] = np.arange(n)
        rows, columns = (number[np.concatenate([*ends, np.arange(n)])] for ends in ((start, end), (end, start)))
        return sparse.csr_array((np.arange(len(rows)), (rows, columns)), shape=(n, n))

    def laplacian(self, weights: FloatArray) -> "sparse.csr_array[np.float64]":
        """Build the matrix (n, n) of weights (m, 3) of the edges opposite the corners; rows sum to zero."""
        # Edge k of a triangle runs from its corner k: it is opposite the corner before that.
        of_edge = np.bincount(self._edge, weights[:, [2, 0, 1]].ravel(), minlength=len(self._ends))
        start, end = self._ends.T
        n = len(self.free)
        diagonal = np.bincount(start, of_edge, minlength=n) + np.bincount(end, of_edge, minlength=n)
        values, entries = np.concatenate([-of_edge, -of_edge, diagonal]), self._entries
        return sparse.csr_array((values[entries.data], entries.indices, entries.indptr), shape=(n, n))


def _index_type(n_entries: int) -> type[np.signedinteger]:
    """Of matrices with so many entries: products of sparse matrices take a third longer with wide indices."""
    index_type: type[np.signedinteger] = sparse.get_index_dtype(maxval=n_entries)
    return index_type


def _links(edges: IntArray, free: BoolArray) -> "sparse.csr_array[np.bool_]":
    """Link free vertices up to three of these edges (k, 2) apart, as the widest term does in whatever shape.

    The term itself would not do: a link may have the weight 0 in one shape, and another one in the next.
    """
    n, (start, end) = len(free), edges.T.astype(_index_type(len(edges)))
    half = sparse.csr_array((np.ones(len(start), bool), (start, end)), shape=(n, n))
    step = sparse.csr_array(half + half.T + sparse.eye_array(n, dtype=bool))
    return sparse.csr_array((step[free] @ step) @ step[:, free])


def cotangent_weights(vertices: Vertices, triangles: Triangles) -> tuple[FloatArray, FloatArray]:
    """Weights (m, 3) of the edges opposite the corners, half their cotangents, and areas (n,) at the vertices.

    The cotangents of a sliver are scaled down together. Cut off one by one, its large weights would no longer cancel
    out, and one needle at a rim would crumple the fill.
    """
    corners = np.ascontiguousarray(vertices.T)[:, triangles.T]
    # Edge vectors (3, 3, m), by component and by the corner that they are opposite to.
    edges = corners[:, [2, 0, 1]] - corners[:, [1, 2, 0]]
    (ux, uy, uz), (vx, vy, vz) = edges[:, 2], -edges[:, 1]
    double_area = np.sqrt((uy * vz - uz * vy) ** 2 + (uz * vx - ux * vz) ** 2 + (ux * vy - uy * vx) ** 2)
    tiny = 1e-12 * double_area.mean() + 1e-300
    products = -np.einsum("xkm,xkm->km", edges[:, [1, 2, 0]], edges[:, [2, 0, 1]])
    cotangents = products / np.maximum(double_area, tiny)
    largest = np.abs(cotangents).max(axis=0, initial=0.0)
    weights = 0.5 * cotangents * (_MAX_COTANGENT / np.maximum(largest, _MAX_COTANGENT))
    area = np.asarray(np.bincount(triangles.ravel(), np.repeat(double_area / 6, 3), minlength=len(vertices)))
    return weights.T, np.maximum(area, 1e-6 * area[area > 0].mean())

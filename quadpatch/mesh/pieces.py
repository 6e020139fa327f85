"""Connected pieces of a mesh."""

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from quadpatch.types import IntArray, TriangleMesh


def connected_pieces(mesh: TriangleMesh) -> IntArray:
    """Find the connected piece (n_vertices,) int64 of every vertex, counted from 0."""
    n, triangles = len(mesh.vertices), mesh.triangles
    start, end = triangles[:, :2].ravel(), triangles[:, 1:].ravel()
    edges = coo_array((np.ones(len(start), bool), (start, end)), shape=(n, n))
    _, piece = connected_components(edges, directed=False)
    return np.asarray(piece, np.int64)
